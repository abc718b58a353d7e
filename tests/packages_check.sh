#!/bin/bash
# Every dependency() of the meson files must come from a package that the lab script installs.
# $1: the project's folder
set -euo pipefail
root=$1

if ! command -v dpkg >/dev/null; then
    echo "no Debian packages here, nothing to check"
    exit 77
fi

# the pkg-config names that the listed packages bring along
offered=$(for package in $("$root/lab" packages); do
    dpkg -L "$package" 2>/dev/null | sed -n 's|.*/\([^/]*\)\.pc$|\1|p'
done | sort -u)

wanted=$(cd "$root" && find . -name meson.build -not -path './build*/*' -exec cat {} + |
    sed 's/#.*//' | grep -o "dependency('[^']*'" | sed "s/.*('//; s/'//" | sort -u)
[ -n "$wanted" ] || { echo "no dependency found in the meson files"; exit 1; }

failed=0
for name in $wanted; do
    # what meson knows by itself comes with the compiler, and the library of this project is built
    case $name in
    threads | dl | m | impactlab) continue ;;
    esac
    if ! grep -qx -- "$name" <<<"$offered"; then
        echo "dependency('$name') comes from no package of the lab script"
        failed=1
    fi
done
exit $failed
