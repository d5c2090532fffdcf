#!/usr/bin/env python3
"""Recognises archives of contacts on a Dask cluster. Writes a CSV file with one row per object.

  PYTHONPATH=... python3 node/examples/archive.py --out rows.csv strokes/*.csv night.recording log.jsonl

Input: recordings (palpate record), CSV files with the contract's columns (a header line with probe, patch, x_m, y_m and
optionally sigma_m, object, group, tip_radius_m, material_side), and files with one ContactBatch per line in protobuf's
JSON. Without --scheduler it runs on processes of this machine; --workers says how many.

Each file is read once and its objects are dealt to tasks. The rows of each task go to a file in OUT.parts. A part that
exists is not computed again, so the program can be stopped and restarted at any time. When all parts exist, OUT is
written, sorted by file, group and object. Each object's samples are used in their order in the file, so the rows do not
depend on which worker computes them. A task that fails, or whose worker dies, is tried again (--retries). A file that
cannot be read is named at the end, and the exit code is 1.

Needs the palpate module, python3-protobuf with the generated package, and python3-distributed.
"""
import argparse
import array
import contextlib
import csv
import hashlib
import io
import json
import operator
import os
import pathlib
import struct
import sys
import time
import zlib

PIECE_BYTES = 1 << 20  # part of a file for one task: seconds of work
COLUMNS = ["file", "group", "object", "status", "doubt", "curve_class", "probability", "a", "b", "c", "x_m", "y_m",
           "theta_rad", "a_std", "b_std", "c_std", "x_m_std", "y_m_std", "theta_rad_std", "sigma_m", "samples", "patches",
           "outliers", "forgotten"]


def batches_of_recording(path):
    """Yields the ContactBatch messages of a recording (format: node/files/recording.h)."""
    from palpate.v1 import contact_pb2
    data = path.read_bytes()
    if data[:8] != b"palpate2":
        raise ValueError("no recording")
    head = struct.Struct("<4sqIIII")
    at = 8
    while at + head.size <= len(data):
        mark, _, frames, topic, payload, checksum = head.unpack_from(data, at)
        body = data[at + head.size:at + head.size + topic + payload]
        if mark != b"\xa7rec" or len(body) < topic + payload or \
                zlib.crc32(body, zlib.crc32(data[at + 4:at + head.size - 4])) != checksum:
            at = data.find(b"\xa7rec", at + 1)  # damaged or incomplete: skip to the next record
            if at < 0:
                return
            continue
        at += head.size + topic + payload
        if frames == 2 and body.startswith(b"contact/"):
            batch = contact_pb2.ContactBatch.FromString(body[topic:])
            if not batch.header.source:  # it is the topic's then (header.proto)
                batch.header.source = body[len(b"contact/"):topic].decode().rstrip("/")
            yield batch


def batches_of_json_lines(path):
    from google.protobuf import json_format
    from palpate.v1 import contact_pb2
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            if line.strip():
                yield json_format.Parse(line, contact_pb2.ContactBatch())


def samples_of_batches(batches):
    sides = {0: "unspecified", 1: "left", 2: "right"}
    for batch in batches:
        probe = batch.header.source
        key = (probe, batch.patch, batch.tip_radius_m, sides[batch.material_side])
        for sample in batch.samples:
            yield batch.group or probe, batch.object, key, (sample.x_m, sample.y_m), sample.sigma_m


def samples_of_csv(path):
    with open(path, newline="", encoding="utf-8") as lines:
        rows = csv.reader("\n" if line.startswith("#") else line for line in lines)
        header = next((row for row in rows if row), [])
        missing = {"probe", "patch", "x_m", "y_m"} - set(header)
        if missing:
            raise ValueError(f"line {rows.line_num}: no column {', '.join(sorted(missing))}")
        names = ("probe", "patch", "x_m", "y_m", "group", "object", "tip_radius_m", "material_side", "sigma_m")
        # A column that the file lacks reads the empty field appended to each row.
        probe, patch, x, y, group, number, tip_radius, side, sigma = (
            header.index(name) if name in header else len(header) for name in names)
        for row in rows:
            if not row:
                continue
            if len(row) != len(header):
                raise ValueError(f"line {rows.line_num}: {len(row)} fields, {len(header)} columns")
            row.append("")
            try:
                key = row[probe], int(row[patch]), float(row[tip_radius] or 0), row[side] or "unspecified"
                yield (row[group] or row[probe], int(row[number] or 0), key, (float(row[x]), float(row[y])),
                       float(row[sigma] or 0))
            except ValueError as error:
                raise ValueError(f"line {rows.line_num}: {error}") from None


def samples_of(path):
    """Yields (group, object, patch's key, (x_m, y_m), sigma_m) of each sample."""
    with open(path, "rb") as file:
        start = file.read(8)
    if start.startswith(b"palpate2"):
        return samples_of_batches(batches_of_recording(path))
    if start.lstrip().startswith(b"{"):
        return samples_of_batches(batches_of_json_lines(path))
    return samples_of_csv(path)


def recognise(patches, sigma_m):
    """The columns of a row that come from the answer."""
    import numpy as np
    import palpate
    recognizer = palpate.Recognizer(sigma=sigma_m or None, most_patches=max(64, len(patches)))
    probes = {}
    for number, ((probe, _, tip_radius, side), (points, sigmas)) in enumerate(patches.items()):
        known = np.frombuffer(sigmas) if any(sigmas) else None
        recognizer.add(np.frombuffer(points).reshape(-1, 2), patch=number, probe=probes.setdefault(probe, len(probes)), sigma=known,
                       tip_radius=tip_radius, material_side=side)
    answer = recognizer.recognize()
    row = {"status": answer.status, "doubt": answer.doubt, "curve_class": answer.curve_class,
           "probability": answer.probabilities.get(answer.curve_class, ""), "sigma_m": answer.sigma,
           "samples": answer.sample_count, "patches": len(patches), "outliers": answer.outlier_count,
           "forgotten": answer.forgotten_count}
    if answer.params or answer.pose[0] == answer.pose[0]:
        row |= answer.params | dict(zip(("x_m", "y_m", "theta_rad"), answer.pose))
        row |= {{"x": "x_m", "y": "y_m", "theta": "theta_rad"}.get(name, name) + "_std": value
                for name, value in answer.std.items()}
    return row


def deal(path, pieces):
    """Runs on a worker: reads a file and splits it into `pieces` lists of objects (group, number, {patch's key: (points,
    sigmas)})."""
    objects = {}
    for group, number, key, point, sigma in samples_of(pathlib.Path(path)):
        points, sigmas = objects.setdefault((group, number), {}).setdefault(key, (array.array("d"), array.array("d")))
        points.extend(point)
        sigmas.append(sigma)
    dealt = [[] for _ in range(pieces)]
    for (group, number), patches in sorted(objects.items()):
        dealt[zlib.crc32(f"{group}/{number}".encode()) % pieces].append((group, number, patches))
    return dealt


def rows_of(path, objects, sigma_m):
    """Runs on a worker: returns one row per object, as CSV text."""
    out = io.StringIO()
    writer = csv.DictWriter(out, COLUMNS, restval="", lineterminator="\n")
    for group, number, patches in objects:
        writer.writerow({"file": path, "group": group, "object": number} | recognise(patches, sigma_m))
    return out.getvalue()


def tasks_of(files, sigma_m):
    """Returns {name of the part: arguments}. The name depends on the file and on the options."""
    tasks = {}
    for path in files:
        state = os.stat(path)
        pieces = max(1, -(-state.st_size // PIECE_BYTES))
        for piece in range(pieces):
            said = json.dumps([str(path), state.st_size, state.st_mtime_ns, piece, pieces, sigma_m])
            tasks[hashlib.sha256(said.encode()).hexdigest()[:24] + ".csv"] = (str(path), piece, pieces, sigma_m)
    return tasks


def write_whole(path, text):
    """Writes the file completely or not at all."""
    beside = path.with_suffix(".writing")
    beside.write_text(text, encoding="utf-8")
    beside.replace(path)


def compute(client, tasks, parts, retries, progress):
    """Runs the tasks whose parts do not exist. Returns {part: error} of those that failed."""
    from distributed import as_completed
    futures, dealt = {}, {}
    for name, (path, piece, pieces, sigma_m) in tasks.items():
        if (parts / name).exists():
            continue
        if path not in dealt:
            dealt[path] = client.submit(deal, path, pieces, retries=retries, pure=False)
        objects = client.submit(operator.getitem, dealt[path], piece, pure=False)
        futures[client.submit(rows_of, path, objects, sigma_m, key=name, retries=retries, pure=False)] = name
    dealt = objects = None  # frees each task's data as soon as its rows exist
    done, answers, failed, begin, told = len(tasks) - len(futures), 0, {}, time.monotonic(), 0.0
    for future in as_completed(futures):
        name = futures[future]
        if future.status == "finished":
            text = future.result()
            write_whole(parts / name, text)
            answers += text.count("\n")
        else:
            failed[name] = f"{tasks[name][0]}: {future.exception()!r}"
        done += 1
        future.release()
        seconds = time.monotonic() - begin
        if progress and (seconds > told + 1 or done == len(tasks)):
            told = seconds
            print(f"{done} of {len(tasks)} tasks, {answers} answers, {answers / max(seconds, 1e-9):.0f} a second"
                  + (f", {len(failed)} failed" if failed else ""), file=sys.stderr, flush=True)
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path, help="CSV file of the rows")
    parser.add_argument("--sigma", type=float, default=0.0, help="noise where a file has none; 0 = estimate it [m]")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="processes on this machine")
    parser.add_argument("--scheduler", help="address of a Dask scheduler, in place of them")
    parser.add_argument("--retries", type=int, default=2)
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    options = parser.parse_args()

    from distributed import Client, LocalCluster
    parts = options.out.with_suffix(options.out.suffix + ".parts")
    parts.mkdir(parents=True, exist_ok=True)
    files = [path.resolve() for path in options.files]
    tasks = tasks_of(files, options.sigma)
    with contextlib.ExitStack() as open_until_done:
        # A scheduler that somebody else started goes on after us. Ours ends after its client: the other way round,
        # Dask prints a traceback for each connection that it finds closed.
        cluster = options.scheduler or open_until_done.enter_context(
            LocalCluster(n_workers=options.workers, threads_per_worker=1, processes=True, dashboard_address=None))
        client = open_until_done.enter_context(Client(cluster))
        failed = compute(client, tasks, parts, options.retries, not options.quiet)
    if failed:
        print("\n".join(sorted(set(failed.values()))), file=sys.stderr)
        return 1
    rows = [row for name in tasks for row in csv.reader(io.StringIO((parts / name).read_text(encoding="utf-8")))]
    rows.sort(key=lambda row: (row[0], row[1], int(row[2])))
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerows([COLUMNS, *rows])
    write_whole(options.out, out.getvalue())
    print(f"{len(rows)} rows in {options.out}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
