#!/bin/bash
# Every place that the tables of docs/thesis.md name is there, and every command in them runs.
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

# rows of the chapters have five columns: thesis, what, place, command, verdict
awk '/^## / { chapter = /^## Chapter/ } chapter && /^\| / && !/^\| thesis/' "$root/docs/thesis.md" |
    awk -F ' \\| ' 'NF == 5' >"$work/rows"
rows=$(wc -l <"$work/rows")
if [ "$rows" -lt 90 ]; then
    echo "only $rows rows were found, so this test sees nothing"
    exit 1
fi

# places: `file`, or `file`: `identifier`
awk -F ' \\| ' '{ print $3 }' "$work/rows" | tr ';' '\n' | sed 's/^ *//' | sort -u |
    while read -r place; do
        file=$(sed -n 's/^`\([^`]*\)`.*/\1/p' <<<"$place")
        name=$(sed -n 's/^`[^`]*`: `\([^`]*\)`$/\1/p' <<<"$place")
        if [ -z "$file" ] || [ ! -e "$root/$file" ]; then
            echo "docs/thesis.md names a place that is not there: $place"
        elif [ -n "$name" ] && ! grep -qw -- "$name" "$root/$file"; then
            echo "docs/thesis.md names $name, which is not in $file"
        fi
    done >"$work/missing"
if [ -s "$work/missing" ]; then
    cat "$work/missing"
    wrong=1
fi

# commands, each once
awk -F ' \\| ' '{ print $4 }' "$work/rows" | sed -n 's/^`impactlab \(.*\)`$/\1/p' | sort -u >"$work/commands"
commands=$(wc -l <"$work/commands")
if [ "$commands" -lt 50 ]; then
    echo "only $commands commands were found in docs/thesis.md"
    wrong=1
fi
if [ "$only" = places ]; then
    exit $wrong
fi
cd "$work"
while read -r command; do
    # shellcheck disable=SC2086
    if ! "$program" $command </dev/null >output 2>&1; then
        echo "docs/thesis.md: impactlab $command ends with an error:"
        tail -n 3 output
        wrong=1
    fi
done <"$work/commands"
echo "$rows rows, $commands commands"
exit $wrong
