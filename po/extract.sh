#!/bin/bash
# Writes the template of all messages: extract.sh OUT. The sources stand in POTFILES.
set -euo pipefail
out=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# core/params.c marks with N_, the programs translate with _.
xgettext --files-from=po/POTFILES --output="$out.new" --from-code=UTF-8 \
  --sort-by-file --add-location=file \
  --add-comments=Translators --keyword=_ --keyword=N_ --keyword=C_:1c,2 --keyword=ngettext:1,2 \
  --package-name=recede --copyright-holder="The Recede developers" \
  --msgid-bugs-address="see README.md"
# The date alone is no change.
if [ -e "$out" ] && cmp -s <(grep -v '^"POT-Creation-Date' "$out") \
  <(grep -v '^"POT-Creation-Date' "$out.new"); then
  rm "$out.new"
else
  mv "$out.new" "$out"
fi
