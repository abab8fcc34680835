#!/usr/bin/env bash
# The main job, as a script does it: every step's exit code is looked at.
# It ends with the PLC in RUN, so its machine may start: try it on sim:demo.state or on a spare PLC.
# Usage: tour.sh TARGET, such as sim:demo.state, /dev/ttyUSB0 or tcp://192.168.2.3
set -u
target=${1:?usage: tour.sh TARGET}
file=press.json

fatektool status -p "$target" --brief || exit

# 0 saved · 2 FILE is there already · 3 no answer · 4 the PLC refused · 5 what was read does not hold
fatektool backup "$file" -p "$target" --force || exit

fatektool verify "$file" -p "$target"
code=$?
case $code in
  0) echo "the PLC holds what is on file" ;;
  1) echo "the PLC's program was changed" ;;
  *) exit $code ;;
esac

# Nothing is asked without a terminal: --yes says what a person would be asked.
fatektool restore "$file" -p "$target" --stop --run --yes
code=$?
if [ $code -eq 6 ]; then
  echo "not complete: run the command that the message names, or put the safety backup back" >&2
fi
exit $code
