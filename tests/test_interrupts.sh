#!/bin/bash
# ^C while a command computes, or writes what it computed: it ends by the interrupt (status 130 in a
# shell), says how far it was, keeps what was computed, and never leaves half a file. Every command of
# `impactlab help` has its case. On a terminal it tells how far it is.
# $1: the program, $2: what sanitizers it was built with
set -u
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/expect.sh"

# runs that would take hours, of a chain that nothing damps and that vibrates on a stuck hub:
# nothing but the interrupt ends them
cat >endless.yaml <<'END'
title: Free and nearly for ever
motor: {voltage: 0.001 V}
initial: {velocity: 0.01 rad/s}
wall: {angle: 3 rad}
arm: {links: 24, damping_ratio: 0}
run: {duration: 90000 s}
method: {step: 0.05 s}
END
cat >brief.yaml <<'END'
title: Brief
motor: {voltage: 1 V}
run: {duration: 0.4 s}
END

# a run whose controller, a program, lets the first question wait for 40 seconds
cat >sleeper.yaml <<'END'
title: A controller that sleeps
control: {law: process, command: "read question; echo $$ >asked; exec sleep 1000", answer_time: 40 s}
run: {duration: 0.4 s}
END

catches() { # JOB SIGNAL: it is the program, and catches that signal
    [ "$(readlink "/proc/$1/exe")" = "$program" ] &&
        (((0x$(awk '/^SigCgt:/ { print $2 }' "/proc/$1/status") >> ($2 - 1) & 1) != 0))
}
begins() { # JOB: it has begun, and catches SIGINT
    catches "$1" 2
}
used_by() { # JOB: time of the processor, in ticks
    awk '{ print $14 + $15 }' "/proc/$1/stat"
}
works() { # JOB: it has begun, and used some time of the processor
    begins "$1" && [ "$(used_by "$1")" -ge "${least:-15}" ]
}
computes() { # JOB: it makes runs, and has used some time of the processor since it began with them: it
    # catches SIGALRM, too, which gives up runs in hand
    catches "$1" 14 || return 1
    [ -n "$used_before" ] || used_before=$(used_by "$1")
    [ $(($(used_by "$1") - used_before)) -ge "${least:-15}" ]
}
looks=0
blocked() { # JOB: all of its threads sleep, and have since it was looked at eight times
    local now
    now=$(cat "/proc/$1"/task/*/stat 2>/dev/null | awk '{ print $3, $14, $15 }' | sort)
    if begins "$1" && [ "$now" = "${before:-}" ] && ! grep -qv '^S' <<<"$now"; then
        looks=$((looks + 1))
    else
        looks=0
    fi
    before=$now
    [ $looks -ge 8 ]
}
asks() { # whoever does: the controller that sleeps was asked
    [ -s asked ]
}

# interrupted_once READY ARGUMENT...: begins the command in a job of its own, whose signals nobody
# ignores, and interrupts it once `READY JOB` succeeds
interrupted_once() {
    local job status ready=$1 i
    shift
    tried+=" $1"
    looks=0 used_before=
    (set -m; exec "$program" "$@" >out 2>err </dev/null) &
    job=$!
    for ((i = 0; i < 6000; i++)); do
        sleep 0.02
        [ -e "/proc/$job/stat" ] && ! "$ready" $job || break
    done
    if ! kill -INT $job 2>/dev/null; then
        fail "impactlab $*: ended by itself"
    elif [ "$ready" = blocked ]; then
        cat late.fifo >got
    fi
    wait $job
    status=$?
    [ $status = 130 ] || fail "impactlab $*: status $status after an interrupt"
    [ -z "$(find . -name '*.part')" ] || fail "impactlab $*: a temporary stays"
}

# interrupted ARGUMENT...: once it computes
interrupted() {
    interrupted_once computes "$@"
    [ -s err ] || fail "impactlab $*: no sentence after an interrupt"
}

# interrupted_late FILE ARGUMENT...: while it writes a result into FILE, a pipe that nobody reads yet:
# that result and all others (in $others) are there then
interrupted_late() {
    local file=$1 other
    shift
    rm -rf late.fifo "$file" $others
    mkfifo late.fifo
    ln -s late.fifo "$file"
    interrupted_once blocked "$@"
    says err "the results are whole"
    [ -s got ] || fail "impactlab $*: $file is lost"
    for other in $others; do
        [ -e "$other" ] || fail "impactlab $*: $other is lost"
    done
    rm "$file"
}

# each_late "NAME..." ARGUMENT...: for each of the options --NAME, the others beside it
each_late() {
    local names=$1 name other options file
    shift
    for name in $names; do
        options=() others=
        for other in $names; do
            file=result-$other
            [ "$other" != plot ] || file+=.svg
            [ "$other" != scene ] || file+=.png
            [ "$other" != nyquist ] || file+=.svg
            [ "$1 $other" != "plot output" ] || file+=.svg
            options+=("--$other" "$file")
            [ "$other" != "$name" ] && others+=" $file" || late=$file
        done
        interrupted_late "$late" "$@" "${options[@]}"
    done
    others=
}

# part FILE: JSON of what was computed until then
part() {
    grep -q '"status": "interrupted"' "$1" || fail "$1 does not say that it was interrupted"
    [ "$(tail -c 2 "$1")" = "}" ] || fail "$1 is not whole"
}

# interrupted_asleep ARGUMENT...: while the controller that sleeps is to answer, for which nobody
# waits then: who did would end by its silence, with status 1. Nothing is left of it.
interrupted_asleep() {
    rm -f asked
    interrupted_once asks "$@" --allow-code
    ! grep -q 'gave no answer' err || fail "impactlab $*: waited for the controller"
    for ((i = 0; i < 500; i++)); do
        kill -0 "$(cat asked)" 2>/dev/null || return 0
        sleep 0.02
    done
    fail "impactlab $*: the controller is left"
}

# the rows before it are kept
interrupted compare brief.yaml endless.yaml --csv rows.csv --json rows.json
says err "1 of 2 runs"
says out "brief.yaml"
[ "$(wc -l <rows.csv)" = 2 ] && grep -q '^brief.yaml,none,ok,' rows.csv || fail "the row that was done is not kept"
grep -q '"scenario": "brief.yaml"' rows.json || fail "the object that was done is not kept"

interrupted converge endless.yaml
says err "0 of 3 runs"
interrupted study links endless.yaml
says err "0 of 6 numbers of links"
interrupted study methods endless.yaml
says err "0 of 40 runs"
interrupted predict endless.yaml
says err "of 90000 s were computed, nothing is predicted"
# (time of the processor in which the program computes some of an endless run)
least=25
[ "${2:-none}" = none ] || least=100
interrupted solve endless.yaml motor.voltage=0.001:0.002 'peak_force_N<2'
says err "0 of 65 runs"

# the rows of a run, its numbers, and pictures of it
interrupted run endless.yaml --csv trace.csv --mat trace.mat --json run.json --plot run.svg --scene scene.png
says err "of 90000 s were computed"
[ "$(wc -l <trace.csv)" -gt 10 ] && [ -s trace.mat ] && [ -s run.svg ] && [ -s scene.png ] ||
    fail "what a run that was stopped came to is not kept"
part run.json

# of a search what it found, of a table its rows, of a picture its points
interrupted solve endless.yaml 'run.duration=0.3:90000' 'steps<300' --runs 2 --jobs 1 --json solve.json
says err "1 of 2 runs were done"
part solve.json
interrupted solve corrected/twenty-links motor.voltage=1:3 'peak_force_N<2' \
    --runs 20000 --json solve.json
says err "of 20000 runs were done, limits"
part solve.json
interrupted sweep brief.yaml --vary motor.voltage=1:2:300000 --csv sweep.csv --json sweep.json --plot sweep.svg
there=$(grep -o '[0-9]* of 300000' err | grep -o '^[0-9]*')
[ "$(wc -l <sweep.csv)" = $((there + 1)) ] && [ -s sweep.json ] && [ -s sweep.svg ] ||
    fail "the rows of a sweep that was stopped are not kept"
says out ": $there runs (grid)"
interrupted sweep brief.yaml --vary motor.voltage=1:2:600 --vary arm.k2=3:6:500 --plot map.png
[ -s map.png ] || fail "the map of a sweep that was stopped is not drawn"
interrupted compare brief.yaml endless.yaml --plot compare.svg --markdown compare.md
[ -s compare.svg ] && [ -s compare.md ] || fail "the run that was done is not drawn"
interrupted robust compare/hybrid --laws hybrid,observer --runs 20000 --csv robust.csv --json robust.json \
    --markdown robust.md --plot robust.svg
there=$(grep -o '[0-9]* of 40000' err | grep -o '^[0-9]*')
grep -q "^hybrid,$there," robust.csv && [ -s robust.svg ] && [ -s robust.md ] ||
    fail "the runs of a law that were done are not judged"
part robust.json
interrupted robust compare/force-pd --draw 3000 --csv exam.csv --json exam.json
there=$(grep -o '[0-9]* of 3000' err | grep -o '^[0-9]*')
[ "$there" -gt 0 ] && [ "$(wc -l <exam.csv)" = $((there + 1)) ] ||
    fail "the cases of an exam that were done are not judged"
part exam.json
interrupted study methods corrected/first-impact --set arm.links=3 --plot methods.svg --json methods.json
[ -s methods.svg ] || fail "the points of a study that were done are not drawn"
part methods.json
interrupted study follow --set control.rate=2000 --json follow.json
says err "of 96 runs were done"
interrupted linear compare/hybrid --vary control.kv=0.1:5:20000 --csv linear.csv --json linear.json --plot linear.svg
there=$(grep -o '[0-9]* of 20000' err | grep -o '^[0-9]*')
[ "$(wc -l <linear.csv)" = $((there + 1)) ] && [ -s linear.svg ] || fail "the loops that were done are not kept"
part linear.json
interrupted linear compare/hybrid --set run.duration=90000 --set arm.links=8 --inject --law --csv poles.csv --json linear.json
grep -q '^pole,' poles.csv || fail "the poles, which need no run, are not kept"
part linear.json
if "$program" tune brief.yaml --vary motor.voltage=1:2 --minimise peak_force_N --runs 2 --quiet 2>err; then
    interrupted tune corrected/first-impact --set run.duration=20 --vary motor.voltage=1:3 \
        --minimise peak_force_N --runs 90000 -o best.yaml --json tune.json --plot tune.svg
    "$program" check best.yaml >out 2>&1 && [ -s tune.svg ] || fail "what a search found is not kept"
    part tune.json
fi
"$program" run brief.yaml --quiet --set control.law=open-loop --csv recorded.csv || fail "no recording"
fit=(identify brief.yaml --set control.law=open-loop --data recorded.csv --fit 'arm.k2=1:90')
"$program" "${fit[@]}" --starts 2 --quiet >out 2>err
if ! grep -q MINPACK err; then
    interrupted "${fit[@]}" --fit arm.mass --set arm.links=64 --set wall.contact=kelvin-voigt --json fit.json -o fitted.yaml --cases cases.set
    says err "stopped: "
    [ ! -e fitted.yaml ] && [ ! -e cases.set ] || fail "values that nobody judged pass for fitted ones"
    ! [ -e fit.json ] || part fit.json
fi
least=15
interrupted figures -o figures --json figures.json
says err "figures were drawn and are kept"
[ "$(find figures -name '*.png' 2>/dev/null | wc -l)" = "$(grep -c '"id"' figures.json)" ] ||
    fail "the figures that were drawn are not those of the list"
cat >recipe.yaml <<'END'
title: A run that does not end
runs:
  - scenario: endless.yaml
panels:
  - signals: [force]
END
interrupted plot recipe.yaml -o recipe.svg
[ ! -e recipe.svg ] || fail "a picture of a run that did not end"
interrupted animate endless.yaml -o film
says err "no film is made"
interrupted bench --json bench.json
part bench.json
interrupted_once works modes corrected/first-impact --set arm.links=1000

printf 'title: T\nruns:\n  - scenario: brief.yaml\npanels:\n  - signals: [force]\n' >late.yaml

# early: nothing is there yet, and nothing is left
for early in "run endless.yaml --csv early.csv" "predict endless.yaml --json early.json" \
    "modes corrected/first-impact --set arm.links=1000 --json early.json" \
    "sweep endless.yaml --vary motor.voltage=1,2 --csv early.csv" \
    "compare endless.yaml --csv early.csv" "converge endless.yaml --json early.json" \
    "study links endless.yaml --json early.json" "robust compare/hybrid --runs 20000 --csv early.csv" \
    "linear compare/hybrid --vary control.kv=0.1:5:20000 --csv early.csv" \
    "figures -o early" "report endless.yaml -o early" "plot recipe.yaml -o early.svg" \
    "animate endless.yaml -o early" "bench --json early.json"; do
    # shellcheck disable=SC2086
    interrupted_once begins $early
done

# late: what is being written becomes whole, and so do the others
each_late "json plot scene" run brief.yaml --csv rows.csv --parquet rows.parquet --mat rows.mat
[ -s rows.csv ] && [ -s rows.parquet ] && [ -s rows.mat ] || fail "the rows of a run are lost"

# the rows of a run are written while it goes on: one that waits for its pipe has not begun
for kind in csv parquet mat; do
    rm -f late.fifo
    mkfifo late.fifo
    interrupted_once blocked run brief.yaml --$kind late.fifo --json run.json
    says err "of 0.4 s were computed"
    [ -s got ] || fail "run --$kind: what there is of the rows is lost"
done
each_late "json plot" predict brief.yaml
each_late "json plot" modes brief.yaml
each_late "csv json plot" sweep brief.yaml --vary motor.voltage=1:2:4
each_late "json csv markdown plot" compare brief.yaml
each_late "json plot" converge brief.yaml
each_late "json plot" study links corrected/first-impact --set run.duration=0.5
each_late "json" solve brief.yaml motor.voltage=1:3 'peak_force_N<2' --runs 3
each_late "json csv markdown plot" robust compare/hybrid --runs 4
each_late "json csv output" calibrate compare/hybrid
each_late "json csv plot mat nyquist" linear compare/hybrid --law
each_late "json csv plot" linear compare/hybrid --vary control.kv=0.5:1:2
each_late "json" tables
each_late "json latex" figures 3.4 -o late-figures
each_late "output" plot late.yaml
each_late "json" bench --only arm_n2_us_per_ms
if grep -q tune <<<"$tried"; then
    # -o is written on the way, too
    each_late "json plot" tune brief.yaml --vary motor.voltage=1:2 --minimise peak_force_N --runs 2 -o best.yaml
fi
if grep -q 'identify' <<<"$tried"; then
    each_late "json output cases plot" "${fit[@]}" --starts 2
fi

# every command has had its turn, but for those that are over at once and the lab, where ^C is a key
for name in $("$program" help | sed -n 's/^  \([a-z]*\)  .*/\1/p'); do
    case " $tried list show check help merge lesson lab calibrate report identify tune export fmu " in
    *" $name "*) ;;
    *) fail "impactlab $name was not interrupted" ;;
    esac
done

# a program that is to answer is not waited for
interrupted_asleep run sleeper.yaml --json rows.json
says err "0 of 0.4 s were computed"
grep -q '"message": "stopped before its end"' rows.json || fail "a run that was stopped while it waited does not say so"
interrupted_asleep compare sleeper.yaml
says err "0 of 1 runs"
interrupted_asleep converge sleeper.yaml
says err "0 of 3 runs"
interrupted_asleep predict sleeper.yaml
says err "0 of 0.4 s were computed"
interrupted_asleep study methods sleeper.yaml
says err "0 of 40 runs"
interrupted_asleep animate sleeper.yaml -o frames
interrupted_asleep sweep sleeper.yaml --vary arm.k2=4:5:4 --db asleep.sqlite
says err "0 of 4 runs"
interrupted_asleep robust sleeper.yaml
says err "0 of 200 runs"

# a calibration's table is that of the commands it had; a scenario wants the whole table
interrupted calibrate compare/hybrid --set run.duration=90000 --set method.step=0.05 --csv presses.csv -o calibrated.yaml
says err "of 8 presses"
[ ! -e calibrated.yaml ] || fail "a part of a calibration passes for the whole"

# a report of before stands
mkdir report
echo old >report/report.html
interrupted report endless.yaml -o report
says err "0 of 2 steps"
[ "$(cat report/report.html)" = old ] && [ ! -e report/report.pdf ] || fail "a stopped report replaces the one before"

# a database that is deleted while a sweep adds to it: said, and nothing passes for its rows
rm -f gone.sqlite
"$program" sweep brief.yaml --vary motor.voltage=1:2:50000 --jobs 1 --db gone.sqlite --quiet --csv gone.csv 2>err &
job=$!
until [ -s gone.sqlite ]; do sleep 0.05; done
rm gone.sqlite
wait $job
[ $? = 1 ] || fail "a sweep whose database was deleted does not fail"
says err "was deleted, moved or replaced"
[ ! -e gone.csv ] && [ ! -e gone.sqlite ] || fail "a sweep whose database was deleted leaves results"

# what ignores the interrupt is not ended by it: the command is done
bash -c 'trap "" INT; kill -INT $$; "$@" & kill -INT $!; wait $!' ignoring \
    "$program" compare brief.yaml >out 2>err </dev/null || fail "an ignored interrupt ended the program"
says out "brief.yaml"

# --- on a terminal: notes how far it is, which are gone at the end
if command -v script >/dev/null; then
    on_terminal timeout -s INT 2.5 "$program" compare brief.yaml endless.yaml
    tr '\r' '\n' <seen | grep -q '^impactlab: 1 of 2 runs (^C stops)' || fail "no note on a terminal"
    on_terminal timeout -s INT 2.5 "$program" compare brief.yaml endless.yaml --quiet
    grep -q '(^C stops)' seen && fail "a note in spite of --quiet"
fi

nothing_failed
