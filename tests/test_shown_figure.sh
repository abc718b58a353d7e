#!/bin/bash
# What the lab saves is what it shows, and its recipes make it again: every combination of runs, data,
# bounds, views and sweeps is saved, drawn again by the program from the recipe alone, and compared to
# the byte; the numbers that are drawn are those of runs that the program makes by itself.
#
#   test_shown_figure.sh PROGRAM
set -u
# shellcheck source=tests/expect.sh
. "$(dirname "$0")/expect.sh" "$1"

# saved NAME PICTURES LINE...: a lab that carries out the lines and saves; each picture that is there
# comes again from its recipe
saved() {
    local name=$1 wanted=$2 count=0
    shift 2
    printf '%s\n' "$@" "save $name" >script
    expect 0 lab --script script --quiet
    for picture in "${name%.*}".??? "${name%.*}"-?.???; do
        [ -e "$picture" ] || continue
        count=$((count + 1))
        expect 0 plot "${picture%.*}.yaml" -o again/"$picture"
        cmp "$picture" "again/$picture" || fail "$picture is not what its recipe gives"
    done
    [ "$count" = "$wanted" ] || fail "$name: $count pictures, expected $wanted"
}

mkdir again
expect 0 run compare/hybrid --set arm.k2=5.5 --quiet --csv bench.csv

# one run as it is; from another folder, too
saved plain.png 1
mkdir elsewhere
(cd elsewhere && expect 0 plot ../plain.yaml -o plain.png)
cmp plain.png elsewhere/plain.png || fail "the recipe's folder changes the picture"

# the arm at the cursor stands above the panels, and of a law its modes below them
grep -q "^arm: 0" plain.yaml || fail "plain.yaml has no arm"
sed "s/^arm: .*/arm: 0.9/" plain.yaml >moved.yaml
sed "/^arm: /d" plain.yaml >armless.yaml
expect 0 plot moved.yaml -o moved.png
expect 0 plot armless.yaml -o armless.png
cmp -s plain.png moved.png && fail "the arm does not move"
cmp -s plain.png armless.png && fail "there is no arm"
saved law.png 1 'open compare/hybrid' 'seek 0.4'
grep -q "^arm: 0.4" law.yaml || fail "the arm is not at the cursor"
grep -q "controller_mode.*label: \"impact\"" law.yaml || fail "law.yaml names no modes"

# the range is that of the screen, which a reading's spike of 5 N and a limit of 10 V do not set
grep "force_reading" law.yaml | grep -q "range: \[0, 1[.]" || fail "law.yaml: a spike sets the range"
grep -qF "command +/-5 %" law.yaml || fail "law.yaml has no band"
grep -q "voltage_limit" law.yaml && fail "law.yaml: a limit beyond the pane sets the range"

# a run that was just kept is drawn once
saved kept.png 1 'set motor.voltage 0.5' 'pin half'
[ "$(grep -c "  - name: run" kept.yaml)" = 2 ] || fail "kept.yaml: the run is not drawn once"
grep -q 'label: "half"' kept.yaml || fail "kept.yaml: the run has lost its name"

# changes from the start and in time, pushes, names, bounds, notes, hidden runs, zoom, views
saved all.pdf 3 'set motor.voltage 0.5' branch 'seek 0.3' 'set motor.voltage 2' 'push 0.02' 'pin "zwei": <&> \' \
    'set arm.k2 6' 'limit force 1.2' 'zoom 0.2 0.6' 'note @0.4 a < b & "q"' 'mark 0.35' 'seek 0.5' \
    'phase force gap' 'spectrum hub_velocity' 'trace force - 2*voltage' 'signal last_velocity 3' 'axis 0 3 1'

# measured data, residuals, other runs
saved data.svg 1 'open compare/hybrid' branch 'set control.force 0.5' 'data bench.csv' 'residual force_reading' \
    'zoom 0.2 0.9' 'limit force 1.2'
saved shifted.png 1 'open compare/hybrid' 'data bench.csv@0.05' 'axis fixed 1'
saved difference.png 1 'open compare/hybrid' branch 'set control.force 0.5' 'difference 0.1'

# sweeps: curves and their quantity, and a map
saved sweep.png 2 'open compare/hybrid' 'set control.force 0.5' 'sweep arm.k2=4:6:3'
saved map.png 2 'sweep motor.voltage=0.5:1:3 arm.k2=4:6:2' 'metric peak_force_N'

# what is drawn: the peaks of both runs, the data's largest reading at its shifted instant, a map's cells
expect 0 plot data.yaml -o d.png
expect 0 run compare/hybrid --quiet --json default.json
expect 0 run compare/hybrid --set control.force=0.5 --quiet --json half.json
expect 0 plot all.yaml -o a.png
expect 0 plot map-2.yaml -o m.png
expect 0 run corrected/first-impact --set motor.voltage=0.5 --set arm.k2=6 --quiet --json cell.json
expect 0 plot all-3.yaml -o s.png
python3 - <<'END' || fail "the numbers that are drawn are not those of the runs"
import csv, json, re
def curve(path, panel, series):
    return [(float(r[2]), float(r[3])) for r in csv.reader(open(path)) if r[:2] == [panel, series] and r[2] and r[3]]
def near(a, b, within=1e-9): assert abs(a - b) <= within * max(1, abs(b)), (a, b)
peak = lambda path: json.load(open(path))["peak_force_N"]
near(max(y for _, y in curve("d.csv", "force[N]", "run 1 force")), peak("half.json"))
near(max(y for _, y in curve("d.csv", "force[N]", "run 2 force")), peak("default.json"))
shift = float(re.search(r"shift: ([-+.e0-9]+)", open("data.yaml").read())[1])
rows = list(csv.DictReader(open("bench.csv")))
measured = max(((float(r["force_reading[N]"]), float(r["time[s]"])) for r in rows if r["force_reading[N]"]))
drawn = curve("d.csv", "force_reading[N]", "data force_reading")
near(max(y for _, y in drawn), measured[0])
assert any(abs(x - measured[1] - shift) < 1e-12 and y == measured[0] for x, y in drawn)
cells = {(x, z): y for x, z, y in ((float(r[2]), float(r[3]), float(r[4])) for r in csv.reader(open("m.csv")) if r[1] == "map")}
near(cells[0.5, 6], peak("cell.json"))
# the expression is what it says, and the note stands where it was put
force = dict(curve("a.csv", "force[N]", "run 1 force"))
run = [(x, y) for x, y in curve("a.csv", "force-2*voltage", "run 1 force-2*voltage") if x < 0.3 and x in force]
assert run and all(abs(y - force[x] + 2 * 0.5) < 1e-12 for x, y in run)
assert ["mark", 'a < b & "q"', "0.4", ""] in [r for r in csv.reader(open("a.csv"))]
# so do the mark and the cursor
assert {("mark", "0.35"), ("+0.15 s", "0.5")} <= {(r[1], r[2]) for r in csv.reader(open("a.csv")) if r[:1] == ["mark"]}
# amplitudes begin at one period of the stretch
assert min(x for x, _ in curve("s.csv", "hub_velocity[rad/s]", "run 1 hub_velocity")) > 0
END

# what is there stays: a scenario of the same name, a picture, its recipe
printf '%s\n' 'save mine.yaml' 'save mine.png' >script
expect 0 lab --script script --quiet
expect 0 check mine.yaml
expect 0 plot mine.png.yaml -o again/mine.png
cmp mine.png again/mine.png || fail "mine.png"
printf '%s\n' 'save plain.png' >script
expect 1 lab --script script --quiet
says err "is there already"
printf '%s\n' 'set motor.voltage 2' 'save! plain.png 85' >script
expect 0 lab --script script --quiet
expect 0 plot plain.yaml -o again/plain.png
cmp plain.png again/plain.png || fail "plain.png, replaced"
says plain.yaml "width: 85"

# what no picture can show is said, and nothing is written
printf '%s\n' 'panes' 'save none.png' >script
expect 1 lab --script script --quiet
nothing_failed
