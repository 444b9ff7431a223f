#!/bin/bash
# Every source with messages is in po/POTFILES, the template is current, and every catalogue is
# well formed. As TAP: messages.sh PROJECT
set -u
cd "$1" || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

number=0
verdict() { # STATUS NAME; what it saw comes on stdin
  number=$((number + 1))
  [ "$1" = 0 ] && echo "ok $number - $2" || echo "not ok $number - $2"
  sed 's/^/# /'
}

grep -rlE '\b(N?_|C_|ngettext) ?\("' --include='*.c' --include='*.h' core cli plugin 2>/dev/null |
  sort >"$work/with-messages"
grep -vE '^(#|$)' po/POTFILES | sort >"$work/listed"
comm -23 "$work/with-messages" "$work/listed" >"$work/unlisted"
[ ! -s "$work/unlisted" ]
verdict $? "POTFILES lists every source with messages" <"$work/unlisted"

while read -r file; do [ -e "$file" ] || echo "$file"; done <"$work/listed" >"$work/gone"
[ ! -s "$work/gone" ]
verdict $? "POTFILES lists only files that exist" <"$work/gone"

cp po/recede.pot "$work/recede.pot"
po/extract.sh "$work/recede.pot" && cmp -s po/recede.pot "$work/recede.pot"
verdict $? "po/recede.pot is current (else: ./dev messages)" < <(
  diff <(grep '^msgid' po/recede.pot) <(grep '^msgid' "$work/recede.pot")
)

while read -r language; do
  msgfmt --check --check-accelerators=_ --statistics -o /dev/null "po/$language.po" \
    >"$work/report" 2>&1
  verdict $? "po/$language.po is well formed" <"$work/report"
done < <(grep -vE '^(#|$)' po/LINGUAS | tr ' ' '\n')
echo "1..$number"
