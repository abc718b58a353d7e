#!/bin/bash
# Tables for other programs: run --parquet and --mat beside --csv, --every, --columns; sweep --parquet.
# $1: the program, $2: the project's folder
set -u
root=$(readlink -f "$2")
readers=$root/tests/tables/readers.py
python=$(command -v /usr/bin/python3 || command -v python3) # scipy is a package of the system's
. "$(dirname "$0")/expect.sh"

alike() {
    "$python" "$readers" "$@" >out 2>err || fail "the tables differ: $*"
}

# every kind of arm: a law with sensors, a wall that gives, links with angles of their own, the printed
# one, which has no energies; more rows than a block of MAT holds
while read -r name changes; do
    # shellcheck disable=SC2086
    expect 0 run "$name" $changes --csv a.csv --parquet a.parquet --mat a.mat --quiet
    alike a.csv a.parquet a.mat
    # shellcheck disable=SC2086
    expect 0 run "$name" $changes --csv b.csv --parquet b.parquet --mat b.mat --every 0.0007 --quiet
    alike b.csv b.parquet b.mat
    "$python" - b.csv <<'END' || fail "$name: rows every 0.7 ms are not at their instants, once each"
import csv, sys
times = [float(row[0]) for row in list(csv.reader(open(sys.argv[1])))[1:]]
assert len(times) > 100 and times == [i * 0.0007 for i in range(len(times))]
END
done <<'END'
compare/hybrid --set sensor.film=true --set sensor.piezo=true
corrected/first-impact --set method.step=2e-5
corrected/wall-with-a-face
corrected/five-links --set arm.tilt=0.1
thesis/fig-3-4
END

# a header of two bytes, and no character lost on the way
printf 'title: "Größe θ, 5 µm"\nwall: {kind: plane}\n' >named.yaml
expect 0 run named.yaml --csv a.csv --parquet a.parquet --mat a.mat --quiet
alike a.csv a.parquet a.mat
grep -q 'Größe θ, 5 µm' a.parquet || fail "the title is not in the notes"

# a bare scenario comes back out of the notes
"$python" - "$readers" a.parquet >again.yaml <<'END'
import runpy, sys
print(runpy.run_path(sys.argv[1])["read_parquet"](sys.argv[2])[1]["impactlab.scenario"], end="")
END
expect 0 run again.yaml --parquet again.parquet --quiet
cmp -s a.parquet again.parquet || fail "the scenario in the notes is another one"

# chosen columns, in their order, in all files and beside what wants every row
expect 0 run compare/hybrid --columns force,time,command --every 0.001 --csv a.csv --parquet a.parquet --mat a.mat \
    --json a.json --plot a.svg --quiet
alike a.csv a.parquet a.mat
[ "$(head -n 1 a.csv)" = 'force[N],time[s],command[V]' ] || fail "the columns are $(head -n 1 a.csv)"
expect 0 run compare/hybrid --columns force,time,command --every 0.001 --csv - --quiet
cmp -s out a.csv || fail "a picture changes the rows of a table"
expect 0 run compare/hybrid --csv all.csv --plot all.svg --quiet
for ms in 0 0.1 0.25 0.5; do
    grid=$(awk -F, -v t=$ms '$2 == t { print $1 }' a.csv)
    own=$(awk -F, -v t=$ms 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "force[N]") c = i }
        $1 == t { f = $c } END { print f }' all.csv)
    [ -n "$grid" ] && [ "$grid" = "$own" ] || fail "at $ms s the grid has the force '$grid', the run '$own'"
done

# to the standard output
for kind in parquet mat; do
    expect 0 run named.yaml --$kind file.$kind --quiet
    expect 0 run named.yaml --$kind -
    cmp -s out file.$kind || fail "--$kind - writes something else than --$kind FILE"
    on_terminal "$program" run named.yaml --$kind -
    grep -q 'the standard output is a terminal' seen || fail "--$kind - writes to a terminal"
done

# what cannot be written is said, and leaves what was there
for kind in csv parquet mat; do
    expect 1 run named.yaml --$kind /dev/full --quiet
    says err "No space left on device"
    echo kept >old
    expect 1 run named.yaml --$kind /dev/full --json old.json --quiet
    [ -s old.json ] || fail "--json is not written beside --$kind /dev/full"
done
expect 1 run named.yaml --parquet nowhere/a.parquet
says err "nowhere/a.parquet"
expect 2 run named.yaml --parquet named.yaml
says err named.yaml
expect 2 run named.yaml --parquet same --mat same
says err "two results cannot both be written to same"
expect 2 run named.yaml --parquet - --csv -
says err "the standard output"
grep -q Größe named.yaml || fail "the scenario was overwritten"
expect 0 run compare/hybrid --csv recorded.csv --quiet
expect 2 run compare/hybrid --set control.law=playback --set control.playback_file=recorded.csv \
    --set control.playback_column=command --mat recorded.csv
says err recorded.csv
[ "$(head -c 7 recorded.csv)" = 'time[s]' ] || fail "the recording was overwritten"

# requests that ask for nothing there is
expect 2 run named.yaml --every 0.001
says err "none of them is asked for"
expect 2 run named.yaml --columns time
says err "none of them is asked for"
expect 2 run named.yaml --csv x.csv --columns forc
says err "--columns forc: there is no column 'forc', did you mean 'force'?"
expect 2 run named.yaml --csv x.csv --columns ''
says err "a name is missing"
expect 2 run named.yaml --csv x.csv --columns piezo_force
says err "no values of 'piezo_force'"
expect 2 run named.yaml --csv x.csv --every 0
expect 2 run named.yaml --csv x.csv --every often
[ ! -e x.csv ] || fail "a refused request leaves a file"

# a run that fails keeps its rows in whole files
expect 1 run corrected/five-links --set method.name=newmark --set method.step=0.02 --set motor.voltage=100 \
    --csv a.csv --parquet a.parquet --mat a.mat --quiet
says err failed
alike a.csv a.parquet a.mat

# a run refused before its first row leaves a table of no rows
printf 'title: T\narm: {model: printed}\nscript:\n  - {at: 0.1 s, push: 0.1 N s}\n' >refused.yaml
expect 2 run refused.yaml --csv a.csv --parquet a.parquet --mat a.mat --quiet
alike a.csv a.parquet a.mat

# a sweep: words, whole numbers, failures, quantities that did not occur, values without effect; and its
# parts in one folder, from memory or from a database, are the same table
for vary in "--vary method.name=event,newmark --vary motor.voltage=0,1,2 --vary arm.links=2,3" \
    "--vary wall.contact=rigid,kelvin-voigt --vary wall.stiffness=1e4,2e4" \
    "--set method.name=newmark --set method.step=0.02 --vary motor.voltage=1:10:5"; do
    rm -rf parts part.sqlite
    mkdir parts
    expect 0 sweep corrected/first-impact $vary --csv rows.csv --json rows.json --parquet rows.parquet --quiet
    alike --rows rows.csv rows.parquet
    for part in 1 2 3; do
        db=
        [ $part != 2 ] || db="--db part.sqlite"
        expect 0 sweep corrected/first-impact $vary --part $part/3 --parquet parts/$part.parquet $db
        says out "part $part of 3"
    done
    alike --rows rows.csv parts/*.parquet
done
expect 2 sweep corrected/first-impact --vary motor.voltage=1,2 --part 1/2
says err "expected --db FILE.sqlite or --parquet FILE.parquet"
expect 2 sweep corrected/first-impact --vary motor.voltage=1,2 --part 1/2 --parquet parts/1.parquet --csv x.csv
says err "is not the whole sweep"
expect 0 sweep corrected/first-impact --vary motor.voltage=1,2 --part 1/2 --parquet -
[ "$(head -c 4 out)$(tail -c 4 out)" = PAR1PAR1 ] || fail "a part on the standard output is no Parquet file"
expect 1 sweep corrected/first-impact --vary motor.voltage=1,2 --parquet /dev/full --quiet
says err "No space left on device"
cp "$root/scenarios/corrected/first-impact.yaml" mine.yaml
expect 2 sweep mine.yaml --vary motor.voltage=1,2 --parquet mine.yaml
cmp -s mine.yaml "$root/scenarios/corrected/first-impact.yaml" || fail "a sweep replaces its scenario"

# memory does not grow with rows: half a million take no more than a thousand, by some megabytes of buffers
most() {
    "$python" - "$program" "$@" <<'END'
import resource, subprocess, sys
subprocess.run([*sys.argv[1:], "--quiet"], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
END
}
for kind in csv parquet mat; do
    few=$(most run corrected/first-impact --set method.step=1e-3 --$kind few)
    many=$(most run corrected/first-impact --set method.step=2e-6 --columns time,force,gap --$kind many)
    [ $((many - few)) -lt 16000 ] || fail "--$kind of half a million rows takes $many kB, of a thousand $few kB"
    rm -f few many
done
nothing_failed
