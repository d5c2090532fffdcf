"""palpate watch, list, hz, record, replay and check against a running system."""
import json
import os
import pty
import subprocess
import time
import unittest

from bus import Bus, wait_for
from palpate.v1 import curve_pb2
from programs import SIM, SOURCE, TOOL, run

SCENE = SOURCE / "sim/scenes/ellipse.textproto"


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

    def test_watch_on_a_terminal_keeps_the_probes_below_the_answers(self):
        with Bus() as bus:
            bus.start_node("--status-period-s", "0.1")
            terminal, far_end = pty.openpty()
            watch = bus.start(TOOL, "watch", "--results", bus.results, "--count", "40", stdout=far_end)
            bus.simulate(SCENE, "--speed", "0.5")
            bus.simulate(SCENE, "--fast")
            watch.kill()
            watch.wait()
            os.close(far_end)
            screen = os.read(terminal, 1 << 20).decode()
            os.close(terminal)
            # The line of a probe is taken away before the next line is written.
            self.assertRegex(screen, r"probe \S+: alive, [^\n]*\r\n\x1b\[A\x1b\[2K")
            shown = screen.split("\x1b[2K")[-1]
            self.assertLessEqual(shown.count("probe "), 1, screen)

    def test_watch_fails_where_nothing_is_heard(self):
        with Bus() as bus:
            code, _, err = run(TOOL, "watch", "--results", bus.results, "--timeout", "0.3")
            self.assertEqual(code, 1)
            self.assertIn("nothing heard", err)

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


if __name__ == "__main__":
    unittest.main()
