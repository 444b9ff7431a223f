#!/bin/bash
# `./dev demo`: fills the hole in the photo of a pier and says where to look.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

photo=docs/images/pier.jpg mask=docs/images/pier-mask.png folder=out/demo
result=$folder/pier-filled.png
mkdir -p "$folder"
echo
echo "+ recede fill $photo --mask $mask -o $result"
build/cli/recede fill "$photo" --mask "$mask" -o "$result" --force --json "$folder/report.json"
echo
echo "the photo:     $PWD/$photo"
echo "the hole:      $PWD/$mask (white)"
echo "the result:    $PWD/$result"
echo "how it went:   $PWD/$folder/report.json"
