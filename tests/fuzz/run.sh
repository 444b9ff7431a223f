#!/bin/bash
# `./dev fuzz [SECONDS [SEED]]`: each target for so long (60); without a seed, by chance. What it
# has found is kept in out/fuzz and used again; an input that breaks something is written there,
# and the target fails.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/../.."
project=$PWD # used by common.sh
# shellcheck source=tests/lib/common.sh
. tests/lib/common.sh

seconds=${1:-60} seed=${2:-0}
targets=(params fill)
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1

CC=clang CXX=clang++ configure build-fuzz -Dfuzz=true -Db_sanitize=address,undefined \
  -Db_lundef=false -Dbuildtype=debugoptimized -Dcommand=disabled -Dgimp2=disabled \
  -Dgimp3=disabled >/dev/null
ninja -C build-fuzz "${targets[@]/#/tests/fuzz/fuzz-}"

failed=0
for target in "${targets[@]}"; do
  found=$project/out/fuzz/$target
  mkdir -p "$found"
  echo "== $target, $seconds s"
  if ! "build-fuzz/tests/fuzz/fuzz-$target" -max_total_time="$seconds" -seed="$seed" \
    -max_len=6000 -timeout=60 -len_control=0 \
    -artifact_prefix="$project/out/fuzz/$target-" "$found" \
    >"$project/out/fuzz/$target.log" 2>&1; then
    failed=1
    grep -E 'ERROR|SUMMARY|Test unit written' "$project/out/fuzz/$target.log" || true
  fi
  tail -n 1 "$project/out/fuzz/$target.log"
done
exit $failed
