#!/bin/bash
# core/recede.h compiles alone, as C11 and as C++17, without a warning. As TAP.
# header.sh PROJECT CC CXX
set -u
header=$1/core/recede.h
number=0
echo 1..2
for language in "$2 -std=c11 -Wstrict-prototypes -x c" "$3 -std=c++17 -x c++"; do
  number=$((number + 1))
  # shellcheck disable=SC2086 # a command and its arguments
  if output=$(echo '#include "'"$header"'"' |
    $language -Wall -Wextra -Wpedantic -Wconversion -Werror -fsyntax-only - 2>&1); then
    echo "ok $number - $language"
  else
    echo "not ok $number - $language"
    printf '%s\n' "${output//#/}" | sed 's/^/# /'
  fi
done
