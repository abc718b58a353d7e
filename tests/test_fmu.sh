#!/bin/bash
# The archive of every shipped scenario: whole, at most 1 MB, its description valid by the schema of
# FMI 2.0, its binary in need of nothing but libm and libc; the same bytes every time. The sources by
# mingw-w64, and FMPy's own look at an FMU, where they are there.
#
#     test_fmu.sh IMPACTLAB SOURCE_ROOT
#     IMPACTLAB_FMPY    folder with FMPy's package, github.com/CATIA-Systems/FMPy/src; it wants numpy, lxml,
#                       attr and lark
set -euo pipefail
impactlab=$(readlink -f -- "$1") root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*"; exit 1; }
cd "$work"

for name in $("$impactlab" list | awk '/^[a-z]+\// { print $1 }'); do
    "$impactlab" fmu "$name" -o arm.fmu -q
    [ "$(stat -c %s arm.fmu)" -le 1000000 ] || fail "$name: $(stat -c %s arm.fmu) bytes"
    # which looks at its sums, too
    rm -rf arm && python3 -m zipfile -e arm.fmu arm
    if command -v xmllint >/dev/null; then
        xmllint --noout --schema "$root/tests/fmi2/fmi2ModelDescription.xsd" arm/modelDescription.xml 2>said ||
            fail "$name: $(cat said)"
    fi
    exported=$((${exported:-0} + 1))
done
[ "${exported:-0}" -ge 80 ] || fail "only ${exported:-0} scenarios were exported"
command -v xmllint >/dev/null || echo "xmllint is not there: no description was checked against the schema"

# every source that is named is there, and the other way round
sed -n 's/ *<File name="\(.*\)".*/\1/p' arm/modelDescription.xml | sort >named
(cd arm/sources && ls ./*.c | sed 's/^..//' | sort) | diff named - || fail "the sources are not those that are named"

# the binary
if [ -d arm/binaries/linux64 ]; then
    readelf -d arm/binaries/linux64/*.so | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | sort | tr '\n' ' ' >needed
    grep -qxE 'libc.so.6 libm.so.6 ' needed || grep -q san needed || fail "the binary needs $(cat needed)"
    nm -D --defined-only arm/binaries/linux64/*.so | awk '{ print $3 }' | grep -v '^fmi2' && fail "the binary exports these"
fi

# the same scenario, the same bytes; another one, another guid
"$impactlab" fmu compare/hybrid -o one.fmu -q
"$impactlab" fmu compare/hybrid -o two.fmu -q
cmp one.fmu two.fmu
guid() { python3 -m zipfile -e "$1" guid && grep -o 'guid="[^"]*"' guid/modelDescription.xml; }
"$impactlab" fmu compare/hybrid -o two.fmu -q --set control.force=2
[ "$(guid one.fmu)" != "$(guid two.fmu)" ] || fail "two scenarios have one guid"

# chosen inputs; what else may change can be tuned
"$impactlab" fmu compare/hybrid -o two.fmu -q --inputs control.force,wall.angle
guid two.fmu >/dev/null
grep -o 'name="[a-z_.]*" valueReference="[0-9]*" causality="input"' guid/modelDescription.xml | cut -d'"' -f2 | tr '\n' ' ' >inputs
[ "$(cat inputs)" = "wall.angle control.force motor_command push " ] || fail "inputs: $(cat inputs)"
grep -q 'name="motor.stiction" valueReference="[0-9]*" causality="parameter" variability="tunable"' guid/modelDescription.xml

# names and titles as people write them
printf 'title: a "b" <c> & d\ncontrol: {law: hybrid}\nrun: {duration: 0.1 s}\n' >"a \"b\" & ü.yaml"
"$impactlab" fmu "a \"b\" & ü.yaml" -o named.fmu -q
rm -rf arm && python3 -m zipfile -e named.fmu arm
python3 -c 'import sys, xml.etree.ElementTree as tree
head = tree.parse("arm/modelDescription.xml").getroot()
assert head.get("description") == "a \"b\" <c> & d", head.get("description")'

# what cannot be
status=0
"$impactlab" fmu compare/hybrid 2>said || status=$?
[ "$status" = 2 ] && grep -q -- '-o FILE.fmu' said || fail "without -o: $status, $(cat said)"
status=0
"$impactlab" fmu compare/hybrid -o /nonexistent/arm.fmu 2>said || status=$?
[ "$status" = 1 ] || fail "a folder that is not there: $status"

if command -v x86_64-w64-mingw32-gcc >/dev/null; then
    (cd arm/sources && x86_64-w64-mingw32-gcc -O1 -shared -o arm.dll ./*.c -lm)
    x86_64-w64-mingw32-objdump -p arm/sources/arm.dll >dll
    grep -q fmi2DoStep dll || fail "the DLL exports no fmi2DoStep"
    sed -n 's/.*DLL Name: //p' dll | grep -viE '^(kernel32|msvcrt)' && fail "the DLL needs these"
else
    echo "mingw-w64 is not there: the sources were not compiled for Windows"
fi

python=python3
"$python" -c 'import numpy, lxml, attr, lark' 2>/dev/null || python=/usr/bin/python3
if [ -n "${IMPACTLAB_FMPY:-}" ]; then
    PYTHONPATH=$IMPACTLAB_FMPY "$python" - one.fmu two.fmu <<'END'
import sys
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu
for file in sys.argv[1:]:
    problems = validate_fmu(file)
    assert not problems, problems
rows = simulate_fmu(sys.argv[1], stop_time=0.5, step_size=1e-3, output=['force', 'hub_angle'])
assert rows['force'].max() > 1, rows['force'].max()
END
else
    echo "IMPACTLAB_FMPY is not set: FMPy did not look at an FMU"
fi
