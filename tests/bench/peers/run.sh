#!/bin/bash
# Builds the peers whose libraries are installed and runs them side by side with impactlab.
#
#   tests/bench/peers/run.sh [--rounds N] [--json FILE|-]
#
# IMPACTLAB_PEERS_BUILD names another build folder, CC and CXX other compilers. README.md beside
# this file tells which packages to install and how to read the tables.
set -euo pipefail

here=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")
root=$(readlink -f -- "$here/../../..")
build=${IMPACTLAB_PEERS_BUILD:-$root/build-peers}
objects=$build/peers-objects
cc=${CC:-cc}
cxx=${CXX:-c++}

say() {
    printf 'peers: %s\n' "$*" >&2
}

give_up() {
    say "$@"
    exit 1
}

# shows what a quiet command had to say only if it failed
quietly() {
    if ! "$@" >"$build/peers.log" 2>&1 </dev/null; then
        cat "$build/peers.log" >&2
        return 1
    fi
}

# the library as it is shipped: optimised, without sanitizers
mkdir -p "$objects"
if [ ! -e "$build/build.ninja" ]; then
    say "setting up $build"
    quietly meson setup "$build" "$root" --buildtype=release -Dtests=false ||
        give_up "impactlab could not be set up; './lab build' installs what it needs"
fi
quietly ninja -C "$build" src/libimpactlab.a || give_up "impactlab's library could not be built"

version=$(sed -n "s/^ *version: '\([^']*\)',.*/\1/p" "$root/meson.build" | head -n 1)
flags=(-O3 -D_GNU_SOURCE -ffp-contract=off -Wall -Wextra "-I$root"
    "-DIMPACTLAB_VERSION=\"$version\"")
read -r -a libraries <<<"$(pkg-config --libs yaml-0.1 jansson) -lm"
used=()
linker=$cc

# true if the compiler $1 (with its options) finds header $2 in language $3
has_header() {
    # shellcheck disable=SC2086
    printf '#include <%s>\n' "$2" | $1 -x "$3" -E - >/dev/null 2>&1
}

compile_c() {
    # shellcheck disable=SC2086
    $cc -std=c17 "${flags[@]}" "${@:2}" -c "$here/$1.c" -o "$objects/$1.o" </dev/null >&2
}

# C++ headers are slow to read: compiled only when something changed
# compile_cxx NAME OPTION...
compile_cxx() {
    local object=$objects/${1}_peer.o source=$here/${1}_peer.cpp
    if [ "$object" -nt "$source" ] && [ "$object" -nt "$here/peer.h" ]; then
        return 0
    fi
    say "compiling the $1 peer, this takes a moment"
    # shellcheck disable=SC2086
    $cxx -std=c++17 "${flags[@]}" "${@:2}" -c "$source" -o "$object" </dev/null >&2
}

# Siconos's headers include each other from folders of their own, beside its configuration
compile_siconos() {
    local folder version
    # shellcheck disable=SC2086
    folder=$(printf '#include <siconos/SiconosConfig.h>\n' | $cxx -x c++ -M - |
        tr ' ' '\n' | sed -n 's,/SiconosConfig.h$,,p')
    version=$(dpkg-query -W -f '${Version}' libsiconos-kernel-dev 2>/dev/null || true)
    compile_cxx siconos -isystem "$folder" -isystem "$folder/kernel" -isystem "$folder/numerics" \
        "-DSICONOS_VERSION=\"${version%%[+-]*}\""
}

# take_peer NAME COMMAND...: takes the peer in if the command succeeds
take_peer() {
    local name=$1
    shift
    if "$@"; then
        used+=("-DPEERS_${name^^}")
        inputs+=("$objects/${name}_peer.o")
        return 0
    fi
    say "the $name peer could not be compiled, left out"
    return 1
}

inputs=()
for source in peer impactlab_peer; do
    compile_c "$source" || give_up "$source.c could not be compiled"
    inputs+=("$objects/$source.o")
done

if ! has_header "$cc" mujoco/mujoco.h c; then
    say "no MuJoCo here (package libmujoco-dev), left out"
elif take_peer mujoco compile_c mujoco_peer; then
    libraries+=(-lmujoco)
fi
if ! has_header "$cxx" siconos/SiconosConfig.h c++; then
    say "no Siconos here (package libsiconos-kernel-dev), left out"
elif take_peer siconos compile_siconos; then
    libraries+=(-lsiconos_kernel -lsiconos_numerics)
    linker=$cxx
fi

compile_c peers "${used[@]}" || give_up "peers.c could not be compiled"
# shellcheck disable=SC2086
quietly $linker -o "$build/peers" "$objects/peers.o" "${inputs[@]}" "$build/src/libimpactlab.a" \
    "${libraries[@]}" || give_up "the peers could not be linked"
exec "$build/peers" "$@"
