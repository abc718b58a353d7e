#!/bin/bash
# What commands print and write, held against what else is known of it: commands of which other tests
# only ask that they run.
# $1: the program
set -u
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/expect.sh"

# number FILE KEY [N]: what follows the N-th "KEY": in a JSON file
number() {
    sed -n "s/.*\"$2\": \([^,]*\),*\$/\1/p" "$1" | sed -n "${3:-1}p"
}

# near A B SHARE: two numbers agree
near() {
    awk -v a="$1" -v b="$2" -v share="$3" 'BEGIN { d = a - b; m = a < 0 ? -a : a
        exit !(a != "" && b != "" && (d < 0 ? -d : d) <= share * m) }' || fail "$1 and $2 differ by more than $3"
}

cat >hit.yaml <<'END'
title: An impact
motor: {voltage: 2 V}
run: {duration: 0.35 s}
END

# --- the predictors say beside the run what the run says itself
expect 0 predict hit.yaml --json p.json
expect 0 run hit.yaml --json r.json --quiet
sed -n '/"simulation"/,$p' p.json >simulation.json
near "$(number simulation.json peak_N)" "$(number r.json first_pulse_peak_N)" 0
near "$(number simulation.json impulse_Ns)" "$(number r.json contact_impulse_Ns)" 0
[ "$(grep -c '"method"' p.json)" -ge 3 ] || fail "predict has fewer than three predictors"

# --- the parts of a sweep, merged, are the sweep; what overlaps is refused
vary="--vary motor.voltage=1:3:5 --quiet"
# shellcheck disable=SC2086
for part in 1 2; do expect 0 sweep hit.yaml $vary --part $part/2 --db part$part.sqlite; done
# shellcheck disable=SC2086
expect 0 sweep hit.yaml $vary --db whole.sqlite --csv whole.csv
expect 0 merge part1.sqlite part2.sqlite -o both.sqlite --json merged.json
# shellcheck disable=SC2086
expect 0 sweep hit.yaml $vary --db both.sqlite --csv both.csv
cmp -s <(cut -d, -f1-6 whole.csv) <(cut -d, -f1-6 both.csv) || fail "merged rows are not those of the sweep"
grep -q ' 5\|: 5' merged.json || fail "merge does not say its five runs: $(cat merged.json)"
expect 2 merge part1.sqlite part1.sqlite -o twice.sqlite
[ ! -e twice.sqlite ] || fail "a merge that was refused leaves a file"

# --- the tables of the thesis: each number beside what was computed and the difference
expect 0 tables --json t.json
grep -q '"printed"' t.json || fail "tables has no printed numbers"
expect 0 tables
[ "$(wc -l <out)" -gt 30 ] || fail "tables prints $(wc -l <out) lines"

# --- the methods: error falls with the step, and the reference is the run's own first contact
expect 0 study methods hit.yaml --set wall.angle=0.01 --set run.duration=0.12 --json m.json --plot m.svg
expect 0 run hit.yaml --set wall.angle=0.01 --set run.duration=0.12 --json r.json --quiet
near "$(number m.json first_contact_s)" "$(number r.json first_contact_s)" 1e-9
awk '/"method": "newmark"/ { on = 1 } /"method": "gen/ { exit } on && /first_contact_s/ { gsub(/[",]/, ""); e[++n] = $2 }
    END { exit !(n == 13 && e[4] > 0 && e[4] < e[1] && e[7] < e[4]) }' m.json ||
    fail "the error of Newmark's method does not fall with the step"
[ -s m.svg ] && [ -s m.csv ] || fail "study methods draws nothing"

# --- a sensor reads less the slower it is, and never more than the impulse over its time constant
expect 0 study sensor corrected/plane-wall-fast --json s.json
awk '/"peak_N"/ { gsub(/,/, ""); p[++n % 4] = $2 } /"time_to_peak_s"/ { k++ } n % 4 == 0 && n > seen {
        seen = n; if (!(p[2] > p[3] && p[3] > p[0])) bad = 1 } END { exit bad || n != 32 }' s.json ||
    fail "a slower sensor reads more"

# --- modes: what is printed is what --json has; four times the stiffness, twice the frequency
mode() {
    awk -v set="$1" -v mode="$2" 'index($0, set) == 1 { on = 1 } on && $1 == mode { print $2; exit }' out
}
expect 0 modes hit.yaml --set arm.k2=5 --json modes.json
expect 0 modes hit.yaml --set arm.k2=5
soft=$(mode 'Hub free, tip free' 2)
near "$soft" "$(sed -n 's/.*"frequency_Hz": \[0, \(.*\)\].*/\1/p' modes.json)" 1e-4
says out "nothing can move"
expect 0 modes hit.yaml --set arm.k2=20
near "$(mode 'Hub free, tip free' 2)" "$(awk -v f="$soft" 'BEGIN { print 2 * f }')" 1e-4
expect 0 modes corrected/twenty-links
says out "more (--json lists all)"

# --- the script of a scenario is shown as it will act
printf 'title: scripted\nscript:\n- at: 0.1 s\n  set: {motor.voltage: 2 V}\n- at: 0.2 s\n  push: 0.01 N s\n' >scripted.yaml
expect 0 show scripted.yaml
says out "at 0.1 s: motor.voltage = 2"
says out "at 0.2 s: push the tip with 0.01 N s"

# --- a scenario with faults is listed, without a title; a folder that is not there is told
mkdir -p own
printf 'title: x\nmotor: {voltage: much}\n' >own/broken.yaml
IMPACTLAB_SCENARIOS=$PWD/own expect 0 list
says out "broken"
says out "has faults, see impactlab check"
IMPACTLAB_SCENARIOS=$PWD/own expect 0 list --json list.json
grep -A1 '"broken"' list.json | grep -q null || fail "a scenario with faults has a title"

# --- a comparison: the rows of its CSV are the runs by themselves
expect 0 compare hit.yaml --vary motor.voltage=1,2 --csv compared.csv --json compared.json --quiet
[ "$(wc -l <compared.csv)" = 3 ] || fail "a comparison of two runs has $(wc -l <compared.csv) lines"
expect 0 run hit.yaml --json r.json --quiet
grep -q "$(number r.json peak_force_N)" compared.json || fail "compare --json lacks the run's peak"
grep -q "$(number r.json peak_force_N)" compared.csv || fail "compare --csv lacks the run's peak"

# --- without a file a sweep lists its first 40 runs and says how many more there are
expect 0 sweep hit.yaml --set run.duration=0.05 --vary motor.voltage=1:2:43
says out "and 3 more (--csv writes all)"
[ "$(grep -c 'motor.voltage = \|motor.voltage=' out)" = 40 ] || fail "not 40 runs are listed: $(cat out)"

# --- drawn at random: the same for the same seed, within the range, another for another
for seed in 1 1 2; do
    expect 0 sweep hit.yaml --sample random --runs 5 --seed $seed --vary motor.voltage=1:2 --quiet --csv drawn.csv
    cut -d, -f2 drawn.csv | tail -n +2 >>drawn
done
awk '{ v[NR] = $1; if (!($1 >= 1 && $1 <= 2)) bad = 1 }
    END { for (i = 1; i <= 5; i++) { if (v[i] != v[i + 5]) bad = 1; if (v[i] == v[i + 10]) bad = 1 }
          exit bad || NR != 15 }' drawn || fail "draws do not follow their seed: $(cat drawn)"

# --- the table of a robust set as Markdown has a row for each law, as many columns in each line
expect 0 robust hit.yaml --set control.force=1 --laws hybrid,force-pd --runs 3 --quiet --markdown table.md
[ "$(grep -c '^| *\(hybrid\|force-pd\) *|' table.md)" = 2 ] || fail "a law has no row: $(cat table.md)"
[ "$(grep '^|' table.md | tr -cd '|\n' | sort -u | wc -l)" = 1 ] || fail "the table's lines have not equal columns"

# --- a law gets of control.settings what it has, and a word that no law has is refused
expect 0 robust compare/least-time --laws hybrid,impedance --runs 2 --set "control.settings=wall_doubt=0 stiffness=20" --csv mixed.csv
says err "hybrid runs without 'wall_doubt=0 stiffness=20'"
says err "impedance runs without 'wall_doubt=0'"
expect 0 robust compare/least-time --laws impedance --runs 2 --set control.settings=stiffness=20 --csv stiff.csv --quiet
grep -q ^impedance stiff.csv || fail "robust has no row for impedance"
grep ^impedance mixed.csv | cmp - <(grep ^impedance stiff.csv) || fail "impedance does not get its settings"
expect 1 robust compare/least-time --laws hybrid --runs 2 --set control.settings=nonsense=1 --quiet
expect 0 robust compare/observer --laws observer,impedance --runs 2 --set control.settings=stiffness=20
says err "observer runs without 'stiffness=20'"
expect 0 robust compare/observer --laws hybrid,process --runs 2 --set control.settings=of_its_own=1 \
    --set control.command=true --allow-code
says err "hybrid runs without 'of_its_own=1'"
printf 'control.seed=1,2\ncase a: arm.k2=4\ncase b: control.settings=stiffness=20\n' >settings.set
expect 0 robust compare/observer --laws hybrid,impedance --runs 2 --over settings.set
says err "hybrid runs without 'stiffness=20'"

# --- a plot without a name of its own has its recipe's
expect 0 sweep hit.yaml --vary motor.voltage=1:2:2 --vary arm.k2=4:6:2 --db map.sqlite --quiet
printf 'tables:\n  - {file: map.sqlite, x: motor.voltage, y: arm.k2, z: peak_force_N}\npanels:\n  - {weight: 2}\n' >map.yaml
expect 0 plot map.yaml
says out "map.png"
[ "$(head -c 4 map.png | tail -c 3)" = PNG ] || fail "plot draws no map.png"

# --- the environments of figures stand in one file, one for each
expect 0 figures 3.4 3.5 -o pictures --format svg --latex all.tex
[ "$(grep -c 'begin{figure}' all.tex)" = 2 ] || fail "all.tex has not two figures"

# --- on a terminal a sweep shows a bar, and takes it away
if command -v script >/dev/null; then
    on_terminal "$program" sweep hit.yaml --set run.duration=2 --vary motor.voltage=1:2:400 --jobs 1 --csv bar.csv
    tr '\r' '\n' <seen | grep -q '400 of 400 runs' || fail "a sweep on a terminal shows no bar"
    [ "$(wc -l <bar.csv)" = 401 ] || fail "the sweep under the bar has not its rows"
fi

nothing_failed
