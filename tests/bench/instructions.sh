#!/bin/bash
# Counts the instructions of a time step with callgrind (package valgrind): a number that a busy
# machine does not change.
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

libraries=$(pkg-config --libs yaml-0.1 jansson sqlite3)
# shellcheck disable=SC2086
${CC:-cc} -std=c17 -O2 -D_GNU_SOURCE "-I$root" -o "$work/hot_step" "$root/tests/bench/hot_step.c" \
    "$build/src/libimpactlab.a" $libraries -ldl -lm -lpthread

# all instructions of a number of passes
collected() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$work/hot_step" "$@" 2>&1 >/dev/null |
        sed -n 's/.*Collected : \([0-9]*\).*/\1/p'
}

printf '%-18s %6s  %-8s %18s %14s\n' method links motion 'instructions/step' 'per link'
for case in "event 2 free" "event 2 contact" "generalized-alpha 2 free" \
    "generalized-alpha 2 contact" "generalized-alpha 128 free" "generalized-alpha 128 contact"; do
    read -r method links motion <<<"$case"
    # what eleven passes take more than one does not count the start
    steps=$(($("$work/hot_step" "$method" "$links" "$motion" 11) - $("$work/hot_step" "$method" "$links" "$motion" 1)))
    more=$(($(collected "$method" "$links" "$motion" 11) - $(collected "$method" "$links" "$motion" 1)))
    awk -v m="$method" -v n="$links" -v k="$motion" -v i="$more" -v s="$steps" \
        'BEGIN { printf "%-18s %6d  %-8s %18.0f %14.0f\n", m, n, k, i / s, i / s / n }'
done
