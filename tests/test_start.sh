#!/bin/bash
# The program loads what draws scenes only where a scene asks for it, and draws wherever it was copied or installed.
#
#   test_start.sh PROGRAM BINDIR
set -u
bin=$2
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/expect.sh"
cat >hit.yaml <<'END'
title: An impact
motor: {voltage: 2 V}
run: {duration: 0.05 s}
END

# asks WANTED STATUS ARGUMENT...: whether the program asks the dynamic linker for OpenGL (yes or no)
asks() {
    local wanted=$1 met=no
    shift
    rm -f linked.*
    LD_DEBUG=files LD_DEBUG_OUTPUT=linked expect "$@"
    ! grep -qE 'lib(OSMesa|EGL)\.so' linked.* || met=yes
    [ "$met" = "$wanted" ] || fail "OpenGL asked for: $met, expected $wanted: $*"
}

asks no 0 --version
asks no 0 list
asks no 0 run hit.yaml --json run.json --csv rows.csv
asks no 0 run hit.yaml --quiet --plot 'a [figure] of "it".svg'
asks no 0 run hit.yaml --quiet --scene scene.png --gl cairo --size 160x90
asks yes 0 run hit.yaml --quiet --scene auto.png --size 160x90
asks no 0 sweep hit.yaml --vary motor.voltage=1:2:2 --quiet --plot sweep.svg
asks no 0 figures 2.1 -o figures
asks no 2 figures nonesuch
for picture in 'a [figure] of "it".svg' scene.png auto.png sweep.svg figures/fig-2-1.png; do
    [ -s "$picture" ] || fail "there is no $picture"
done

# copied into a folder of its own, as with a build folder that was moved
mkdir copied
cp "$program" copied/impactlab
(program=copied/impactlab && expect 0 run hit.yaml --quiet --plot copied.svg) || fail "a copy does not draw"
[ -s copied.svg ] || fail "a copy draws nothing"

# an installation in a place of any name, called through the path and through a link
case $bin in
/* | *..*) echo "skipped: the folder of programs is not below the prefix" ;;
*)
    prefix="$folder/my [lab] (2)"
    mkdir -p "$prefix/$bin"
    cp "$program" "$prefix/$bin/impactlab"
    ln -s "$prefix/$bin/impactlab" link
    (PATH="$prefix/$bin:$PATH" && impactlab run hit.yaml --quiet --plot installed.svg) ||
        fail "the installed program does not draw"
    program=./link
    expect 0 run hit.yaml --quiet --plot linked.svg
    cmp installed.svg linked.svg || fail "two figures of the same run"
    ;;
esac
nothing_failed
