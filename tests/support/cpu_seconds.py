#!/usr/bin/env python3
"""Prints the CPU seconds of building targets from an empty folder, and the most expensive files.

    tests/support/cpu_seconds.py strict                              # everything
    tests/support/cpu_seconds.py release palpate palpate-node palpate-sim
    tests/support/cpu_seconds.py asan tests_core tests_recognition

CPU seconds (user and system, of compiling and linking, without ccache) hardly depend on what else the
machine does. A machine of n cores that is idle waits a little more than their sum divided by n.
"""
import os
import subprocess
import sys
import tempfile

SLOWEST = 15


def measure(log, command):
    """The compiler launcher: runs the compiler and adds a line to the log."""
    pid = os.fork()
    if pid == 0:
        os.execvp(command[0], command)
    _, status, used = os.wait4(pid, 0)
    output = command[command.index("-o") + 1] if "-o" in command else "?"
    with open(log, "a", encoding="utf-8") as lines:
        lines.write(f"{used.ru_utime} {used.ru_stime} {output}\n")
    return os.waitstatus_to_exitcode(status)


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        print(__doc__.strip())
        return 2
    preset, targets = sys.argv[1], sys.argv[2:]
    source = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    with tempfile.TemporaryDirectory() as folder:
        log = os.path.join(folder, "cpu_seconds")
        launcher = f"{os.path.abspath(__file__)};--launch;{log}"
        build = os.path.join(folder, "build")
        quiet = {"cwd": source, "check": True, "stdout": subprocess.DEVNULL}
        subprocess.run(["cmake", "--preset", preset, "-B", build, f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}",
                        f"-DCMAKE_CXX_LINKER_LAUNCHER={launcher}"], **quiet)
        subprocess.run(["cmake", "--build", build, "-j", str(os.cpu_count())]
                       + (["--target", *targets] if targets else []), **quiet)
        with open(log, encoding="utf-8") as lines:
            rows = [(float(user), float(system), output.strip())
                    for user, system, output in (line.split(" ", 2) for line in lines)]
    user, system = sum(row[0] for row in rows), sum(row[1] for row in rows)
    print(f"{preset}: {user + system:.0f} CPU seconds ({user:.0f} user, {system:.0f} system), {len(rows)} files")
    for row in sorted(rows, key=lambda row: -row[0] - row[1])[:SLOWEST]:
        print(f"{row[0] + row[1]:7.1f}  {row[2]}")
    return 0


if __name__ == "__main__":
    sys.exit(measure(sys.argv[2], sys.argv[3:]) if sys.argv[1:2] == ["--launch"] else main())
