#!/bin/bash
# How much faster a batch of two-link runs is than with another commit, in computing time and in turns,
# so that a busy machine is as slow for both.
#
#   tests/bench/in_turns.sh [ROUNDS [BUILD-FOLDER]]
#
# ROUNDS (11) of some two seconds each. BUILD-FOLDER (build) holds the library as it is shipped; that of
# commit 57dad42, the last with the explicit Runge-Kutta formula, is built first.
set -euo pipefail
root=$(readlink -f -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")
rounds=${1:-11}
build=$(readlink -f -- "${2:-$root/build}")
before=57dad42
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# the library of that commit
mkdir "$work/source"
git -C "$root" archive "$before" | tar -x -C "$work/source"
if ! { meson setup "$work/build" "$work/source" --buildtype=release -Dtests=false &&
    ninja -C "$work/build" src/libimpactlab.a; } >"$work/log" 2>&1; then
    cat "$work/log" >&2
    exit 1
fi

# the same runs with both
compile() {
    ${CC:-cc} -std=c17 -O2 -D_GNU_SOURCE "${@:4}" "-I$2" -o "$1" "$root/tests/bench/whole_runs.c" \
        -Wl,--whole-archive "$3/src/libimpactlab.a" -Wl,--no-whole-archive "${libraries[@]}"
}
read -r -a libraries <<<"$(pkg-config --libs yaml-0.1 jansson lapack sqlite3) -ldl -lm -lpthread"
compile "$work/before" "$work/source" "$work/build" -DBEFORE
compile "$work/now" "$root" "$build"

# a line a round: microseconds of a run before, and now with 1, 2, 4 and 8 arms side by side
for ((i = 0; i < rounds; i++)); do
    line=$("$work/before" batch 8)
    line=${line#* }
    for width in 1 2 4 8; do
        now=$("$work/now" batch 40 "$width")
        line+=" ${now#* }"
    done
    echo "$line"
done >"$work/rounds"

printf '%-24s %10s %10s %16s %12s\n' 'arms side by side' 'least us' 'median us' 'times as fast' 'quartiles'
for column in 1 2 3 4 5; do
    name=$((column == 1 ? 0 : 1 << (column - 2)))
    awk -v c=$column '{ print $c, $1 / $c }' "$work/rounds" >"$work/column"
    # quantile FIELD SHARE
    quantile() {
        sort -g -k "$1,$1" "$work/column" | awk -v f="$1" -v s="$2" '{ v[NR] = $f } END { print v[1 + int((NR - 1) * s)] }'
    }
    printf '%-24s %10.1f %10.1f %16.2f %6.2f %5.2f\n' "${name/#0/$before}" "$(quantile 1 0)" "$(quantile 1 0.5)" \
        "$(quantile 2 0.5)" "$(quantile 2 0.25)" "$(quantile 2 0.75)"
done
