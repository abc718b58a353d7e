#!/bin/bash
# The table "What was run" of docs/reliability.md is the sum of docs/reliability.csv, to which the long
# scripts add a line each (IMPACTLAB_COUNTS=docs/reliability.csv .ci/long NAME); of branches, which are
# the same ones every time, the last count stands alone.
# $1: the project's folder, $2: --write puts the sums into the page
set -eu
page=$1/docs/reliability.md
counts=$1/docs/reliability.csv
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# a row for each thing that was tried, in the order of the first lines
awk -F, '
    NR == 1 { next }
    NF != 6 || $4 !~ /^[0-9]+$/ || $5 !~ /^[0-9]+$/ || $6 !~ /^[0-9]+$/ {
        print "docs/reliability.csv:" NR ": expected DATE,COMMIT,WHAT,TRIED,SECONDS,FOUND" >"/dev/stderr"; bad = 1 }
    !($3 in times) { order[++n] = $3 }
    $3 ~ /^branches / { times[$3] = tried[$3] = seconds[$3] = found[$3] = 0 }
    { times[$3]++; tried[$3] += $4; seconds[$3] += $5; found[$3] += $6; last[$3] = $1 " " $2 }
    END {
        print "| what | runs | tried | seconds of the processor | found | last |"
        print "|---|---|---|---|---|---|"
        for (i = 1; i <= n; i++) {
            w = order[i]
            print "| " w " | " times[w] " | " tried[w] " | " seconds[w] " | " found[w] " | " last[w] " |"
        }
        exit bad
    }' "$counts" >"$folder/table"

mark='<!-- sums of docs/reliability.csv -->'
grep -qxF "$mark" "$page"
awk -v mark="$mark" '$0 == mark { on = !on; next } on' "$page" >"$folder/shown"
if cmp -s "$folder/table" "$folder/shown"; then
    echo "the page has the sums"
elif [ "${2:-}" = --write ]; then
    awk -v mark="$mark" -v table="$folder/table" '
        $0 == mark { print; on = !on; if (on) while ((getline text <table) > 0) print text; next }
        !on' "$page" >"$folder/page"
    cat "$folder/page" >"$page"
else
    diff "$folder/shown" "$folder/table" || true
    echo "docs/reliability.md has other sums: ninja -C build counts"
    exit 1
fi
