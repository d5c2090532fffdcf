"""The README's recipe for CURVE between two machines, to the letter: each a network namespace of its own."""
import os
import re
import shutil
import subprocess
import sys
import time
import unittest

from bus import Bus
from programs import NODE, SIM, SOURCE, TOOL

RECIPE = (SOURCE / "node/README.md").read_text().partition("## Beyond this machine")[2].partition("\n##")[0]
PROGRAMS = {"palpate": TOOL, "palpate-node": NODE, "palpate-sim": SIM}

# Their cable, laid by the test inside its own namespaces: all of it is gone when they end.
FIRST = """
ip link set lo up
ip link add left type veth peer name right netns {other}
ip address add 10.0.0.1/24 dev left
ip link set left up
"""
OTHER = """
ip link set lo up
ip address add 10.0.0.2/24 dev right
ip link set right up
"""


def commands():
    return [line.strip() for line in re.findall(r"^    (.*)$", RECIPE, re.MULTILINE)]


class TwoMachines(unittest.TestCase):
    def setUp(self):
        if shutil.which("ip") is None:
            self.skipTest("iproute2 is not installed: the recipe was not followed")
        cable = ["unshare", "--net", "ip", "link", "add", "left", "type", "veth", "peer", "name", "right"]
        if os.geteuid() != 0 or subprocess.run(cable, capture_output=True).returncode != 0:
            self.skipTest("only root may make network namespaces and a cable between them, and not everywhere")

    def machine(self, bus):
        """A shell in a namespace of its own, that reads commands."""
        shell = bus.start("unshare", "--net", "sh", "-e", stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, cwd=bus.folder,
                          env=os.environ | {"PATH": f"{bus.folder}/bin:{os.environ['PATH']}"})
        return shell

    def say(self, shell, text):
        shell.stdin.write(text + "\necho done\n")
        shell.stdin.flush()
        said = []
        while (line := shell.stdout.readline()) not in ("", "done\n"):
            said.append(line)
        self.assertIsNone(shell.poll(), "".join(said))
        return "".join(said)

    def test_a_probe_and_a_planner_on_another_machine(self):
        keys, allowed, node, watch, sim = commands()
        with Bus() as bus:
            (bus.folder / "bin").mkdir()
            for name, path in PROGRAMS.items():
                (bus.folder / "bin" / name).symlink_to(path)
            shutil.copy(SOURCE / "sim/scenes/circle.textproto", bus.folder / "scene.textproto")
            first, other = self.machine(bus), self.machine(bus)
            self.say(other, "true")
            self.say(first, FIRST.format(other=other.pid))
            self.say(other, OTHER)
            self.say(first, keys)
            self.say(first, allowed)
            self.say(first, f"{node} 2> node.log & echo $! > node.pid")
            try:
                self.say(other, f"{watch} --format json --count 1 --timeout 30 > answer.json 2> watch.log & echo $! > watch.pid")
                self.say(other, f"{sim} --wait 20 --quiet")
                # What has no key hears why.
                stranger = sim.replace("--curve-secret-key finger.secret --curve-server-key node.public", "--wait 20 --quiet")
                self.assertIn("do not agree on CURVE", self.say(other, f"{stranger} 2>&1 || true"))
                deadline = time.monotonic() + 30
                while "CURVE_CLASS" not in (bus.folder / "answer.json").read_text():
                    self.assertLess(time.monotonic(), deadline, (bus.folder / "watch.log").read_text())
                    time.sleep(0.05)
            finally:
                for name in ("node", "watch"):
                    pid = bus.folder / f"{name}.pid"
                    if pid.exists():
                        subprocess.run(["kill", pid.read_text().strip()], capture_output=True)
            for shell in (first, other):
                shell.stdin.write("exit\n")
                shell.stdin.flush()
                shell.wait(10)
            self.assertIn('"CURVE_CLASS_CIRCLE"', (bus.folder / "answer.json").read_text())


if __name__ == "__main__":
    sys.exit(unittest.main())
