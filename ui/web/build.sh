#!/bin/bash
# The lab in a web page: a folder of static files, and one page that holds all of them. What is
# missing for it is said, and then nothing is built.
#
#   build.sh SOURCE_ROOT BUILD_ROOT
#
# The page lies in BUILD_ROOT/web afterwards. libyaml and jansson come as Debian's sources, by a list
# of sources of their own, so that the system's stays as it is.
set -euo pipefail
export LC_ALL=C
export NODE_PATH=/usr/share/nodejs # where a node that is not Debian's does not look
source_root=$1
work=$2/web-module
page=$2/web
libraries=$work/libraries

skip() {
    echo "web is skipped: $*" >&2
    exit 0
}

# the two libraries' sources, once
fetch_sources() {
    mkdir -p "$libraries/lists/partial" "$libraries/archives/partial"
    cd "$libraries"
    local release
    release=$(. /etc/os-release && echo "${VERSION_CODENAME-}")
    echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg]" \
        "http://deb.debian.org/debian $release main" >sources.list
    local own=(-o "Dir::Etc::sourcelist=$PWD/sources.list" -o Dir::Etc::sourceparts=-
        -o "Dir::State::lists=$PWD/lists" -o "Dir::Cache=$PWD" -o APT::Sandbox::User=)
    apt-get "${own[@]}" -q update && apt-get "${own[@]}" -q source libyaml jansson
}

# compile NAME SOURCE... with the flags in `flags`: the archive libNAME.a
compile() {
    local name=$1 source objects=()
    shift
    for source; do
        objects+=("$name-$(basename "$source" .c).o")
        emcc -O2 -w "${flags[@]}" -c "$source" -o "${objects[-1]}"
    done
    emar rcs "lib$name.a" "${objects[@]}"
}

# describe NAME VERSION LIBRARY INCLUDE: what pkg-config answers of it
describe() {
    printf '%s\n' "Name: $1" "Description: $1 for a browser" "Version: $2" \
        "Libs: -L$libraries -l$3" "Cflags: -isystem $libraries/$4" >"$1.pc"
}

build_libraries() {
    cd "$libraries"
    local yaml jansson version
    yaml=$(echo libyaml-*/src) jansson=$(echo jansson-*/src)

    version=$(sed -E 's/.*-([0-9.]+).*/\1/' <<<"$yaml")
    local part=(${version//./ })
    local flags=(-DYAML_VERSION_MAJOR="${part[0]}" -DYAML_VERSION_MINOR="${part[1]}"
        -DYAML_VERSION_PATCH="${part[2]}" -DYAML_VERSION_STRING="\"$version\"" -I"$yaml/../include")
    compile yaml "$yaml"/*.c
    describe yaml-0.1 "$version" yaml "${yaml%/src}/include"

    # its settings for a machine without autoconf, and what autoconf would have found
    version=$(sed -E 's/.*-([0-9.]+).*/\1/' <<<"$jansson")
    cp "$jansson/../android/jansson_config.h" "$jansson"
    printf '#define %s 1\n' HAVE_STDINT_H HAVE_SYS_TYPES_H HAVE_SYS_TIME_H HAVE_UNISTD_H \
        >"$jansson/jansson_private_config.h"
    echo '#define INITIAL_HASHTABLE_ORDER 3' >>"$jansson/jansson_private_config.h"
    flags=(-DHAVE_CONFIG_H -I"$jansson")
    compile jansson "$jansson"/*.c
    describe jansson "$version" jansson "$jansson"
    touch done
}

for program in emcc:emscripten node:nodejs acorn:node-acorn dpkg-source:dpkg-dev apt-get:apt python3:python3; do
    command -v "${program%:*}" >/dev/null || skip "${program%:*} is missing (package ${program#*:})"
done

if [ ! -e "$libraries/done" ]; then
    fetch_sources >"$work.log" 2>&1 ||
        skip "the sources of libyaml and jansson cannot be had by apt-get ($work.log says why)"
    build_libraries
fi

if [ ! -e "$work/build.ninja" ]; then
    PKG_CONFIG_LIBDIR=$libraries meson setup "$work" "$source_root" --cross-file "$source_root/ui/web/emscripten.ini"
fi
ninja -C "$work" ui/web/impactlab.js

python3 "$source_root/ui/web/page_parts.py" "$source_root" "$work/ui/web" "$page"
echo "web: $page/index.html for a server, $page/impactlab.html for a file by itself"
