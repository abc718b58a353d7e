#!/usr/bin/env bash
# What a command reads: no result takes its place, under whatever name, and what has no end is no
# input.
#
#   test_inputs.sh PROGRAM
set -u
# shellcheck source=tests/expect.sh
. "${0%/*}/expect.sh"

# one file of each kind that a command reads
"$program" sweep corrected/first-impact --vary motor.voltage=1:2:2 --part 1/2 --db one.sqlite --quiet
"$program" sweep corrected/first-impact --vary motor.voltage=1:2:2 --part 2/2 --db two.sqlite --quiet
cp "$IMPACTLAB_SCENARIOS/corrected/first-impact.yaml" arm.yaml
cp "$IMPACTLAB_SCENARIOS/sets/robust.set" drawn.set
"$program" run arm.yaml --set run.duration=0.5 --csv data.csv --quiet
printf 'time[s],displacement[m]\n0,0\n1,0.001\n' >motion.csv
printf 'time[s],command[V]\n0,0\n1,1\n' >voltage.csv
printf 'title: two\nruns:\n  - scenario: arm.yaml\ndata:\n  - file: drawn.csv\npanels:\n  - signals: [force]\n' >two.yaml
(echo panel,time,force && echo 1,0,0 && echo 1,1,2) >drawn.csv
echo '{"bench": []}' >before.json
touch law.so
ln -s data.csv to-data
ln data.csv same-data
cp -r . ../"${PWD##*/}"-kept && kept=../${PWD##*/}-kept
trap 'rm -rf "$folder" "$folder-kept"' EXIT

# kept FILE ARGUMENT...: the command is refused before it begins, by a sentence with the file's name
kept() {
    local read=$1
    shift
    expect 2 "$@"
    says err "$read"
    says err "written over"
    diff -qr . "$kept" -x out -x err || fail "impactlab $*: a file was touched"
}
kept arm.yaml check arm.yaml --json arm.yaml
kept arm.yaml check two.yaml arm.yaml --json ./arm.yaml
kept arm.yaml show arm.yaml --json arm.yaml
kept data.csv identify arm.yaml --data data.csv --fit arm.k2 --json data.csv
kept data.csv identify arm.yaml --data data.csv --fit arm.k2 --cases "$PWD/data.csv"
kept data.csv identify arm.yaml --data motion.csv --validate data.csv --fit arm.k2 --json to-data
kept data.csv run arm.yaml --overlay data.csv:force@0.1 --csv same-data --plot arm.png
kept motion.csv run arm.yaml --set wall.motion=file --set wall.motion_file=motion.csv --csv motion.csv
kept motion.csv sweep arm.yaml --set wall.motion_file=motion.csv --vary motor.voltage=1:2:2 --db motion.csv
kept voltage.csv run arm.yaml --set control.law=playback --set control.playback_file=voltage.csv --csv ./voltage.csv
kept law.so run arm.yaml --set control.law=plugin --set control.plugin=./law.so --json law.so --allow-code
kept "law.sh --table=data.csv" run arm.yaml --set 'control.command=law.sh --table=data.csv' --json data.csv
kept drawn.set robust compare/hybrid --over drawn.set --runs 1 --csv drawn.set
kept two.sqlite merge one.sqlite two.sqlite -o two.sqlite
kept two.yaml plot two.yaml -o two.png --latex two.yaml
kept arm.yaml plot two.yaml -o two.png --latex arm.yaml
kept drawn.csv plot two.yaml -o drawn.png
kept before.json bench --baseline before.json --json before.json --only tables_s
for file in data.csv arm.yaml motion.csv; do
    expect 1 lab arm.yaml --size 100x30 --keys \
        ":set wall.motion_file=motion.csv<Enter>:data data.csv<Enter>:save! $file<Enter>"
    says err "$file is a file that this run reads"
    cmp -s "$file" "$kept/$file" || fail "the lab wrote over $file"
done

# a result takes no place of a file of another kind; of its own it does
for file in data.csv two.sqlite law.so; do
    [ -s "$file" ] || echo text >"$file"
    cp "$file" before
    expect 2 tune arm.yaml --vary motor.voltage=1:2 --minimise peak_force_N --runs 2 -o "$file"
    says err "a file of another kind"
    [ "$file" = two.sqlite ] || expect 2 merge one.sqlite two.sqlite -o "$file"
    cmp -s "$file" before || fail "$file is not as it was"
done
expect 2 sweep arm.yaml --vary motor.voltage=1:2:2 --db data.csv
for _ in 1 2; do
    expect 0 tune arm.yaml --vary motor.voltage=1:2 --minimise peak_force_N --runs 2 -o best.yaml
    expect 0 merge one.sqlite two.sqlite -o both.sqlite
done

# what has no end is refused at once, everywhere: a pipe that nobody writes to would be waited for
mkfifo pipe
for file in pipe /dev/zero; do
    endless() {
        timeout -k 1 20 "$program" "$@" >out 2>err </dev/null
        [ $? = 2 ] || fail "impactlab $*: not refused"
        says err "'$file' is a device or a pipe"
    }
    endless run "$file"
    endless check "$file"
    endless run arm.yaml --set wall.motion=file --set "wall.motion_file=$file"
    endless run arm.yaml --set control.law=playback --set "control.playback_file=$file"
    endless identify arm.yaml --data "$file" --fit arm.k2
    endless run arm.yaml --overlay "$file" --plot arm.png
    endless robust compare/hybrid --over "$file" --runs 1
    endless plot "$file"
    endless merge "$file" -o none.sqlite
    endless sweep arm.yaml --vary motor.voltage=1:2:2 --db "$file"
    endless compare arm.yaml arm.yaml --overlay "$file:force@0.1"
    endless lab arm.yaml --script "$file"
    endless bench --only tables_s --baseline "$file"
    timeout -k 1 20 "$program" run arm.yaml --set control.law=plugin --allow-code \
        --set "control.plugin=$(readlink -f "$file")" >out 2>err
    [ $? = 1 ] && says err "is a device or a pipe"
    for command in session\ open data open; do
        timeout 20 "$program" lab arm.yaml --size 100x20 --keys ":$command $file<Enter>" >out 2>err
        [ $? = 1 ] && says err "'$file' is a device or a pipe"
    done
done

# an overlay without an end is refused before the run, not behind it
timeout -k 1 20 "$program" run arm.yaml --overlay pipe --plot arm.png >out 2>err
[ ! -s out ] || fail "the run was computed before its overlay was refused"

# a set that ships is found by its name from any folder, as a scenario is; a file comes first
expect 0 robust compare/hybrid --over sets/robust.set --runs 2 --json shipped.json
expect 0 robust compare/hybrid --runs 2 --json usual.json
for file in shipped usual; do
    grep -v '_time_s\|"command"' $file.json >$file.kept
done
cmp -s shipped.kept usual.kept || fail "--over sets/robust.set is not the set that ships"
expect 0 tune compare/hybrid --over sets/robust.set --vary control.kv=1:2 --runs 4 \
    --minimise overshoot_nine_tenths_percent
mkdir sets
echo 'belief.no_such=1:2' >sets/robust.set
expect 2 robust compare/hybrid --over sets/robust.set --runs 2
says err "no_such"
expect 2 robust compare/hybrid --over sets/none.set --runs 2
says err "'sets/none.set' cannot be opened"

# rows that are kept for a picture and that no memory holds are refused before the first
timeout 20 "$program" run arm.yaml --set run.duration=1e5 --set method.step=1e-5 --plot many.svg >out 2>err
[ $? = 2 ] && says err "GB of memory" || fail "1e10 rows are begun"

# what tune found is told in every form, also where a tenth more of it, or less, cannot be
tuned() {
    expect 0 tune "$@" --runs 4 --json tuned.json --plot tuned.svg -o tuned.yaml
    says out "-10 % gives"
    [ -s tuned.svg ] && grep -q '"tenth_higher"' tuned.json && "$program" check tuned.yaml >out 2>err ||
        fail "tune $*: a result is missing"
    rm -f tuned.*
}
tuned arm.yaml --set wall.restitution=0.97 --vary wall.restitution=0.95:1 --minimise impacts
tuned compare/observer --set belief.links=5 --vary belief.links=2:9 --minimise settling_time_s

# a name of a file that cannot be a title makes a scenario that can be read again
for name in $'tab\there.yaml' $'line\nhere.yaml'; do
    echo 'motor: {voltage: 1}' >"$name"
    expect 0 tune "$name" --vary motor.voltage=1:2 --minimise peak_force_N --runs 2 -o again.yaml
    expect 0 check again.yaml
    rm again.yaml
done

nothing_failed
