#!/bin/bash
# chroot-enter.sh FOLDER UID:GID PROJECT WORKDIR COMMAND...
# Called as root in a mount namespace of its own: mounts, then runs COMMAND in FOLDER. PROJECT, and
# its neighbour ../shared, have the same path inside; "-" for none.
set -euo pipefail

folder=$1 owner=$2 project=$3 workdir=$4
shift 4

bind() {
  mkdir -p "$folder$2"
  mount --bind "$1" "$folder$2"
}

mount --make-rprivate /
# A mount of its own, so that this script can be called again inside.
mount --bind "$folder" "$folder"
mount -t proc proc "$folder/proc"
mount --rbind /dev "$folder/dev"
mount -t tmpfs -o mode=1777 tmpfs "$folder/tmp"
mount -t tmpfs tmpfs "$folder/run"
# apt inside needs to find the mirror.
for file in /etc/resolv.conf /etc/hosts; do
  [ -e "$file" ] && cp -L "$file" "$folder$file"
done
if [ "$project" != - ]; then
  bind "$project" "$project"
  shared=$(dirname "$project")/shared
  [ -d "$shared" ] && bind "$(readlink -f "$shared")" "$shared"
fi
mkdir -p "$folder/tmp/home" "$folder/tmp/run"
chown "$owner" "$folder/tmp/home" "$folder/tmp/run"
chmod 700 "$folder/tmp/run"

settings=()
for name in CI TERM MESON_TESTTHREADS SOURCE_DATE_EPOCH \
  http_proxy https_proxy no_proxy ${!RECEDE_*}; do
  [ -n "${!name-}" ] && settings+=("$name=${!name}")
done
# shellcheck disable=SC2016 # expanded inside
chroot --userspec="$owner" "$folder" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp/home \
  XDG_RUNTIME_DIR=/tmp/run DEBIAN_FRONTEND=noninteractive LANG=C.UTF-8 "${settings[@]}" \
  sh -c 'cd "$1" && shift && exec "$@"' sh "$workdir" "$@"
