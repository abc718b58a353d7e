#!/bin/bash
# The same bytes from the library compiled at -O1, -O2 and -O3: nothing may depend on how the
# compiler arranges the arithmetic.
#
#   optimisation_levels.sh SOURCE-FOLDER BUILD-FOLDER [COMPILER [ARGUMENT...]]
#
# Objects stay in BUILD-FOLDER/optimisation-levels, so that a second call compiles only what changed.
set -euo pipefail
script=$(readlink -f -- "${BASH_SOURCE[0]}")
cd -- "$1"
work=$2/optimisation-levels
cc=("${@:3}")
[ ${#cc[@]} -gt 0 ] || cc=(cc)

# how everything is compiled and linked, one argument an element: folders may have blanks
flags=(-std=c17 -D_GNU_SOURCE -ffp-contract=off -Wno-psabi -I. "-I$2/..")
# shellcheck disable=SC2207
flags+=($(pkg-config --cflags yaml-0.1 jansson))
# shellcheck disable=SC2207
libraries=($(pkg-config --libs yaml-0.1 jansson sqlite3) -ldl -lm -lpthread)

# what a run needs: the library below the studies, which make many runs or time them, and its own
# interface above
mapfile -t sources < <(find src tests/optimisation_runs.c -name '*.c' | grep -Ev '^src/(api|study)/' | sort)
newest_header=$(find src -name '*.h' -printf '%T@\n' | sort -n | tail -n 1)

# level and source of every object to be made, two words an object
stale() {
    local level source object
    for level in 1 2 3; do
        mkdir -p "$work/$level"
        for source in "${sources[@]}"; do
            object=$work/$level/${source//\//_}.o
            if [ ! -e "$object" ] || [ "$source" -nt "$object" ] || [ "$script" -nt "$object" ] ||
                [ "$(stat -c %Y "$object")" -le "${newest_header%.*}" ]; then
                printf '%s\0%s\0' "$level" "$source"
            fi
        done
    done
}

# the compiler's words come first, then level and source
make_object() {
    local words=("${@:1:$#-2}") level=${*: -2:1} source=${*: -1}
    "${words[@]}" "-O$level" -c "$source" -o "$work/$level/${source//\//_}.o"
}
export work
export -f make_object
# shellcheck disable=SC2016
stale | xargs -0 -r -n 2 -P "$(nproc)" bash -c 'make_object "$@"' each "${cc[@]}" "${flags[@]}"

for level in 1 2 3; do
    # objects of sources that are gone must not be linked
    objects=()
    for source in "${sources[@]}"; do
        objects+=("$work/$level/${source//\//_}.o")
    done
    "${cc[@]}" -o "$work/runs-O$level" "${objects[@]}" "${libraries[@]}"
    "$work/runs-O$level" >"$work/O$level.txt"
done

lines=$(wc -l <"$work/O1.txt")
if [ "$lines" -lt 1000 ]; then
    echo "only $lines lines were written"
    exit 1
fi
for level in 1 3; do
    if ! cmp "$work/O2.txt" "$work/O$level.txt"; then
        echo "-O$level does not give the bytes of -O2; the first differences are"
        diff "$work/O2.txt" "$work/O$level.txt" | head -n 10 || true
        exit 1
    fi
done
echo "$lines lines, the same bytes at -O1, -O2 and -O3"
