"""Files and outputs that are not what they should be: a clear error, a bound, an exit code."""
import os
import pathlib
import subprocess
import tempfile
import unittest

from programs import SIM, SOURCE, TOOL, run

HEADER = "probe,patch,x_m,y_m\n"


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="palpate-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def scene(self, text):
        path = self.folder / "scene.textproto"
        path.write_text(text)
        code, _, err = run(SIM, path, "--csv", "-")
        return code, err

    def test_a_directory(self):
        for command in ([TOOL, "fit", self.folder], [TOOL, "estimate", self.folder],
                        [SIM, self.folder, "--csv", "-"]):
            code, out, err = run(*command)
            self.assertEqual((code, out), (2, ""), err)
            self.assertIn("is a directory", err)
            self.assertIn(str(self.folder), err)

    def test_a_header_line_only(self):
        code, out, err = run(TOOL, "fit", "-", text_in="# nothing yet\n" + HEADER)
        self.assertEqual((code, out), (2, ""))
        self.assertIn("standard input:2:", err)
        self.assertIn("no samples", err)

    def test_a_pipe_without_end(self):
        endless = subprocess.Popen(["yes", "p,0,0.001,0.002"], stdout=subprocess.PIPE)
        try:
            done = subprocess.run([TOOL, "fit", "-"], stdin=endless.stdout, capture_output=True,
                                  text=True, timeout=60)
        finally:
            endless.kill()
            endless.communicate()
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("longer than", done.stderr)

    def test_scenes_without_what_they_need(self):
        circle = 'curve { curve_class: CURVE_CLASS_CIRCLE parameters { a: 0.02 } }\n'
        probe = 'name: "p" patches { start_t: 0 arc_m: 0.05 %s }'
        for text, wrong in ((circle, "probes"),
                            ("closed_spline { }\n", "control_points"),
                            (circle + 'probes { name: "p" }\n', "patches")):
            code, err = self.scene(text)
            self.assertEqual(code, 2, err)
            self.assertIn(wrong, err)
            self.assertRegex(err, r"scene\.textproto:\d+: ")
            self.assertNotIn("FATAL", err)
        for pace in ("spacing_m: 1e-12", "speed_m_per_s: 1e-9"):
            code, err = self.scene(circle + "probes { " + probe % pace + " }\n")
            self.assertEqual(code, 2, err)
            self.assertIn(pace.split(":")[0], err)
            self.assertIn("10 million", err)

    def test_a_port_that_is_none(self):
        code, _, err = run(TOOL, "watch", "--results", "tcp://127.0.0.1:99999")
        self.assertEqual(code, 2, err)
        self.assertIn("port", err)

    def test_a_full_disk(self):
        csv = self.folder / "line.csv"
        csv.write_text(HEADER + "".join(f"p,0,{0.001 * i},0\n" for i in range(50)))
        for command in ([TOOL, "fit", csv], [TOOL, "estimate", csv], [TOOL, "--help"],
                        [SIM, SOURCE / "sim/scenes/line.textproto", "--csv", "-"]):
            with open("/dev/full", "w") as full:
                done = subprocess.run(list(map(str, command)), stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, 1, command)
            self.assertIn("cannot be written", done.stderr)
        os.symlink("/dev/full", self.folder / "plot.svg")
        code, _, err = run(TOOL, "fit", csv, "--plot", self.folder / "plot.svg")
        self.assertEqual(code, 1)
        self.assertIn("cannot be written", err)


if __name__ == "__main__":
    unittest.main()
