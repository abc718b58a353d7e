#!/bin/bash
# Counts the instructions of a time step and of whole runs with callgrind (package valgrind): numbers
# that a busy machine does not change.
#
#   tests/bench/instructions.sh [BUILD-FOLDER]
#
# BUILD-FOLDER (build) holds the library as it is shipped. Nothing of the test suite needs this.
set -euo pipefail
root=$(readlink -f -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")
build=${1:-$root/build}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

command -v valgrind >/dev/null || {
    echo "instructions: valgrind is not installed (package valgrind)" >&2
    exit 1
}
[ -e "$build/src/libimpactlab.a" ] || {
    echo "instructions: there is no $build/src/libimpactlab.a, ./lab build makes it" >&2
    exit 1
}

read -r -a libraries <<<"$(pkg-config --libs yaml-0.1 jansson sqlite3) -ldl -lm -lpthread"
for program in hot_step whole_runs; do
    ${CC:-cc} -std=c17 -O2 -D_GNU_SOURCE "-I$root" -o "$work/$program" "$root/tests/bench/$program.c" \
        "$build/src/libimpactlab.a" "${libraries[@]}"
done

# all instructions of a command
collected() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$@" 2>&1 >/dev/null |
        sed -n 's/.*Collected : \([0-9]*\).*/\1/p'
}

# what eleven passes take more than one does not count the start
printf '%-18s %6s  %-8s %18s %14s\n' method links motion 'instructions/step' 'per link'
for case in "event 2 free" "event 2 contact" "generalized-alpha 2 free" \
    "generalized-alpha 2 contact" "generalized-alpha 128 free" "generalized-alpha 128 contact"; do
    read -r method links motion <<<"$case"
    steps=$(($("$work/hot_step" "$method" "$links" "$motion" 11) - $("$work/hot_step" "$method" "$links" "$motion" 1)))
    more=$(($(collected "$work/hot_step" "$method" "$links" "$motion" 11) - $(collected "$work/hot_step" "$method" "$links" "$motion" 1)))
    awk -v m="$method" -v n="$links" -v k="$motion" -v i="$more" -v s="$steps" \
        'BEGIN { printf "%-18s %6d  %-8s %18.0f %14.0f\n", m, n, k, i / s, i / s / n }'
done

# whole runs of 1 s, and of the rig a sample of them: there are 200
printf '\n%-36s %18s\n' 'two links' 'instructions/run'
for case in "single:one run:1" "rows:with a row each millisecond:1" "rig:on the rig, a sample:200" \
    "batch 1:one of a batch:1" "batch 2:two side by side:1" "batch 4:four side by side:1"; do
    IFS=: read -r what label share <<<"$case"
    read -r kind width <<<"$what"
    read -r more _ < <("$work/whole_runs" "$kind" 10 ${width:+"$width"})
    count=$(($(collected "$work/whole_runs" "$kind" 11 ${width:+"$width"}) - $(collected "$work/whole_runs" "$kind" 1 ${width:+"$width"})))
    awk -v l="$label" -v i="$count" -v n="$more" -v s="$share" \
        'BEGIN { printf "%-36s %18.0f\n", l, i / n / s }'
done
