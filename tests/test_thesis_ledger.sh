#!/bin/bash
# Every place that docs/explanation/claims.tsv names is there, and every command in it runs.
#
#   test_thesis_ledger.sh PROGRAM SOURCE_ROOT [places]
#
# With `places` the commands are not run.
set -euo pipefail
program=$(realpath "$1")
root=$2
only=${3:-}
wrong=0

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# a row is a claim: chapter, thesis, what it says, place, command, verdict
claims=docs/explanation/claims.tsv
awk -F '\t' 'NR > 1 && NF != 6 { print FILENAME ":" NR ": expected six columns"; exit 1 }' "$root/$claims"
tail -n +2 "$root/$claims" >"$work/rows"
rows=$(wc -l <"$work/rows")
if [ "$rows" -lt 90 ]; then
    echo "only $rows rows were found, so this test sees nothing"
    exit 1
fi

# places: `file`, or `file`: `identifier`
awk -F '\t' '{ print $4 }' "$work/rows" | tr ';' '\n' | sed 's/^ *//' | sort -u |
    while read -r place; do
        file=$(sed -n 's/^`\([^`]*\)`.*/\1/p' <<<"$place")
        name=$(sed -n 's/^`[^`]*`: `\([^`]*\)`$/\1/p' <<<"$place")
        if [ -z "$file" ] || [ ! -e "$root/$file" ]; then
            echo "$claims names a place that is not there: $place"
        elif [ -n "$name" ] && ! grep -qw -- "$name" "$root/$file"; then
            echo "$claims names $name, which is not in $file"
        fi
    done >"$work/missing"
if [ -s "$work/missing" ]; then
    cat "$work/missing"
    wrong=1
fi

# commands, each once
awk -F '\t' '{ print $5 }' "$work/rows" | sed -n 's/^`impactlab \(.*\)`$/\1/p' | sort -u >"$work/commands"
commands=$(wc -l <"$work/commands")
if [ "$commands" -lt 50 ]; then
    echo "only $commands commands were found in $claims"
    wrong=1
fi
if [ "$only" = places ]; then
    exit $wrong
fi
cd "$work"
while read -r command; do
    # shellcheck disable=SC2086
    if ! "$program" $command </dev/null >output 2>&1; then
        echo "$claims: impactlab $command ends with an error:"
        tail -n 3 output
        wrong=1
    fi
done <"$work/commands"
echo "$rows rows, $commands commands"
exit $wrong
