"""palpate-node as systemd runs it: told when it serves, lives and ends, and with no more rights than it needs."""
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest

from bus import Bus, Probe, stop, wait_for
from programs import BUILD, NODE, SOURCE
from strangers import call

UNIT = SOURCE / "node/package/palpate-node.service"
GATEWAY = BUILD / "node/gateway/palpate-gateway"  # where there was libnats
UNITS = {UNIT: NODE} | ({SOURCE / "node/package/palpate-gateway@.service": GATEWAY} if GATEWAY.exists() else {})
ANALYZE = shutil.which("systemd-analyze")


class Listener:
    """The service manager's end of $NOTIFY_SOCKET."""

    def __init__(self, address):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind("\0" + address[1:] if address.startswith("@") else address)

    def hear(self, timeout_s=10):
        self.socket.settimeout(timeout_s)
        return self.socket.recv(4096).decode().splitlines()

    def empty(self):
        self.socket.setblocking(False)
        try:
            while self.socket.recv(4096):
                pass
        except BlockingIOError:
            pass


class Notify(unittest.TestCase):
    def start(self, bus, address, watchdog_us=400000):
        listener = Listener(address)
        node = bus.start(NODE, "--contacts", bus.contacts, "--results", bus.results, stderr=subprocess.DEVNULL,
                         env={"NOTIFY_SOCKET": address, "WATCHDOG_USEC": str(watchdog_us)})
        self.addCleanup(listener.socket.close)
        return listener, node

    def test_ready_when_its_sockets_are_open_alive_and_stopping(self):
        with Bus() as bus:
            for address in (f"{bus.folder}/notify", f"@palpate-test-{bus.folder.name}"):
                listener, node = self.start(bus, address)
                first = listener.hear()
                self.assertEqual(first[0], "READY=1")
                self.assertIn(bus.contacts, first[1])
                self.assertTrue(pathlib.Path(bus.contacts[6:]).exists())
                for _ in range(3):
                    self.assertEqual(listener.hear(), ["WATCHDOG=1"])
                self.assertEqual(stop(node)[0], 0)
                said = []
                while not said or said[-1] != ["STOPPING=1"]:
                    said.append(listener.hear())
                self.assertEqual({line for lines in said[:-1] for line in lines} - {"WATCHDOG=1"}, set())

    def test_it_does_not_say_that_it_lives_when_it_does_not_serve(self):
        with Bus() as bus:
            listener, node = self.start(bus, f"{bus.folder}/notify")
            listener.hear()
            listener.hear()
            node.send_signal(signal.SIGSTOP)
            status = pathlib.Path(f"/proc/{node.pid}/stat")
            while status.read_text().rpartition(")")[2].split()[0] != "T":
                time.sleep(0.01)
            listener.empty()
            with self.assertRaises(TimeoutError):
                listener.hear(1.0)
            node.send_signal(signal.SIGCONT)
            self.assertEqual(listener.hear(), ["WATCHDOG=1"])

    def test_another_process_is_watched_not_this_one(self):
        with Bus() as bus:
            listener = Listener(f"{bus.folder}/notify")
            self.addCleanup(listener.socket.close)
            bus.start(NODE, "--contacts", bus.contacts, "--results", bus.results, stderr=subprocess.DEVNULL,
                      env={"NOTIFY_SOCKET": f"{bus.folder}/notify", "WATCHDOG_USEC": "200000", "WATCHDOG_PID": "1"})
            self.assertEqual(listener.hear()[0], "READY=1")
            with self.assertRaises(TimeoutError):
                listener.hear(1.0)


class Unit(unittest.TestCase):
    @unittest.skipUnless(ANALYZE, "systemd-analyze is not installed: the unit was not read")
    def test_exposure_is_below_two(self):
        for unit in UNITS:
            out = call(ANALYZE, "security", "--offline=true", unit)
            exposure = float(re.search(r"Overall exposure level .*: ([\d.]+)", out)[1])
            print(f"systemd-analyze security: {unit.name} {exposure}")
            self.assertLess(exposure, 2.0)

    @unittest.skipUnless(ANALYZE, "systemd-analyze is not installed: the unit was not read")
    def test_systemd_understands_every_line(self):
        for given, program in UNITS.items():
            with tempfile.TemporaryDirectory(prefix="palpate-") as folder:
                unit = pathlib.Path(folder) / given.name.replace("@", "@name")
                unit.write_text(given.read_text().replace(f"ExecStart={program.name}", f"ExecStart={program}"))
                done = subprocess.run([ANALYZE, "verify", "--man=no", unit], capture_output=True, text=True)
                about_ours = [line for line in done.stderr.splitlines() if unit.name in line]
                self.assertEqual((done.returncode, about_ours), (0, []), done.stderr)

    @unittest.skipUnless(ANALYZE and shutil.which("strace"), "no systemd-analyze or no strace: calls were not counted")
    def test_the_filter_of_system_calls_lets_through_what_the_node_does(self):
        # A call that is refused ends the node, as libzmq's of sched_setscheduler did.
        if subprocess.run(["strace", "--output", "/dev/null", "true"], capture_output=True).returncode != 0:
            self.skipTest("nothing may be traced here: calls were not counted")
        def members(name):
            found = set()
            for line in call(ANALYZE, "syscall-filter", name).splitlines()[1:]:
                line = line.strip()
                found |= members(line) if line.startswith("@") else {line} - {""}
            return {name for name in found if not name.startswith("#")}

        allowed = set()
        for value in re.findall(r"^SystemCallFilter=(.*)$", UNIT.read_text(), re.MULTILINE):
            names = set().union(*(members(name) if name.startswith("@") else {name} for name in value.lstrip("~").split()))
            allowed = allowed - names if value.startswith("~") else allowed | names
        self.assertGreater(len(allowed), 100)
        with Bus("tcp") as bus:
            trace = bus.folder / "trace"
            with open(bus.folder / "log", "w") as log:
                tracer = bus.start("strace", "--follow-forks", "--output", trace, NODE, "--contacts", bus.contacts,
                                   "--results", bus.results, stderr=log)
            deadline = time.monotonic() + 30
            while not (found := re.search(r"contacts on (\S+), results on ([^\s,]+)", (bus.folder / "log").read_text())):
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.01)
            bus.contacts, bus.results = found.groups()
            planner = bus.subscriber()
            probe = Probe(bus.publisher())
            probe.stroke()
            wait_for(planner, lambda answer: answer.sample_count == 200, timeout_s=30)
            node = int(re.match(r"\d+", trace.read_text())[0])
            subprocess.run(["kill", str(node)], check=True)
            self.assertEqual(tracer.wait(10), 0)
            used = set(re.findall(r"^\d+ +(\w+)\(", trace.read_text(), re.MULTILINE)) - {"execve"}
        self.assertGreater(len(used), 20)
        self.assertEqual(used - allowed, set())


if __name__ == "__main__":
    unittest.main()
