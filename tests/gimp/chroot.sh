#!/bin/bash
# A Debian 13 (trixie) root folder with GIMP 3: no Debian release has both GIMP 2.10 and GIMP 3.
#
#     chroot.sh make            make it, or make it anew when packages.txt's [gimp3] has changed
#     chroot.sh run COMMAND...  run COMMAND inside, in the current folder
#     chroot.sh path            where it is: $RECEDE_CHROOT, default ~/.cache/recede/trixie
#
# Inside, the project and its neighbour ../shared have the same path as outside; the rest of the
# machine is not there. Mounts and left-over processes vanish with the command. Needs root or sudo.
set -euo pipefail

suite=trixie
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
root=${RECEDE_CHROOT:-${XDG_CACHE_HOME:-$HOME/.cache}/recede/$suite}
# shellcheck source=tests/lib/common.sh
. "$project/tests/lib/common.sh"

wanted_stamp() {
  echo "$suite"
  package_list gimp3
}

# inside FOLDER USER:GROUP COMMAND...: the mounts live in a namespace of their own.
inside() {
  local folder=$1 owner=$2
  shift 2
  as_root unshare --mount --pid --fork --kill-child \
    bash "$project/tests/lib/chroot-enter.sh" "$folder" "$owner" "$project" "$PWD" "$@"
}

make_root() {
  local new="$root.new"
  as_root rm -rf --one-file-system "$new"
  mkdir -p "$(dirname "$root")"
  make_debian "$suite" "$new"
  # shellcheck disable=SC2046 # one word a package
  inside "$new" 0:0 apt-get install -y -q $(package_list gimp3)
  inside "$new" 0:0 apt-get clean
  wanted_stamp | as_root tee "$new/etc/recede-stamp" >/dev/null
  as_root rm -rf --one-file-system "$root"
  as_root mv "$new" "$root"
}

up_to_date() {
  wanted_stamp | cmp -s - "$root/etc/recede-stamp"
}

# Two callers at once: the second waits, then finds it made.
make_once() {
  up_to_date && return
  mkdir -p "$(dirname "$root")"
  exec 9>"$root.lock"
  flock 9
  up_to_date && return
  echo "chroot.sh: making $root (a few minutes, 2 GB)" >&2
  # Another process, for `set -e` is off in a condition.
  "${BASH_SOURCE[0]}" make-locked >"$root.log" 2>&1 9>&- || {
    tail -n 20 "$root.log" >&2
    echo "chroot.sh: $root could not be made; the whole log is $root.log" >&2
    return 1
  }
}

case "${1:-}" in
  make) make_once ;;
  make-locked) make_root ;; # called by make, which holds the lock
  run)
    shift
    up_to_date || {
      echo "chroot.sh: $root is missing or old; run $0 make" >&2
      exit 1
    }
    inside "$root" "$(id -u):$(id -g)" "$@"
    ;;
  path) echo "$root" ;;
  *)
    sed -n '2,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
    exit 2
    ;;
esac
