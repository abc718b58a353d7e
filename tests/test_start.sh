#!/bin/bash
# A command that draws nothing maps no library of pictures or of terminals; one that draws goes over to the program
# that has them, in the build folder and installed, with the same words, or says what is missing.
#
#   test_start.sh PROGRAM DRAWING_PROGRAM BINDIR LIBEXECDIR
set -u
drawing=$(readlink -f "$2")
bin=$3
libexec=$4
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/expect.sh"
cat >hit.yaml <<'END'
title: An impact
motor: {voltage: 2 V}
run: {duration: 0.05 s}
END

# maps WANTED STATUS ARGUMENT...: whether the dynamic linker met a rendering library (yes or no), in
# whatever this process became
maps() {
    local wanted=$1 met=no
    shift
    rm -f linked.*
    LD_DEBUG=files LD_DEBUG_OUTPUT=linked expect "$@"
    ! grep -qE 'lib(cairo|pango|harfbuzz|fontconfig|glib|png|ncurses)' linked.* || met=yes
    [ "$met" = "$wanted" ] || fail "rendering libraries mapped: $met, expected $wanted: $*"
}

maps no 0 --version
maps no 0 --help
maps no 0 list
maps no 0 show corrected/first-impact
maps no 0 check hit.yaml
maps no 0 run hit.yaml --json run.json --csv rows.csv
maps no 0 sweep hit.yaml --vary motor.voltage=1:2:2 --db sweep.sqlite --csv sweep.csv
maps no 0 merge sweep.sqlite -o merged.sqlite
maps no 0 predict corrected/first-impact
maps no 0 modes hit.yaml
maps no 0 tables
maps no 2 run nonesuch.yaml

# whatever draws: by its option or always
maps yes 0 run hit.yaml --quiet --plot 'a [figure] of "it".svg'
maps yes 0 run hit.yaml --quiet --scene scene.png --gl cairo --size 160x90
maps yes 0 sweep hit.yaml --vary motor.voltage=1:2:2 --quiet --plot sweep.svg
maps yes 0 figures 2.1 -o figures
maps yes 2 figures nonesuch
for picture in 'a [figure] of "it".svg' scene.png sweep.svg figures/fig-2-1.png; do
    [ -s "$picture" ] || fail "there is no $picture"
done

# said once, though two programs had to do with it
expect 0 run hit.yaml --plot figure.svg
[ "$(grep -c '^hit.yaml: An impact' out)" = 1 ] || fail "the report is not there once"

# both programs copied into one folder, as with a build folder that was moved
mkdir copied
cp "$program" copied/impactlab
cp "$drawing" copied/impactlab-draw
(program=copied/impactlab && expect 0 run hit.yaml --quiet --plot copied.svg) || fail "a copy does not draw"
[ -s copied.svg ] || fail "a copy draws nothing"

# an installation in a place of any name, called through the path and through a link
case $bin$libexec in
/* | */*..*) echo "skipped: these folders of programs are not below the prefix" ;;
*)
    prefix="$folder/my [lab] (2)"
    mkdir -p "$prefix/$bin" "$prefix/$libexec/impactlab"
    cp "$program" "$prefix/$bin/impactlab"
    cp "$drawing" "$prefix/$libexec/impactlab/impactlab-draw"
    ln -s "$prefix/$bin/impactlab" link
    built=$program
    (PATH="$prefix/$bin:$PATH" && impactlab run hit.yaml --quiet --plot installed.svg) ||
        fail "the installed program does not draw"
    program=./link
    expect 0 run hit.yaml --quiet --plot linked.svg
    cmp installed.svg linked.svg || fail "two figures of the same run"

    # without the program that draws: a sentence, and everything else goes on
    : >"$prefix/$libexec/impactlab/impactlab-draw"
    chmod -x "$prefix/$libexec/impactlab/impactlab-draw"
    expect 1 run hit.yaml --plot none.svg
    says err "the program that draws cannot be started as $prefix/$libexec/impactlab/impactlab-draw"
    if [ -s out ] || [ -e none.svg ]; then
        fail "something was done before"
    fi
    expect 0 run hit.yaml --quiet --csv again.csv
    cmp rows.csv again.csv || fail "other rows"
    program=$built
    ;;
esac
nothing_failed
