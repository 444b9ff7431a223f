#!/bin/bash
# A display, a window manager and a session of their own for a test:
# windowed.sh [--screen WIDTHxHEIGHT] COMMAND...
set -uo pipefail
screen=1400x900
if [ "$1" = --screen ]; then
  screen=$2
  shift 2
fi
work=$(mktemp -d)
trap 'kill $xvfb 2>/dev/null; rm -rf "$work"' EXIT
Xvfb -displayfd 6 -screen 0 "${screen}x24" -nolisten tcp 6>"$work/display" >/dev/null 2>&1 &
xvfb=$!
for _ in $(seq 100); do [ -s "$work/display" ] && break; sleep .1; done
DISPLAY=:$(cat "$work/display")
export DISPLAY XDG_RUNTIME_DIR=$work GSETTINGS_BACKEND=memory
chmod 700 "$work"
# shellcheck disable=SC2016 # expanded inside
dbus-run-session -- bash -c '
  openbox >/dev/null 2>&1 &
  manager=$!
  "$@"
  status=$?
  kill $manager
  exit $status' windowed "$@" 2>"$work/stderr"
status=$?
grep -vE 'dbus-daemon|SpiRegistry|^$' "$work/stderr" | tail -20 >&2
exit $status
