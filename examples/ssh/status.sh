#!/usr/bin/env bash
# The status of a PLC that another computer is connected to, over SSH:
#
#   examples/ssh/status.sh HOST [OPTIONS OF fatektool status]
#   examples/ssh/status.sh pi@gateway -p /dev/ttyUSB0 --brief
#
# fatektool is installed on HOST, where the PLC is plugged in; here there need be nothing but ssh. Prints what
# fatektool prints. The exit code is fatektool's, or 255 if HOST was not reached.
set -euo pipefail

host=${1:?usage: status.sh HOST [OPTIONS OF fatektool status]}
shift
# BatchMode: no question for a password, which nobody would answer at night. -n: ssh reads nothing from here.
# @Q: each option reaches fatektool as it was given here, with its spaces and its &.
exec ssh -n -o BatchMode=yes -o ConnectTimeout=10 "$host" "fatektool status ${*@Q}"
