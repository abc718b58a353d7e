#!/bin/bash
# Where the instructions of whole runs go: shares of the folders of src (the series and their bounds
# apart) and of the files that take most, counted by callgrind (package valgrind). What the compiler
# puts into its caller counts as the caller's.
#
#   tests/bench/where.sh single|rows|rig|batch [WIDTH [BUILD-FOLDER]]
set -euo pipefail
case ${1-} in
single | rows | rig | batch) ;;
*)
    echo "usage: tests/bench/where.sh single|rows|rig|batch [WIDTH [BUILD-FOLDER]]" >&2
    exit 2
    ;;
esac
root=$(readlink -f -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")
build=$(readlink -f -- "${3:-$root/build}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

read -r -a libraries <<<"$(pkg-config --libs yaml-0.1 jansson sqlite3) -ldl -lm -lpthread"
${CC:-cc} -std=c17 -O2 -D_GNU_SOURCE "-I$root" -o "$work/whole_runs" "$root/tests/bench/whole_runs.c" \
    "$build/src/libimpactlab.a" "${libraries[@]}"
passes=100
[ "$1" != batch ] || passes=2
valgrind --tool=callgrind "--callgrind-out-file=$work/out" "$work/whole_runs" "$1" "$passes" ${2:+"$2"} >/dev/null 2>&1

# function and file; a function that several widths have is the first one's
nm -A "$build/src/libimpactlab.a" 2>/dev/null |
    sed -nE 's/^.*:([^:]*)\.c\.o:[0-9a-f]* [tT] ([^.]*).*$/\2 \1/p' |
    sed -E 's/ .*\/(taylor_series).*$/ series/; s/ .*\/([^/_]*)_([^/]*)$/ \1\/\2/' >"$work/places"
callgrind_annotate --threshold=99.9 "$work/out" |
    sed -nE "s/^ *([0-9,]+) \(.*\) +[^ ]*:([A-Za-z_0-9]+).*$/\2 \1/p" | tr -d , >"$work/counts"

# shares NAME-OF-A-PLACE: of places, or of what is before their slash
shares() {
    awk -v whole="$1" 'NR == FNR { if (!($1 in place)) { place[$1] = $2 } next }
        { at = $1 in place ? place[$1] : "C library"; if (whole == "folder") { sub("/.*", "", at) }
          n[at] += $2; sum += $2 }
        END { for (at in n) { printf "%5.1f %%  %s\n", 100 * n[at] / sum, at } }' \
        "$work/places" "$work/counts" | sort -rn
}
shares folder
echo
shares file | head -n 12
