"""node/examples/archive.py on local processes: three kinds of files, the same rows whatever happens."""
import csv
import importlib.util
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock

import numpy as np
from google.protobuf import json_format
from palpate.v1 import contact_pb2
from programs import BUILD, SOURCE

ARCHIVE = SOURCE / "node/examples/archive.py"
FILES = 24
STROKES = 60  # of a file


def strokes(count, seed=1):
    """Objects of one stroke each, a circle's: points of (30, 2)."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        radius, start = rng.uniform(0.01, 0.05), rng.uniform(0, 6)
        t = start + np.linspace(0, rng.uniform(1.5, 4), 30)
        yield radius, radius * np.column_stack([np.cos(t), np.sin(t)]) + rng.normal(0, 1e-5, (30, 2))


def write_csv(path, count, seed=1, first=0):
    with open(path, "w") as file:
        file.write("probe,patch,x_m,y_m,sigma_m,object\n")
        for number, (_, points) in enumerate(strokes(count, seed), first):
            file.writelines(f"finger,0,{x!r},{y!r},1e-5,{number}\n" for x, y in points.tolist())


def batches(count, seed):
    for number, (_, points) in enumerate(strokes(count, seed)):
        batch = contact_pb2.ContactBatch(group="hand", object=number)
        batch.header.source, batch.header.epoch, batch.header.seq = "finger", 1, number
        for x, y in points.tolist():
            batch.samples.add(x_m=x, y_m=y, sigma_m=1e-5)
        yield batch


def write_recording(path, count, seed):
    import struct
    import zlib
    with open(path, "wb") as file:
        file.write(b"palpate2")
        for batch in batches(count, seed):
            # Who leaves source and group empty is named by the topic.
            batch.header.source = batch.group = ""
            topic, payload = b"contact/finger/", batch.SerializeToString()
            fields = struct.pack("<qIII", 0, 2, len(topic), len(payload))
            file.write(b"\xa7rec" + fields + struct.pack("<I", zlib.crc32(topic + payload, zlib.crc32(fields))) + topic + payload)


@unittest.skipUnless(importlib.util.find_spec("distributed"), "no python3-distributed")
class Archive(unittest.TestCase):
    def start(self, folder, out, files, *options):
        environment = os.environ | {"PYTHONPATH": f"{BUILD / 'node/python'}:{os.environ['PYTHONPATH']}"}
        return subprocess.Popen([sys.executable, ARCHIVE, "--out", folder / out, "--workers", "2", *options, *files],
                                stderr=subprocess.PIPE, text=True, env=environment, cwd=folder)

    def rows(self, path):
        with open(path, newline="") as file:
            return list(csv.DictReader(file))

    def test_the_same_rows_with_a_worker_killed_and_begun_again(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for i in range(FILES):
                write_csv(folder / f"{i}.csv", STROKES, seed=i)
            write_recording(folder / "night.recording", 40, seed=7)
            (folder / "log.jsonl").write_text("".join(json_format.MessageToJson(batch, indent=None) + "\n"
                                                      for batch in batches(40, seed=8)))
            files = sorted(folder.glob("*.*"))
            whole = self.start(folder, "whole.csv", files)
            said = whole.communicate(timeout=120)[1]
            self.assertEqual(whole.returncode, 0, said)
            self.assertIn(f"{FILES + 2} of {FILES + 2} tasks", said)
            self.assertNotIn("Traceback", said)
            rows = self.rows(folder / "whole.csv")
            self.assertEqual(len(rows), FILES * STROKES + 80)
            self.assertEqual(len({(row["file"], row["group"], row["object"]) for row in rows}), len(rows))
            self.assertGreater(sum(row["curve_class"] == "circle" for row in rows), 0.9 * len(rows))
            self.assertEqual({row["samples"] for row in rows}, {"30"})
            self.assertEqual({row["group"] for row in rows if row["file"].endswith("night.recording")}, {"finger"})

            # In another order; a worker is killed, then the one who deals out the work, which is begun again.
            broken = self.start(folder, "broken.csv", files[::-1])
            parts = folder / "broken.csv.parts"
            killed = self.kill_a_worker(broken, parts)
            broken.send_signal(signal.SIGKILL)
            broken.communicate()
            there = len(list(parts.glob("*.csv")))
            self.assertIsNotNone(killed)
            self.assertLess(there, FILES + 2, "there was nothing left to do")
            again = self.start(folder, "broken.csv", files)
            said = again.communicate(timeout=120)[1]
            self.assertEqual(again.returncode, 0, said)
            self.assertEqual((folder / "broken.csv").read_text(), (folder / "whole.csv").read_text())
            print(f"{len(rows)} rows of {FILES + 2} files, the same with a worker killed, and begun again with {there} parts there")

    def kill_a_worker(self, process, parts):
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and process.poll() is None:
            if parts.exists() and len(list(parts.glob("*.csv"))) >= 1:
                break
            time.sleep(0.01)
        for child in self.children(process.pid):
            command = pathlib.Path(f"/proc/{child}/cmdline").read_bytes()
            if b"spawn_main" in command or b"forkserver" in command:
                os.kill(child, signal.SIGKILL)
                time.sleep(0.3)
                return child
        return None

    def children(self, pid):
        found = []
        for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
            found += [int(child) for child in (task / "children").read_text().split()]
        return found

    def test_a_long_file_is_dealt_to_several_tasks(self):
        """Each object whole and in one of them, however its samples lie in the file."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_csv(folder / "long.csv", 600)
            head, *lines = (folder / "long.csv").read_text().splitlines()
            turns = sorted(range(len(lines)), key=lambda i: i % 30)  # the objects by turns, each in its own order
            (folder / "turns.csv").write_text("\n".join([head, *(lines[i] for i in turns)]) + "\n")
            process = self.start(folder, "out.csv", [folder / "long.csv", folder / "turns.csv"])
            said = process.communicate(timeout=120)[1]
            self.assertEqual(process.returncode, 0, said)
            self.assertIn("4 of 4 tasks", said)
            rows = {"long.csv": [], "turns.csv": []}
            for row in self.rows(folder / "out.csv"):
                rows[pathlib.Path(row.pop("file")).name].append(row)
            self.assertEqual(rows["long.csv"], rows["turns.csv"])
            self.assertEqual([int(row["object"]) for row in rows["long.csv"]], list(range(600)))

    def test_a_cluster_of_somebody_else_goes_on(self):
        from distributed import Client, LocalCluster
        path = [str(BUILD / "node/python"), *sys.path]  # its workers take it over
        with tempfile.TemporaryDirectory() as name, unittest.mock.patch.object(sys, "path", path), \
                LocalCluster(n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None) as cluster, \
                Client(cluster) as client:
            folder = pathlib.Path(name)
            write_csv(folder / "night.csv", 20)
            process = self.start(folder, "out.csv", [folder / "night.csv"], "--scheduler", cluster.scheduler_address)
            said = process.communicate(timeout=60)[1]
            self.assertEqual(process.returncode, 0, said)
            self.assertNotIn("Traceback", said)
            self.assertEqual(len(self.rows(folder / "out.csv")), 20)
            self.assertEqual(client.submit(sum, (1, 2)).result(timeout=30), 3)

    def test_a_file_that_cannot_be_read_is_named(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_csv(folder / "good.csv", 3)
            (folder / "bad.csv").write_text("# of a stranger\nprobe,patch,x_m,y_m\nfinger,0,one,2\n")
            process = self.start(folder, "out.csv", [folder / "bad.csv", folder / "good.csv"], "--retries", "0")
            said = process.communicate(timeout=60)[1]
            self.assertEqual(process.returncode, 1)
            self.assertRegex(said, "bad.csv.*line 3.*one")
            self.assertFalse((folder / "out.csv").exists())
            # The other one is done.
            self.assertEqual(len(list((folder / "out.csv.parts").glob("*.csv"))), 1)


if __name__ == "__main__":
    unittest.main()
