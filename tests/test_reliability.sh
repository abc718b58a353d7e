#!/bin/bash
# What must not happen when something goes wrong outside the program: a broken file that is called
# done, a terminal that obeys a stranger's file, a mistake that passes for a result.
# $1: the program
#
# Each case was found in a program that did it; the test fails there.
set -u
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/expect.sh"

# true if a file holds characters that a terminal obeys (C0 but line feeds, C1) or that turn the
# direction of text
holds_controls() {
    LC_ALL=C grep -qP '[\x00-\x09\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80[\x8e\x8f\xa8-\xae]|\xe2\x81[\xa6-\xa9]|\xd8\x9c' "$1"
}

# --- films: ffmpeg may complain and yet end well, leave nothing, or hang
mkdir bin
cat >bin/ffmpeg <<'END'
#!/bin/sh
cat >/dev/null
for last; do :; done
echo broken >"${last#file:}"
echo "av_interleaved_write_frame(): No space left on device" >&2
END
chmod +x bin/ffmpeg
film="corrected/first-impact --size 320x240 --fps 2 --seconds 1 --gl cairo -o film.mp4"
echo old >film.mp4
# shellcheck disable=SC2086
PATH=$folder/bin:$PATH expect 1 animate $film
says err "No space left on device"
[ "$(cat film.mp4)" = old ] || fail "a film that could not be made replaces the one before"
printf '#!/bin/sh\ncat >/dev/null\n' >bin/ffmpeg
# shellcheck disable=SC2086
PATH=$folder/bin:$PATH expect 1 animate $film
[ "$(cat film.mp4)" = old ] || fail "an empty film replaces the one before"
printf '#!/bin/sh\ntouch started\ncat >/dev/null\nexec sleep 1000\n' >bin/ffmpeg
for name in INT TERM; do
    rm -f started
    # a job of its own, whose signals nobody ignores
    # shellcheck disable=SC2086
    (set -m; PATH=$folder/bin:$PATH exec "$program" animate $film >out 2>err) &
    job=$!
    for ((i = 0; i < 6000; i++)); do [ ! -e started ] || break; sleep 0.02; done
    sleep 0.5
    kill -s "$name" $job
    for ((i = 0; i < 1000; i++)); do kill -0 $job 2>/dev/null || break; sleep 0.02; done
    kill -9 $job 2>/dev/null && fail "SIG$name does not end a film whose ffmpeg hangs"
    wait $job 2>/dev/null
    [ "$(cat film.mp4)" = old ] || fail "a film that was ended replaces the one before"
done
rm -rf bin film.mp4

# --- texts from outside: every way out filters what a terminal would obey
esc=$'\033' c1=$'\302\233' bidi=$'\342\200\256'
cat >hostile.yaml <<'END'
title: "a \u202Eevil\u2066 title"
description: "b\u202E"
run: {duration: 0.3 s}
END
cat >refused.yaml <<'END'
title: "a\e]0;owned\a \x9b31m title"
END
cp hostile.yaml "h${esc}[31m${c1}5n${bidi}x.yaml"
for call in "run hostile.yaml" "show hostile.yaml" "modes hostile.yaml" "list" "check hostile.yaml" \
    "check refused.yaml" "run refused.yaml" "list"     "predict hostile.yaml" "sweep hostile.yaml --vary motor.voltage=1,2" \
    "compare hostile.yaml --columns peak_force_N" "run hostile.yaml --set a${esc}[31m=1" \
    "run hostile.yaml --set motor.voltage=1${bidi}" "run ${esc}[31m${c1}" \
    "run hostile.yaml --json no/such${esc}[1m/x" "${esc}[7m" "run --${esc}[7m" \
    "plot ${c1}.yaml" "lab hostile.yaml --size 100x30 --keys ${esc}" \
    "sweep hostile.yaml --vary motor.voltage=1,2 --db ${bidi}/x.sqlite" \
    "run hostile.yaml --overlay ${c1}.csv --plot p.svg"; do
    # shellcheck disable=SC2086
    "$program" $call >out 2>err </dev/null
    for file in out err; do
        holds_controls $file && fail "control characters in $file of: $(printf %q "$call")"
    done
done
for file in h?*31m*.yaml; do
    "$program" run "$file" >out 2>err </dev/null
    holds_controls out && fail "control characters of a file's name in out"
    "$program" run "$file" --set x=1 >out 2>err </dev/null
    holds_controls err && fail "control characters of a file's name in err"
done
expect 0 run hostile.yaml --quiet --plot hostile.svg --csv hostile.csv
holds_controls hostile.svg && fail "control characters in an SVG"
printf 'time[s],force[N],na%sme\n0,1,%s\n1,%s\n' "$esc" "$esc[2J" "$bidi" >overlay.csv
"$program" run hostile.yaml --quiet --overlay overlay.csv --plot o.svg >out 2>err
printf 'time[s],force[N]\n0,%s\n' "$esc[2J" >overlay.csv
expect 2 run hostile.yaml --quiet --overlay overlay.csv --plot o.svg
holds_controls err && fail "control characters of an overlay's cell in err"

# --- an overlay that lays nothing over anything is a mistake
: >overlay.csv
expect 2 run corrected/first-impact --quiet --overlay overlay.csv --plot o.svg
says err "0 rows below the headings"
for rows in "" "1,\n2,\n" ",3\n" "nan,1\n"; do
    # shellcheck disable=SC2059
    printf "time[s],force[N]\n$rows" >overlay.csv
    expect 2 run corrected/first-impact --quiet --overlay overlay.csv --plot o.svg
    says err "overlay.csv:"
done

# --- databases from elsewhere: no code of theirs runs, and what is no row of a sweep is refused
if command -v sqlite3 >/dev/null; then
    sweep="sweep hostile.yaml --vary motor.voltage=1:2:3 --quiet --db"
    # shellcheck disable=SC2086
    expect 0 $sweep own.sqlite
    lines=$(sqlite3 own.sqlite "SELECT count(*) FROM sweep")

    # a trigger that would forget what the sweep is
    cp own.sqlite trigger.sqlite
    sqlite3 trigger.sqlite "DELETE FROM run WHERE run = 2;
        CREATE TRIGGER t AFTER INSERT ON run BEGIN DELETE FROM sweep; END"
    # shellcheck disable=SC2086
    expect 0 $sweep trigger.sqlite
    [ "$(sqlite3 trigger.sqlite "SELECT count(*) FROM sweep")" = "$lines" ] || fail "a trigger of a database ran"

    # a row without a status, a view for a table, a column less
    cp own.sqlite null.sqlite
    sqlite3 null.sqlite "ALTER TABLE run RENAME TO was; CREATE TABLE run AS SELECT * FROM was;
        UPDATE run SET status = NULL WHERE run = 2; DROP TABLE was"
    cp own.sqlite view.sqlite
    sqlite3 view.sqlite "ALTER TABLE run RENAME TO was; CREATE VIEW run AS SELECT * FROM was"
    cp own.sqlite column.sqlite
    sqlite3 column.sqlite "ALTER TABLE run DROP COLUMN peak_force_N"
    for database in null view column; do
        # shellcheck disable=SC2086
        expect 2 $sweep $database.sqlite --csv rows.csv
        says err "'$database.sqlite'"
        [ ! -e rows.csv ] || fail "rows were taken from $database.sqlite"
    done
fi

# --- a command that fails among keys ends the program so
expect 1 lab corrected/first-impact --size 100x30 --keys ':sat motor.voltage 2<Enter>:seek 0.1<Enter>'
says err "there is no command 'sat'"
expect 0 lab corrected/first-impact --size 100x30 --keys ':seek 0.1<Enter>'
expect 2 lab corrected/first-impact --size 100x30 --keys '<Nonsense>'

# --- a limit of zero volts converts to zero, not to what a processor makes of "not a number"
expect 0 run compare/hybrid --set motor.voltage_limit=0 --set run.duration=0.2 --json zero.json --quiet
grep -q '"motor_work_J": 0[,.]' zero.json || grep -q '"motor_work_J": 0$' zero.json ||
    fail "a motor without voltage works: $(grep motor_work zero.json)"

# --- a file too large, or a full disk, is called that for every kind of picture
for picture in p.svg p.pdf p.png; do
    echo old >$picture
    (
        trap '' XFSZ
        ulimit -S -f 2 # of 1024 bytes
        "$program" run corrected/first-impact --quiet --plot $picture 2>err
    )
    status=$?
    [ $status = 1 ] || fail "$picture beyond the limit: status $status"
    says err "File too large"
    [ "$(cat $picture)" = old ] || fail "$picture was replaced by half a picture"
done

# --- a link of somebody else's in a folder like /tmp is not followed
if [ "$(id -u)" = 0 ]; then
    mkdir -m 1777 shared
    ln -s "$folder/victim" shared/result.json
    chown -h 12345:12345 shared/result.json
    "$program" run corrected/first-impact --quiet --json shared/result.json 2>err
    [ ! -e victim ] || fail "a stranger's link was followed"
fi

[ -z "$(find . -name '*.part')" ] || fail "a temporary file stayed behind"
nothing_failed
