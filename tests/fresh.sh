#!/bin/bash
# `./dev fresh`: runs a subcommand of ./dev in a bare Debian 12, made for it and removed after: what
# someone meets who has just installed the system. fresh.sh SUBCOMMAND...  Needs root or sudo.
# Only what is committed goes in. RECEDE_KEEP=FOLDER keeps it, and uses it again.
set -euo pipefail
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
# shellcheck source=tests/lib/common.sh
. "$project/tests/lib/common.sh"
cd /

folder=${RECEDE_KEEP:-$(mktemp -d)}
if [ -z "${RECEDE_KEEP:-}" ]; then
  trap 'as_root rm -rf --one-file-system "$folder"' EXIT
fi
if [ ! -e "$folder/etc/debian_version" ]; then
  make_debian bookworm "$folder"
fi
as_root rm -rf "$folder/root/recede"
as_root git -c safe.directory='*' clone --quiet --no-local "$project" "$folder/root/recede"
as_root unshare --mount --pid --fork --kill-child bash "$project/tests/lib/chroot-enter.sh" \
  "$folder" 0:0 - /root/recede ./dev "$@"
