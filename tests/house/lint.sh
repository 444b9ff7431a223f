#!/bin/bash
# shellcheck disable=SC2317 # functions are called through check()
# `./dev lint`: all that can be said about the sources without running them. Fails at the end when
# anything was found, after having said everything.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 1
found=0

check() {
  local name=$1
  shift
  echo "== $name"
  "$@" || found=1
}

tracked() {
  git ls-files -- "$@" | while read -r file; do [ -e "$file" ] && echo "$file"; done
}

formatting() {
  tracked '*.c' '*.h' '*.cpp' | xargs clang-format --dry-run -Werror
}

static_checks() {
  # missingInclude: cppcheck reads no system headers. ctuuninitvar: it does not know that GLib sets
  # a GError when it returns false. fill_plane.c: its loop over the levels runs at least once.
  tracked 'core/*.c' 'cli/*.c' 'cli/*.cpp' 'plugin/*.c' |
    cppcheck --file-list=- --quiet --error-exitcode=1 --inline-suppr --std=c11 -I core \
      --enable=warning,performance,portability --suppress=missingInclude \
      --suppress=missingIncludeSystem --suppress=unknownMacro --suppress=ctuuninitvar \
      --suppress=uninitvar:core/synthesis/fill_plane.c --library=gtk \
      --template='{file}:{line}: {severity}: {message} [{id}]'
}

shell_checks() {
  # dev and .ci/run have no suffix.
  tracked 'dev' '.ci/run' '*.sh' | xargs shellcheck -x
}

lengths() {
  tracked '*.c' '*.h' '*.cpp' '*.py' '*.sh' dev | xargs wc -l |
    awk '$2 != "total" && $1 > 400 { print $2 ": " $1 " lines, more than 400"; bad = 1 }
         END { exit bad }'
}

widths() {
  ! tracked '*.c' '*.h' '*.cpp' '*.py' '*.sh' '*meson.build' dev |
    xargs grep -HnE '^.{101,}$'
}

tap() { # shows only what failed
  local output
  output=$("$@")
  ! grep -A 20 '^not ok' <<<"$output"
}

check "clang-format" formatting
check "cppcheck" static_checks
check "shellcheck" shell_checks
check "at most 400 lines a file" lengths
check "at most 100 columns" widths
check "direction of includes" tap /usr/bin/python3 tests/house/includes.py .
check "recede.h alone" tap tests/house/header.sh "$PWD" cc c++
check "messages" tap tests/house/messages.sh "$PWD"
exit $found
