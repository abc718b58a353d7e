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

# --- on a terminal a sweep shows a bar, and takes it away
if command -v script >/dev/null; then
    on_terminal "$program" sweep hit.yaml --set run.duration=2 --vary motor.voltage=1:2:400 --jobs 1 --csv bar.csv
    tr '\r' '\n' <seen | grep -q '400 of 400 runs' || fail "a sweep on a terminal shows no bar"
    [ "$(wc -l <bar.csv)" = 401 ] || fail "the sweep under the bar has not its rows"
fi

nothing_failed
