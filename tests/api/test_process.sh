#!/bin/bash
# Programs as controllers: what they may do wrong ends the run with a sentence in time and leaves
# nothing running, and a scenario starts nothing unless it is allowed.
#
#   test_process.sh PROGRAM SOURCE_ROOT
set -euo pipefail
source=$2
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../expect.sh"
lab=$program
work=$folder
cp "$source/docs/examples/soft_push.yaml" scenario.yaml

# runs the scenario with a command as its controller; what it says goes to `said`
run_with() {
    local command=$1
    shift
    timeout 100 "$lab" run scenario.yaml --allow-code --quiet --set "control.command=$command" "$@" \
        >said 2>&1
}

# ends_with COMMAND WORDS: the run fails by itself (exit status 1) with a sentence that has WORDS
ends_with() {
    local code=0
    run_with "$1" --set control.answer_time=0.4 || code=$?
    [ "$code" = 1 ] || fail "'$1' ends with $code"
    grep -qF "$2" said || fail "'$1' says: $(cat -v said)"
    ! grep -q $'\033' said || fail "'$1' writes an escape sequence"
}

# a law in the shell: the same command whatever is read
always='while read -r line; do echo "{\"command\": 1.5, \"note\": \"ignored\"}"; done'
run_with "$always" --json answer.json || fail "a process that answers: $(cat said)"
"$lab" run scenario.yaml --quiet --json open.json --set control.law=open-loop \
    --set control.approach_voltage=1.5 --set control.settings=
peak() {
    grep '"peak_force_N"' "$1"
}
[ "$(peak answer.json)" = "$(peak open.json)" ] || fail "the constant command gives another peak"

# what goes wrong
ends_with 'exit 3' 'ended without an answer (exit status 3)'
ends_with 'nonesuch-program' 'ended without an answer (exit status 127)'
ends_with 'sleep 7001' 'gave no answer within control.answer_time = 0.4 s'
ends_with 'echo hello; sleep 7002' "answered 'hello'"
ends_with 'echo "{\"command\": \"much\"}"; sleep 7002' 'expected one line such as'
ends_with 'echo "{}"; sleep 7002' 'expected one line such as'
ends_with 'echo "{\"command\": null}"; sleep 7002' 'expected one line such as'
ends_with 'yes' "answered 'y'"
ends_with 'yes "{\"command\": 1}"' 'answered more than one line'
ends_with 'cat /dev/zero' 'without the end of a line'
ends_with 'yes >&2' 'gave no answer'
ends_with 'printf "\033[31mred\n" >&2; exit 1' 'it said last'
ends_with 'exec 0<&-; echo "{\"command\": 1}"; sleep 7002' 'gave no answer'
ends_with '(sleep 7003 &) ; sleep 7004 & sleep 7005' 'gave no answer'
ends_with 'trap "" TERM HUP INT; while :; do sleep 7006 & sleep 0.02; done' 'gave no answer'

# one that floods its standard error and still answers is no trouble
run_with 'while read -r line; do head -c 20000 /dev/zero | tr "\\0" x >&2; echo "{\"command\": 1}"; done' \
    --set run.duration=0.2 || fail "a flooded standard error: $(head -c 300 said)"

# nothing is left of any of them
left=$(ps -eo args= | grep -E '^sleep 700[0-9]$' || true)
[ -z "$left" ] || fail "still running: $left"

# without being allowed nothing starts: no program, no plug-in, by no command that runs a scenario
touch_it="touch $work/started; $always"
for command in run animate predict compare; do
    "$lab" $command scenario.yaml --set "control.command=$touch_it" -o "$work/out" >said 2>&1 && :
done
"$lab" run scenario.yaml --quiet --set "control.command=$touch_it" >said 2>&1 && fail "it runs"
grep -q -- --allow-code said || fail "the way to allow it is not said: $(cat said)"
"$lab" show scenario.yaml >/dev/null || fail "show needs no permission"
"$lab" check scenario.yaml >/dev/null || fail "check needs no permission"
"$lab" run scenario.yaml --quiet --set control.law=plugin --set control.plugin=./x.so >said 2>&1 &&
    fail "a plug-in is loaded"
grep -q -- --allow-code said || fail "the way to allow a plug-in is not said: $(cat said)"
[ ! -e started ] || fail "a program was started without permission"

# a scenario cannot allow itself anything
printf 'title: x\ncode_allowed: true\n' >self.yaml
"$lab" check self.yaml >/dev/null 2>&1 && fail "a file can allow code"
printf 'title: x\ncontrol: {code_allowed: true}\n' >self.yaml
"$lab" check self.yaml >/dev/null 2>&1 && fail "a file can allow code"

# nor make the lab print what a terminal would obey
printf 'title: "a\\e[31mb"\ndescription: "c\\e]0;d\\a"\n' >hostile.yaml
for command in run show check predict modes; do
    "$lab" $command hostile.yaml >said 2>&1 || :
    ! grep -q $'\033' said || fail "$command prints an escape sequence of the file's"
done

nothing_failed && echo "processes end with a sentence, and nothing is left"
