"""Calls the built programs from script tests."""
import os
import pathlib
import subprocess

BUILD = pathlib.Path(os.environ["PALPATE_BUILD"])
SOURCE = pathlib.Path(os.environ["PALPATE_SOURCE"])
TOOL = BUILD / "node/tool/palpate"
NODE = BUILD / "node/palpate-node"
SIM = BUILD / "sim/palpate-sim"

# As tests/support/test_rng.h: how many of their random cases the tests draw, and whether counts and means tell then.
STRESS = float(os.environ.get("PALPATE_TEST_STRESS", "1"))
COUNTS_TELL = STRESS >= 1


def run(program, *arguments, text_in=None, timeout=30):
    """Runs a program until it ends. Returns exit code, standard output and standard error."""
    done = subprocess.run([str(program), *map(str, arguments)], input=text_in, text=True,
                          capture_output=True, timeout=timeout)
    return done.returncode, done.stdout, done.stderr
