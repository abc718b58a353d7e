#!/bin/bash
# Allocations that fail inside the library: each ends the call with a status and a sentence and
# leaves nothing behind, or nothing is wrong with what comes out; never a crash, never an abort.
#
#   test_memory.sh PROGRAM_THAT_CALLS FAIL_KTH.so
set -euo pipefail
fail_kth=$(readlink -f "$2")
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../expect.sh"
ln -s "$fail_kth" fail_kth.so # LD_PRELOAD splits at blanks and colons
MOST=150 # of some thousand allocations, spread evenly after the first hundred

"$program" >whole
FAIL_CALL=malloc FAIL_AT=0 FAIL_COUNT=$folder/count LD_PRELOAD=./fail_kth.so "$program" >out
cmp -s out whole || fail "what is preloaded changes something"
calls=$(cat count)
stride=$(((calls - 100) / (MOST - 100) + 1))
refused=0
for ((k = 1; k <= calls; k += k < 100 ? 2 : stride)); do
    status=0
    FAIL_CALL=malloc FAIL_AT=$k LD_PRELOAD=./fail_kth.so "$program" >out 2>err || status=$?
    [ "$status" = 0 ] || fail "allocation $k of $calls: exit status $status"
    grep -q '^whole' out && { cmp -s out whole || fail "allocation $k of $calls: other results"; }
    grep -q '^whole' out || refused=$((refused + 1))
done
[ "$refused" -gt 20 ] || fail "only $refused allocations that failed were noticed"

nothing_failed && echo "$refused calls refused for want of memory, none of $calls allocations crashes"
