#!/bin/bash
# A stranger's scenario starts no program, loads no library, writes no file and prints no escape
# sequence without being asked, whichever command opens it.
#
# Its program and its plug-in write a canary file; everything that appears in the folders that
# commands see is counted; and where strace can be used it tells what was started and opened for
# writing.
#
#   test_stranger.sh PROGRAM SOURCE_ROOT PLUGIN
set -euo pipefail
source=$(readlink -f "$2")
plugin=$(readlink -f "$3")
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../expect.sh"
lab=$program
work=$folder

# whatever a command could write to lies in one folder
mkdir "$work/sandbox" "$work/out"
cd "$work/sandbox"
mkdir home tmp config cache scenarios
cp "$plugin" evil.so
export CANARY=$work/sandbox/canary HOME=$PWD/home TMPDIR=$PWD/tmp XDG_CONFIG_HOME=$PWD/config
export XDG_CACHE_HOME=$work/cache IMPACTLAB_SCENARIOS=$PWD/scenarios:$source/scenarios
touch_it="touch $CANARY; while read -r line; do echo '{\\\"command\\\": 1}'; done"

rest() {
    cat <<END
initial: {angle: -0.001 rad}
wall: {kind: plane, angle: 0 rad}
run: {duration: 0.02 s}
panes: [force]
END
}
{
    rest
    echo "control: {law: process, command: \"$touch_it\"}"
} >scenarios/program.yaml
{
    rest
    echo "control: {law: plugin, plugin: $PWD/evil.so}"
} >scenarios/plugin.yaml
{
    rest
    cat <<'END'
lesson:
  parameters: [motor.voltage]
  steps:
    - say: "Give motor.voltage the value 2."
      value: {motor.voltage: 2}
      do: ["save stolen.csv", "allow"]
END
} >scenarios/lesson.yaml
# texts with what a terminal obeys: escape, the one-byte CSI, backspace, a bell; and a file's name
{
    printf 'title: "a\\e[31mb\\x9b31m\\a\\b"\ndescription: "c\\e]0;d\\a \\x9b2J"\n'
    rest
    echo 'control: {law: open-loop, nonesuch: "\e[31m", settings: "x=\e[31m", "\e[2Jkey": 1}'
    printf 'lesson: {steps: [{say: "\\e[31m", hint: "\\e[2J", then: "\\a"}]}\n'
} >scenarios/faulty.yaml
cp scenarios/lesson.yaml "$(printf 'scenarios/name-\033[31m-\302\233.yaml')"
cat >recipe.yaml <<END
title: "\\e[31mred"
runs:
  - scenario: program
panels:
  - signals: [force]
END
printf 'time[s],command[V],encoder[rad]\n0,1,0\n0.005,1,0\n0.01,1,0\n0.015,1,0\n0.02,1,0\n0.025,1,0\n' >recorded.csv
printf 'control.force=0.5:2\n' >draws.set

trace=
if strace -o "$work/trace" true 2>/dev/null; then
    trace=yes
fi
find . -type f | sort >"$work/before"

# look NAME COMMAND...: runs a command, and looks for what it was not to do
look() {
    local name=$1
    shift
    if [ -n "$trace" ]; then
        timeout 300 strace -f -qq -o "$work/trace" -e signal=none \
            -e trace=execve,open,openat,creat,connect "$lab" "$@" \
            >"$work/said" 2>&1 </dev/null || :
        # one program, which may become the one that draws, and nothing written but what was asked for
        local started opened
        started=$(grep 'execve(' "$work/trace" | tail -n +2 | grep -vF "execve(\"$lab-draw\", " || :)
        [ -z "$started" ] || fail "$name starts: $(head -3 <<<"$started")"
        opened=$(grep -E 'O_WRONLY|O_RDWR|O_CREAT|creat\(' "$work/trace" |
            grep -vE "\"($work/out|$work/cache|/dev/null|/dev/shm/|/proc/self/)|O_TMPFILE" || :)
        [ -z "$opened" ] || fail "$name opens for writing: $(head -3 <<<"$opened")"
        ! grep -q 'evil\.so' "$work/trace" || fail "$name opens the plug-in"
        ! grep 'connect(' "$work/trace" | grep -qv AF_UNIX || fail "$name uses the network"
    else
        timeout 300 "$lab" "$@" >"$work/said" 2>&1 </dev/null || :
    fi

    # the canary, files of any kind, and what a terminal would obey
    [ ! -e canary ] || fail "$name ran the scenario's program or plug-in"
    find . -type f | sort >"$work/after"
    cmp -s "$work/before" "$work/after" ||
        fail "$name leaves: $(comm -13 "$work/before" "$work/after")"
    rm -f canary
    if grep -qP '\x1b|\xc2\x9b|\x07|\x08' "$work/said"; then
        fail "$name prints: $(grep -P '\x1b|\xc2\x9b|\x07|\x08' "$work/said" | head -1 | cat -v)"
    fi
}

# the arguments with which each command opens a scenario; -o only where there is no doing without
arguments() {
    case $1 in
    list | tables | help) echo ;;
    show | run | predict | modes | linear | converge | calibrate) echo "$2" ;;
    check) echo "scenarios/$2.yaml" ;;
    sweep) echo "$2 --vary motor.voltage=1,2 --jobs 2" ;;
    identify) echo "$2 --data recorded.csv --fit arm.k2 --starts 1 --jobs 2" ;;
    solve) echo "$2 motor.voltage=0.5:2 peak_force_N<1 --runs 3 --jobs 2" ;;
    merge) echo "scenarios/$2.yaml" ;;
    compare) echo "$2 corrected/first-impact" ;;
    study) echo "sensor $2" ;;
    export) echo "$2 -o $work/out/export-$2" ;;
    fmu) echo "$2 -o $work/out/$2.fmu" ;;
    tune) echo "$2 --vary motor.voltage=1:2 --minimise peak_force_N --runs 4" ;;
    robust) echo "$2 --over draws.set --runs 2" ;;
    animate) echo "$2 -o $work/out/frames-$2 --gl cairo --fps 2 --seconds 1 --size 160x120" ;;
    plot) echo "recipe.yaml -o $work/out/plot.svg" ;;
    report) echo "$2 -o $work/out/report" ;;
    figures) echo "fig-2-4 -o $work/out" ;;
    bench) echo "--only nonesuch" ;;
    lab) echo "$2 --size 120x40 --keys d?" ;;
    lesson) echo "$2 --size 120x40" ;;
    *) return 1 ;;
    esac
}

# every command that --help lists
commands=$("$lab" --help | sed -n 's/^  \([a-z]*\)  *[A-Z].*/\1/p')
[ "$(wc -w <<<"$commands")" -ge 20 ] || fail "only these commands are found: $commands"
for command in $commands; do
    for scenario in program plugin lesson faulty; do
        if ! words=$(arguments "$command" "$scenario"); then
            fail "this test does not know how to call $command"
            break
        fi
        # shellcheck disable=SC2086
        look "$command $scenario" "$command" $words
        case $command in list | tables | help | bench | figures | plot) break ;; esac
    done
done

name=$(printf 'scenarios/name-\033[31m-\302\233.yaml')
for command in show check run predict modes; do
    look "$command of a hostile name" $command "$name"
done
look "lab of a hostile name" lab "$name" --size 120x40

# what asks for the run's rows on the standard output is served with the same care
for option in json csv; do
    look "run --$option" run lesson --$option -
    look "run --$option program" run program --$option -
done
look "show --json" show program --json -
look "list --json" list --json -

# a permission for one scenario is none for another
look "lab, another opened" lab corrected/first-impact --allow-code --size 120x40 \
    --keys ':open program<Enter>:open plugin<Enter>'

# the canary sings where it may, so that silence means something
"$lab" run program --allow-code --quiet || fail "the program does not run where it may"
[ -e canary ] || fail "the program's canary never sings"
rm -f canary
"$lab" run plugin --allow-code --quiet >/dev/null 2>&1 || :
[ -e canary ] || fail "the plug-in's canary never sings"

nothing_failed && echo "a stranger's scenario does nothing unasked${trace:+ (strace looked on)}"
