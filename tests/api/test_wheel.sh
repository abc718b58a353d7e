#!/bin/bash
# The wheel in an environment of its own without a network: its library needs no other than those of C, a
# run gives the peak of `impactlab run`, types are checked, a notebook becomes a page with its figures.
#
#   test_wheel.sh BUILD_FOLDER SOURCE_ROOT PROGRAM
#
# What needs a package that is missing is skipped with a sentence.
set -euo pipefail
build=$1
source=$2
lab=$(readlink -f "$3")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset IMPACTLAB_SCENARIOS IMPACTLAB_LIBRARY IMPACTLAB_PROGRAM PYTHONPATH

fail() {
    echo "$*"
    exit 1
}

python=
for candidate in python3 /usr/bin/python3; do
    if [ -z "$python" ] && "$candidate" -c 'import numpy, ensurepip' 2>/dev/null; then
        python=$candidate
    fi
done
[ -n "$python" ] || { echo "skipped: python3-numpy or python3-venv is missing"; exit 77; }
if ! ninja -C "$build" wheel >"$work/log" 2>&1; then
    grep -qE 'is missing|unknown target' "$work/log" || fail "$(tail "$work/log")"
    echo "skipped: $(tail -n 1 "$work/log")"
    exit 77
fi
wheel=$(ls "$build"/impactlab-*.whl)

# installed as the page of the library says, from the file alone
alone=()
unshare -rn true 2>/dev/null && alone=(unshare -rn)
"$python" -m venv --system-site-packages "$work/env"
"${alone[@]}" "$work/env/bin/pip" install --no-index "$wheel" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
cd "$work"
library=$(find env -name 'libimpactlab.so*')
needed=$(readelf -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | sort | xargs)
[ "$needed" = "libc.so.6 libm.so.6" ] || fail "the library of the wheel needs $needed"
LC_ALL=C grep -qF "$source" "$library" && fail "the library of the wheel names the source tree"

"$lab" run corrected/first-impact --quiet --json run.json
env/bin/python - "$library" <<'EOF'
import json, os, sys
import impactlab
assert os.path.samefile(impactlab.library.lib._name, sys.argv[1])
peak = impactlab.Scenario("corrected/first-impact").run().peak_force_N
assert peak == json.load(open("run.json"))["peak_force_N"]
EOF

# every wrong line is found and no other
typed=$source/tests/api/python/typed.py
if /usr/bin/python3 -c 'import mypy' 2>/dev/null; then
    /usr/bin/python3 -m mypy --strict --python-executable env/bin/python --cache-dir mypy "$typed" >said || true
    sed -n 's/^[^:]*typed.py:\([0-9]*\): error.*/\1/p' said | sort -un >found
    grep -n '# wrong$' "$typed" | cut -d: -f1 | sort -un | diff - found || fail "$(cat said)"
else
    echo "skipped: python3-mypy is missing, no test of types"
fi

# the notebook of the examples, with the lab's figures where the program is on the path
if env/bin/python -c 'import nbconvert, ipykernel' 2>/dev/null; then
    cp "$source/docs/examples/figure-5-7.ipynb" .
    env/bin/python -m ipykernel install --sys-prefix >said 2>&1 || fail "$(tail said)"
    PATH=$(dirname "$lab"):$PATH env/bin/python -m nbconvert --to html --execute figure-5-7.ipynb >said 2>&1 ||
        fail "$(tail said)"
    [ "$(grep -o 'src="data:image/svg+xml;base64' figure-5-7.html | wc -l)" -ge 2 ] ||
        fail "the page of the notebook lacks the figures of its runs"
    grep -q 'impact+contact' figure-5-7.html || fail "the page of the notebook lacks its table"
else
    echo "skipped: python3-nbconvert or python3-ipykernel is missing, no test of the notebook"
fi
