#!/bin/bash
# What a sweep takes on 1, 2 and 4 ranks of MPI, and whether its rows are those of one process. (That
# they are so after a rank was killed, tests/api/test_mpi.sh shows.)
#
#   tests/bench/ranks.sh [BUILD-FOLDER [RUNS]]
#
# BUILD-FOLDER (build) holds impactlab and impactlab-mpi; RUNS (10000) are of four links, some
# milliseconds each. Nothing of the test suite needs this.
set -euo pipefail
root=$(readlink -f -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")
build=$(readlink -f -- "${1:-$root/build}")
runs=${2:-10000}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
TIMEFORMAT='%U %S %R'

if [ ! -x "$build/impactlab-mpi" ] || ! command -v mpirun >/dev/null; then
    echo "ranks: no mpirun or no $build/impactlab-mpi (packages libopenmpi-dev, openmpi-bin)" >&2
    exit 1
fi
what=(sweep corrected/first-impact --set arm.links=4 --vary "motor.voltage=0.5:5:$runs" --quiet)

# on_ranks N ARGUMENT...: the sweep on so many ranks, whatever the number of processors
on_ranks() {
    mpirun --oversubscribe -n "$1" "$build/impactlab-mpi" "${what[@]}" "${@:2}"
}

# rows_of FILE: everything but what the clock says
rows_of() {
    "$build/impactlab" "${what[@]}" --db "$1" --csv - | sha256sum
}

# row LABEL FILE COMMAND...: a line of the table
row() {
    local user system wall same=
    read -r user system wall < <({ time "${@:3}" >/dev/null 2>"$work/said"; } 2>&1)
    if [ ! -e "$2" ]; then
        cat "$work/said" >&2
        exit 1
    fi
    if [ "$2" != one.sqlite ]; then
        same=DIFFERENT
        if [ "$(rows_of one.sqlite)" = "$(rows_of "$2")" ]; then
            same='the same'
        fi
    fi
    awk -v l="$1" -v u="$user" -v s="$system" -v w="$wall" -v r="$same" \
        'BEGIN { printf "| %s | %.1f | %.1f | %s |\n", l, u + s, w, r }'
}

echo "| ranks | processor time of all ranks and of MPI's start [s] | by the clock [s] | rows |"
echo '|---|---|---|---|'
row '1 (one thread)' one.sqlite "$build/impactlab" "${what[@]}" --jobs 1 --db one.sqlite
row 2 two.sqlite on_ranks 2 --db two.sqlite
row 4 four.sqlite on_ranks 4 --db four.sqlite
