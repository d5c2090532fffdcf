"""palpate watch, list, hz, record, replay and check against a running system."""
import codecs
import fcntl
import json
import math
import os
import pty
import re
import struct
import subprocess
import termios
import time
import unittest

from bus import Bus, Probe, wait_for, wait_for_log
from palpate.v1 import curve_pb2
from programs import SIM, SOURCE, TOOL, run

SCENE = SOURCE / "sim/scenes/ellipse.textproto"


class Terminal:
    """A terminal of that size; reads the tables that are drawn on it."""

    def __init__(self, rows, columns):
        self._near_end, self.far_end = pty.openpty()
        fcntl.ioctl(self.far_end, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        os.set_blocking(self._near_end, False)
        self._decoder = codecs.getincrementaldecoder("utf-8")()
        self.read = ""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.far_end)
        os.close(self._near_end)

    def wait_for_table(self, accept):
        """The newest table that is whole and accepted, as lines."""
        deadline = time.monotonic() + 15
        while time.monotonic() < deadline:
            try:
                self.read += self._decoder.decode(os.read(self._near_end, 1 << 20))
            except BlockingIOError:
                time.sleep(0.02)
            tables = self.read.split("\x1b[J")
            if len(tables) > 1:
                # After the cursor has gone up to the table before.
                table = re.sub(r"\x1b\[\d*[AK]|\x1b\[2K", "", tables[-2]).split("\r\n")
                if accept("\n".join(table)):
                    return [line for line in table if line]
        raise AssertionError(self.read[-3000:])


class Tool(unittest.TestCase):
    def test_watch_shows_answers_as_text_and_as_the_wire_contracts_json(self):
        with Bus() as bus:
            bus.start_node()
            bus.simulate(SCENE, "--fast")
            # The last value is there at once.
            code, out, _ = run(TOOL, "watch", "--results", bus.results, "--count", "1", "--timeout", "5")
            self.assertEqual(code, 0)
            self.assertRegex(out, r"part object \d+: ellipse \(recognized\), a 2\d\.\d+ \+- |a 30\.")
            code, out, _ = run(TOOL, "watch", "--results", bus.results, "--format", "json", "--count",
                               "1", "--timeout", "5")
            answer = next(m for m in map(json.loads, out.splitlines()) if "hypotheses" in m)
            self.assertEqual(answer["curve_class"], "CURVE_CLASS_ELLIPSE")

    def test_watch_on_a_terminal_is_one_table_that_is_drawn_anew(self):
        with Bus() as bus, Terminal(rows=24, columns=100) as terminal:
            node = bus.start_node("--status-period-s", "0.1")
            watch = bus.start(TOOL, "watch", "--results", bus.results, "--interval", "0.1", stdout=terminal.far_end)
            bus.simulate(SCENE, "--fast")
            table = terminal.wait_for_table(lambda text: "recognized" in text and "finger" in text)
            self.assertRegex(table[0], r"recognizer alive for \d+ s")
            self.assertTrue(any(re.match(r"part +\.\.\d{5} ellipse +recognized +333", line) for line in table), table)
            self.assertTrue(any(re.match(r"finger +part +(alive|SILENT)", line) for line in table), table)
            self.assertLessEqual(max(map(len, table)), 100)
            self.check_places(terminal)
            node.kill()
            node.wait()
            terminal.wait_for_table(lambda text: "recognizer silent for 3 s" in text)
            watch.terminate()
            self.assertEqual(watch.wait(5), 0)

    def check_places(self, terminal):
        """In its place: the cursor goes up as many lines as the table before had."""
        tables = terminal.read.split("\x1b[J")[:-1]
        for before, after in zip(tables, tables[1:]):
            self.assertEqual(int(re.match(r"\x1b\[(\d+)A", after).group(1)), before.count("\r\n"))

    def test_watch_draws_a_small_picture_on_a_terminal(self):
        with Bus() as bus, Terminal(rows=30, columns=80) as terminal:
            bus.start_node("--status-period-s", "0.1")
            watch = bus.start(TOOL, "watch", "--results", bus.results, "--interval", "0.1", "--plot",
                              stdout=terminal.far_end)
            terminal.wait_for_table(lambda text: "recognizer alive" in text)  # it has subscribed
            bus.simulate(SCENE, "--fast")
            table = terminal.wait_for_table(lambda text: "recognized" in text and "finger" in text)
            plain = [re.sub(r"\x1b\[\d*m", "", line) for line in table]
            self.assertLessEqual(max(map(len, plain)), 80)
            drawn = [line for line in plain if any("\u2800" <= c <= "\u28ff" for c in line)]
            self.assertGreater(len(drawn), 12, table)
            self.assertTrue(any("\x1b[36m" in line for line in table), table)  # what was touched
            # The part's ellipse of 60 by 40 mm: turned by any angle, its box has the same diagonal.
            width, height = map(int, re.match(r"part, object \d+: (\d+) x (\d+) mm$", plain[-1]).groups())
            self.assertAlmostEqual(math.hypot(width, height), math.hypot(60, 40), delta=1)
            self.check_places(terminal)
            watch.terminate()
            self.assertEqual(watch.wait(5), 0)
        code, _, err = run(TOOL, "watch", "--plot")
        self.assertEqual(code, 2)
        self.assertIn("--plot draws on a terminal", err)

    def test_watch_fails_where_nothing_is_heard(self):
        with Bus() as bus:
            code, _, err = run(TOOL, "watch", "--results", bus.results, "--timeout", "0.3")
            self.assertEqual(code, 1)
            self.assertIn("nothing heard", err)
            path = bus.folder / "nothing.rec"
            code, _, err = run(TOOL, "record", path, "--results", bus.results, "--seconds", "0.3")
            self.assertEqual(code, 0)
            self.assertIn(f"nothing.rec: 0 messages: nothing was heard on {bus.results}", err)
            bus.start_node()
            code, _, err = run(TOOL, "watch", "--results", bus.results, "--count", "1", "--timeout", "2", "absent", "gone")
            self.assertEqual(code, 1)
            self.assertIn(f"no recognition of group absent, gone heard for 2 s on {bus.results}", err)

    def test_watch_and_the_log_tell_objects_without_an_answer(self):
        objects = 500
        with Bus() as bus:
            node = bus.start_node("--status-period-s", "0.1")
            planner = bus.subscriber("recognition/", "status/", high_water_mark=0)
            watch = bus.start(TOOL, "watch", "--results", bus.results, "--interval", "0", stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL)
            probe = Probe(bus.publisher())
            wait_for(planner, lambda m: hasattr(m, "groups"))
            for number in range(1, objects + 1):
                probe.send(probe.batch(0, object_number=number))
            answered = set()

            def all_is_told(message):
                if hasattr(message, "curve_class"):
                    answered.add(message.object)
                    return False
                return len(answered) + message.objects_superseded == objects

            count = wait_for(planner, all_is_told).objects_superseded
            self.assertGreater(count, 0)
            wait_for_log(node, "objects without an answer")
            while watch.stdout.readline() != f"recognizer recognizer: {count} objects without an answer\n":
                self.assertIsNone(watch.poll())
            watch.stdout.close()

    def test_list_and_hz_show_the_topics(self):
        with Bus() as bus:
            bus.start_node()
            bus.simulate(SCENE, "--fast")
            code, out, _ = run(TOOL, "list", "--results", bus.results, "--seconds", "1.5")
            self.assertEqual(code, 0)
            self.assertEqual([line.split("\t")[0] for line in out.splitlines()],
                             ["recognition/part/", "status/recognizer/"])
            code, out, _ = run(TOOL, "hz", "--results", bus.results, "--seconds", "3.2")
            self.assertEqual(code, 0)
            rate = float(next(l for l in out.splitlines() if l.startswith("status")).split()[1])
            self.assertGreater(rate, 0.7)
            # One answer, repeated with each status for planners that come late: no rate of its own.
            answers = next(l for l in out.splitlines() if l.startswith("recognition"))
            self.assertRegex(answers, r" 0\.0 Hz .* 1 messages, [2-9] repeats$")

    def test_a_recording_replayed_gives_the_same_answer(self):
        with Bus() as bus:
            path = bus.folder / "contacts.rec"
            recorder = bus.start(TOOL, "record", path, "--contacts", bus.contacts, "--count", "36",
                                 stderr=subprocess.DEVNULL)
            bus.simulate(SCENE, "--fast")
            self.assertEqual(recorder.wait(10), 0)
            # Never over an old one.
            self.assertEqual(run(TOOL, "record", path, "--results", bus.results, "--count", "1")[0], 1)
            bus.start_node()
            planner = bus.subscriber()
            first = None
            for _ in range(2):
                code, _, err = run(TOOL, "replay", path, "--contacts", bus.contacts, "--fast")
                self.assertEqual(code, 0, err)
                answer = wait_for(planner, lambda a: a.sample_count == 333 and a.object != first)
                first = answer.object
                self.assertEqual(answer.curve_class, curve_pb2.CURVE_CLASS_ELLIPSE)

    def test_a_csv_file_is_replayed_at_its_pace(self):
        with Bus() as bus:
            path = bus.folder / "part.csv"
            self.assertEqual(run(SIM, SOURCE / "sim/scenes/circle.textproto", "--csv", path)[0], 0)
            bus.start_node()
            planner = bus.subscriber()
            start = time.monotonic()
            code, _, err = run(TOOL, "replay", path, "--contacts", bus.contacts, "--speed", "2")
            self.assertEqual(code, 0, err)
            # 222 samples at 200 Hz and a lift-off, twice as fast.
            self.assertGreater(time.monotonic() - start, 0.5)
            answer = wait_for(planner, lambda a: a.sample_count == 222)
            self.assertEqual(answer.curve_class, curve_pb2.CURVE_CLASS_CIRCLE)

    def test_what_cannot_be_replayed_is_said(self):
        with Bus() as bus:
            bad = bus.folder / "bad.csv"
            bad.write_text("probe,patch,x_m,y_m\np,0,1,zwei\n")
            code, _, err = run(TOOL, "replay", bad, "--contacts", bus.contacts)
            self.assertEqual(code, 2)
            self.assertIn("bad.csv:2:7", err)
            good = bus.folder / "good.csv"
            good.write_text("probe,patch,x_m,y_m\np,0,1,2\n")
            code, _, err = run(TOOL, "replay", good, "--contacts", bus.contacts, "--wait", "0.2")
            self.assertEqual(code, 1)
            self.assertIn("no recognizer", err)

    def test_what_is_no_number_of_objects_or_rounds_is_refused(self):
        scene = SOURCE / "sim/scenes/circle.textproto"
        with Bus() as bus:
            file = bus.folder / "out.csv"
            for option, value in (("--object", "-1"), ("--object", str(1 << 64)), ("--repeat", "-1"), ("--repeat", "1.5")):
                code, _, err = run(SIM, scene, "--csv", file, option, value)
                self.assertNotEqual(code, 0, (option, value))
                self.assertIn(option, err)
                self.assertIn(f'"{value}" is no whole number', err)
            code, _, err = run(SIM, scene, "--csv", file, "--repeat", "0")
            self.assertEqual(code, 2)
            self.assertIn("--repeat 0 is for ever", err)
            self.assertFalse(file.exists())
            code, _, err = run(TOOL, "record", bus.folder / "x.rec", "--results", bus.results, "--count", "-1")
            self.assertEqual(code, 2)
            self.assertIn("--count", err)

    def test_check_tells_a_probes_author_what_is_wrong(self):
        with Bus() as bus:
            def check(rows):
                path = bus.folder / "probe.csv"
                path.write_text("probe,patch,x_m,y_m\n" + "".join(rows))
                checker = bus.start(TOOL, "check", "--contacts", bus.contacts, "--seconds", "1.5",
                                    stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
                run(TOOL, "replay", path, "--contacts", bus.contacts, "--fast")
                out, _ = checker.communicate(timeout=10)
                return checker.returncode, out

            line = [f"p,0,{0.001 * i},{0.00001 * (i % 3)}\n" for i in range(60)]
            code, out = check(line)
            self.assertEqual(code, 0, out)
            code, out = check(line + [f"p,0,{1 + 0.001 * i},0\n" for i in range(60)])
            self.assertEqual(code, 1)
            self.assertIn("count patch up by one", out)
            # What the socket drops leaves no other trace.
            code, _, err = run(TOOL, "check", "--contacts", bus.contacts, "--seconds", "0.2")
            self.assertEqual(code, 1)
            self.assertIn("no message came: does the probe connect to", err)
            self.assertIn("A message of more than 65536 bytes does not arrive", err)


if __name__ == "__main__":
    unittest.main()
