#!/bin/bash
# `./dev test`: builds and runs the tests. A line for every failing one with the path of its log;
# the last line is `N passed, N failed`, counting single cases. Fails when one did, or none ran.
set -uo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
project=$PWD # used by common.sh too
# shellcheck source=tests/lib/common.sh
. tests/lib/common.sh

logs=$project/out/test-logs # one folder for the whole run, emptied at its start
names=()
fast=0 sanitize='' ci=0

for argument; do
  case $argument in
    --fast) fast=1 ;;
    --sanitize) sanitize=sanitize ;;
    --sanitize-threads) sanitize=threads ;;
    --ci) ci=1 ;;
    -*)
      echo "test: no such option: $argument" >&2
      exit 2
      ;;
    *) names+=("$argument") ;;
  esac
done

# step NAME COMMAND...: something that must succeed for tests to be run; a failure counts as one.
step() {
  local name=$1
  shift
  echo "== $name"
  if ! "$@" >"$logs/$name.log" 2>&1 </dev/null; then
    tail -n 30 "$logs/$name.log"
    echo "$name: $* failed" >>"$logs/failed-steps"
    return 1
  fi
}

# meson_test LABEL PREFIX FOLDER ARGUMENT...: PREFIX is a command to run meson with, or nothing.
meson_test() {
  local label=$1 folder=$3 prefix
  read -ra prefix <<<"$2"
  shift 3
  echo "== $label"
  rm -f "$folder/meson-logs/testlog".*
  "${prefix[@]}" meson test -C "$folder" --no-rebuild --print-errorlogs "$@" \
    >"$logs/$label.out" 2>&1 </dev/null
  grep -E '^ *[0-9]+/[0-9]+ ' "$logs/$label.out"
  # Absent when no test matched: then nothing is counted.
  if [ -e "$folder/meson-logs/testlog.json" ]; then
    cp "$folder/meson-logs/testlog.json" "$logs/$label.testlog.json"
  fi
}

native() {
  step configure configure build -Dwerror=true && step compile ninja -C build || return
  if [ ${#names[@]} -gt 0 ]; then
    meson_test named "" build "${names[@]}"
    return
  fi
  meson_test fast "" build --suite fast
  if [ $fast = 0 ]; then
    meson_test full "" build --no-suite fast --no-suite gimp2 --timeout-multiplier 2
  fi
}

build_sanitized() {
  local label=$1 folder=build-$1 sanitizers=address,undefined
  [ "$label" = threads ] && sanitizers=thread
  step "configure-$label" configure "$folder" "-Db_sanitize=$sanitizers" -Db_lundef=false \
    -Dbuildtype=debugoptimized -Db_ndebug=false -Dgimp2=disabled -Dgimp3=disabled || return
  step "compile-$label" nice ninja -C "$folder"
}

# sanitized KIND: the tests of core and command under sanitizers, in a build folder of their own,
# which is built.
sanitized() {
  local label=$1 folder=build-$1
  export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1:malloc_context_size=12
  export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
  export LSAN_OPTIONS=suppressions=$project/tests/house/lsan.supp:print_suppressions=0
  export TSAN_OPTIONS=suppressions=$project/tests/house/tsan.supp:print_suppressions=0
  # It says little of a forked child.
  [ "$label" = threads ] && export RECEDE_TEST_ONE_BY_ONE=1
  local selection=(--no-suite house --no-suite quality)
  [ $fast = 1 ] && selection=(--suite fast --no-suite house)
  [ ${#names[@]} -gt 0 ] && selection=("${names[@]}")
  meson_test "$label" "" "$folder" --timeout-multiplier 6 "${selection[@]}"
}

# gimp HOST INSIDE FOLDER ARGUMENT...: its tests, of which there must be some.
gimp() {
  local host=$1 inside=$2 folder=$3
  shift 3
  meson_test "gimp$host" "$inside" "$folder" --suite "gimp$host" --timeout-multiplier 2 "$@"
  [ -e "$logs/gimp$host.testlog.json" ] && return
  cp "$logs/gimp$host.out" "$logs/gimp$host-tests.log"
  echo "gimp$host-tests: no test ran in GIMP $host" >>"$logs/failed-steps"
}

gimp2() {
  gimp 2 "" build --no-suite fast
}

gimp3() {
  local inside=tests/gimp/chroot.sh
  step chroot-gimp3 $inside make || return
  step configure-gimp3 $inside run bash -c '
    . tests/lib/common.sh && configure build-gimp3 -Dgimp2=disabled -Dgimp3=enabled' || return
  step compile-gimp3 $inside run ninja -C build-gimp3 || return
  gimp 3 "$inside run" build-gimp3
}

# succeeded STEP PROCESS: waits for steps in the background, STEP the last of them; if they fail and
# none of theirs is on the list, they were killed.
succeeded() {
  wait "$2" && return
  grep -qs -e "${1#*-}: " "$logs/failed-steps" || echo "$1: ended by itself" >>"$logs/failed-steps"
  return 1
}

# GIMP's windows keep one core busy: what needs no window goes on beside them.
gimp_and_sanitizers() {
  local building fuzzing
  build_sanitized sanitize &
  building=$!
  gimp2
  step fuzz-packages install_packages fuzz
  step fuzz nice tests/fuzz/run.sh 20 1 &
  fuzzing=$!
  gimp3
  succeeded fuzz "$fuzzing"
  succeeded compile-sanitize "$building" && sanitized sanitize
}

if [ $ci = 1 ] && [ $# -gt 1 ]; then
  echo "test: --ci is everything, and goes with nothing else: $*" >&2
  exit 2
fi
rm -rf "$logs"
mkdir -p "$logs"
groups=(build)
[ $fast = 1 ] || groups+=(plugin test)
step packages install_packages "${groups[@]}"
if [ $fast = 0 ] && [ -z "$sanitize" ] && [ ${#names[@]} = 0 ]; then
  # Minutes of fetching and unpacking beside the first tests; gimp3() waits for it, and reports.
  nice tests/gimp/chroot.sh make >/dev/null 2>&1 </dev/null &
fi
if [ -n "$sanitize" ]; then
  build_sanitized "$sanitize" && sanitized "$sanitize"
else
  if native; then
    if [ $ci = 1 ]; then
      gimp_and_sanitizers
    elif [ $fast = 0 ] && [ ${#names[@]} = 0 ]; then
      gimp2
      gimp3
    fi
  fi
fi
/usr/bin/python3 tests/lib/summary.py "$logs"
