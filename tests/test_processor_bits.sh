#!/bin/sh
# What the processor can do must not be seen in results: the C library without fused multiply-add
# and AVX2 gives the same bytes. Elsewhere than with glibc on x86 both runs are the same anyway.
#
#     test_processor_bits.sh IMPACTLAB
set -eu
impactlab=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# each of the laws and arms that take exponentials, logarithms, powers, sines
for scenario in corrected/first-impact corrected/three-links compare/hybrid \
    compare/inverse-dynamics-free compare/touch compare/observer \
    compare/force-integral-soft-wall; do
    "$impactlab" run "$scenario" --quiet --csv "$work/here.csv" || [ $? = 1 ]
    GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F \
        "$impactlab" run "$scenario" --quiet --csv "$work/there.csv" || [ $? = 1 ]
    cmp "$work/here.csv" "$work/there.csv"
done
echo "same bytes"
