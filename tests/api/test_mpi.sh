#!/bin/bash
# A sweep under mpirun gives the rows that one process gives, whatever the number of ranks, also when
# a rank was killed on the way and the same command goes on; so does robust.
#
#   test_mpi.sh PROGRAM PROGRAM_OF_MPI
set -euo pipefail
lab_mpi=$(readlink -f "$2" 2>/dev/null || :)
if [ ! -x "$lab_mpi" ] || ! command -v mpirun >/dev/null; then
    echo "skipped: mpirun or impactlab-mpi is missing (Debian: libopenmpi-dev, openmpi-bin)"
    exit 77
fi
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../expect.sh"
lab=$program
work=$folder
# whoever runs the tests, and however few processors there are
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_btl=self,vader,tcp TMPDIR=$work
together() {
    local ranks=$1
    shift
    timeout 1000 mpirun -n "$ranks" "$lab_mpi" "$@" >said 2>&1
}

# the rows, in the file and in the database, but for the times
rows() {
    python3 - "$1" <<'END'
import sqlite3, sys
db = sqlite3.connect(sys.argv[1])
rows = db.execute("SELECT * FROM run ORDER BY run")
keep = [i for i, c in enumerate(rows.description) if "time_s" not in c[0] or "cpu" not in c[0] and "wall" not in c[0]]
for row in rows:
    print([row[i] for i in keep])
print(db.execute("SELECT * FROM sweep ORDER BY key").fetchall())
END
}

sweep=(sweep corrected/first-impact --vary motor.voltage=1:5:13 --vary arm.k2=4:8:7 --vary wall.kind=point,plane)
"$lab" "${sweep[@]}" --db one.sqlite --csv one.csv --quiet
rows one.sqlite >one.rows
for ranks in 1 2 3; do
    together $ranks "${sweep[@]}" --db "$ranks.sqlite" --csv "$ranks.csv" || fail "$ranks ranks: $(cat said)"
    cmp -s one.csv "$ranks.csv" || fail "$ranks ranks give other rows"
    rows "$ranks.sqlite" | cmp -s - one.rows || fail "$ranks ranks: another database"
done

# what was there is not computed again, and a part is as it is for one
cp one.sqlite half.sqlite
python3 -c 'import sqlite3; d = sqlite3.connect("half.sqlite"); d.execute("DELETE FROM run WHERE run % 7 = 3"); d.commit()'
together 3 "${sweep[@]}" --db half.sqlite --csv half.csv || fail "half a sweep: $(cat said)"
cmp -s one.csv half.csv || fail "a sweep that goes on has other rows"
for part in 1 2; do
    together 2 "${sweep[@]}" --part $part/2 --db "part$part.sqlite" || fail "a part: $(cat said)"
done
"$lab" merge part2.sqlite part1.sqlite -o merged.sqlite >/dev/null
rows merged.sqlite | cmp -s - one.rows || fail "parts make another database"

# a rank is killed on the way; the same command goes on
runs=96
heavy=(sweep corrected/twenty-links --set run.duration=1 --vary motor.voltage=1:3:$runs)
count() {
    python3 -c 'import sqlite3; print(sqlite3.connect("killed.sqlite").execute("SELECT count(*) FROM run").fetchone()[0])'
}

# kills rank 2 as soon as there is a row
kill_on_the_way() {
    rm -f killed.sqlite*
    timeout 1000 mpirun -n 3 "$lab_mpi" "${heavy[@]}" --db killed.sqlite >said 2>&1 &
    local mpi=$!
    python3 - "$work" "$(basename -- "$lab_mpi")" $runs <<'END'
import os, pathlib, signal, sqlite3, sys, time

def rows():
    try:
        with sqlite3.connect("file:killed.sqlite?mode=ro", uri=True) as db:
            return db.execute("SELECT count(*) FROM run").fetchone()[0]
    except sqlite3.Error:
        return 0

def kill_rank_two():
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if (os.readlink(process / "cwd") == sys.argv[1]
                    and (process / "comm").read_text().strip() == sys.argv[2][:15]
                    and b"\0OMPI_COMM_WORLD_RANK=2\0" in (process / "environ").read_bytes()):
                os.kill(int(process.name), signal.SIGKILL)
                return True
        except OSError:
            pass

end = time.monotonic() + 120
while (rows() < 1 or not kill_rank_two()) and rows() < int(sys.argv[3]) and time.monotonic() < end:
    time.sleep(0.02)
END
    status=0
    wait "$mpi" || status=$?
    there=$(count)
}

# where the ranks were through before the eye saw it, once more
for _ in 1 2 3; do
    kill_on_the_way
    [ "$there" = $runs ] || break
done
[ "$status" != 0 ] || fail "a killed rank went unnoticed"
[ "$there" -gt 0 ] && [ "$there" -lt $runs ] || fail "$there of $runs rows are there after the kill"
together 3 "${heavy[@]}" --db killed.sqlite --csv killed.csv || fail "it does not go on: $(cat said)"
grep -q "were there already" said || fail "what was there is computed again: $(cat said)"
"$lab" "${heavy[@]}" --csv whole.csv --quiet
cmp -s killed.csv whole.csv || fail "after a kill the rows are others"

# laws over a set
robust=(robust corrected/first-impact --laws hybrid,force-pd --runs 6)
"$lab" "${robust[@]}" --csv one-robust.csv --quiet
together 3 "${robust[@]}" --csv three-robust.csv --quiet || fail "robust: $(cat said)"
cmp -s one-robust.csv three-robust.csv || fail "robust is another under mpirun"

# what is wrong is said once and ends all ranks; other commands run once
together 3 sweep corrected/first-impact --vary motor.voltage=1:5 && fail "a bad sweep runs"
[ "$(grep -c '^impactlab:' said)" = 1 ] || fail "a fault is not said once: $(cat said)"
together 3 run corrected/first-impact --quiet --json - || fail "run: $(cat said)"
[ "$(grep -c peak_force_N said)" = 1 ] || fail "another command runs on every rank"

# ranks that have different things in mind are refused
cat >two.sh <<END
#!/bin/sh
cd "$work" && mkdir -p "r\$OMPI_COMM_WORLD_RANK" && cd "r\$OMPI_COMM_WORLD_RANK"
printf 'title: mine\nmotor: {voltage: %s V}\n' "\$((OMPI_COMM_WORLD_RANK + 1))" >mine.yaml
exec "$lab_mpi" sweep mine.yaml --vary wall.angle=0,0.1 --quiet
END
timeout 1000 mpirun -n 2 sh two.sh >said 2>&1 && fail "two different sweeps are one"
grep -q 'rank 1 has other work than rank 0' said || fail "different work is not told: $(cat said)"

nothing_failed && echo "as many ranks as one likes give the same rows"
