#!/bin/bash
# The sums of docs/reliability.csv, to which the long scripts add a line each
# (IMPACTLAB_COUNTS=docs/reliability.csv .ci/long NAME); of branches, which are the same ones every
# time, the last count stands alone. Fails where a line of the file is wrong.
# $1: the project's folder
set -eu
counts=$1/docs/reliability.csv

# a row for each thing that was tried, in the order of the first lines
awk -F, '
    NR == 1 { next }
    NF != 6 || $4 !~ /^[0-9]+$/ || $5 !~ /^[0-9]+$/ || $6 !~ /^[0-9]+$/ {
        print "docs/reliability.csv:" NR ": expected DATE,COMMIT,WHAT,TRIED,SECONDS,FOUND" >"/dev/stderr"; bad = 1 }
    !($3 in times) { order[++n] = $3 }
    $3 ~ /^branches / { times[$3] = tried[$3] = seconds[$3] = found[$3] = 0 }
    { times[$3]++; tried[$3] += $4; seconds[$3] += $5; found[$3] += $6; last[$3] = $1 }
    END {
        print "| what | runs | tried | seconds of the processor | found | last |"
        print "|---|---|---|---|---|---|"
        for (i = 1; i <= n; i++) {
            w = order[i]
            print "| " w " | " times[w] " | " tried[w] " | " seconds[w] " | " found[w] " | " last[w] " |"
        }
        exit bad || n == 0
    }' "$counts"
