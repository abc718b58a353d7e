#!/bin/bash
# ^C while a command computes: it ends by the interrupt (status 130 in a shell), says how far it was,
# keeps what was computed, and never leaves half a file. On a terminal it tells how far it is.
# $1: the program
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
method: {step: 0.1 s}
run: {duration: 90000 s}
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

computes() { # JOB: it has used some time of the processor, and catches SIGINT
    [ "$(awk '{ print $14 + $15 }' "/proc/$1/stat")" -ge 15 ] &&
        (((0x$(awk '/^SigCgt:/ { print $2 }' "/proc/$1/status") & 2) != 0))
}
asks() { # whoever does: the controller that sleeps was asked
    [ -s asked ]
}

# interrupted_once READY ARGUMENT...: begins the command in a job of its own, whose signals nobody
# ignores, and interrupts it once `READY JOB` succeeds
interrupted_once() {
    local job status ready=$1 i
    shift
    (set -m; exec "$program" "$@" >out 2>err </dev/null) &
    job=$!
    for ((i = 0; i < 6000; i++)); do
        sleep 0.02
        [ -e "/proc/$job/stat" ] && ! "$ready" $job || break
    done
    kill -INT $job 2>/dev/null || fail "impactlab $*: ended by itself"
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
says err "stopped before its end"
interrupted solve endless.yaml motor.voltage=0.001:0.002 'peak_force_N<2'
says err "stopped before its end"
"$program" run brief.yaml --quiet --set control.law=open-loop --csv recorded.csv || fail "no recording"
interrupted identify endless.yaml --set control.law=open-loop --data recorded.csv --fit arm.k2
says err "stopped before its end"
interrupted run endless.yaml --csv trace.csv
says err "stopped before its end"
[ "$(wc -l <trace.csv)" -gt 10 ] || fail "rows of a run that was stopped are not kept"

# a program that is to answer is not waited for
interrupted_asleep run sleeper.yaml --json rows.json
says err "stopped before its end"
grep -q '"message": "stopped before its end"' rows.json || fail "a run that was stopped while it waited does not say so"
interrupted_asleep compare sleeper.yaml
says err "0 of 1 runs"
interrupted_asleep converge sleeper.yaml
says err "0 of 3 runs"
interrupted_asleep predict sleeper.yaml
says err "stopped before its end"
interrupted_asleep study methods sleeper.yaml
says err "0 of 40 runs"
interrupted_asleep animate sleeper.yaml -o frames
interrupted_asleep sweep sleeper.yaml --vary arm.k2=4:5:4 --db asleep.sqlite
says err "0 of 4 runs"
interrupted_asleep robust sleeper.yaml
says err "0 of 200 runs"

# a calibration's table is that of the commands it had; a scenario wants the whole table
interrupted calibrate compare/hybrid --set run.duration=90000 --set method.step=0.1 --csv presses.csv -o calibrated.yaml
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
