#!/bin/bash
# README.md and the reader's pages of docs show what the program does. On each page, in a folder of its own,
#
#   <!-- file: NAME -->          makes a file of the block below it;
#   ```sh                        begins a block whose lines './lab ...' and 'impactlab ...' are
#                                carried out and must succeed ('# exit N' behind one: end with N);
#   <!-- output of: COMMAND -->  the block below is what the command prints now, but for the time
#                                that computing took and for rounding (below 1e-9), which differs
#                                between processors;
#   <!-- table of: COMMAND -->   the table below is the one that the command prints.
#
# $1: the program, $2: the project's folder, $3: --write puts into the pages what is printed now
# (ninja -C build pages)
set -u
program=$(readlink -f "$1") # the commands hold its arguments
root=$(readlink -f "$2")
write=${3:-}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export program LC_ALL=C.UTF-8
failures=0
commands=0

# both names that pages call the program by
mkdir "$folder/bin"
printf '#!/bin/sh\nexec "%s" "$@"\n' "$program" | tee "$folder/bin/lab" >"$folder/bin/impactlab"
chmod +x "$folder/bin/"*
export PATH=$folder/bin:$PATH

fail() {
    echo "FAILED: ${page#"$root/"}:$1"
    failures=$((failures + 1))
}

# the lines of the block that begins after line $1 of the page
block_after() {
    awk -v line="$1" 'NR > line && /^```/ { if (++fences == 2) exit; next } fences == 1' "$page"
}

# puts the file printed in the place of that block
replace_block_after() {
    awk -v line="$1" '
        NR > line && /^```/ && ++fences == 1 { print; while ((getline text <"printed") > 0) print text }
        fences != 1' "$page" >renewed && cat renewed >"$page"
}

# without what differs from call to call and from processor to processor
comparable() {
    sed -E 's/^  wall time +[0-9.e-]+ s$/  wall time/; s/^  cpu time +[0-9.e-]+ s$/  cpu time/
        s/ +[0-9.]+e-(1[0-9]|[2-9][0-9]) / rounding /
        s/ +$//' "$1" | cat -s
}

# the lines of the table that begins after line $1 of the page
table_after() {
    awk -v line="$1" 'NR > line && /^[|]/ { begun = 1; print; next } begun { exit }' "$page"
}

# puts the file printed in the place of that table
replace_table_after() {
    awk -v line="$1" '
        NR > line && /^[|]/ && !over { if (!begun++) while ((getline text <"printed") > 0) print text; next }
        { over = begun; print }' "$page" >renewed && cat renewed >"$page"
}

# what is shown below the mark in line $1, a block or a table, is what the command $2 prints
check_output() {
    "$3_after" "$1" >shown
    eval "$2" >printed 2>&1 </dev/null || { fail "$1: $2"; cat printed; return; }
    [ "$3" = block ] || sed -i '/^|/!d' printed
    diff <(comparable shown) <(comparable printed) >differences && return
    if [ "$write" = --write ]; then
        "replace_$3_after" "$1"
        moved=$((moved + $(wc -l <printed) - $(wc -l <shown)))
    else
        fail "$1: $2 (<: the page, >: the program)"
        cat differences
    fi
}

# the line $1 of an example, the command $2, ends as it says
check_command() {
    local expected=0
    [[ $2 =~ \#\ exit\ ([0-9]+) ]] && expected=${BASH_REMATCH[1]}
    (eval "$2") >printed 2>&1 </dev/null
    local ended=$?
    [ "$ended" = "$expected" ] || { fail "$1: $2 ends with $ended"; head -n 20 printed; }
}

# "LINE KIND WORDS" of everything that a page wants done, in its order
things_to_do() {
    awk '
        /^<!-- output of: .* -->$/ { sub(/^<!-- output of: /, ""); sub(/ -->$/, ""); print NR " output " $0 }
        /^<!-- table of: .* -->$/ { sub(/^<!-- table of: /, ""); sub(/ -->$/, ""); print NR " table " $0 }
        /^<!-- file: .* -->$/ { print NR " file " $3 }
        /^```/ { runs = !inside && $0 == "```sh"; inside = !inside }
        inside && runs && /^(\.\/lab|impactlab) +[^#]/ && !/^\.\/lab (test|build)/ { print NR " command " $0 }
    ' "$page"
}

check_page() {
    mkdir "$folder/work"
    cd "$folder/work" || exit 1
    ln -s "$folder/bin/lab" lab
    ln -s "$root/scenarios" "$root/docs" "$root/src" .
    moved=0 # lines by which --write has moved what follows
    while read -r number kind words; do
        number=$((number + moved))
        case $kind in
        file) block_after "$number" >"$words" ;;
        output) check_output "$number" "$words" block ;;
        table) check_output "$number" "$words" table ;;
        command) check_command "$number" "$words" ;;
        esac
        commands=$((commands + 1))
    done < <(things_to_do)
    cd "$folder" || exit 1
    rm -r "$folder/work"
}

for page in "$root"/README.md "$root"/docs/{start,faq,glossary}.md "$root"/docs/howto/*.md "$root"/docs/reference/laws.md; do
    check_page
done
[ $commands -gt 50 ] || fail "1: only $commands commands and outputs were found on the pages"
[ $failures = 0 ] && echo "$commands commands and outputs, as the pages have them"
[ $failures = 0 ] || echo "if the program is right: ninja -C build pages"
[ $failures = 0 ]
