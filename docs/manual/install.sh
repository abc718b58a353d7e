#!/bin/sh
# Installs a page, such as the manual, if it has been built.
#
#   install.sh PAGE.html FOLDER
set -eu
case $2 in
/*) folder=${DESTDIR:-}$2 ;;
*) folder=$MESON_INSTALL_DESTDIR_PREFIX/$2 ;;
esac
if [ -e "$1" ]; then
    mkdir -p "$folder"
    cp "$1" "$folder"
fi
