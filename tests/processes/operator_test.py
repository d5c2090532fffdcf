"""What an operator reads in the node's log: who comes, who falls silent, who is turned away, whose messages are bad."""
import fcntl
import os
import pty
import re
import select
import struct
import termios
import time
import unittest

from bus import Bus, Probe
from programs import SIM, SOURCE, TOOL, run


class Log(unittest.TestCase):
    def wait_for(self, node, pattern, timeout_s=20):
        deadline = time.monotonic() + timeout_s
        while not (found := re.search(pattern, node.log_path.read_text())):
            self.assertLess(time.monotonic(), deadline, f"{pattern} not in:\n{node.log_path.read_text()}")
            time.sleep(0.05)
        return found

    def test_probes_that_come_fall_silent_and_come_back(self):
        with Bus() as bus:
            node = bus.start_node()
            socket = bus.publisher()
            finger, thumb = Probe(socket, group="cup"), Probe(socket, name="thumb")
            finger.send(finger.batch(0))
            self.wait_for(node, r"\[info\] probe finger: up, group \"cup\"")
            deadline = time.monotonic() + 30
            while "probe finger: silent" not in node.log_path.read_text():  # thumb is heard all the time
                self.assertLess(time.monotonic(), deadline, node.log_path.read_text())
                thumb.send(thumb.batch(0))
                time.sleep(0.1)
            self.wait_for(node, r"\[warning\] probe finger: silent for [5-9] s")
            finger.send(finger.batch(10))
            self.wait_for(node, r"probe finger: heard again")
            self.assertNotIn("thumb: silent", node.log_path.read_text())
            self.assertEqual(node.log_path.read_text().count("probe finger: up"), 1)

    def test_whose_messages_are_rejected(self):
        with Bus() as bus:
            node = bus.start_node()
            socket = bus.publisher()
            for _ in range(3):
                socket.send_multipart([b"contact/thumb/", b"\xff\xff no message"])
            self.wait_for(node, r"3 messages rejected: REJECT_REASON_PARSE, the last of probe thumb")
            socket.send_multipart([b"contact/", b""])
            self.wait_for(node, r"1 messages rejected: \w+, of no probe's topic")

    def test_a_flood_of_names_is_few_lines(self):
        with Bus() as bus:
            node = bus.start_node()
            socket = bus.publisher()
            start = time.monotonic()
            for number in range(100):
                probe = Probe(socket, name=f"invented-{number}", group="")
                probe.send(probe.batch(0))
            self.wait_for(node, r"more probes have come")
            time.sleep(2)
            # Ten a second at most, and a line that says how many more.
            lines = node.log_path.read_text().count("probe invented")
            self.assertLessEqual(lines, 10 * (time.monotonic() - start + 1))
            self.assertLess(lines, 100)

    def test_who_is_turned_away(self):
        with Bus("tcp") as bus:
            for name in ("node", "friend", "stranger"):
                self.assertEqual(run(TOOL, "keygen", bus.folder / name)[0], 0)
            node = bus.start_node("--curve-secret-key", bus.folder / "node.secret", "--allow-clients",
                                  bus.folder / "friend.public")
            run(SIM, SOURCE / "sim/scenes/circle.textproto", "--contacts", bus.contacts, "--wait", "1", "--curve-secret-key",
                bus.folder / "stranger.secret", "--curve-server-key", bus.folder / "node.public")
            self.wait_for(node, r"\d+ clients denied: their keys are not on the list; the last from 127\.0\.0\.1")


class Terminal:
    """What a program draws on its standard error (or output)."""

    def __init__(self, bus, *command, stream="stderr"):
        self.ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 100, 0, 0))
        self.process = bus.start(*command, **{stream: theirs})
        os.close(theirs)
        self.text = ""

    def wait_for(self, pattern, timeout_s=20):
        deadline = time.monotonic() + timeout_s
        while not (found := re.search(pattern, self.text)):
            if not select.select([self.ours], [], [], max(0.0, deadline - time.monotonic()))[0]:
                raise AssertionError(f"{pattern} not in {self.text[-2000:]!r}")
            try:
                self.text += os.read(self.ours, 1 << 16).decode()
            except OSError as ended:  # of a program that has gone
                raise AssertionError(f"{pattern} not in {self.text[-2000:]!r}") from ended
        return found


class Progress(unittest.TestCase):
    def test_who_waits_says_for_what(self):
        with Bus() as bus:
            scene = bus.folder / "scene.csv"
            self.assertEqual(run(SIM, SOURCE / "sim/scenes/circle.textproto", "--csv", scene)[0], 0)
            Terminal(bus, TOOL, "record", bus.folder / "a.rec", "--contacts", bus.contacts).wait_for("a.rec: waiting for messages")
            Terminal(bus, TOOL, "replay", scene, "--contacts", f"ipc://{bus.folder}/nobody").wait_for("waiting for a recognizer at ipc:")
            Terminal(bus, TOOL, "watch", "--results", f"ipc://{bus.folder}/nobody", stream="stdout").wait_for("no recognizer heard yet")
            # Into a pipe too, which has no panel.
            code, out, _ = run(TOOL, "watch", "--results", f"ipc://{bus.folder}/nobody", "--timeout", 4)
            self.assertEqual((code, out), (1, "no recognizer heard yet\n"))

    def test_record_and_replay_say_how_far_they_are(self):
        with Bus() as bus:
            scene = bus.folder / "scene.csv"
            self.assertEqual(run(SIM, SOURCE / "sim/scenes/circle.textproto", "--csv", scene)[0], 0)
            record = Terminal(bus, TOOL, "record", bus.folder / "a.rec", "--contacts", bus.contacts)
            record.wait_for("waiting")
            replay = Terminal(bus, TOOL, "replay", scene, "--contacts", bus.contacts, "--speed", "0.5")
            replay.wait_for(r"scene\.csv: [1-9]\d* messages, \d+ samples\x1b")
            record.wait_for(r"a\.rec: [1-9]\d* messages\x1b")
            record.process.terminate()
            record.wait_for(r"\r\x1b\[K\S+a\.rec: [1-9]\d* messages\r\n")
            # Where nobody looks on, nothing is drawn.
            code, _, err = run(TOOL, "record", bus.folder / "b.rec", "--results", bus.results, "--seconds", "0.2")
            self.assertEqual((code, err), (0, f"{bus.folder}/b.rec: 0 messages: nothing was heard on {bus.results}\n"))


if __name__ == "__main__":
    unittest.main()
