#!/bin/bash
# An installation that has moved: programs outside the tree build against it and give the peak of
# `impactlab run` to the last digit, in C, C++, statically, in Python, and within another project; the same law as a plug-in and
# as a process in Python and Octave gives one peak.
#
#   test_install.sh BUILD_FOLDER SOURCE_ROOT MESON...
#
# What needs a language or package that is missing is skipped with a sentence.
set -euo pipefail
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../expect.sh"
build=$1
source=$2
shift 2
work=$folder
unset IMPACTLAB_SCENARIOS IMPACTLAB_LIBRARY IMPACTLAB_PROGRAM PYTHONPATH

skip() {
    echo "skipped: $*"
}

# installed in one place, then moved to another
"$@" install -C "$build" --no-rebuild --destdir "$work/first" >"$work/log" 2>&1 ||
    { cat "$work/log"; exit 1; }
prefix=$(dirname -- "$(dirname -- "$(find "$work/first" -path '*/bin/impactlab')")")
mv "$prefix" "$work/lab moved"
prefix="$work/lab moved"
lab=$prefix/bin/impactlab
cd "$work"

# everything is there
library=$(dirname -- "$(find "$prefix" -name libimpactlab.so.1)")
for file in include/impactlab/impactlab.h include/impactlab/controller.h \
    share/impactlab/scenarios/corrected/first-impact.yaml share/impactlab/examples/peak.c \
    share/doc/impactlab/README.md share/man/man1/impactlab.1 share/man/man1/impactlab-run.1 \
    share/man/man5/impactlab-scenario.5 share/man/man3/libimpactlab.3 \
    share/bash-completion/completions/impactlab.bash share/zsh/site-functions/_impactlab \
    share/fish/vendor_completions.d/impactlab.fish; do
    [ -e "$prefix/$file" ] || fail "$file is not installed"
done
[ -e "$library/pkgconfig/impactlab.pc" ] || fail "impactlab.pc is not installed"
cp "$prefix"/share/impactlab/examples/* .

# the moved program has its own scenarios, not those of the tree it was built from
mv "$prefix/share/impactlab/scenarios/corrected/first-impact.yaml" kept.yaml
"$lab" list | grep -q 'corrected/first-impact' && fail "the installed program reads the source tree"
mv kept.yaml "$prefix/share/impactlab/scenarios/corrected/first-impact.yaml"
"$lab" list | grep -q 'corrected/first-impact' || fail "a moved program does not find its scenarios"
mkdir own && sed 's/^title:.*/title: my own/' "$prefix/share/impactlab/scenarios/corrected/first-impact.yaml" >own/mine.yaml
IMPACTLAB_SCENARIOS=$work/nonesuch-is-skipped:$work/own "$lab" list >/dev/null 2>&1 &&
    fail "a folder that is not there is not told"
IMPACTLAB_SCENARIOS=$work/own "$lab" list | grep -q '^mine .*my own' || fail "own scenarios are not added"
IMPACTLAB_SCENARIOS=$work/own "$lab" list | grep -q 'corrected/first-impact' ||
    fail "own scenarios take the place of those that ship"

# it says where its manual lies, and every page that it names is there
"$lab" help settling time >answer || fail "a moved program answers no question"
grep -qxF "The pages are in $prefix/share/doc/impactlab" answer || fail "a moved program does not find its manual"
while read -r page; do
    [ -e "$prefix/share/doc/impactlab/$page" ] || fail "$page is not installed"
done < <(sed -n 's/^\(README.md\|docs[^,]*\), ".*/\1/p' answer)

# it draws
"$lab" run corrected/first-impact --quiet --plot moved.svg && [ -s moved.svg ] || fail "a moved program does not draw"

# the peak that all of them have to give
"$lab" run corrected/first-impact --quiet --json run.json
expect() {
    local what=$1 given=$2
    python3 - "$given" run.json <<'EOF' || fail "$what gives $given"
import json, sys
sys.exit(float(sys.argv[1]) != json.load(open(sys.argv[2]))["peak_force_N"])
EOF
}

# C and C++ through pkg-config
export PKG_CONFIG_PATH=$library/pkgconfig
# the prefix moved, which pkg-config is told; blanks in it need quoting, so flags go through eval
flags() {
    pkg-config --define-variable=prefix="${prefix// /\\ }" "$@" impactlab
}
if command -v pkg-config >/dev/null; then
    eval "${CC:-cc} -std=c17 -Wall -Werror -o peak_c peak.c $(flags --cflags --libs)" ||
        fail "peak.c does not compile"
    expect "the program in C" "$(LD_LIBRARY_PATH=$library ./peak_c corrected/first-impact)"
    if command -v "${CXX:-c++}" >/dev/null; then
        eval "${CXX:-c++} -std=c++17 -Wall -Werror -x c++ peak.c -x none -o peak_cpp $(flags --cflags --libs)" ||
            fail "peak.c does not compile as C++17"
        expect "the program in C++" "$(LD_LIBRARY_PATH=$library ./peak_cpp corrected/first-impact)"
    else
        skip "no C++ compiler"
    fi
    if [ -e "$library/libimpactlab.a" ]; then
        eval "${CC:-cc} -std=c17 -o peak_static peak.c $(flags --cflags) '$library/libimpactlab.a' \
            $(pkg-config --libs $(pkg-config --print-requires-private impactlab)) -lm -ldl -lpthread" ||
            fail "peak.c does not link statically"
        expect "the program linked statically" \
            "$(IMPACTLAB_SCENARIOS=$prefix/share/impactlab/scenarios ./peak_static corrected/first-impact)"
    fi
else
    skip "pkg-config is missing"
fi

# no file of the installation knows where it was built
for file in "$library"/libimpactlab.* "$lab"; do
    LC_ALL=C grep -qaF "$build" "$file" && fail "${file##*/} names the build folder"
    LC_ALL=C grep -qaF "$source/" "$file" && fail "${file##*/} names the source tree"
done

# the commands of the page as they stand, for a prefix in the home
if command -v pkg-config >/dev/null; then
    mkdir home && cp -r "$prefix" home/.local && cp peak.c home
    grep -A 3 '^export PKG_CONFIG_PATH' "$source/docs/howto/library.md" | grep -v '^```' >home/commands
    if grep -q pcfiledir "$library/pkgconfig/impactlab.pc"; then
        expect "the page's program in C" "$(cd home && env -u PKG_CONFIG_PATH HOME="$work/home" sh -eu ./commands)"
    else
        skip "the build folder was set up without pkgconfig.relocatable, no test of the page's commands"
    fi
fi

# within another project of Meson it is the library
mkdir -p host/subprojects && cp peak.c host && ln -s "$source" host/subprojects/impactlab
cat >host/meson.build <<'EOF'
project('host', 'c')
executable('peak', 'peak.c', dependencies: dependency('impactlab', fallback: 'impactlab'))
EOF
"$@" setup host/build host >log 2>&1 && "$@" compile -C host/build peak >>log 2>&1 || fail "$(tail log)"
expect "the program of a Meson project" "$(host/build/peak corrected/first-impact)"

# Python, from where the installation put its package
package=$(dirname -- "$(dirname -- "$(find "$prefix" -path '*/impactlab/__init__.py' | head -n 1)")")
python=
for candidate in python3 /usr/bin/python3; do
    if [ -z "$python" ] && "$candidate" -c 'import numpy' 2>/dev/null; then
        python=$candidate
    fi
done
if [ -n "$python" ] && [ "$package" != . ]; then
    expect "the script in Python" "$(PYTHONPATH=$package "$python" -c '
import impactlab
print(repr(impactlab.Scenario("corrected/first-impact").run().peak_force_N))')"
else
    skip "python3-numpy is missing, no test of the package for Python"
fi

# one law as a plug-in, and as a process in Python and Octave
peak_of() {
    "$lab" run soft_push.yaml --allow-code --quiet --json law.json "$@" &&
        python3 -c 'import json; print(repr(json.load(open("law.json"))["peak_force_N"]))'
}
eval "${CC:-cc} -std=c17 -Wall -Werror -shared -fPIC -o soft_push.so soft_push.c -I'$prefix/include'"
plugin=$(peak_of --set control.law=plugin --set control.plugin=./soft_push.so) ||
    fail "the plug-in does not run"
"$lab" run soft_push.yaml --quiet --set control.law=plugin --set control.plugin=./soft_push.so \
    >said 2>&1 && fail "a plug-in runs unasked"
given=$(peak_of) || fail "the process in Python does not run"
[ "$given" = "$plugin" ] || fail "Python gives $given, the plug-in $plugin"
if command -v octave-cli >/dev/null; then
    given=$(peak_of --set 'control.command=octave-cli -q soft_push.m' --set control.answer_time=60) ||
        fail "the process in Octave does not run"
    [ "$given" = "$plugin" ] || fail "Octave gives $given, the plug-in $plugin"
else
    skip "octave-cli is missing, no controller in Octave"
fi

nothing_failed && echo "the moved installation is whole"
