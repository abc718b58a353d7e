#!/bin/bash
# The terminal lab in a real pseudo-terminal (tmux): it shows, acts, and gives the terminal back.
# $1: the program, $2: the sanitizers it is compiled with, or 'none'
#
# Whatever the lab does is waited for, so that a slow or busy machine makes no difference: LIMIT
# only catches a lab that hangs, and is a hundred times what anything here takes on an idle machine.
# shellcheck disable=SC2317 # functions that until_true calls
set -u
LIMIT=120 # [s]
export LC_ALL=C.UTF-8
# a sanitizer's own handlers would end the program with another status
export ASAN_OPTIONS=${ASAN_OPTIONS:-}:handle_segv=0:handle_sigbus=0:handle_sigill=0:handle_sigfpe=0:handle_abort=0
# the console's mouse library, which ncurses loads for TERM=linux, leaks a few bytes
export NCURSES_GPM_TERMS=none
# blanks and the like in the program's own path are no matter for the shells in here
folder=$(mktemp -d /tmp/impactlab-terminal-XXXXXX)
program=$folder/impactlab
ln -s "$(readlink -f "$1")" "$program"
socket=impactlab-$$
failed=0

if ! command -v tmux >/dev/null; then
    echo "tmux is not here"
    exit 77
fi

mux() {
    tmux -L "$socket" -f /dev/null "$@"
}

# shellcheck disable=SC2317
finish() {
    mux kill-server 2>/dev/null
    rm -rf "$folder"
}
trap finish EXIT

picture() {
    mux capture-pane -p
}

fail() {
    echo "FAILED: $*"
    picture
    failed=1
}

# waits until the command "$@" succeeds; false after LIMIT
until_true() {
    local end=$((SECONDS + LIMIT))
    until "$@"; do
        [ $SECONDS -lt $end ] || return 1
        sleep 0.05
    done
}

shows() {
    picture | grep -qF -- "$1"
}

# waits until the screen shows the text $1
await() {
    until_true shows "$1" || { fail "'$1' does not appear"; return 1; }
}

# waits until a file exists and has a line
await_file() {
    until_true test -s "$1" || { fail "$1 is not written"; return 1; }
}

# whether the shell waits for a command: what is sent to it earlier may be lost
is_prompted() {
    picture | grep -v '^ *$' | tail -n 1 | grep -q '^ready> *$'
}

# the same, once what the terminal answered a lab that a signal ended is deleted: "1;2c"
is_ready() {
    is_prompted && return
    picture | grep -v '^ *$' | tail -n 1 | grep -q '^ready> ' && mux send-keys C-u
    false
}

# starts the lab; afterwards its exit status and the terminal's settings go to files. On a busy
# machine keys that follow a signal at once are lost: they are sent again where the prompt still waits
start() {
    local end=$((SECONDS + LIMIT)) patience=5
    rm -f "$folder/after" "$folder/pid"
    while [ $SECONDS -lt $end ]; do
        until_true is_ready || fail "the shell has no prompt"
        mux send-keys "clear; lab $*" Enter
        LIMIT=$patience until_true test -s "$folder/pid" && break
        patience=$((2 * patience))
    done
    await "${SHOWS:-why (W)}"
}

# suspends the lab; on a busy machine the shell may not have handed the terminal over when the key
# comes, which is then lost
suspend() {
    local end=$((SECONDS + LIMIT)) patience=2
    while [ $SECONDS -lt $end ]; do
        mux send-keys C-z
        LIMIT=$patience until_true shows "ready>" && return 0
        patience=$((2 * patience))
    done
    fail "^Z does not suspend"
}

# tmux has read all that the lab wrote: no alternate screen, cursor shown, no mouse
modes_are_given_back() {
    [ "$(mux display-message -p '#{alternate_on} #{cursor_flag} #{mouse_any_flag}')" = "0 1 0" ]
}

# the terminal is as it was: settings, alternate screen, cursor, mouse
check_given_back() {
    await_file "$folder/after" || return
    cmp -s "$folder/before" "$folder/after" || fail "$1: stty settings differ"
    until_true modes_are_given_back || fail "$1: alternate screen, cursor or mouse are left over"
}

cat >"$folder/profile" <<PROFILE
PS1='ready> '
set +o history
# a job of its own, so that signals reach it alone
lab() {
    (echo \$BASHPID >"$folder/pid"; exec "$program" "\$@")
    echo "status \$?"
    note_settings
}
# whole or not at all, for who waits for it
note_settings() {
    stty -g >"$folder/noted" && mv "$folder/noted" "$folder/after"
}
stty -g >"$folder/before"
export XDG_CONFIG_HOME="$folder/config"
export XDG_STATE_HOME="$folder/state"
PROFILE
mux new-session -d -x 120 -y 40 "bash --noprofile --rcfile $folder/profile -i"
await "ready>"

start
await "44.3 mN s"
mux send-keys q
await "status 0"
check_given_back q

for name in TERM HUP SEGV ABRT FPE BUS ILL TRAP XCPU SYS USR1 USR2 ALRM VTALRM PROF IO PWR STKFLT; do
    start
    kill -s "$name" "$(cat "$folder/pid")"
    await "status $((128 + $(kill -l "$name")))"
    check_given_back "$name"
done

# ^C ends it by SIGINT, which also ends what the shell was about to do
start
mux send-keys C-c
await "ready>"
mux send-keys note_settings Enter
check_given_back INT

# however it ends, what was done is there again; a picture for which there is no memory is one way
is_kept() {
    grep -qs "arm.k2 $1" "$folder"/state/impactlab/recovery-*
}
offers() {
    SHOWS="y goes on with it" start
    mux send-keys y
    await "1 change, 1 pinned run"
    mux send-keys q q
    await "status 0"
    [ -z "$(find "$folder/state/impactlab" -name 'recovery*')" ] || fail "$1: the recovery file outlives an end that was asked for"
}
mux new-window "bash --noprofile --rcfile $folder/profile -i"
await "ready>"
ends=(KILL HUP ABRT TRAP)
if [ "$2" = none ]; then
    # where there is no memory to load what draws, the lab says so and goes on; a sanitizer's own memory takes
    # terabytes of addresses, and it dies where they end
    ends+=(drawing)
fi
for name in "${ends[@]}"; do
    start
    mux send-keys b ":set arm.k2 5" Enter
    until_true is_kept 5 || fail "$name: no recovery file"
    pid=$(cat "$folder/pid")
    if [ "$name" = drawing ]; then
        room=$(awk '/^VmSize/ { printf "%d", $2 + 1000 }' "/proc/$pid/status")
        prlimit --pid "$pid" --as=$((room * 1024))
        mux send-keys ":save $folder/none.svg" Enter
        await "drawing.so"
        kill -s ABRT "$pid"
    else
        kill -s "$name" "$pid"
    fi
    if [ "$name" = KILL ]; then
        mux kill-window
    else
        until_true is_ready
    fi
    is_kept 5 || fail "$name: the recovery file is gone"
    offers "$name"
done

# suspended and taken up again
start
suspend
until_true modes_are_given_back || fail "^Z: alternate screen, cursor or mouse are left over"
mux send-keys "clear; jobs" Enter
await "Stopped"
mux send-keys "fg" Enter
await "Space run/pause"
mux send-keys q
await "ready>"

# any size, at any moment
start
for size in "1 1" "10 3" "200 60" "30 8" "300 100" "41 12"; do
    mux resize-window -x "${size% *}" -y "${size#* }"
    sleep 0.1
done
mux resize-window -x 20 -y 8
await "12 characters, here"
mux resize-window -x 120 -y 40
await "Space run/pause"
mux send-keys q
await "status 0"
check_given_back resize

# the terminal goes away: the program ends too
mux new-window "sh -c 'echo \$\$ >$folder/gone; exec $program'"
await "Space run/pause"
mux kill-window
is_gone() {
    ! kill -0 "$1" 2>/dev/null
}
until_true is_gone "$(cat "$folder/gone")" || fail "the lab outlives its terminal"

# a click in the curves moves the cursor, unless the mouse is off
mux send-keys "export TERM=xterm-256color" Enter
start
mux send-keys Space Home
await "t 0.00000 s"
mux send-keys -l $'\033[<0;45;35M\033[<0;45;35m'
await "t 0.53906 s"
# what is pasted presses no keys: neither quits nor opens anything, and in the prompt it is text
mux set-buffer $'q\nqy:quit\n'
mux paste-buffer -p
await "pasted text does nothing here"
mux send-keys :
mux set-buffer $'set motor.voltage=3\nquit'
mux paste-buffer -p
await "set motor.voltage=3 quit"
mux send-keys Escape
mux send-keys ":mouse off" Enter
await "the mouse is off"
mouse_is_off() {
    [ "$(mux display-message -p '#{mouse_any_flag}')" = 0 ]
}
until_true mouse_is_off || fail "the mouse stays on"
mux send-keys q
await "status 0"
check_given_back mouse

# suspended, the shell has the mouse; taken up again, the lab
mouse_is_on() {
    [ "$(mux display-message -p '#{mouse_any_flag}')" = 1 ]
}
start
until_true mouse_is_on || fail "the mouse stays off"
suspend
until_true modes_are_given_back || fail "^Z: alternate screen, cursor or mouse are left over"
mux send-keys "clear; fg" Enter
await "Space run/pause"
until_true mouse_is_on || fail "the mouse stays off after fg"
mux send-keys q
await "ready>"
mux send-keys note_settings Enter
check_given_back "suspended with a mouse"

# a drag in the curves scrubs, the wheel zooms, Shift and an arrow pans
start
mux send-keys Space Home
await "t 0.00000 s"
mux send-keys -l $'\033[<0;45;35M'
mux send-keys -l $'\033[<32;60;35M'
mux send-keys -l $'\033[<0;60;35m'
await "t 0.77"
mux send-keys -l $'\033[<64;60;35M'
await "0.8 s"
mux send-keys -l $'\033[1;2D'
await "f follows the cursor again"
mux send-keys q
await "status 0"
check_given_back "mouse wheel"
mux send-keys "export TERM=screen" Enter

# what was done is saved and can be run
start
mux send-keys Space ":seek 0.2" Enter Enter BSpace "0.5" Enter
await "motor.voltage = 0.5 V from 0.2000 s on"
mux send-keys ":save $folder/half.yaml" Enter
await "saved $folder/half.yaml"
mux send-keys q
await "status 0"
"$program" run "$folder/half.yaml" | grep -q "peak force  *0.94" || fail "the saved run differs"

# as many colours as the terminal has, or is said to have
# $1: settings of the environment, $2: options, $3: what the screen has, $4: what it has not
colours() {
    rm -f "$folder/after"
    mux send-keys "clear; env $1 $program lab $2; note_settings" Enter
    await "Space run/pause"
    mux send-keys ":seek 0.35" Enter
    await "t 0.35000 s"
    mux capture-pane -e -p >"$folder/cells"
    grep -q "$3" "$folder/cells" || fail "$1 $2: no $3"
    if [ -n "$4" ] && grep -q "$4" "$folder/cells"; then
        fail "$1 $2: $4"
    fi
    mux send-keys q
    await "changes, peak force"
    check_given_back "$1 $2"
}
mux set-option -g default-terminal tmux-256color
mux new-window "bash --noprofile --rcfile $folder/profile -i"
await "ready>"
colours "COLORTERM=truecolor" "" "38;2;255;150;40m" "38;5;"
colours "COLORTERM=24bit" "--theme light" "38;2;175;70;0m" "38;5;"
colours "COLORTERM=" "" "38;5;" "38;2;"
colours "COLORTERM=truecolor" "--theme mono" "\[1m" "38;[25];"
colours "COLORTERM=truecolor NO_COLOR=1" "" "\[1m" "38;[25];"
colours "COLORTERM=truecolor NO_COLOR=" "" "38;2;" ""
colours "COLORTERM=truecolor TERM=vt100" "" "\[1m" "38;[25];"
colours "COLORTERM=truecolor TERM=linux" "" "\[3[1-7]m" "38;[25];"
colours "-u TMUX COLORTERM=truecolor TERM=screen" "" "\[3[1-7]m" "38;[25];"
colours "COLORTERM=truecolor TERM=xterm" "" "38;2;" "38;5;"
colours "COLORTERM=truecolor COLORFGBG=\"0;15\"" "" "38;2;175;70;0m" "38;2;255;150;40m"

# on a large screen playing takes at most 30 kB a second, and what was written change by change looks as
# what is drawn at once
mux resize-window -x 200 -y 60
mux send-keys "export COLORTERM=truecolor; clear; lab" Enter
await "Space run/pause"
mux send-keys Space ":seek 0.1" Enter
await "t 0.10000 s"
mux pipe-pane "cat >$folder/played"
mux send-keys Space
sleep 3
mux send-keys Space
mux pipe-pane
[ "$(stat -c %s "$folder/played")" -lt 95000 ] || fail "playing takes $(stat -c %s "$folder/played") bytes in 3 s"
mux send-keys ":seek 0.25" Enter Enter "2" Enter End Escape
await "t 1.00000 s"
sleep 0.5
picture >"$folder/by_changes"
mux send-keys C-l
sleep 0.5
picture >"$folder/at_once"
cmp "$folder/by_changes" "$folder/at_once" || fail "changes leave another picture than drawing at once"
mux send-keys ":quit!" Enter
await "ready>"
mux resize-window -x 120 -y 40

# resized, suspended and taken up again in such colours: the picture is whole
mux send-keys "export COLORTERM=truecolor; clear; lab" Enter
await "Space run/pause"
mux resize-window -x 90 -y 30
await "? help"
mux send-keys Escape
suspend
mux send-keys "clear; fg" Enter
await "impactlab  corrected/first-impact"
await "knobs (/ all"
mux resize-window -x 120 -y 40
mux send-keys ":theme mono" Enter
sleep 0.2
mux send-keys ":theme dark" Enter
await "impactlab  corrected/first-impact"
mux send-keys q
await "ready>"
for name in SEGV TERM; do
    start
    kill -s "$name" "$(cat "$folder/pid")"
    await "status $((128 + $(kill -l "$name")))"
    check_given_back "true colour $name"
done
mux kill-window
mux set-option -g default-terminal screen

# settings are kept; a file with faults is told of and left alone
start
mux send-keys ":panes 27" Enter ":theme light" Enter ":remember" Enter
await "settings kept"
mux send-keys q
await "status 0"
start
await " Di "
mux send-keys q
await "status 0"
echo "glyphs purple" >>"$folder/config/impactlab/lab"
cp "$folder/config/impactlab/lab" "$folder/broken"
mux send-keys "clear; lab" Enter
await ":8 is ignored: 'purple' is none of"
mux send-keys ":remember" Enter
await "left alone"
mux send-keys q
await "status 0"
cmp -s "$folder/broken" "$folder/config/impactlab/lab" || fail "broken settings were overwritten"
rm -r "$folder/config"

# other terminals, no colour, no UTF-8
for setting in "TERM=xterm-256color" "TERM=vt100" "TERM=linux" "NO_COLOR=1" "LC_ALL=C" \
    "TERM=screen"; do
    mux send-keys "export $setting" Enter
    start
    mux send-keys q
    await "status 0"
    check_given_back "$setting"
    mux send-keys "unset NO_COLOR; export LC_ALL=C.UTF-8 TERM=screen" Enter
done
for theme in dark light mono; do
    for glyphs in braille blocks ascii; do
        start lab --theme "$theme" --glyphs "$glyphs"
        mux send-keys q
        await "status 0"
        check_given_back "$theme $glyphs"
    done
done
for name in dumb nonsense ""; do
    mux send-keys "clear; TERM='$name' lab lab" Enter
    await "TERM is '$name'"
    await "status 2"
done

# the tools of the bench at three sizes: what is typed, and what the screen answers
mux set -s set-clipboard on
"$program" run corrected/first-impact --set arm.k2=4.5 --quiet --csv "$folder/rows.csv"
ask() {
    mux send-keys "$1" Enter
    await "$2"
}
copied() {
    mux show-buffer 2>/dev/null | grep -qF -- "$1"
}
for size in 80x24 100x30 200x60; do
    mux resize-window -x "${size%x*}" -y "${size#*x}"
    start lab corrected/first-impact
    mux send-keys Space End
    ask ":solve voltage peak_force_N<2" "up to motor.voltage = 1.4441"
    ask ":note a hard one" "noted at"
    ask ":notes" "a hard one"
    mux send-keys Escape
    ask ":difference 0.1" "differs by more than"
    ask ":difference off" "the runs themselves"
    ask ":trace force - voltage" "force-voltage"
    ask ":data $folder/rows.csv" "shifted by"
    ask ":residual force" "trace 11 hides it"
    ask ":identify k2" "command"
    ask ":sweep arm.k2=4:8:3 motor.voltage=1:2:3" "9 runs"
    mux send-keys Up '>'
    await "k2 6, voltage 1.5"
    mux send-keys Enter
    await "motor.voltage = 1.5"
    mux send-keys Escape
    ask ":why" "why (Esc closes)"
    mux send-keys Escape
    ask ":poles" "poles (Esc closes)"
    mux send-keys Escape F1
    await "linearised constrained arm"
    mux send-keys Escape
    ask ":copy run" "clipboard"
    until_true copied "impactlab run 'corrected/first-impact' --set 'arm.k2=6'" ||
        fail "nothing is on the clipboard"
    ask ":session save $folder/$size.session" "goes on"
    mux send-keys q
    await "status 0"
    check_given_back "tools at $size"

    # another day: one command
    until_true is_ready || fail "the shell has no prompt"
    mux send-keys "clear; lab lab $folder/$size.session" Enter
    await "2 changes"
    ask ":notes" "a hard one"
    mux send-keys Escape q
    await "status 0"
done
mux resize-window -x 120 -y 40

# no terminal at all
"$program" lab </dev/null >"$folder/out" 2>&1 && fail "a lab without a terminal"
grep -q "needs a terminal" "$folder/out" || fail "no word about the terminal"
"$program" </dev/null | grep -q "corrected/first-impact" || fail "no list without a terminal"
printf 'seek 0.3\nset motor.voltage 2\nbranch\n' >"$folder/script"
"$program" --script "$folder/script" --size 100x30 | grep -q "1 change" || fail "--script"
printf 'seek 0.3\nsat motor.voltage 2\n' >"$folder/script"
"$program" --script "$folder/script" --size 100x30 2>"$folder/out" && fail "a wrong script passes"
grep -q "script:2: there is no command 'sat'" "$folder/out" || fail "the script's fault is not told"

[ "$failed" = 0 ] && echo "all is well"
exit "$failed"
