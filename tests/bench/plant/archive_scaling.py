#!/usr/bin/python3
"""Scaling of node/examples/archive.py: with one local process, with two, and with two of which one is killed.

    PALPATE_SOURCE=$PWD PALPATE_BUILD=$PWD/build/strict \\
      PYTHONPATH=$PWD/tests/support:$PWD/build/strict/node/python:$PWD/build/strict/proto/python \\
      /usr/bin/python3 tests/bench/plant/archive_scaling.py [--strokes N]

Each object is one stroke of 30 noisy samples of a circle's arc; a CSV file has a thousand of them. The scaling is that of
the time between the first and the last task, without the start of the processes. For comparison it prints the scaling of
two independent processes that do the same work on this machine.
"""
import argparse
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

from programs import SOURCE

sys.path.insert(0, str(SOURCE / "tests/python"))
from archive_test import ARCHIVE, Archive, write_csv  # noqa: E402

STROKES_PER_FILE = 1000


def run(folder, files, workers, kill=False):
    out = folder / f"{workers}{'-killed' if kill else ''}.csv"
    process = subprocess.Popen([sys.executable, ARCHIVE, "--out", out, "--workers", str(workers), *files],
                               stderr=subprocess.PIPE, text=True)
    if kill:
        Archive().kill_a_worker(process, out.with_suffix(".csv.parts"))
    said = process.communicate()[1]
    assert process.returncode == 0, said
    answers, rate = re.findall(r"(\d+) answers, (\d+) a second", said)[-1]
    print(f"{workers} worker(s){', one killed' if kill else ''}: {answers} rows, {rate} a second", flush=True)
    return out.read_text(), float(rate), said


def plain_scaling(file, rounds=5):
    """Scaling from one process to two independent ones that do the same work without Dask."""
    code = (f"import sys; sys.path.insert(0, {str(ARCHIVE.parent)!r}); import archive, time; path = sys.argv[1];"
            "work = lambda: archive.rows_of(path, archive.deal(path, 1)[0], 0.0);"
            "work(); print(flush=True); input(); begin = time.monotonic(); [work() for _ in range(3)];"
            "print(time.monotonic() - begin)")

    def seconds(count):
        processes = [subprocess.Popen([sys.executable, "-c", code, file], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
                     for _ in range(count)]
        for process in processes:
            process.stdout.readline()
        for process in processes:  # all are ready: now
            process.stdin.write("\n")
            process.stdin.flush()
        return max(float(process.communicate()[0]) for process in processes)

    return statistics.median(2 * seconds(1) / seconds(2) for _ in range(rounds))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--strokes", type=int, default=100_000)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        files = []
        for number in range(options.strokes // STROKES_PER_FILE):
            files.append(folder / f"{number:04d}.csv")
            write_csv(files[-1], STROKES_PER_FILE, seed=number)
        machine = plain_scaling(files[0])
        start = time.monotonic()
        one, one_rate, _ = run(folder, files, 1)
        two, two_rate, _ = run(folder, files, 2)
        killed, _, said = run(folder, files, 2, kill=True)
        assert one == two == killed, "the rows differ"
        assert one.count("\n") == 1 + options.strokes
        print(f"{options.strokes} strokes: the same rows of all three runs; {two_rate / one_rate:.2f} times as fast with two workers, "
              f"where this machine gives two processes without Dask {machine:.2f} times the work of one; "
              f"{time.monotonic() - start:.0f} s in all. last words of progress: "
              + [line for line in said.splitlines() if " tasks, " in line][-1])


if __name__ == "__main__":
    main()
