#!/usr/bin/env bash
# The status of the PLCs at many computers, over SSH, eight computers at once:
#
#   examples/ssh/status_of_many.sh hosts.txt
#
# A line of hosts.txt is what status.sh takes, as a shell reads it: a host, then options of 'fatektool status'.
#
#   pi@press-hall  -p /dev/ttyUSB0
#   pi@oven        -p tcp://192.168.2.3 --station 2
#
# Prints what each one says with its host before it, in the order of the file, and at the end how many answered.
# Exit code 0 if all did, 1 if one did not: its code is printed, 255 for a host that was not reached.
set -euo pipefail

file=${1:?usage: status_of_many.sh HOSTS_FILE}
one=$(dirname "$0")/status.sh
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT

mapfile -t lines < <(grep -vE '^[[:space:]]*(#|$)' "$file")
if [ "${#lines[@]}" -eq 0 ]; then
  echo "$file: expected a host in each line, got none" >&2
  exit 2
fi
running=0
for number in "${!lines[@]}"; do
  eval "words=(${lines[number]})"
  {
    code=0
    "$one" "${words[@]}" >"$results/$number.out" 2>"$results/$number.err" || code=$?
    echo "$code" >"$results/$number.code"
  } &
  running=$((running + 1))
  if [ "$running" -ge 8 ]; then
    wait -n
    running=$((running - 1))
  fi
done
wait

well=0
for number in "${!lines[@]}"; do
  read -r host _ <<<"${lines[number]}"
  while IFS= read -r line; do printf '%s: %s\n' "$host" "$line"; done <"$results/$number.out"
  while IFS= read -r line; do printf '%s: %s\n' "$host" "$line"; done <"$results/$number.err" >&2
  if [ "$(cat "$results/$number.code")" -eq 0 ]; then
    well=$((well + 1))
  else
    echo "$host: no status, exit code $(cat "$results/$number.code")" >&2
  fi
done
echo "$well of ${#lines[@]} answered"
[ "$well" -eq "${#lines[@]}" ]
