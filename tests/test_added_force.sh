#!/bin/bash
# A new force touches the files of tests/added_force/wall_friction.patch and no other, and leaving one
# of them out does not compile. The patch is applied to a copy of the sources, which are built.
#
#     test_added_force.sh SOURCE_ROOT
set -euo pipefail
root=$1
copy=$(mktemp -d /tmp/impactlab-force-XXXXXX)
trap 'rm -rf "$copy"' EXIT
patch=$root/tests/added_force/wall_friction.patch
mapfile -t files < <(sed -n 's|^+++ b/||p' "$patch")
[ "${#files[@]}" -le 4 ] || { echo "the patch touches ${#files[@]} files"; exit 1; }

tar -C "$root" --exclude='./build*' --exclude=./.git -cf - . | tar -C "$copy" -xf -
patch -d "$copy" -p1 --quiet <"$patch"
cd "$copy"
meson setup -Doptimization=0 -Dwerror=false build >log 2>&1 || { tail -20 log; exit 1; }

# the force acts
ninja -C build tests/wall_friction >log 2>&1 || { tail -40 log; exit 1; }
build/tests/wall_friction

# without one of the files: what reads the lists of parameters and forces, and the forces themselves
objects=(tables_features arm_arm_setup arm_chain_sweep)
objects=("${objects[@]/#/src/libimpactlab.a.p/}")
for file in "${files[@]}"; do
    cp "$file" with
    cp "$root/$file" "$file"
    if ninja -C build "${objects[@]/%/.c.o}" >log 2>&1; then
        echo "FAILED: it compiles without the change of $file"
        exit 1
    fi
    printf 'without %s: %s\n' "$file" "$(grep -m1 'error:' log)"
    cp with "$file"
done
