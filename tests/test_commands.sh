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

printf 'time[s],command[V],encoder[rad]\n0,1,0\n0.005,1,0.001\n0.01,1,0.004\n0.015,1,0.009\n0.02,1,0.016\n0.025,1,0.025\n0.03,1,0.036\n0.035,1,0.049\n0.04,1,0.064\n0.045,1,0.081\n0.05,1,0.1\n0.055,1,0.121\n' >recorded.csv
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
expect 0 study links corrected/plane-wall-fast --json s.json
awk '/"first_impulse_Ns":/ { gsub(/,/, ""); i = $2 } /"sensed_[^"]*":/ { gsub(/,/, ""); p[n++ % 3] = $2 }
    /"sensed_2ms_N":/ && !(p[0] > p[1] && p[1] > p[2] && p[0] >= i / 0.5e-3 - 1e-6) { bad = 1 }
    END { exit bad || n != 18 }' s.json ||
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

# --- a long chain that nothing damps says so, and what damping would change is as it says
short="--set arm.links=32 --set run.duration=0.31"
# shellcheck disable=SC2086
expect 0 run corrected/first-impact $short --json undamped.json
says err "nothing damps the 32 links"
# shellcheck disable=SC2086
expect 0 run corrected/first-impact $short --set arm.damping_ratio=1e-4 --json damped.json
grep -q "nothing damps" err && fail "a damped chain is said to be undamped"
near "$(number undamped.json contact_impulse_Ns)" "$(number damped.json contact_impulse_Ns)" 0.01

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

# --- a run that never starts has no numbers to print: its sentence stands alone
expect 1 run compare/hybrid --set control.law=process --set control.command=false
says err "the scenario wants to start the program 'false'"
! grep -qE ' -$|^ +steps ' out || fail "numbers of a run that never started"

# --- what is wrong with a set is told before anything is run, with its lines, and all cases at once
printf 'control.seed=1,2\ncase a: control.settings=kp=2\ncase b: arm.links=-3\ncase c:\ncase d: arm.k2=x\n' >faulty.set
expect 2 robust compare/observer --runs 2 --over faulty.set --db faulty.sqlite
says err "faulty.set:3: case 'b': --set arm.links=-3: arm.links = -3 is out of range"
says err "faulty.set:5: case 'd': "
[ "$(ls faulty*.sqlite 2>/dev/null | wc -l)" = 0 ] || fail "cases were run before others were looked at"
printf 'control.seed=1,2\n\ninitial.angle=-0.1,9\ncase a:\ncase b:\n' >faulty.set
expect 2 robust compare/observer --runs 2 --over faulty.set
says err "faulty.set:3: "
[ "$(wc -l <err)" = 1 ] || fail "a line of a set is told for each case"
printf 'initial.angle=-0.1,0.5\ncase a: arm.k2=4\n' >faulty.set
expect 2 robust compare/observer --runs 2 --over faulty.set
says err "faulty.set:2: case 'a': run "
head -c 70000 /dev/zero | tr '\0' 1 >long.set
printf 'control.seed=1\0,2\n' >zero.set
for set in . /dev/full long.set zero.set; do
    expect 2 robust compare/observer --over "$set"
    says err "'$set'"
    [ "$(wc -l <err)" = 1 ] || fail "robust --over $set says more than why"
done

# --- what lies outside the scenario is changed between two calls: the second one gives what a call
# --- without the rows of the first gives, or refuses them
cat >outside.yaml <<'END'
title: A program that reads a table
control: {law: process, command: runner law.sh --table=volts.txt, rate: 100 Hz, force: 1 N}
run: {duration: 0.05 s}
END
mkdir -p programs
reset_outside() {
    echo 2 >volts.txt
    echo 'volts=$(cat volts.txt); while read -r line; do echo "{\"command\": $volts}"; done' >law.sh
    printf '#!/bin/sh\nexec sh "$@"\n' >programs/runner
    chmod +x programs/runner
    sed -i 's/duration: .*}/duration: 0.05 s}/' outside.yaml
    printf 'initial.angle=-0.1,-0.2\ncase a: motor.stiction=0.04\n' >outside.set
}
many() { # ROWS COMMAND...: a sweep or cases over the program, with the rows they keep
    local rows=$1
    shift
    code=0
    PATH=$PWD/programs:$PATH "$program" "$@" --db "$rows" --csv "$rows.csv" --allow-code --quiet 2>err || code=$?
}
reset_outside
for command in 'sweep outside.yaml --vary initial.angle=-0.1,-0.2' 'robust outside.yaml --over outside.set --runs 2'; do
    for change in 'echo 3 >volts.txt' 'sed -i "s/volts}/volts.5}/" law.sh' 'rm volts.txt' \
        'sed -i "s/duration: .*}/duration: 0.06 s}/" outside.yaml' 'sed -i s/0.04/0.08/ outside.set' \
        'touch law.sh volts.txt outside.yaml' 'chmod -x programs/runner' 'echo >programs/runner' 'sed -i s/-0.2/-0.3/ outside.set'; do
        rm -f kept*.sqlite fresh*.sqlite
        # shellcheck disable=SC2086
        many kept.sqlite $command
        [ "$code" = 0 ] || fail "$command: $(cat err)"
        eval "$change"
        # shellcheck disable=SC2086
        many kept.sqlite $command
        kept=$code
        # shellcheck disable=SC2086
        many fresh.sqlite $command
        if [ "$kept" != 2 ]; then
            [ "$kept" = "$code" ] && cmp -s kept.sqlite.csv fresh.sqlite.csv ||
                fail "$command goes on after '$change' with other rows"
        elif [ "$change" = 'touch law.sh volts.txt outside.yaml' ]; then
            fail "$command refuses what is the same: $(cat err)"
        fi
        reset_outside
    done
done

# --- a plot without a name of its own has its recipe's
expect 0 sweep hit.yaml --vary motor.voltage=1:2:2 --vary arm.k2=4:6:2 --db map.sqlite --quiet
printf 'tables:\n  - {file: map.sqlite, x: motor.voltage, y: arm.k2, z: peak_force_N}\npanels:\n  - {weight: 2}\n' >map.yaml
expect 0 plot map.yaml
says out "map.png"
[ "$(head -c 4 map.png | tail -c 3)" = PNG ] || fail "plot draws no map.png"

# --- the environments of figures stand in one file, one for each
expect 0 figures 3.4 3.5 -o pictures --format svg --latex all.tex
[ "$(grep -c 'begin{figure}' all.tex)" = 2 ] || fail "all.tex has not two figures"
[ -s pictures/fig-3-4.pdf ] && grep -q '{pictures/fig-3-5.pdf}' all.tex || fail "LaTeX gets pictures that it cannot read"

# --- whatever draws or heads a run says what was changed of the scenario: what --help lists with
# --set, each with what it needs besides; a command that is new has to be added here
recorded='--set control.law=open-loop --set control.rate=1000 --set method.step=0.0005'
# shellcheck disable=SC2086
expect 0 run hit.yaml $recorded --set run.duration=0.3 --set arm.tip_mass=0.004 --quiet --csv fits.csv
declare -A besides=([run]='' [predict]='' [modes]='' [converge]='' [compare]='hit.yaml' [show]=''
    [sweep]='--vary motor.voltage=1:2:2' [study]='' [robust]='--set control.force=1 --laws hybrid,force-pd --runs 3'
    [tune]='--set control.force=1 --set control.law=hybrid --vary control.kv=0.5:1 --minimise peak_force_N --runs 6'
    [calibrate]='' [linear]='' [identify]="$recorded --data fits.csv --fit arm.hub_inertia" [solve]='' [animate]='' [lab]='' [lesson]='' [export]='' [fmu]='')
title_of() { sed -n 's/.*<title>\(.*\)<\/title>.*/\1/p' "$1" | head -1; }
expect 0 help
for command in $(awk '/^  [a-z]/ { print $1 }' out); do
    "$program" "$command" --help 2>/dev/null >help.txt
    grep -q -e '--set' help.txt || continue
    [ -n "${besides[$command]+there}" ] || fail "$command takes --set: does its title say what was changed?"
    operands=hit.yaml
    [ "$command" != study ] || operands="methods hit.yaml --set wall.angle=0.01"
    if grep -q -e '--plot' help.txt; then
        # shellcheck disable=SC2086
        expect 0 "$command" $operands ${besides[$command]} --set run.duration=0.3 --set arm.tip_mass=0.004 \
            --plot "$command.svg" --quiet
        title_of "$command.svg" | grep -q 'arm.tip_mass.=.0.004' ||
            fail "$command draws a title without what was changed: $(title_of "$command.svg")"
    fi
done
for command in show run predict modes converge; do
    expect 0 "$command" hit.yaml --set arm.tip_mass=0.004
    head -1 out | grep -q 'An impact, with arm.tip_mass = 0.004 kg' || fail "$command does not say what was changed"
done
expect 0 run hit.yaml --set arm.tip_mass=0.004 --quiet --scene changed.png
LC_ALL=C grep -aq 'An impact, with..arm.tip_mass..=..0.004..kg' changed.png || fail "a scene does not say what was changed"

# given the value that it has, nothing is changed; a name that stands in for the title is not kept from it
expect 0 run hit.yaml --set motor.voltage=2
[ "$(head -1 out)" = "hit.yaml: An impact" ] || fail "what was not changed is said to be: $(head -1 out)"

# --- on a terminal a sweep shows a bar, and takes it away
if command -v script >/dev/null; then
    on_terminal "$program" sweep hit.yaml --set run.duration=2 --vary motor.voltage=1:2:400 --jobs 1 --csv bar.csv
    tr '\r' '\n' <seen | grep -q '400 of 400 runs' || fail "a sweep on a terminal shows no bar"
    [ "$(wc -l <bar.csv)" = 401 ] || fail "the sweep under the bar has not its rows"
fi

nothing_failed
