#!/bin/bash
# Exported laws, compiled here: every command of a run has the lab's bits in double precision, and is
# within what law.h says in single. The second compiler, where there is one, and a run of another seed
# through the same law.
#
#     test_law_export.sh IMPACTLAB
set -euo pipefail
impactlab=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
flags="-std=c99 -O2 -Wall -Wextra -Werror -ffp-contract=off"

# compiles what was exported and replays it
replay() {
    (cd "$work/out" && $1 $flags -o replay law.c replay.c -lm && ./replay <readings.csv >said) ||
        { echo "$2 by $1: $(cat "$work/out/said")"; exit 1; }
}

for law in touch hybrid recovering reverse-torque speed-limit bang-bang force-pd force-integral discontinuous; do
    for precision in "" --float; do
        "$impactlab" export "compare/$law" -o "$work/out" -q $precision
        replay cc "$law $precision"
        ! command -v clang >/dev/null || replay clang "$law $precision"
    done
done

# other arms, beliefs, delays and limits
while read -r settings; do
    "$impactlab" export compare/touch -o "$work/out" -q $settings
    replay cc "$settings"
done <<'END'
--set control.delay=0.008 --set wall.restitution=0.4 --set belief.k2_factor=0.8
--set arm.links=5 --set belief.links=5 --set control.rate=500 --set control.force=3
--set arm.hub_joint=spring --set sensor.force=piezo --set control.force_limit=2
--set control.settings=touch_speed=0.3 --set control.jitter=0.001 --set control.seed=9
END

# a name with a line end stays within its comment
printf 'title: t\ncontrol: {law: touch}\nrun: {duration: 0.1 s}\n' >"$work"/$'a\nint b = c; d.yaml'
"$impactlab" export "$work"/$'a\nint b = c; d.yaml' -o "$work/out" -q
replay cc "a name with a line end"

# another seed: the law is the same file, the readings are others
"$impactlab" export compare/touch -o "$work/out" -q
cp "$work/out/law.c" "$work/law.c"
for seed in 1 2 3 4 5 6 7 8 9 10; do
    "$impactlab" export compare/touch -o "$work/out" -q --set control.seed=$seed
    cmp "$work/law.c" "$work/out/law.c"
    [ -x "$work/replay" ] || { replay cc touch; cp "$work/out/replay" "$work/replay"; }
    "$work/replay" <"$work/out/readings.csv" >/dev/null
done

# what cannot be exported is said, and nothing is written
status=0
"$impactlab" export compare/observer -o "$work/none" 2>"$work/said" || status=$?
[ "$status" = 2 ] || { echo "observer: exit status $status, expected 2"; exit 1; }
grep -q "cannot be exported" "$work/said"
[ ! -e "$work/none" ] || { echo "a refused export leaves a folder"; exit 1; }

# a folder of somebody else's keeps its files
mkdir "$work/theirs"
echo mine >"$work/theirs/readings.csv"
status=0
"$impactlab" export compare/touch -o "$work/theirs" -q 2>"$work/said" || status=$?
[ "$status" = 1 ] || { echo "a foreign folder: exit status $status, expected 1"; exit 1; }
[ "$(cat "$work/theirs/readings.csv")" = mine ]
[ ! -e "$work/theirs/law.h" ] || { echo "a foreign folder gets files"; exit 1; }
echo "the same commands"
