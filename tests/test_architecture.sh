#!/bin/bash
# The architecture as the includes show it: every arrow points down, no module stands in a circle, and
# every place that the manual names is there.
#
#   test_architecture.sh SOURCE_ROOT BUILD_ROOT
#
# A module is a .c with its .h. The rooms of each floor are listed from the lowest up; a file may
# include its own room and what stands before it in the list, nothing else of the project.
set -euo pipefail
cd "$1"

rooms="src/base src/tables src/arm src/thesis src/contact src/engines src/engines/pair src/engines/newmark
    src/engines/stiff src/predict src/rig/controller src/rig/external
    src/rig/estimation src/rig/laws src/rig src/scenario src/run src/session src/study src/study/identify src/study/linear src/study/robust
    src/study/store src/exchange/fmu/fmi2 src/exchange/fmu src/exchange src/api/impactlab src/api
    render/page render/plot render/scene render/figures render
    ui/terminal ui/explorer/state ui/explorer/actions ui/explorer/panels ui/explorer ui/manual ui/commands
    ui/commands/studies ui/commands/exchange ui/web ui"

# the room of a file; what a controller is stands below all that the rig is made of
room_of() {
    case $1 in src/rig/controller*) echo src/rig/controller ;; *) echo "${1%/*}" ;; esac
}

# "module room header-module header-room" of each include of the project's own files
list_includes() {
    # what stands in board goes out with an exported law and is no part of the lab; fmi2 is of others
    find src render ui \( -name board -o -name fmi2 \) -prune -o -name '*.[ch]' -print0 | xargs -0 grep -HE '^ *# *include "' |
        sed -E 's/^([^:]*):[^"]*"([^"]*)".*/\1 \2/' |
        while read -r file header; do
            echo "${file%.[ch]} $(room_of "$file") ${header%.[ch]} $(room_of "$header")"
        done
}

includes=$(list_includes)
arrows=$(wc -l <<<"$includes")
if [ "$arrows" -lt 200 ]; then
    echo "only $arrows includes were found, so this test sees nothing"
    exit 1
fi

awk -v rooms="$rooms" '
    BEGIN {
        count = split(rooms, list, /[ \n]+/)
        for (i = 1; i <= count; i++) rank[list[i]] = i
    }
    # a file in no known room, or a header that is not named by its whole path
    !($2 in rank) { print $1 ": stands in no room that the test knows: " $2; wrong = 1; next }
    !($4 in rank) { print $1 ": includes \"" $3 "\", expected a path from the top"; wrong = 1; next }
    rank[$4] > rank[$2] {
        print $1 ": includes " $3 ", an arrow upward from " $2 " to " $4; wrong = 1
    }
    $1 != $3 { arrow[$1] = arrow[$1] " " $3; module[$1] = module[$3] = 1 }

    # depth first: a module met again while it is open closes a circle
    function visit(name, path,    next_modules, n, i) {
        state[name] = "open"
        n = split(arrow[name], next_modules, " ")
        for (i = 1; i <= n; i++) {
            if (state[next_modules[i]] == "open") {
                print "a circle of includes: " path " -> " next_modules[i]; wrong = 1
            } else if (state[next_modules[i]] == "") {
                visit(next_modules[i], path " -> " next_modules[i])
            }
        }
        state[name] = "done"
    }
    END {
        for (name in module) if (state[name] == "") visit(name, name)
        exit wrong
    }' <<<"$includes"

# the C library picks these by the processor: results would depend on it in their last bit. Sine and
# cosine of large angles alone are its own, in src/base/sincos.h.
functions='a?(sin|cos|tan)h?|sincos|atan2|exp2?|expm1|log(2|10|1p)?|pow|cbrt|hypot|fma|erfc?|[lt]gamma'
if grep -rnE --include='*.[ch]' "(^|[^A-Za-z_0-9])($functions)\\(" src | grep -v '^src/base/sincos\.h:' |
    grep -vE '^[^:]*:[0-9]+:.*(//|").*\('; then
    echo "src/base/plain_math.h and sincos.h have functions with the same bits everywhere"
    exit 1
fi

# GLib's functions that print into memory return nothing, or leave the text out, where that is refused
if grep -rnE --include='*.[ch]' 'g_(strdup_v?printf|string_(append_)?v?printf|markup_printf_escaped)\(' \
    src render ui; then
    echo "render/page/text.h has text_printf and text_append, which lose nothing"
    exit 1
fi

# the explorer's state is whole in its loop alone: all others are given the parts that they read or change
whole='ui/explorer/(explorer|keys|recovery)\.c|ui/explorer/explorer\.h|ui/commands/lab_command\.c'
if grep -rnE --include='*.[ch]' '(^|[^a-z_])explorer( \*| [a-z]+;)' ui | grep -vE "^($whole):" |
    grep -vE '^[^:]*:[0-9]+: *//'; then
    echo "only the explorer's loop has it whole, all else is given the parts of ui/explorer/state/state.h"
    exit 1
fi

# parts of a run of the corrected arm are written by one file each (src/run/arm_run.h): no other has
# a pointer to one that is not const, or assigns to its fields
assigned='[a-z_.]* *([-+*/]?=[^=]|\+\+|--)'
while read -r owner type part; do
    if grep -nE "(^|[(, ])$type \\*|$part$assigned" src/run/*.c | grep -v "const $type \\*" |
        grep -v "^src/run/$owner\.c:"; then
        echo "$part of an arm_run is written by src/run/$owner.c alone"
        exit 1
    fi
done <<'PARTS'
arm_run run_segment run->segment
arm_run step_under_way run->under_way
arm_run zeno_monitor run->zeno
arm_run_events contact_history state\.contact
arm_run_rows row_record state\.rows
arm_run_forces force_record state\.force
PARTS

# places that the manual names exist ("NAME" and "*" stand for something)
lost=0
while IFS=: read -r page place; do
    case $place in *NAME* | *FOLDER* | *'*'*) continue ;; esac
    if [ ! -e "$place" ] && ! compgen -G "$place.[ch]" >/dev/null; then
        echo "$page names $place, which is not there"
        lost=1
    fi
done < <(grep -oHE '`(src|render|ui|tests|scenarios|docs)/[A-Za-z0-9_./*-]*[A-Za-z0-9_*]`?' \
    CONTRIBUTING.md README.md $(find docs -name '*.md') | tr -d '`' | sort -u)
[ "$lost" = 0 ]

# "caller callee" of each two files of the program of which one uses what the other defines, as the
# linker sees it; copies of a file for other widths of vectors, and for the page, are left out
list_calls() {
    (cd "$1" && find . -name '*.c.o' -path '*.a.p/*' ! -path './tests/*' ! -path './web-module/*' ! -path '*_[1248].a.p/*' \
        ! -path '*_avx2.a.p/*' -print0 | xargs -0 nm -A) | awk '
            { file = $1; sub(/:[0-9a-f]*$/, "", file); sub(/.*\//, "", file); sub(/\.c\.o$/, "", file) }
            $(NF - 1) ~ /^[TDRBCVW]$/ && !($NF in home) { home[$NF] = file }
            $(NF - 1) == "U" { wants[file, $NF] }
            END {
                for (pair in wants) {
                    split(pair, of, SUBSEP)
                    if (of[2] in home && home[of[2]] != of[1]) print of[1], home[of[2]]
                }
            }' | sort -u
}

calls=$(list_calls "$2")
if [ "$(wc -l <<<"$calls")" -lt 500 ]; then
    echo "only $(wc -l <<<"$calls") calls between files were found, so this test sees nothing"
    exit 1
fi
if ! circle=$(tsort <<<"$calls" 2>&1 >/dev/null); then
    echo "files that call each other in a circle:"
    sed 's/^tsort: //' <<<"$circle"
    exit 1
fi

echo "$arrows includes, all of them downward, no circle of them and none of calls"
