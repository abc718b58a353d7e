#!/bin/bash
# The program's version is that of the newest entry of CHANGELOG.md and of CITATION.cff; an entry
# whose second number grew says which results changed.
#
#   test_version.sh PROGRAM SOURCE_ROOT
set -euo pipefail
version=$("$1" --version | sed 's/^impactlab //')
cd "$2"
fails=0

complain() {
    echo "FAILED: $*"
    fails=$((fails + 1))
}

newest=$(sed -n 's/^## \([0-9.]*\).*/\1/p' CHANGELOG.md | head -1)
[ "$newest" = "$version" ] || complain "the newest entry of CHANGELOG.md is $newest, not $version"
grep -qx "version: $version" CITATION.cff || complain "CITATION.cff is of another version"
grep -qx "version = \"$version\"" src/api/python/pyproject.toml || complain "so is the package"

# X.Y.0 says what changed; X.Y.Z with another Z must not have changed any
entry=$(awk '/^## / { n++ } n == 1' CHANGELOG.md)
if [[ $version == *.0 ]]; then
    grep -q '^\*\*Results\*\*' <<<"$entry" || complain "the entry does not say which results changed"
else
    ! grep -q '^\*\*Results\*\*' <<<"$entry" || complain "results changed: the second number must grow"
fi

[ "$fails" = 0 ] && echo "one version, $version"
