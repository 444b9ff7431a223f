#!/bin/bash
# `./dev demo`: fills the hole in the photo of a pier and says where to look.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

photo=docs/images/pier.jpg folder=out/demo
result=$folder/pier-filled.png
mkdir -p "$folder"
set -x
build/cli/recede fill $photo --mask docs/images/pier-mask.png --horizon 0,362,1200,362 \
  -o $result --force --json $folder/report.json
{ set +x; } 2>/dev/null
echo
echo "the photo:   $PWD/$photo"
echo "the hole:    $PWD/docs/images/pier-mask.png (white; planks are copied, the water is not)"
echo "the result:  $PWD/$result"
