#!/bin/bash
# The command line as a person or a script meets it.
# $1: the program
set -u
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/expect.sh"
lab=$program

silent() {
    [ ! -s "$1" ] || fail "$1 is not empty"
}

cat >hit.yaml <<'END'
title: Hit
motor: {voltage: 1 V}
run: {duration: 0.5 s}
END
cat >faults.yaml <<'END'
title: Two faults
motor: {voltge: 1 V}
wall: {angle: 99 rad}
END
cat >unmet.yaml <<'END'
title: Wrong expectation
run: {duration: 0.5 s}
expect:
  first_contact_s: {value: 0.1, tolerance: 0.001}
END

# --- help and misspellings
expect 0
says out "impactlab run SCENARIO"
says out corrected/first-impact
expect 0 --version
says out "impactlab "
expect 0 --help
for command in list show check run tables figures animate predict modes sweep compare calibrate robust bench converge solve study linear identify tune; do
    grep -q "^  $command " out || fail "--help does not name $command"
    "$lab" $command --help >help 2>err || fail "$command --help fails"
    grep -q "^impactlab $command" help || fail "$command --help does not say how to call it"
done
# no command lists an option that it always refuses: only runs have recorded signals
for command in modes predict converge study sweep identify robust linear tune plot; do
    expect 0 $command --help
    ! grep -qE -- '--(signals|overlay)' out || fail "$command --help lists options that it refuses"
done
for command in run compare figures; do
    expect 0 $command --help
    says out '--signals A,B+C'
done

# list, show and check in few words
expect 0 list -q
grep -qx corrected/first-impact out || fail "list -q has no name alone"
expect 0 check -q hit.yaml
silent out
expect 0 show -q hit.yaml --set wall.angle=0.2
[ "$(sed 's/ *=.*//' out | paste -s -d ' ')" = 'motor.voltage wall.angle run.duration' ] ||
    fail "show -q prints $(cat out)"
# the columns of show stand below their headings, whatever stands in them
expect 0 show hit.yaml
column=$(grep -ob 'range   ' <(grep '^parameter ' out) | cut -d: -f1)
[ -z "$(sed -n '/^arm\./p' out | cut -c"$column" | tr -d ' ')" ] || fail "show's columns do not line up"
meaning=$(grep -ob 'meaning' <(grep '^parameter ' out) | cut -d: -f1)
grep -qE "^ {$meaning}control law on the rig" out || fail "a long range moves its meaning"

# a scenario instead of a command opens the lab on it
expect 0 compare/hybrid --size 80x24
says out 'impactlab  compare/hybrid'
expect 0 ./hit.yaml --size 80x24
says out 'Hit'
expect 2 compare/hybird --size 80x24
says err "did you mean 'compare/hybrid'"
expect 2 hybird
says err 'there is no command'

# the chapters of the manual have what the tables have
expect 0 show corrected/first-impact
sed -n 's/^\([a-z]*\.[A-Za-z0-9_]*\) .*/\1/p' out | sort >shown
expect 0 help --reference parameters
sed -n 's/^| `\([^`]*\)` |.*/\1/p' out | sort >described
diff shown described >err || fail "the chapter of parameters has others"
expect 0 help --reference scenario.5
[ "$(wc -l <described)" -ge 100 ] || fail "the chapter of parameters has too few"
while read -r path; do
    grep -qF "$path" out || fail "man 5 impactlab-scenario does not name $path"
done <described
expect 0 help --reference quantities
says out '| `peak_force_N` | N |'
expect 0 help --reference signals
says out '| `force` |'
expect 0 help --reference scenarios
[ "$(grep -c '^`impactlab run ' out)" = "$("$lab" list -q | wc -l)" ] || fail "the gallery has others"
says out '### corrected/first-impact'
expect 0 help --reference events
says out '| `chatter` |'
expect 0 help --reference laws
says out '## observer'
expect 2 help --reference blurp
# every option of every command stands in its man page and in each shell's completion
expect 0 help --man-pages man1
for shell in bash zsh fish; do
    expect 0 help --completion $shell
    cp out "completion.$shell"
    # the shell itself judges the script, where it is installed
    ! command -v $shell >/dev/null || $shell -n "completion.$shell" 2>err || fail "$shell does not read its completion"
done
commands=$("$lab" --help | sed -n 's/^  \([a-z]*\)  .*/\1/p')
[ "$(wc -w <<<"$commands")" -ge 18 ] || fail "--help lists too few commands"
for command in $commands; do
    says man1/impactlab.1 "impactlab\\-$command"
    options=$("$lab" $command --help | sed -n 's/^  ....--\([a-z-]*\).*/\1/p')
    [ -n "$options" ] || fail "$command --help lists no option"
    # the part of each completion that is the command's
    sed -n "/^    $command)\$/,/^    [a-z]*)\$/p" completion.bash >part.bash
    sed -n "/^        $command)\$/,/^        [a-z]*)\$/p" completion.zsh >part.zsh
    grep "'__fish_seen_subcommand_from $command'" completion.fish >part.fish
    for option in $options; do
        says "man1/impactlab-$command.1" "\\-\\-${option//-/\\-}"
        grep -q -e "options='.*--$option[ ']" part.bash || fail "bash does not complete $command --$option"
        grep -q -e "--$option[=[]" part.zsh || fail "zsh does not complete $command --$option"
        grep -q -e " -l $option " part.fish || fail "fish does not complete $command --$option"
    done
done
expect 2 help --completion tcsh
says err "bash, zsh or fish"
# bash as it would answer somebody who presses Tab
offers() {
    bash -c 'source completion.bash; COMP_WORDS=(impactlab "$@"); COMP_CWORD=$#
        compopt() { :; }; _impactlab; printf "%s\n" "${COMPREPLY[@]}"' - "$@" >out 2>err
    silent err
}
offers con
says out converge
offers run hit.yaml --camera t
says out three-quarter
says out top
offers run --set motor.vol
says out motor.voltage=
offers sweep --quantity peak_f
says out peak_force_N
offers run hit
says out hit.yaml
offers figures 3.1
says out 3.10

expect 2 lsit
says err "did you mean 'list'?"
expect 2 nothing-like-it
says err "there is no command 'nothing-like-it'"
expect 2 run hit.yaml --jsn x.json
says err "did you mean --json?"
expect 2 run hit.yaml --vary motor.voltage=1:2:3
says err "that is one of sweep"
expect 2 run hit.yaml --csv
says err "needs a value"
expect 2 run
says err "run needs SCENARIO"
expect 2 run hit.yaml one-more
says err "one-more"
expect 2 run first-impct
says err "did you mean 'corrected/first-impact'?"
expect 2 run frist-impact
says err "did you mean 'corrected/first-impact'?"
expect 2 lab --theme purple
says err "expected dark, light or mono"
expect 2 run no-such-file.yaml
expect 2 animate hit.yaml
says err "-o FILE.mp4"

# pictures
expect 0 run hit.yaml --quiet --plot hit.png
expect 0 run hit.yaml --quiet --plot again.png
cmp -s hit.png again.png || fail "two plots of the same run differ"
[ "$(head -c 4 hit.png | tail -c 3)" = PNG ] || fail "hit.png is no PNG"
expect 1 run hit.yaml --quiet --plot no/such/folder/hit.png
expect 2 run hit.yaml --quiet --plot hit.gif
expect 0 figures 3.4 -o pictures --format png,pdf,svg
for ending in png pdf svg csv; do
    [ -s "pictures/fig-3-4.$ending" ] || fail "pictures/fig-3-4.$ending is missing"
done
expect 2 figures 9.9 -o pictures
says err "no figure '9.9'"
expect 1 figures 3.4 -o /proc/pictures

# one set of options for every picture
expect 0 run hit.yaml --quiet --plot look.svg --width 85mm --theme mono --font serif --bare \
    --signals force,hub_angle+last_angle --from 0 --to 0.1 --latex look.tex
grep -q 'includegraphics\[width=85mm' look.tex || fail "look.tex has no figure of 85 mm"
grep -q 'impactlab run --quiet --width 85mm' look.svg || fail "look.svg does not know its command"
[ -s look.txt ] || fail "a bare picture has no caption beside it"
expect 2 run hit.yaml --plot look.svg --width 5mm
says err "expected a length from 60mm to 400mm"
expect 2 run hit.yaml --plot look.svg --theme blue
expect 2 run hit.yaml --plot look.svg --theme dark --mono
expect 2 run hit.yaml --plot look.svg --signals forse
says err "did you mean 'force'"
expect 2 run hit.yaml --plot look.svg --font "No Such Font"
expect 2 run hit.yaml --plot look.svg --from 1
expect 0 modes hit.yaml --quiet --plot modes.svg --width 85mm
[ -s modes.csv ] || fail "no numbers beside the picture of modes"
expect 0 predict hit.yaml --quiet --plot predict.svg
expect 0 compare hit.yaml corrected/first-impact --quiet --plot compared.svg --signals force
expect 2 compare hit.yaml --vary motor.voltage=1,2 --quiet --plot compared.svg

# recipes
expect 0 plot "$IMPACTLAB_SCENARIOS/recipes/measured.yaml" -o recipe.svg --width 85mm
[ -s recipe.csv ] || fail "no numbers beside a recipe's figure"
printf 'runs:\n  - scenario: hit.yaml\npanels:\n  - signals: [forse]\n' >bad-recipe.yaml
expect 2 plot bad-recipe.yaml -o recipe.svg
says err "bad-recipe.yaml:4:15: there is no signal 'forse', did you mean 'force'?"
expect 2 plot nowhere.yaml -o recipe.svg
expect 0 sweep hit.yaml --vary motor.voltage=1:2:2 --vary arm.k2=4:6:2 --db map.sqlite --quiet
printf 'tables:\n  - {file: map.sqlite, x: motor.voltage, y: arm.k2, z: peak_force_N}\npanels:\n  - {weight: 2}\n' >map.yaml
expect 0 plot map.yaml -o map.svg --quiet
[ "$(grep -c '^[^,]*,[^,]*,' map.csv)" -ge 5 ] || fail "a map's numbers are missing: $(cat map.csv)"

# a report of one's own
expect 0 report hit.yaml "$IMPACTLAB_SCENARIOS/recipes/voltages.yaml" -o own --quiet
grep -q 'data-panels=' own/report.html || fail "the report's page has no panels for its script"
[ -s own/report.pdf ] || fail "no PDF of the report"
expect 2 report nowhere/at-all -o own2 --quiet

# the arm in space
expect 0 run hit.yaml --quiet --scene arm.png --gl cairo --size 320x180
expect 0 run hit.yaml --quiet --scene again-arm.png --gl cairo --size 320x180
cmp -s arm.png again-arm.png || fail "two scenes of the same run differ"
expect 0 run hit.yaml --quiet --scene auto.png --size 320x180 --at 0.1 --at 0.32
expect 1 run hit.yaml --quiet --scene no/such/folder/arm.png
expect 2 run hit.yaml --quiet --scene arm.gif
expect 2 run hit.yaml --quiet --scene arm.png --at 9
says err "0 to 0.5 s"
expect 2 run hit.yaml --quiet --scene arm.png --camera above
says err "three-quarter, top, side, tip, or two angles"
expect 2 run hit.yaml --quiet --scene arm.png --gl mesa
expect 2 run hit.yaml --quiet --scene arm.png --size 12
expect 0 animate hit.yaml -o film --gl cairo --size 320x240 --seconds 0.3 --fps 10
[ "$(find film -name 'frame-*.png' | wc -l)" = 3 ] || fail "the film does not have 3 frames"
expect 1 animate hit.yaml -o film
says err "not empty"
expect 2 animate hit.yaml -o film.avi
says err ".webm"
expect 2 animate hit.yaml -o more --fps 0

# --- list, show, check
expect 0 list
says out "thesis/fig-3-4"
[ "$(wc -l <out)" = "$(find "$IMPACTLAB_SCENARIOS" -name '*.yaml' -not -path '*/recipes/*' | wc -l)" ] ||
    fail "list does not have a line for every scenario"
expect 0 list --json -
says out '"name": "thesis/fig-3-4"'
expect 0 show hit.yaml --set arm.k2=6 --json -
grep -q "\"title\": \".*, with arm.k2 = 6 N m/rad\"" out || fail "show --json gives a title without what was set"
says out '"arm.k2": 6'
expect 0 show hit.yaml --set arm.k2=6
grep -q '^arm.k2 *= *6 N m/rad' out || fail "show does not mark what was set"
grep -q '^arm.mass  *0.40108 kg' out || fail "show does not give a default without a mark"
expect 0 check hit.yaml unmet.yaml
expect 2 check hit.yaml faults.yaml
says err "faults.yaml:2:"
says err "faults.yaml:3:"
says err "did you mean 'voltage'?"
# in the order of the lines, however the reader came upon them
printf 'script: [{at: 99 s, set: {motor.voltage: 1}}]\nrun: {duration: -1}\nwall: {knd: 3}\n' >order.yaml
expect 2 check order.yaml
sed 's/^[^:]*:\([0-9]*\):.*/\1/' err | sort -nc || fail "faults are not told line by line"
# a name that is none has no place in a file
expect 2 check nonesuch hit.yaml
says err "impactlab: 'nonesuch' is neither a scenario nor a file"
says out "hit.yaml: no fault"
# every scenario that ships is sound
mapfile -t shipped < <(find "$IMPACTLAB_SCENARIOS" -name '*.yaml' -not -path '*/recipes/*')
expect 0 check "${shipped[@]}"

# --- run
cp hit.yaml kept.yaml
expect 2 run kept.yaml --json kept.yaml
says err "a result would be written over it"
cmp -s hit.yaml kept.yaml || fail "results replaced their own scenario"
expect 0 run hit.yaml --set motor.voltage=12
says err "motor.voltage_limit"
expect 0 run hit.yaml
says out "first contact"
says out "impact "
silent err
expect 0 run hit.yaml --quiet
silent out
expect 0 run --quiet --json one.json hit.yaml
expect 0 run hit.yaml --json two.json --quiet
grep -vE '(wall|cpu)_time_s' one.json >one
grep -vE '(wall|cpu)_time_s' two.json >two
cmp -s one two || fail "the same scenario gave two results"
grep -q '"status": "ok"' one.json || fail "the status of a run is not ok"
grep -q '"motor.voltage": 1,' one.json || fail "a parameter is missing in the JSON"
expect 0 run hit.yaml --json - --csv trace.csv
grep -q '^{' out || fail "the JSON on the standard output is not alone there"
[ "$(grep -c '^time\[s\],hub_angle\[rad\],' trace.csv)" = 1 ] || fail "no CSV header"
[ "$(wc -l <trace.csv)" -gt 500 ] || fail "the CSV has too few rows"
expect 0 run hit.yaml --csv again.csv --quiet
cmp -s trace.csv again.csv || fail "the same scenario gave two traces"

# --set: order is free, the last one counts, faults are named
expect 0 run hit.yaml --set motor.voltage=2 --set 'motor.voltage=0.5 V' --json - --quiet
says out '"motor.voltage": 0.5'
expect 0 show thesis/fig-3-4 --set arm.links=4 --set arm.model=corrected
expect 2 run hit.yaml --set motor.voltag=2 --set arm.k2=stiff
says err "did you mean 'motor.voltage'?"
says err "arm.k2"
expect 2 run hit.yaml --set motor.voltage
expect 2 run hit.yaml --set wall.angle=99

# --- a start behind the wall, on either side of it, by every way in
printf 'title: Behind\nwall: {kind: plane, angle: 2.9}\ninitial: {angle: -0.4}\n' >behind.yaml
for how in "check behind.yaml" "run behind.yaml" "predict behind.yaml" "sweep behind.yaml --vary motor.voltage=1,2"; do
    # shellcheck disable=SC2086
    expect 2 $how
    says err "behind.yaml:3:"
    says err "initial.angle = -0.4 rad lies behind the wall"
done
for contact in rigid kelvin-voigt hunt-crossley; do
    for kind in point plane; do
        expect 2 run hit.yaml --quiet --set wall.kind=$kind --set wall.contact=$contact --set wall.angle=2.9 \
            --set initial.angle=-0.4
        says err "initial.angle = -0.4 rad lies behind the wall"
    done
done
expect 2 run thesis/fig-3-4 --set wall.angle=2.9 --set initial.angle=-0.4 --quiet
expect 2 sweep hit.yaml --vary initial.angle=-0.1,-3.1 --quiet
expect 2 sweep hit.yaml --set initial.angle=-0.4 --vary wall.angle=0.1:2.9:3 --quiet
says err "initial.angle"
expect 0 run hit.yaml --set wall.angle=2.9 --set initial.angle=-0.2 --quiet

# expectations
expect 1 run unmet.yaml
says err "unmet.yaml:4:"
says err "first_contact_s"
expect 0 run unmet.yaml --set motor.voltage=2 --quiet

# a result that cannot be written
expect 1 run hit.yaml --json /dev/full --quiet
says err "/dev/full"
says err "No space left"
expect 1 run hit.yaml --csv no/such/folder/x.csv
says err "no/such/folder/x.csv"
expect 1 run hit.yaml --csv /proc/x.csv
status=0
"$lab" run hit.yaml --csv - >/dev/full 2>err || status=$?
[ $status = 1 ] || fail "a full standard output gave exit status $status"
says err "standard output"
status=0
"$lab" list >/dev/full 2>err || status=$?
[ $status = 1 ] || fail "list to a full standard output gave exit status $status"
expect 2 run hit.yaml --json - --csv -
expect 2 run hit.yaml --json same --csv same
[ ! -e same ] || fail "a refused command wrote a file"
expect 2 run hit.yaml --json a --json b

# a reader that goes away early is no fault
("$lab" run hit.yaml --csv - 2>err; echo $? >status) | head -n 1 >out
[ "$(cat status)" = 0 ] || fail "a closed pipe gave exit status $(cat status)"
silent err

# what has no descriptors left is not listed as if it were not there
(ulimit -n 4 && "$lab" list >out 2>err)
[ $? != 0 ] && [ -s err ] || fail "list without descriptors does not fail"

# a script ends, or what is no line of one ends it
expect 2 lab hit.yaml --quiet --script /dev/zero
says err "is a device or a pipe, expected a plain file"
expect 2 lab hit.yaml --quiet --script .
says err ". cannot be read: Is a directory"
{ printf 'seek 0.1\nseek '; printf '%01100d\n' 1; } >long.script
expect 2 lab hit.yaml --quiet --script long.script
says err "long.script:2: no command"

# two results have two places, however these are written
echo before >alone.json
ln -s alone.json to-one
for other in alone.json ./alone.json "$PWD/alone.json" to-one; do
    expect 2 run hit.yaml --json alone.json --csv "$other"
    says err "two results cannot both be written to $other"
done
[ "$(cat alone.json)" = before ] || fail "two results in one place wrote a file"

# nor a result and what stands beside a picture, nor that of two pictures
for other in json latex; do
    expect 2 run hit.yaml --plot alone.svg --bare --$other alone.txt
    says err "two results cannot both be written to alone.txt"
done
expect 2 run hit.yaml --plot alone.svg --latex alone.tex --json alone.pdf
says err "two results cannot both be written to alone.pdf"
expect 2 linear compare/hybrid --law --plot alone.svg --nyquist alone.pdf
says err "differ in more than their ending"
expect 2 linear compare/hybrid --law --plot alone.svg --nyquist plane.svg --latex alone.tex
says err "--latex for one of them"

# the numbers of a picture take no file that was asked for or is somebody else's
expect 0 sweep hit.yaml --vary motor.voltage=1:2:2 --csv beside.csv --plot beside.svg
[ "$(wc -l <beside.csv)" = 3 ] || fail "a sweep's rows gave way to the numbers of its picture"
expect 1 linear hit.yaml --plot beside.svg --bare --latex beside.tex
says err "'beside.csv' holds other numbers and is kept"
[ -s beside.txt ] && [ -s beside.tex ] && [ -s beside.pdf ] || fail "a CSV that is kept hindered the caption or LaTeX"
[ "$(wc -l <beside.csv)" = 3 ] || fail "the numbers of a picture replaced a sweep's rows"
rm beside.csv
expect 0 linear hit.yaml --plot beside.svg
expect 0 linear hit.yaml --plot beside.svg
grep -q '^panel,series,' beside.csv || fail "the numbers of a picture are not beside it"
mkdir drawn && echo "measured" >drawn/fig-3-4.csv
expect 1 figures 3.4 2.2 -o drawn --format svg,pdf --latex drawn.tex --json drawn.json
says err "'drawn/fig-3-4.csv' holds other numbers and is kept"
ls drawn | tr '\n' ' ' >listed
says listed "fig-2-2.csv fig-2-2.pdf fig-2-2.svg fig-3-4.csv fig-3-4.pdf fig-3-4.svg"
[ "$(grep -c 'includegraphics.*{drawn/.*pdf}' drawn.tex)" = 2 ] || fail "a CSV that is kept hindered LaTeX"
expect 2 figures 2.1 --format ""
says err "there is no figure format ''"

# descriptors that are closed at the start are not taken by the first files opened
"$lab" sweep hit.yaml --vary motor.voltage=1:2:2 --db closed.db --csv closed.csv <&- >&- 2>&- || true
[ "$(head -c 15 closed.db | tr -d '\0')" = "SQLite format 3" ] || fail "a closed output ended in the database"
[ "$(wc -l <closed.csv)" = 3 ] || fail "a closed output spoilt a CSV file"
status=0
"$lab" sweep hit.yaml --vary motor.voltage=1:2:2 --db other.db --csv - >&- 2>err || status=$?
[ $status = 0 ] && [ "$(head -c 15 other.db | tr -d '\0')" = "SQLite format 3" ] ||
    fail "rows for a closed output (status $status) went into the database"
status=0
"$lab" run hit.yaml --csv closed.csv >&- 2>err || status=$?
[ $status = 0 ] || fail "a closed output gave exit status $status"

# --- sweep
expect 0 sweep hit.yaml --vary motor.voltage=1:2:3 --csv -
[ "$(wc -l <out)" = 4 ] || fail "a sweep of three runs has not three rows"
grep -q '^3,2,ok,,' out || fail "the third run is not the third row"
silent err
expect 0 sweep hit.yaml --vary motor.voltage=1:2:3 --db s.sqlite --csv one.csv --plot s.svg
says out "largest"
expect 0 sweep hit.yaml --vary motor.voltage=1:2:3 --db s.sqlite --csv two.csv --quiet
silent out
cmp -s one.csv two.csv || fail "a finished sweep gave other rows when it was called again"
grep -q '</svg>' s.svg || fail "the sweep's plot is no whole SVG"
expect 2 sweep hit.yaml --vary motor.voltage=1:2:4 --db s.sqlite
says err "holds another sweep"
expect 2 sweep hit.yaml
says err "--vary"
expect 2 sweep hit.yaml --vary motor.voltage=1:2:3 --jobs none
expect 2 sweep hit.yaml --vary motor.voltage=1:2:3 --sample latn
expect 2 sweep hit.yaml --vary motor.voltage=1:2:3 --quantity peak_forc_N
says err "did you mean peak_force_N"
expect 2 sweep hit.yaml --vary motor.voltage=1:2:3 --plot s.gif
expect 1 sweep hit.yaml --vary motor.voltage=1:2:3 --csv no/such/folder/x.csv
expect 1 sweep hit.yaml --vary motor.voltage=1:2:3 --csv /dev/full
says err "No space left"

# nothing half-written stays behind
[ -z "$(find . -name '*.part')" ] || fail "a temporary file stayed behind"

# --- the other commands
expect 0 predict hit.yaml
says out "simulation"
expect 1 predict hit.yaml --set wall.kind=none
says err "nothing to predict"
expect 0 modes hit.yaml --json - --quiet
says out '"hub": "locked"'
expect 2 modes thesis/fig-3-4
expect 0 bench --only tables_s --json bench.json --quiet
grep -q '"name": "tables_s"' bench.json || fail "bench names no figure"
sed 's/"median": [0-9.e+-]*/"median": 1e-9/' bench.json >fast.json
expect 0 bench --only tables_s --baseline fast.json
says out "slower"
# controllers: the table of (5.26), several runs in one table
cat >press.yaml <<'END'
title: Four links under the hybrid law
arm: {links: 4}
wall: {angle: 0 rad}
initial: {angle: -0.1 rad}
control: {law: hybrid}
run: {duration: 1.5 s}
END
expect 0 calibrate press.yaml --vary control.approach_voltage=2,4 -o table.yaml --csv table.csv --json table.json
says out "control.k2_table="
grep -q "^  k2_table: \"" table.yaml || fail "calibrate wrote no table"
[ "$(wc -l <table.csv)" = 3 ] || fail "calibrate --csv has not a row for each command"
expect 0 check table.yaml
expect 0 calibrate press.yaml --vary control.approach_voltage=2,4 -o -
says out "title: "
expect 2 calibrate press.yaml --vary control.kp=1,2
says err "nothing else"
expect 2 calibrate press.yaml --vary control.approach_voltage=0.01,2
says err "does not press"
expect 2 calibrate press.yaml --set wall.kind=none
expect 1 calibrate press.yaml -o no/such/folder/table.yaml

# laws over a set, the same bytes for the same seed, and on from a database
expect 0 robust compare/observer --laws hybrid,observer --runs 6 --json one.json --csv robust.csv --db robust.sqlite
expect 0 robust compare/observer --laws hybrid,observer --runs 6 --json two.json --db robust.sqlite --jobs 1
cmp one.json two.json || fail "robust gives other bytes the second time"
[ "$(wc -l <robust.csv)" = 3 ] || fail "robust --csv has not a row for each law"
[ -s robust-hybrid.sqlite ] && [ -s robust-observer.sqlite ] || fail "robust --db keeps no runs"

# a table of cases, and a set of runs that is interrupted
printf 'control.seed=1,2\ncase plain:\ncase another arm: arm.links=3\n' >two.set
expect 0 robust compare/observer --over two.set --runs 2 --against hybrid --csv cases.csv
says out "/hybrid"
[ "$(wc -l <cases.csv)" = 3 ] || fail "robust --csv has not a row for each case"
expect 2 robust compare/observer --against hybrid
expect 2 robust compare/observer --over two.set --against nonsense

# an exam of cases that nobody chose: the same with any number of threads, beside rows of before
examined=(robust compare/force-pd --draw 12 --seed 40 --force 1 --force 3)
expect 0 "${examined[@]}" --json before.json --csv exam.csv
expect 0 "${examined[@]}" --json again.json --jobs 1
cmp before.json again.json || fail "robust --draw gives other bytes the second time"
[ "$(wc -l <exam.csv)" = 25 ] || fail "robust --draw --csv has not a row for each run"
expect 0 "${examined[@]}" --before before.json
says out "+0.0 (+0.0 to +0.0)"
expect 2 robust compare/force-pd --draw 12 --seed 41 --force 1 --before before.json
says err "has 12 cases from seed 40, expected 12 from 41"
expect 0 "${examined[@]:0:2}" --draw 5 --seed 40 --force 1 --before before.json
says out "+0.0 (+0.0 to +0.0)"
expect 2 robust compare/force-pd --draw 12 --over two.set
says err "--over does not go with --draw"
expect 2 robust compare/force-pd --force 1
expect 2 robust compare/hybrid-printed-arm --draw 12
says err "cannot be drawn around compare/hybrid-printed-arm"

# around a fit the arms are its own
printf 'control: {law: touch, force: 1}\nfit: {arm.k2: [0.02]}\n' >fitted.yaml
expect 0 robust fitted.yaml --draw 4 --json fitted.json --csv fitted.csv
says out "the arm of each case is drawn from the fit to your recordings"
grep -q '"standard_error": 0.02' fitted.json || fail "robust --draw --json does not tell of the fit"
[ "$(grep -c 'arm.k2=.* belief.k2_factor=' fitted.csv)" = 4 ] || fail "a case has not its fitted arm"
"$lab" robust compare/twelve-links --runs 5000 --db long.sqlite --jobs 1 2>err &
interrupted=$!
until [ -s long-hybrid.sqlite ]; do sleep 0.05; done
kill -TERM $interrupted
code=0
wait $interrupted || code=$?
[ "$code" = 143 ] || fail "robust ended by a signal has status $code, expected 143"
says err "kept in 'long-hybrid.sqlite'"
printf 'belief.k2_factor=0.9:1.1\ncase Thrown: push=1e300@0.1\n' >thrown.set
expect 1 robust compare/bang-bang-rigid --over thrown.set --runs 2 --quiet
says err "2 of 2 runs failed; run 1: at t = 0.1 s: a push of 1e+300 N s"
expect 2 robust compare/observer --laws nonsense
expect 2 robust compare/observer --over press.yaml
expect 2 robust corrected/first-impact

# --- tune: the same bytes with any number of threads and after any stop, and always a whole scenario
printf 'belief.k2_factor=0.8:1.2\ncontrol.seed=1:1000\n' >beliefs.set
tuning=(tune compare/hybrid --set run.duration=0.8 --vary control.transition_time=0.05:0.35
    --vary control.kv=0.2:2 --minimise 'max(overshoot_worst_percent/100, settling_nine_tenths_s/0.2)'
    --over beliefs.set --runs 400 --quiet)
expect 0 "${tuning[@]}" --jobs 1 -o one.yaml --json tune1.json --plot tune.svg
expect 0 "${tuning[@]}" --jobs 4 -o four.yaml --json tune4.json
cmp one.yaml four.yaml && cmp tune1.json tune4.json || fail "tune gives other bytes with other --jobs"
cp one.yaml best.yaml
for ((i = 0; i < ${KILLS:-5}; i++)); do
    "$lab" "${tuning[@]}" --jobs 1 --db tune.sqlite -o best.yaml >/dev/null 2>&1 &
    sleep "0.$((RANDOM % 3))$((RANDOM % 10))"
    kill -9 $! 2>/dev/null || true
    wait $! 2>/dev/null || true
    "$lab" show best.yaml >/dev/null 2>err || fail "tune, killed, leaves no scenario: $(cat err)"
done
expect 0 "${tuning[@]}" --jobs 2 --db tune.sqlite -o best.yaml --json tune5.json
cmp one.yaml best.yaml && cmp tune1.json tune5.json || fail "tune finds something else after it was killed"
expect 2 "${tuning[@]}" --db tune.sqlite --seed 4
says err "seed was 0, now it is 4"
expect 1 "${tuning[@]}" --subject 'overshoot_worst_percent<=0-1'
says err "evaluations meets --subject"
expect 2 tune compare/hybrid --minimise steps
expect 2 tune compare/hybrid --vary control.kv=1:2
expect 2 tune compare/hybrid --vary control.kv=1:2 --minimise 'max(steps, seps)'
says err "column 12"
expect 2 tune corrected/first-impact --vary arm.k2=4:5 --minimise failed --over beliefs.set
expect 2 tune compare/hybrid --vary control.kv=1:2 --minimise failed --over two.set
says err "has cases"
expect 2 run nosuch
says err "impactlab: 'nosuch' is neither a scenario nor a file"
expect 2 run press.yaml --set "control.k2_table=1:0"
says err "expected FORCE:K2"
expect 0 compare press.yaml table.yaml --against press.yaml --vary control.force=1,2 \
    --columns peak_force_N,steady_error_N --markdown page.md
says out "force/N"
says out "* differs"
[ "$(wc -l <page.md)" = 6 ] || fail "compare --markdown has not a row for each run"
expect 2 compare press.yaml --columns peak
says err "no column 'peak'"
expect 2 compare press.yaml --vary control.settings=a,b
says err "is a text"

# every command that prints data gives it to programs, too
expect 0 sweep hit.yaml --vary motor.voltage=1,2 --json sweep.json --csv sweep.csv
[ "$(grep -c '"peak_force_N":' sweep.json)" = 2 ] || fail "sweep --json has not a row a run"
expect 0 check hit.yaml --json -
says out '"faults": []'
expect 0 lesson --json -
says out '"scenario": "lessons/hybrid-law"'
expect 0 figures 2.4 --format svg -o drawn --json -
says out '"file": "fig-2-4"'
for command in list show run predict modes sweep merge compare converge solve study calibrate robust linear identify tune \
    tables bench check lesson figures; do
    expect 0 $command --help
    says out '--json FILE|-'
done

# poles with and without a loop, and what cannot be closed
expect 0 linear corrected/first-impact --at free --json - --mat poles.mat
says out '"imaginary_rad_per_s": 34.3'
[ "$(head -c 19 poles.mat)" = "MATLAB 5.0 MAT-file" ] || fail "linear writes no MAT file"
expect 0 linear compare/hybrid --law --json - --csv poles.csv
says out '"z_real"' && says out '"phase_deg"' && says out '"stable": true'
grep -q '^zero,loop,' poles.csv || fail "linear --csv has no zeros of the loop"
expect 0 linear compare/sampling-rate --set sensor.ideal=true --vary control.rate=150:250:3 --json - --plot limits.svg
says out '"of": "runs"' && says out '"value": 193.'
expect 0 linear compare/hybrid --vary control.rate=100:200:3 --vary control.delay_periods=0:1:3 --plot map.svg
expect 0 linear compare/hybrid --law --plot bode.svg --nyquist nyquist.svg
[ -s map.svg ] && [ -s bode.svg ] && [ -s nyquist.svg ] || fail "linear draws nothing"
expect 2 linear corrected/first-impact --nyquist nyquist.svg
expect 2 linear corrected/first-impact --vary motor.voltage=1:2:2
expect 2 linear corrected/first-impact --law
says err "needs a control law"
expect 0 linear compare/hybrid --at free --law
expect 2 linear compare/hybrid --at free --law --inject
says err "not free"
expect 2 linear corrected/first-impact --set wall.kind=none
says err "try --at free"
expect 0 linear compare/inverse-dynamics --law
says out "gain up none"

# without LAPACK a sentence; runs do not need it
mkdir -p no_lapack
echo >no_lapack/liblapack.so.3
LD_LIBRARY_PATH=$PWD/no_lapack expect 1 linear compare/hybrid
says err "need LAPACK"
LD_LIBRARY_PATH=$PWD/no_lapack expect 0 run compare/hybrid --quiet

expect 2 bench --only tables_z
says err "did you mean 'tables_s'?"
expect 2 bench --baseline hit.yaml
says err "expected what bench --json writes"
expect 0 converge hit.yaml --set method.name=newmark --json converge.json --plot converge.svg
says out "first contact"
grep -q '"order": 2' converge.json || grep -q '"order": 1.9' converge.json ||
    fail "converge finds no second order"
[ -s converge.svg ] || fail "converge draws nothing"
expect 0 converge corrected/three-links --json converge.json --plot converge.svg
says out "digits that the first and the last column share"
grep -q '"tolerance": \[1e-08, 1e-09, 1e-10\]' converge.json || fail "converge leaves the tolerance as it is"
grep -q '"digits": [0-9]' converge.json || fail "converge counts no digits"
grep -q 'at three tolerances' converge.svg || fail "converge draws no tolerances"
expect 2 converge corrected/three-links --set method.tolerance=1e-12
says err "no hundredth to compare with"

# --- parameters from recorded traces
expect 0 run hit.yaml --set control.law=open-loop --set control.rate=1000 --set method.step=0.0005 --set arm.hub_inertia=0.006 \
    --csv recorded.csv
rig='--set control.law=open-loop --set control.rate=1000'
expect 0 identify hit.yaml $rig --data recorded.csv --fit arm.hub_inertia --json fit.json --plot fit.svg -o fit.yaml \
    --cases fit.set --validate recorded.csv --links 2,3
says out "arm.hub_inertia"
says out "with 3 links"
grep -q '"determined": true' fit.json && grep -q '"standard_error"' fit.json || fail "identify --json has not the keys of a fit"
[ -s fit.svg ] && [ "$(grep -c "^with " fit.set)" -ge 1 ] || fail "identify draws nothing or writes no cases"
expect 0 check fit.yaml
expect 0 robust hit.yaml --set control.force=1 --laws force-pd --over fit.set --runs 1
printf 'time[s],command[V],encoder[rad]\n0,1,0\n0.1,1,wide\n' >bad.csv
expect 2 identify hit.yaml $rig --data bad.csv --fit arm.k2
says err "bad.csv:3:3: 'wide'"
expect 2 identify hit.yaml $rig --data recorded.csv --fit arm.k2 --column 'encoder=turn[rad]'
says err "there is no column 'turn[rad]'"
expect 2 identify hit.yaml $rig --data recorded.csv --fit arm.links
says err "no real value"
expect 2 identify hit.yaml $rig --data recorded.csv --fit sensor.fsr_offset
says err "expected a range to search"
expect 2 identify hit.yaml $rig --fit arm.k2
says err "needs a recorded trace"
expect 1 identify hit.yaml $rig --data recorded.csv --fit arm.hub_inertia=0.004:0.005
says err "arm.hub_inertia = 0.005 is an end of its range"
expect 3 identify hit.yaml $rig --set arm.mass=1 --data recorded.csv --fit arm.k2=1:10
says err "the model lacks something"
says err "recorded.csv shows it most in "
expect 1 identify hit.yaml $rig --data recorded.csv --fit arm.hub_inertia --starts 3
says err "not found: of 3 starts 1 of those that were drawn"
expect 0 identify hit.yaml $rig --data recorded.csv --fit arm.hub_inertia --fit arm.damping_ratio=0:0.05 --noise residual --json fit.json
grep -q '"low": 0,' fit.json && grep -q '"explained": 0.9' fit.json || fail "an undamped arm has no damping of at least 0"

# --- the limit of a parameter for a condition
expect 0 solve hit.yaml motor.voltage=0.5:5 'peak_force_N<2' --json solved.json
says out "up to motor.voltage = "
grep -q '"path": "motor.voltage"' solved.json && grep -q '"quantity": "peak_force_N"' solved.json ||
    fail "solve --json has not the keys of a limit"
expect 1 solve hit.yaml motor.voltage=0.5:5 'peak_force_N<1e9' --json -
says out '"solve": []'
says err "no limit: it holds in "
expect 2 solve hit.yaml motor.volage 'peak_force_N<2'
says err "did you mean 'motor.voltage'?"
expect 2 solve hit.yaml motor.voltage=3 'peak_force_N<2'
says err "expected a range, motor.voltage=a:b"
expect 2 solve hit.yaml motor.voltage peak_force_N
says err "KEY<VALUE"

expect 0 study links --json links.json --plot links.svg
says out "from 8 links on"
says out "it has no limit"
says out "contact time: does not occur"
says out "first impulse: falls"
grep -q '"limits"' links.json && [ -s links.svg ] || fail "study links writes no limits or draws nothing"
expect 0 study follow --json follow.json --plot follow.svg
grep -q bound out && fail "study follow has a bound"
grep -q '"follow"' follow.json && [ -s follow.svg ] || fail "study follow writes no answers or draws nothing"
expect 2 study sense
says err "expected methods, links or follow"

nothing_failed
