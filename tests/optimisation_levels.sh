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
mapfile -t sources < <(find src tests/optimisation_runs.c -name '*.c' | grep -Ev '^src/(api|study|exchange)/|_plain\.c$' | sort)
# the engines' kernels are compiled once for each width (src/engines/meson.build): SOURCE@WIDTH
units=()
for source in "${sources[@]}"; do
    case $source in
    */taylor_kernel.c) units+=("$source"@{1,1_avx2,2,4,8}) ;;
    */stiff_kernel.c) units+=("$source"@{1,4}) ;;
    *) units+=("$source") ;;
    esac
done

# the compiler's words come first, then a unit and its object
compile_unit() {
    local words=("${@:1:$#-2}") unit=${*: -2:1} object=${*: -1}
    if [[ $unit == *@* ]]; then
        local width=${unit#*@} engine=${unit##*/}
        words+=("-DLANES=${width%%_*}" "-DLOOPS=${engine%%_*}_loops_$width")
    fi
    "${words[@]}" -c "${unit%@*}" -o "$object"
}
export -f compile_unit
newest_header=$(find src -name '*.h' -printf '%T@\n' | sort -n | tail -n 1)

# level, unit and object of every object to be made, three words an object
stale() {
    local level unit object
    for level in 1 2 3; do
        mkdir -p "$work/$level"
        for unit in "${units[@]}"; do
            object=$work/$level/${unit//\//_}.o
            if [ ! -e "$object" ] || [ "${unit%@*}" -nt "$object" ] || [ "$script" -nt "$object" ] ||
                [ "$(stat -c %Y "$object")" -le "${newest_header%.*}" ]; then
                printf '%s\0%s\0%s\0' "-O$level" "$unit" "$object"
            fi
        done
    done
}
# shellcheck disable=SC2016
stale | xargs -0 -r -n 3 -P "$(nproc)" bash -c 'compile_unit "$@"' each "${cc[@]}" "${flags[@]}"

for level in 1 2 3; do
    # objects of sources that are gone must not be linked
    objects=()
    for unit in "${units[@]}"; do
        objects+=("$work/$level/${unit//\//_}.o")
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
