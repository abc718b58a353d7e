#!/usr/bin/python3
"""A sweep in parts, by the workers of a Dask cluster, merged into one database:

    sweep_on_dask.py ADDRESS PARTS OUTPUT.sqlite SCENARIO --vary ... (as impactlab sweep takes them)

ADDRESS is that of the scheduler, PARTS a number well above that of the workers' threads: a part takes
some seconds. The workers have the same `impactlab` on their paths. Where one dies, another computes its
part. Parts that came in lie in OUTPUT.sqlite.parts, from where the same command goes on.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

from distributed import Client, as_completed


def compute(part: str, sweep: list[str]) -> bytes:
    """The database of part "K/N" of a sweep; by a worker."""
    with tempfile.TemporaryDirectory() as folder:
        database = Path(folder, "part.sqlite")
        options = ["--part", part, "--db", str(database), "--jobs", "1", "--quiet"]

        # a part of failed runs alone says so once, and has nothing to compute the second time
        for _ in range(2):
            done = subprocess.run(["impactlab", "sweep", *sweep, *options], capture_output=True, text=True)
            if done.returncode == 0:
                return database.read_bytes()
        raise RuntimeError(done.stderr)


def main(address: str, parts: int, output: str, sweep: list[str]) -> int:
    """Has the missing parts computed, keeps each as it comes in, and merges all."""
    folder = Path(output + ".parts")
    folder.mkdir(exist_ok=True)
    files = [folder / f"{k}.sqlite" for k in range(1, parts + 1)]
    with Client(address) as client:
        missing = [k for k, file in enumerate(files) if not file.exists()]
        futures = client.map(lambda k: (k, compute(f"{k + 1}/{parts}", sweep)), missing, pure=False)
        for _, (k, database) in as_completed(futures, with_results=True):
            files[k].with_suffix(".new").write_bytes(database)
            files[k].with_suffix(".new").rename(files[k])
    return subprocess.run(["impactlab", "merge", *files, "-o", output]).returncode


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    try:
        sys.exit(main(sys.argv[1], int(sys.argv[2]), sys.argv[3], sys.argv[4:]))
    except (RuntimeError, OSError) as error:  # what a part, or the cluster, says
        sys.exit(str(error))
