#!/bin/bash
# What the shared library exports is what the list says, and nothing else; the public headers
# compile as C and as C++ without anything of the project's own beside them.
#
#   test_symbols.sh LIBRARY SOURCE_ROOT
set -euo pipefail
library=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# names with their versions
nm -D --defined-only "$library" | awk '$2 != "A" { print $3 }' | LC_ALL=C sort >"$work/exported"
sed '/@@/!s/$/@@IMPACTLAB_1/' "$source/tests/api/symbols.txt" | LC_ALL=C sort >"$work/listed"
if ! diff "$work/listed" "$work/exported"; then
    echo "the library exports other names than tests/api/symbols.txt lists (impactlab.h, what stays)"
    exit 1
fi

# the archive has the same names
archive=${library%.so*}.a
if [ -e "$archive" ]; then
    nm --defined-only -g "$archive" | awk 'NF == 3 { print $3 }' | LC_ALL=C sort >"$work/archived"
    sed 's/@@.*//' "$source/tests/api/symbols.txt" | LC_ALL=C sort | diff - "$work/archived" ||
        { echo "the archive has other names than tests/api/symbols.txt lists"; exit 1; }
fi

# the headers by themselves, as an installation has them
mkdir -p "$work/include/impactlab"
cp "$source/src/api/impactlab/impactlab.h" "$source/src/rig/controller.h" "$work/include/impactlab"
printf '#include <impactlab/impactlab.h>\n#include <impactlab/controller.h>\nint main(void) { return 0; }\n' \
    >"$work/alone.c"
cp "$work/alone.c" "$work/alone.cpp"
${CC:-cc} -std=c99 -Wall -Wextra -Wpedantic -Werror -I"$work/include" -fsyntax-only "$work/alone.c"
if command -v "${CXX:-c++}" >/dev/null; then
    for standard in c++11 c++17 c++20; do
        ${CXX:-c++} -std=$standard -Wall -Wextra -Wpedantic -Werror -I"$work/include" \
            -fsyntax-only "$work/alone.cpp"
    done
fi
echo "$(wc -l <"$work/listed") names, C and C++"
