#!/bin/bash
# A host program that has set a locale with a decimal comma, or an eight-bit character set, opens the
# same scenarios and writes the same bytes as one that has not.
# $1: the program as such a host, see host_in_locale.c
set -u
host=$(readlink -f "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

# runs the host, whose words are looked at only where it fails
host() {
    LC_ALL=$host_locale "$host" "$@" >"$folder/said" 2>&1 </dev/null || {
        echo "FAILED: impactlab $*"
        head -n 5 "$folder/said"
        failures=$((failures + 1))
    }
}

# everything the library writes, into the folder $1
write_all() {
    mkdir "$1"
    cd "$1" || exit 1
    local name changed=(--set "motor.voltage=1.25 V" --set "wall.angle=0.5e-1 rad")
    for name in corrected/first-impact thesis/fig-3-4 compare/hybrid; do
        mkdir -p "$name"
        host run "$name" "${changed[@]}" --csv "$name/run.csv" --json "$name/all.json" \
            --plot "$name/run.svg"
    done
    # one with a remark that it is inaccurate, which is a failure
    mkdir rough
    printf 'title: Presses\nwall: {angle: 0.5e-1 rad}\nrun: {duration: 0.5 s}\n' >short.yaml
    LC_ALL=$host_locale "$host" run short.yaml --set method.name=newmark --quiet \
        --set method.residual_bound=1e-15 --json rough/all.json --plot rough/run.svg 2>fault
    # but for the time the computing took
    for name in */all.json */*/all.json; do
        grep -vE '(wall|cpu)_time_s' "$name" >"${name%all.json}run.json"
        rm "$name"
    done
    host run corrected/first-impact --scene scene.png --gl cairo --size 320x180
    host figures -o figures --format svg
    host figures 3.4 -o figures --format pdf
    host tables --json tables.json

    # many runs; a sweep that is taken up finds its own numbers again
    # shellcheck disable=SC2054
    local sweep=(sweep short.yaml --vary motor.voltage=0.5:1.5:3 --vary arm.k2=4.5,5.25)
    host "${sweep[@]}" --db s.sqlite --csv sweep.csv --plot sweep.svg
    host "${sweep[@]}" --db s.sqlite --csv again.csv
    rm -f s.sqlite*
    host compare short.yaml --vary arm.k2=4.5,5.25 --csv compare.csv --markdown compare.md
    host modes short.yaml --json modes.json
    host converge short.yaml --set method.name=newmark --json converge.json --plot converge.svg

    # a session saved, a text of several bytes a character, and a fault with numbers in it
    printf 'set motor.voltage 1.5\nsave half.yaml\n' >script
    host lab short.yaml --script script --size 100x30 --glyphs ascii
    host run half.yaml --csv half.csv
    LC_ALL=$host_locale "$host" check short.yaml --set "control.settings=…" >>fault 2>&1
    LC_ALL=$host_locale "$host" run short.yaml --set wall.angle=99.5 >>fault 2>&1
    cd ..
}

# builds the locale $1 from the language $2 and the character set $3 unless the system has it; false
# if there is no such locale to be had
provide() {
    if [ "$(LC_ALL=$1 locale decimal_point 2>/dev/null)" = , ]; then
        return 0
    fi
    localedef --no-archive -c -i "$2" -f "$3" "$folder/locales/$1" >/dev/null 2>&1
    [ "$(LOCPATH=$folder/locales LC_ALL=$1 locale decimal_point 2>/dev/null)" = , ]
}

mkdir locales
export LC_ALL=C
host_locale=C
write_all plain
looked_at=0
for locale in "de_DE.UTF-8 de_DE UTF-8" "de_DE.ISO-8859-1 de_DE ISO-8859-1"; do
    # shellcheck disable=SC2086
    set -- $locale
    if ! provide "$@"; then
        echo "there is no locale $1 here, and no localedef or no files to make it (package locales)"
        continue
    fi
    looked_at=$((looked_at + 1))
    [ ! -e "$folder/locales/$1" ] || export LOCPATH=$folder/locales
    host_locale=$1
    write_all "$1"
    unset LOCPATH
    diff -r plain "$1" >differences || {
        echo "FAILED: in the locale $1"
        cut -c 1-200 differences | head -n 20
        failures=$((failures + 1))
    }
done
[ $looked_at -gt 0 ] || exit 77
[ $failures = 0 ] && echo "$looked_at locales, the same bytes"
exit $failures
