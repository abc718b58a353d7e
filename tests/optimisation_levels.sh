#!/bin/bash
# The same bytes from the library compiled at -O1, -O2 and -O3: nothing may depend on how the
# compiler arranges the arithmetic.
#
#   optimisation_levels.sh SOURCE-FOLDER BUILD-FOLDER [COMPILER]
#
# Objects stay in BUILD-FOLDER/optimisation-levels, so that a second call compiles only what changed.
set -euo pipefail
script=$(readlink -f -- "${BASH_SOURCE[0]}")
cd -- "$1"
work=$2/optimisation-levels
cc=${3:-cc}
jobs=$(nproc)
flags="-std=c17 -D_GNU_SOURCE -ffp-contract=off -I. -I$2/.. $(pkg-config --cflags yaml-0.1 jansson lapack)"
libraries="$(pkg-config --libs yaml-0.1 jansson lapack sqlite3) -ldl -lm -lpthread"

# what a run needs: the library below the studies, which make many runs or time them
sources=$(find src tests/optimisation_runs.c -name '*.c' | grep -v '^src/study/' | sort)
newest_header=$(find src -name '*.h' -printf '%T@\n' | sort -n | tail -n 1)

for level in 1 2 3; do
    mkdir -p "$work/$level"
    for source in $sources; do
        object=$work/$level/${source//\//_}.o
        if [ ! -e "$object" ] || [ "$source" -nt "$object" ] || [ "$script" -nt "$object" ] ||
            [ "$(stat -c %Y "$object")" -le "${newest_header%.*}" ]; then
            echo "$cc $flags -O$level -c $source -o $object"
        fi
    done
done | tr '\n' '\0' | xargs -0 -r -I '{}' -P "$jobs" sh -c '{}'

for level in 1 2 3; do
    # objects of sources that are gone must not be linked
    objects=$(for source in $sources; do echo "$work/$level/${source//\//_}.o"; done)
    # shellcheck disable=SC2086
    $cc -o "$work/runs-O$level" $objects $libraries
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
