#!/bin/bash
# Makes the README's before/after pictures with the command itself. Needs build/ and imagemagick.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# pair NAME CROP OPTION...: docs/images/NAME.jpg with its hole shown, beside its fill.
pair() {
  local images=docs/images name=$1 crop=$2
  shift 2
  build/cli/recede fill "$images/$name.jpg" --mask "$images/$name-mask.png" -o "$work/after.png" \
    --force "$@"
  convert "$images/$name.jpg" \( -clone 0 -fill '#ff2d95' -colorize 100 \) \
    "$images/$name-mask.png" -composite "$work/before.png"
  convert "$work/before.png" "$work/after.png" -crop "$crop" +repage -bordercolor white \
    -border 4x0 +append -quality 88 -strip "$images/$name-before-after.jpg"
}

pair pier 620x400+290+390 --horizon 0,362,1200,362
pair motorway 560x260+60+280 --horizon 0,302,960,302
pair roofs 330x230+10+235 --frontal

# laid NAME SLANT: tests/data/NAME.png, from the front, beside a floor of it.
laid() {
  local texture=tests/data/$1.png
  build/cli/recede synthesize "$texture" -o "$work/floor.png" --size 640x320 --slant "$2" \
    --exemplar frontal --force
  convert "$texture" -crop 320x320+0+0 +repage "$work/texture.png"
  convert "$work/texture.png" "$work/floor.png" -bordercolor white -border 4x0 +append \
    "$work/$1.png"
}

laid sk_gravel 64
laid brick_regular 64
convert "$work/sk_gravel.png" "$work/brick_regular.png" -bordercolor white -border 0x4 -append \
  -quality 88 -strip docs/images/laid.jpg
