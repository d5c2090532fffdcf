#!/usr/bin/env python3
"""Runs clang-tidy on core/, node/ and sim/. Exits with 1 if there is a finding.

    tests/support/tidy.py           everything but the analyzer, files of a folder together
    tests/support/tidy.py --deep    the analyzer too, each file alone: ten times as long
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = SOURCE / "build/tidy"
OURS = re.compile(r"(core|node|sim)/")


def call(*command):
    subprocess.run(list(map(str, command)), cwd=SOURCE, check=True, stdout=subprocess.DEVNULL)


def configure():
    call("cmake", "--preset", "tidy")
    # Generated headers that our files include.
    protos = (SOURCE / "proto").rglob("*.proto")
    headers = [f"proto/cpp/{proto.relative_to(SOURCE / 'proto').with_suffix('.pb.h')}" for proto in protos]
    call("cmake", "--build", BUILD, "--target", *headers)


def ours():
    """Yields each of our files with its target and compiler options."""
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        file = pathlib.Path(entry["file"])
        if BUILD in file.parents or not OURS.match(str(file.relative_to(SOURCE))):
            continue
        options = shlex.split(entry["command"])
        compiler = next(i for i, option in enumerate(options) if option.endswith("clang++"))
        output = options.index("-o")
        target = re.search(r"(\w[\w-]*)\.dir/", options[output + 1])[1]
        yield file, target, options[compiler + 1:output]


def together(files):
    """Combines the files of a folder and target into one, so that their includes are checked once."""
    groups = {}
    for file, target, options in files:
        groups.setdefault((file.parent, target), (options, []))[1].append(file)
    folder = BUILD / "together"
    folder.mkdir(exist_ok=True)
    for (parent, target), (options, members) in groups.items():
        one = folder / f"{'_'.join(parent.relative_to(SOURCE).parts)}-{target}.cpp"
        one.write_text("".join(f'#include "{member}"\n' for member in members))
        yield one, target, options


def check(file, options, deep):
    command = ["clang-tidy", "--quiet", file, "--", *options]
    if not deep:
        command.insert(1, "--checks=-clang-analyzer-*")
    done = subprocess.run(list(map(str, command)), cwd=BUILD, capture_output=True, text=True)
    return done.returncode, done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--deep", action="store_true")
    parser.add_argument("--only", action="append", help="files whose path has this; may be repeated")
    deep, only = vars(parser.parse_args()).values()
    configure()
    start = time.monotonic()
    said = set()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        work = [pool.submit(check, file, options, deep)
                for file, _, options in (ours() if deep else together(ours()))
                if not only or any(part in str(file) for part in only)]
        for done in concurrent.futures.as_completed(work):
            status, text = done.result()
            # A finding in a header is reported for every file that includes it.
            for finding in re.split(r"^(?=/\S+:\d+:\d+: (?:warning|error): )", text, flags=re.MULTILINE):
                if finding.strip() and finding not in said:
                    said.add(finding)
                    print(finding.replace(f"{SOURCE}/", ""), flush=True)
            if status and not text.strip():
                said.add("failed")
                print(f"clang-tidy ended with {status} and said nothing")
    cpu = os.times()
    print(f"{len(work)} compiled, {len(said)} findings, {time.monotonic() - start:.0f} s, "
          f"{cpu.children_user + cpu.children_system:.0f} s of processor")
    sys.exit(1 if said or not work else 0)


if __name__ == "__main__":
    main()
