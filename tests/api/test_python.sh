#!/bin/bash
# Runs the tests of the package for Python, or says what they lack (Debian: python3-numpy,
# python3-pytest).
#
#   test_python.sh PACKAGE_FOLDER TESTS LIBRARY PROGRAM
set -euo pipefail
for python in python3 /usr/bin/python3; do
    if "$python" -c 'import numpy, pytest' 2>/dev/null; then
        export PYTHONPATH=$1 IMPACTLAB_LIBRARY=$3 IMPACTLAB_PROGRAM=$4 PYTHONDONTWRITEBYTECODE=1
        # a library under a sanitizer wants its runtime loaded before everything else
        if grep -qa __asan_init "$3"; then
            echo "skipped: the library is built with a sanitizer, which Python does not load"
            exit 77
        fi
        exec "$python" -m pytest -q -p no:cacheprovider "$2"
    fi
done
echo "skipped: python3-numpy or python3-pytest is missing"
exit 77
