#!/bin/bash
# The plug-in into the user's GIMP folders, or out of them: install.sh install|uninstall
# For a system: meson install. RECEDE_BUILD names a build folder, default build.
set -euo pipefail

project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
build=${RECEDE_BUILD:-$project/build}
config=${XDG_CONFIG_HOME:-$HOME/.config}/GIMP
# Where GIMP looks; its own variables name another profile.
folder_of_2=${GIMP2_DIRECTORY:-$config/2.10}/plug-ins/recede

# GIMP 3.0 and 3.2 each have a folder, made when they are first started.
folders_of_3() {
  local profiles=("$config"/3.*)
  [ -d "${profiles[0]}" ] || profiles=("$config/3.0")
  [ -n "${GIMP3_DIRECTORY:-}" ] && profiles=("$GIMP3_DIRECTORY")
  printf '%s/plug-ins/recede\n' "${profiles[@]}"
}

catalogues() { # FOLDER
  local language
  while read -r language; do
    mkdir -p "$1/locale/$language/LC_MESSAGES"
    msgfmt -o "$1/locale/$language/LC_MESSAGES/recede.mo" "$project/po/$language.po"
  done < <(grep -vE '^(#|$)' "$project/po/LINGUAS" | tr ' ' '\n')
}

# put HOST EXECUTABLE FOLDER
put() {
  # GIMP may be running it: replaced, not overwritten.
  mkdir -p "$3"
  cp "$2" "$3/recede.new"
  mv "$3/recede.new" "$3/recede"
  rm -rf "$3/help"
  cp -r "$project/plugin/data/help" "$3/"
  cp "$project/plugin/data/recede.svg" "$3/"
  catalogues "$3"
  echo "GIMP $1: $3 (start GIMP again; Filters > Enhance > Perspective Fill)"
}

install_all() {
  local found=0 built folder
  [ -e "$build/build.ninja" ] || meson setup "$build" "$project"
  ninja -C "$build"
  if [ -e "$build/plugin/gimp2/recede" ]; then
    put 2.10 "$build/plugin/gimp2/recede" "$folder_of_2"
    found=1
  fi
  # Built here where GIMP 3 is, else by the tests in their chroot.
  for built in "$build" "$project/build-gimp3"; do
    if [ -e "$built/plugin/gimp3/recede" ]; then
      while read -r folder; do
        put 3 "$built/plugin/gimp3/recede" "$folder"
      done < <(folders_of_3)
      found=1
      break
    fi
  done
  if [ $found = 0 ]; then
    echo "install.sh: neither GIMP 2.10's nor GIMP 3's development files are here" >&2
    return 1
  fi
}

case "${1:-}" in
  install) install_all ;;
  uninstall)
    rm -rf "$folder_of_2"
    folders_of_3 | xargs -d '\n' rm -rf
    ;;
  *)
    echo "usage: install.sh install|uninstall" >&2
    exit 2
    ;;
esac
