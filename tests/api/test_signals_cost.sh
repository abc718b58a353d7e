#!/bin/bash
# A step of 1 ms with all signals read takes at most twice the instructions of the step alone, counted
# by valgrind.
#
#   test_signals_cost.sh PROGRAM
set -euo pipefail
program=$1
command -v valgrind >/dev/null || { echo "skipped: valgrind is missing"; exit 77; }
grep -qa __asan_init "$program" && { echo "skipped: valgrind runs no program with a sanitizer"; exit 77; }

# the instructions of a call
count() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" "$@" 2>&1 >/dev/null |
        sed -n 's/.*Collected : //p'
}

for scenario in corrected/first-impact compare/hybrid compare/touch corrected/twenty-links; do
    start=$(count "$scenario" 0)
    alone=$(($(count "$scenario" 500) - start))
    read=$(($(count "$scenario" 500 signals) - start))
    echo "$scenario: $((100 * read / alone)) % of the instructions of a step"
    ((read <= 2 * alone)) || { echo "more than twice a step"; exit 1; }
done
