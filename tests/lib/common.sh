# Sourced by the scripts: root, the list of packages, build folders. $project: the project's folder.
# shellcheck shell=bash disable=SC2154

as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo -E "$@"
  else
    echo "needs root: $*" >&2
    return 1
  fi
}

# package_list GROUP...: the packages of those groups, one a line.
package_list() {
  awk -v groups=" $* " '
    /^\[/ { on = index(groups, " " substr($0, 2, length($0) - 2) " "); next }
    on && /^[a-z0-9]/ { print $1 }' "$project/packages.txt"
}

# missing_packages GROUP...: those of them that are not installed.
missing_packages() {
  local package
  for package in $(package_list "$@"); do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
      echo "$package"
  done
}

# install_packages GROUP...: unattended; does nothing when all are there.
install_packages() {
  local missing
  missing=$(missing_packages "$@")
  [ -z "$missing" ] && return
  echo "installing: ${missing//$'\n'/ }" >&2
  # A source other than Debian that cannot be reached must not stop us.
  as_root apt-get update -q || echo "apt-get update failed; trying to install all the same" >&2
  # shellcheck disable=SC2086 # one word a package
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends \
    -o DPkg::Lock::Timeout=300 $missing
}

# configure FOLDER OPTION...: sets a build folder up, or applies changed options.
configure() {
  if [ -e "$1/build.ninja" ]; then
    meson configure "$@"
  else
    rm -rf "$1"
    meson setup "$@"
  fi
}

# The Debian mirror that this machine's own apt uses, whatever the format of its sources. Nothing
# when there is none; debootstrap then has its own.
mirror() {
  apt-get indextargets --format "\$(ORIGIN) \$(CODENAME) \$(REPO_URI)" 'Created-By: Packages' |
    awk '$1 == "Debian" && $2 !~ /-/ { print $3; exit }'
}

# make_debian SUITE FOLDER: a minimal Debian with this machine's mirror, unattended and lean.
make_debian() {
  local conf uri apt=$2/etc/apt/apt.conf.d
  uri=$(mirror)
  if [ -z "$uri" ]; then # apt's lists may have been cleaned away
    as_root apt-get update -q
    uri=$(mirror)
  fi
  as_root debootstrap --variant=minbase --include=ca-certificates \
    --keyring=/usr/share/keyrings/debian-archive-keyring.gpg "$1" "$2" ${uri:+"$uri"}
  # The machine's own proxy and validity settings, where it has any.
  for conf in /etc/apt/apt.conf.d/99*; do
    [ -e "$conf" ] && as_root cp "$conf" "$apt/"
  done
  printf 'APT::Install-Recommends "false";\nAcquire::Languages "none";\n' |
    as_root tee "$apt/90recede" >/dev/null
  # No daemon starts inside.
  printf '#!/bin/sh\nexit 101\n' | as_root tee "$2/usr/sbin/policy-rc.d" >/dev/null
  as_root chmod 755 "$2/usr/sbin/policy-rc.d"
}
