#!/bin/bash
# The program loads what draws only where a picture is asked for, and OpenGL only where a scene is, and draws
# wherever it was copied or installed.
#
#   test_start.sh PROGRAM BINDIR LIBDIR MODULE
set -u
bin=$2 lib=$3 module=$(readlink -f "$4")
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/expect.sh"
cat >hit.yaml <<'END'
title: An impact
motor: {voltage: 2 V}
run: {duration: 0.05 s}
END

# asks WANTED STATUS ARGUMENT...: what the program asks the dynamic linker for: nothing that draws, cairo, or
# OpenGL, too
asks() {
    local wanted=$1 met=nothing
    shift
    rm -f linked.*
    LD_DEBUG=files LD_DEBUG_OUTPUT=linked expect "$@"
    ! grep -qE 'lib(cairo|pango-1\.0|fontconfig)\.so' linked.* || met=cairo
    ! grep -qE 'lib(OSMesa|EGL)\.so' linked.* || met=opengl
    [ "$met" = "$wanted" ] || fail "asked for: $met, expected $wanted: $*"
}

asks nothing 0 --version
asks nothing 0 list
asks nothing 0 help
asks nothing 0 check hit.yaml
asks nothing 0 sweep hit.yaml --vary motor.voltage=1:2:2 --quiet --csv rows-of-runs.csv
asks nothing 0 run hit.yaml --json run.json --csv rows.csv
asks cairo 0 run hit.yaml --quiet --plot 'a [figure] of "it".svg'
asks cairo 0 run hit.yaml --quiet --scene scene.png --gl cairo --size 160x90
asks opengl 0 run hit.yaml --quiet --scene auto.png --size 160x90
asks cairo 0 sweep hit.yaml --vary motor.voltage=1:2:2 --quiet --plot sweep.svg
asks cairo 0 figures 2.1 -o figures
asks cairo 2 figures nonesuch
for picture in 'a [figure] of "it".svg' scene.png auto.png sweep.svg figures/fig-2-1.png; do
    [ -s "$picture" ] || fail "there is no $picture"
done

# what a start takes, where no sanitizer runs beside it
if ! grep -qa __asan_init "$program"; then
    libraries=$(LD_TRACE_LOADED_OBJECTS=1 "$program" | grep -c '=>\|ld-linux\|vdso')
    [ "$libraries" -le 14 ] || fail "$libraries libraries are loaded, expected at most 14"
fi
if ! grep -qa __asan_init "$program" && command -v valgrind >/dev/null; then
    for request in help 'check hit.yaml'; do
        # shellcheck disable=SC2086
        count=$(env -u LD_LIBRARY_PATH -u MALLOC_PERTURB_ valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" $request 2>&1 >/dev/null |
            sed -n 's/.*Collected : \([0-9]*\).*/\1/p')
        [ "${count:-0}" -gt 100000 ] || fail "$request: its instructions are not counted"
        [ "${count:-0}" -le 3100000 ] || fail "$request takes $count instructions, expected at most 3 100 000"
    done
fi

# copied into a folder of its own, as with a build folder that was moved, with its module and without
mkdir -p "copied/$lib/impactlab"
cp "$program" copied/impactlab
cp "$module" "copied/$lib/impactlab"
(program=copied/impactlab && expect 0 run hit.yaml --quiet --plot copied.svg) || fail "a copy does not draw"
[ -s copied.svg ] || fail "a copy draws nothing"
mkdir alone
cp "$program" alone/impactlab
built=$program
program=alone/impactlab
expect 0 run hit.yaml --quiet --json -
for request in '--plot alone.svg' '--scene alone.png' '--font serif'; do
    # shellcheck disable=SC2086
    expect 1 run hit.yaml --quiet $request
    says err 'drawing.so'
done
expect 1 figures 2.1
says err 'drawing.so'
expect 0 figures --help
program=$built

# an installation in a place of any name, called through the path and through a link
case $bin$lib in
/* | *..*) echo "skipped: the folder of programs is not below the prefix" ;;
*)
    prefix="$folder/my [lab] (2)"
    mkdir -p "$prefix/$bin" "$prefix/$lib/impactlab"
    cp "$program" "$prefix/$bin/impactlab"
    cp "$module" "$prefix/$lib/impactlab"
    ln -s "$prefix/$bin/impactlab" link
    (PATH="$prefix/$bin:$PATH" && impactlab run hit.yaml --quiet --plot installed.svg) ||
        fail "the installed program does not draw"
    program=./link
    expect 0 run hit.yaml --quiet --plot linked.svg
    cmp installed.svg linked.svg || fail "two figures of the same run"
    ;;
esac
nothing_failed
