#!/bin/sh
# install_as.sh -- installs a file under another name: FILE FOLDER NAME, the folder below the prefix.
set -eu
to="$MESON_INSTALL_DESTDIR_PREFIX/$2"
mkdir -p "$to"
install -m 644 "$1" "$to/$3"
