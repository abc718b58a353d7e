#!/bin/bash
# Lets the k-th allocation, write, fsync, rename and open of the program fail, for every k or, where
# there are very many, for every n-th, and kills it at random instants. Whatever fails: with exit
# status 0 all results are those of an undisturbed run; otherwise there is a sentence, the file of
# before stands unchanged (or the whole new one), and nothing is left beside it.
# $1: the program, $2: fail_kth.so, $3: how many allocations at most fail for each command (default 60)
set -u
fail_kth=$(readlink -f "$2")
most=${3:-60}
note_count=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/note_count
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/expect.sh"
preload=./fail_kth.so # LD_PRELOAD splits at blanks and colons, which the build folder's name may have
ln -s "$fail_kth" "$preload"
injected=0

if ldd "$program" | grep -q 'lib[atu]*san'; then
    echo "a sanitizer's allocator takes no other's place"
    exit 77
fi

cat >hit.yaml <<'END'
title: An impact
motor: {voltage: 2 V}
run: {duration: 0.05 s}
END

# what a command wrote, the times of the machine removed
essence() {
    case $1 in
    *.json) grep -v '"\(wall\|cpu\)_time_s"' "$1" ;;
    *.sqlite) "$program" sweep hit.yaml --vary motor.voltage=1:2:3 --db "$1" --quiet --csv - 2>&1 ;;
    *) cat "$1" ;;
    esac
}

# true if a result is that of a run that failed, and says so: in its status, or by its rows being the
# first ones of the whole result
tells_of_its_end() {
    case $1 in
    *.json) grep -q '"status": "failed"\|"ok": false\|out of memory' "$1" ;;
    *.csv) head -c "$(stat -c %s "$1")" "expected-$1" | cmp -s - "$1" ;;
    *) false ;;
    esac
}

# attempt CALL K RESULT ARGUMENT...: one call fails; looks at what became of it
attempt() {
    local call=$1 k=$2 result=$3 status
    shift 3
    rm -f "$result" "$result"-journal
    [ "${result##*.}" = sqlite ] || echo old >"$result"
    LD_PRELOAD=$preload FAIL_CALL=$call FAIL_AT=$k FAIL_COUNT=/dev/null "$program" "$@" >out 2>err </dev/null
    status=$?
    injected=$((injected + 1))
    if [ $status -gt 2 ]; then
        fail "$call $k of: $*: status $status: $(head -c 200 err)"
    elif [ $status != 0 ] && [ ! -s err ]; then
        fail "$call $k of: $*: status $status without a sentence"
    fi
    if [ "${result##*.}" = sqlite ]; then
        # the same command goes on from what is there
        "$program" "$@" >out 2>err </dev/null || fail "$call $k of: $*: cannot be continued: $(head -c 200 err)"
        essence "$result" | cmp -s - "expected-$result" || fail "$call $k of: $*: other rows afterwards"
    elif [ "$(cat "$result")" = old ]; then
        [ $status != 0 ] || fail "$call $k of: $*: status 0 and no result"
    elif [ $status = 0 ] || ! tells_of_its_end "$result"; then
        essence "$result" | cmp -s - "expected-$result" || fail "$call $k of: $*: status $status, another result"
    fi
    [ -z "$(find . -name '*.part')" ] || fail "$call $k of: $*: a temporary stays"
    rm -f .impactlab-*.part
}

# try RESULT ARGUMENT...
# Memory is refused to runs and their tables only: libraries that draw may crash without it.
try() {
    local result=$1 call count step k calls='malloc write fsync rename open'
    shift
    rm -f "$result"
    "$program" "$@" >out 2>err </dev/null || fail "$*: $(cat err)"
    essence "$result" >"expected-$result"
    case $result in
    *.svg | *.pdf | *.webp) calls='write fsync rename open' ;;
    esac
    for call in $calls; do
        echo 0 >count
        rm -f "$result"
        LD_PRELOAD=$preload FAIL_CALL=$call FAIL_COUNT=$folder/count "$program" "$@" >out 2>err </dev/null
        count=$(cat count)
        # a film's bytes are written by its encoder
        [ "$call" = rename ] || [ "${result##*.}" = webp ] || [ "$count" -gt 0 ] ||
            fail "no $call is counted: is $preload preloaded?"
        step=$(((count + most - 1) / most))
        for ((k = 1; k <= count; k += step > 0 ? step : 1)); do
            attempt "$call" "$k" "$result" "$@"
        done
        echo "$call: $count calls, every ${step}th failed: impactlab $*"
    done
}

# runs the program and kills it at a random instant of the time it takes (in thousandths of a second)
kill_within() {
    local most=$1 instant
    shift
    instant=$((RANDOM % most))
    "$program" "$@" >/dev/null 2>&1 </dev/null &
    sleep "$((instant / 1000)).$(printf %03d $((instant % 1000)))"
    kill -9 $! 2>/dev/null
    wait $! 2>/dev/null
    injected=$((injected + 1))

    # a temporary is all that it may leave; whoever kills removes it
    find . -name '.impactlab-*.part' -delete
}

# killed at random instants: the sweep goes on to the same rows, files are the old or the new ones
kill_at_random() {
    local result=$1 i
    shift
    for ((i = 0; i < 12; i++)); do
        [ "${result##*.}" = sqlite ] || echo old >"$result"
        kill_within 100 "$@"
        if [ "${result##*.}" != sqlite ] && [ "$(cat "$result")" != old ]; then
            essence "$result" | cmp -s - "expected-$result" || fail "killed: half a result of: $*"
        fi
    done
    "$program" "$@" >out 2>err </dev/null || fail "killed: cannot be continued: $*: $(cat err)"
    essence "$result" | cmp -s - "expected-$result" || fail "killed: another result of: $*"
}

# what stood in a file before: a picture's CSV replaces only one of its kind
old_of() {
    case $1 in
    *.csv) echo panel,old ;;
    *) echo old ;;
    esac
}

# kill_folder FOLDER ARGUMENT...: the same for a command that fills a folder: each file is that of
# before or the whole new one
kill_folder() {
    local into=$1 i begun took file
    shift
    rm -rf "${into:?}"/* whole
    begun=$(date +%s%N)
    "$program" "$@" >out 2>err </dev/null || fail "$*: $(cat err)"
    took=$((($(date +%s%N) - begun) / 1000000 + 1))
    cp -r "$into" whole

    for ((i = 0; i < kills; i++)); do
        find "$into" -type f -name '[!.]*' | while read -r file; do old_of "$file" >"$file"; done
        [ "$into" != frames ] || rm -f frames/*
        kill_within "$took" "$@"
        while read -r file; do
            [ "$(head -c 9 "$file" | tr -d "\0")" = "$(old_of "$file")" ] || cmp -s "$file" "whole/${file#"$into"/}" ||
                fail "killed: half a file $file of: $*"
        done < <(find "$into" -type f -name '[!.]*')
    done

    # an encoder whose program was killed ends by itself, at the end of its input; frames of two films
    # would mix, so that is refused
    for ((i = 0; i < 20; i++)); do
        [ "$into" != frames ] || rm -f frames/*
        "$program" "$@" >out 2>err </dev/null || fail "killed: cannot be repeated: $*: $(cat err)"
        ! diff -r "$into" whole >err || return
        sleep 0.2
    done
    fail "killed: other files afterwards of: $*: $(cat err)"
}

# kill_session INSTANTS: a session that is kept over its own file is the old or the new one, whole
kill_session() {
    local i begun took keys=':push 0.01<Enter>b:note again<Enter>:session save day.session<Enter>'
    local size=(--size 80x24 --keys)
    rm -f ./*.session
    "$program" lab hit.yaml "${size[@]}" 'b:set arm.k2 5<Enter>:session save old.session<Enter>' >out 2>err ||
        fail "no session is kept: $(cat err)"
    cp old.session day.session
    begun=$(date +%s%N)
    "$program" lab day.session "${size[@]}" "$keys" >out 2>err || fail "no session again: $(cat err)"
    took=$((($(date +%s%N) - begun) / 1000000 + 1))
    mv day.session new.session
    cmp -s old.session new.session && fail "the session kept again is the old one"
    for ((i = 0; i < $1; i++)); do
        cp old.session day.session
        kill_within "$took" lab day.session "${size[@]}" "$keys"
        cmp -s day.session old.session || cmp -s day.session new.session || fail "killed: half a session"
    done
}

try r.json run hit.yaml --quiet --json r.json
try r.csv run hit.yaml --quiet --csv r.csv
try s.sqlite sweep hit.yaml --vary motor.voltage=1:2:3 --quiet --jobs 1 --db s.sqlite
try p.svg run hit.yaml --quiet --plot p.svg
try p.pdf run hit.yaml --quiet --plot p.pdf
try c.json compare hit.yaml --columns peak_force_N --quiet --json c.json
! command -v ffmpeg >/dev/null ||
    try f.webp animate hit.yaml --size 320x240 --fps 4 --seconds 0.5 --gl cairo --quiet -o f.webp
# nobody is told that nothing is known where there was no memory to look
for k in 500 5000 50000; do
    injected=$((injected + 1))
    LD_PRELOAD=$preload FAIL_CALL=malloc FAIL_AT=$k FAIL_COUNT=/dev/null "$program" help wall stifness >out 2>err
    [ $? = 1 ] && grep -q memory err || fail "help without memory for call $k: $(cat err)"
done
kill_at_random r.csv run hit.yaml --quiet --csv r.csv
kill_at_random s.sqlite sweep hit.yaml --vary motor.voltage=1:2:3 --quiet --jobs 1 --db s.sqlite
kills=$(((most + 3) / 4))
kill_folder figures figures 3.4 T3.1 --quiet -o figures
kill_folder frames animate hit.yaml --size 320x240 --fps 10 --seconds 1 --gl cairo --quiet -o frames
kill_folder report report hit.yaml --quiet -o report
mkdir films
! command -v ffmpeg >/dev/null ||
    kill_folder films animate hit.yaml --size 320x240 --fps 10 --seconds 1 --gl cairo --quiet -o films/a.mp4
export XDG_CONFIG_HOME=$folder/settings
kill_session 50
kill_folder settings lab hit.yaml --size 80x24 --keys ':theme dark<Enter>:remember<Enter>'

echo "$injected faults injected, $failures broken promises"
times >times
"$note_count" faults "$injected" \
    "$(awk 'NR == 2 { gsub(/[ms]/, " "); printf "%.0f", 60 * $1 + $2 + 60 * $3 + $4 }' times)" "$failures"
nothing_failed
