#!/bin/bash
# `./dev bench plugin [2|3]`: how fast the plug-in answers in a running GIMP, and what it adds to
# the command's time. GIMP 3 (build-gimp3/, made by ./dev test) runs in its chroot.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
host=${1:-2}
build=build
inside=()
if [ "$host" = 3 ]; then
  build="build-gimp3"
  inside=(tests/gimp/chroot.sh run)
fi
exec "${inside[@]}" tests/gimp/windowed.sh /usr/bin/python3 tests/gimp/bench.py "$host" \
  "$build/plugin/gimp$host/recede" "$build/cli/recede"
