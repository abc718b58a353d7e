#!/bin/bash
# README.md shows what the program shows: every block below a mark "output of: ./lab ..." is compared
# with what that command prints now, but for the time the computing took and for what is rounding
# (below 1e-9), which differs between processors.
# $1: the program, $2: the project's folder, $3: --write puts what it prints now into README.md
# (ninja -C build readme)
set -u
program=$(readlink -f "$1") # the marks hold its arguments
export program
readme=$2/README.md
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export LC_ALL=C.UTF-8
failures=0
blocks=0

# the lines of the block that begins after line $1
block_after() {
    awk -v line="$1" 'NR > line && /^```/ { if (++fences == 2) exit; next } fences == 1' "$readme"
}

# puts the file printed in the place of that block
replace_block_after() {
    awk -v line="$1" '
        NR > line && /^```/ && ++fences == 1 { print; while ((getline text <"printed") > 0) print text }
        fences != 1' "$readme" >renewed && cat renewed >"$readme"
}

# without what differs from call to call and from processor to processor
comparable() {
    sed -E 's/^  wall time +[0-9.e-]+ s$/  wall time/; s/^  cpu time +[0-9.e-]+ s$/  cpu time/
        s/ +[0-9.]+e-(1[0-9]|[2-9][0-9]) / rounding /
        s/ +$//' "$1" | cat -s
}

while IFS=: read -r number mark; do
    command=${mark#*output of: ./lab }
    command=${command% -->}
    blocks=$((blocks + 1))
    block_after "$number" >shown
    eval "\"\$program\" $command" >printed 2>&1 </dev/null || {
        echo "FAILED: ./lab $command"
        cat printed
        failures=$((failures + 1))
        continue
    }
    if ! diff <(comparable shown) <(comparable printed) >differences && [ "${3:-}" = --write ]; then
        replace_block_after "$number"
    elif [ -s differences ]; then
        echo "FAILED: line $number of README.md, ./lab $command (<: README.md, >: the program)"
        cat differences
        failures=$((failures + 1))
    fi
done < <(grep -n '^<!-- output of: \./lab ' "$readme" | tac)

[ $blocks -gt 0 ] || { echo "README.md has no marked block"; exit 1; }
[ $failures = 0 ] && echo "$blocks blocks, as the program prints them"
[ $failures = 0 ] || echo "if the program is right: ninja -C build readme"
exit $failures
