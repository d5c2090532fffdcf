"""Files and outputs that are not what they should be: a clear error, a bound, an exit code."""
import json
import math
import os
import pathlib
import random
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

    def test_numbers_commands_and_places_that_are_none(self):
        csv = self.folder / "line.csv"
        csv.write_text(HEADER + "".join(f"p,0,{0.001 * i},0\n" for i in range(50)))
        for option in ("--sigma", "--tip-radius", "--recognized-probability"):
            for number in ("nan", "inf", "-1", "one"):
                code, out, err = run(TOOL, "fit", csv, f"{option}={number}")
                self.assertEqual((code, out), (2, ""), err)
                self.assertRegex(err, option + '.*"' + number + '" is no number from 0 to ')
        code, out, err = run(TOOL, "fti", csv)
        self.assertEqual((code, out), (2, ""))
        self.assertIn("there is no command fti", err)
        for name in ("", f"{self.folder}/"):
            code, out, err = run(TOOL, "keygen", name)
            self.assertEqual((code, out), (2, ""))
            self.assertIn("names no file", err)
        for option in ("--plot", "--plot-invariants", "--export"):
            ending = ".dxf" if option == "--export" else ".svg"
            code, _, err = run(TOOL, "fit", csv, "--sigma", "1e-5", option, self.folder / "none" / ("a" + ending))
            self.assertEqual(code, 1, err)
            self.assertIn("a" + ending + ": cannot be written: No such file or directory", err)

    def test_a_word_that_is_none_gets_the_nearest_that_is(self):
        lists = " --help lists them\n"
        for arguments, told in (
                (["fti", "a.csv"], "there is no command fti, did you mean fit? palpate" + lists),
                (["sphere"], "there is no command sphere; palpate" + lists),
                (["--verison"], "there is no option --verison, did you mean --version? palpate" + lists),
                (["fit", "a.csv", "--tipradius=1e-3"], "there is no option --tipradius of fit, did you mean --tip-radius? palpate fit" + lists),
                (["fit", "--sgima", "1e-5", "a.csv"], "there is no option --sgima of fit, did you mean --sigma? palpate fit" + lists),
                (["watch", "--nonsense"], "there is no option --nonsense of watch; palpate watch" + lists),
                (["check", "--" + 10_000 * "x"], "there is no option --" + 198 * "x" + "... of check; palpate check" + lists),
                (["fit", "a.csv", "--touched-from", "top"], "--touched-from: expected outside, inside or unknown; palpate fit --help says more\n"),
                (["fit", "a.csv", "--method", "best"], "--method: expected ml or tree; palpate fit --help says more\n"),
                (["fit"], "FILE is required; palpate fit --help says more\n"),
                (["fit", "a.csv", "--sigma"], "--sigma: 1 required NUMBER:FLOAT in [0 - 1000] missing; palpate fit --help says more\n"),
                (["estimate", "a.csv", "b.csv"], "The following argument was not expected: b.csv; palpate estimate --help says more\n"),
                ([], "A subcommand is required; palpate --help says more\n")):
            code, out, err = run(TOOL, *arguments)
            self.assertEqual((code, out, err), (2, "", "palpate: " + told))
        for arguments in (["--help"], ["fit", "--help"], ["--version"]):
            code, out, err = run(TOOL, *arguments)
            self.assertEqual((code, err), (0, ""))
            self.assertTrue(out)

    def test_the_verdict_of_check_tells_an_assumed_unit(self):
        path = self.folder / "ring.csv"
        assumed = "; check the unit: no unit is named: taken as metres (else --unit mm, um or in)"
        doubt = ", but see the warnings: its answer may be wrong"
        for names, scale, arguments, rest in (("x,y", 1, (), assumed), ("x,y", 1e3, (), doubt + assumed),
                                              ("x,y", 1e3, ("--unit", "mm"), ""), ("x_mm,y_mm", 1e3, (), "")):
            rng = random.Random(1)
            path.write_text(names + "\n" + "".join(
                f"{scale * (0.02 * math.cos(t) + rng.gauss(0, 2e-5))},{scale * (0.02 * math.sin(t) + rng.gauss(0, 2e-5))}\n"
                for t in (0.01 * i for i in range(300))))
            code, out, _ = run(TOOL, "check", path, *arguments)
            self.assertEqual((code, out.splitlines()[-1]), (0, "fit for the recognizer" + rest), out)
            # fit takes the same for granted.
            notes = json.loads(run(TOOL, "fit", "--format", "json", path, *arguments)[1]).get("notes", [])
            self.assertEqual(any("taken as metres" in note for note in notes), assumed in rest, notes)

    def test_names_of_files_are_shown_on_one_line_and_obeyed_by_no_terminal(self):
        csv = self.folder / "Stück 1\n\x1b[31m\u009b2J.csv"
        csv.write_text(HEADER + "".join(f"p,0,{0.001 * i},0\n" for i in range(50)))
        code, out, err = run(TOOL, "fit", csv, "--format", "text", "--sigma", "1e-5")
        self.assertEqual(code, 0, err)
        self.assertTrue(out.startswith(f"{self.folder}/Stück 1\\x0a\\x1b[31m\\xc2\\x9b2J.csv: group p"), out)
        csv.write_text(HEADER + "p,0,nan,0\n")
        code, out, err = run(TOOL, "fit", csv)
        self.assertEqual(code, 2)
        self.assertIn("Stück 1\\x0a\\x1b[31m\\xc2\\x9b2J.csv:2:5: x_m 'nan'", err)
        self.assertEqual(len(err.splitlines()), 1)

    def test_few_samples_and_curves_of_no_class_get_advice(self):
        code, out, err = run(TOOL, "fit", "-", "--format", "text", text_in=HEADER + "p,0,1,2\n")
        self.assertEqual(code, 0, err)
        self.assertIn("noise        not known yet", out)
        self.assertIn("advice       Too few places yet, as far as noise tells them apart (samples: 1)", out)
        self.assertNotIn("hypothesis", out)
        rng = random.Random(3)
        edge = HEADER + "".join(f"p,0,{2e-5 * i + rng.gauss(0, 2e-5)},{2e-5 * abs(i % 500 - 250) + rng.gauss(0, 2e-5)}\n"
                                for i in range(1000))
        code, out, err = run(TOOL, "fit", "-", "--format", "text", "--export", self.folder / "edge.csv", text_in=edge)
        self.assertEqual(code, 1)
        self.assertIn("not written: the samples are no curve of the known classes", err)
        self.assertIn("a stroke leaves it (through the air, over an edge)", out)

    def test_what_is_read_is_not_written_over(self):
        circle = "".join(f"{math.cos(t / 20)},{math.sin(t / 20)}\n" for t in range(126))
        part, link, svg = self.folder / "part.csv", self.folder / "link.csv", self.folder / "part.svg"
        ring, scene = self.folder / "ring.svg", self.folder / "scene.csv"
        for file in (part, svg, ring):
            file.write_text("x_m,y_m\n" + circle)
        scene.write_text((SOURCE / "sim/scenes/two_finger_grasp.textproto").read_text())
        link.symlink_to(part)
        os.link(part, self.folder / "hard.csv")
        # A second object goes to FILE-2.svg.
        two = self.folder / "a-2.svg"
        two.write_text("object,patch,x_m,y_m\n" + "".join(f"{k},0,{line}\n" for k in (1, 2) for line in circle.split()))
        for read, *command in (
                (part, TOOL, "fit", part, "--export", part),
                (part, TOOL, "fit", part, "--export", self.folder / "." / "part.csv"),
                (part, TOOL, "fit", link, "--export", part),
                (part, TOOL, "fit", part, "--export", link),
                (part, TOOL, "fit", part, "--export", self.folder / "hard.csv"),
                (svg, TOOL, "fit", svg, "--plot", svg),
                (svg, TOOL, "fit", svg, "--class", "circle", "--plot", svg),
                (svg, TOOL, "fit", svg, "--plot-invariants", svg),
                (two, TOOL, "fit", two, "--plot", self.folder / "a.svg"),
                (ring, TOOL, "calibrate", ring, "--circle", "1", "--output", ring),
                (ring, TOOL, "calibrate", ring, "--circle", "1", "--plot", ring),
                (scene, SIM, scene, "--csv", scene),
                (scene, SIM, scene, "--csv", self.folder / "new.csv", "--truth", scene)):
            before = read.read_bytes()
            code, out, err = run(*command)
            self.assertEqual((code, out), (2, ""), (command, err))
            self.assertIn("not written: it is the file that is read", err)
            self.assertEqual(read.read_bytes(), before, command)
        self.assertFalse((self.folder / "a.svg").exists())
        for command in ((TOOL, "fit", part, "--plot", self.folder / "b.svg", "--plot-invariants", self.folder / "." / "b.svg"),
                        (TOOL, "calibrate", ring, "--circle", "1", "--output", self.folder / "b.svg", "--plot", self.folder / "b.svg"),
                        (SIM, scene, "--csv", self.folder / "b.svg", "--truth", self.folder / "b.svg"),
                        (SIM, scene, "--csv", "-", "--truth", "-")):
            code, out, err = run(*command)
            self.assertEqual((code, out), (2, ""), (command, err))
            self.assertIn("two outputs have this name", err)
        self.assertFalse((self.folder / "b.svg").exists())
        code, _, err = run(SIM, scene, "--csv", "/dev/null", "--truth", "/dev/null")
        self.assertEqual((code, err), (0, ""))
        before = part.read_bytes()
        with part.open() as stdin:
            done = subprocess.run([TOOL, "fit", "-", "--export", part], stdin=stdin, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("as standard input", done.stderr)
        self.assertEqual(part.read_bytes(), before)
        # Another file of that name's ending may be there already: it is the answer of yesterday.
        code, _, err = run(TOOL, "fit", part, "--export", ring.with_name("old.csv"))
        self.assertEqual(code, 0, err)
        self.assertEqual(run(TOOL, "fit", part, "--export", ring.with_name("old.csv"))[0], 0)

    def test_a_full_disk(self):
        csv = self.folder / "line.csv"
        csv.write_text(HEADER + "".join(f"p,0,{0.001 * i},0\n" for i in range(50)))
        for command in ([TOOL, "fit", csv], [TOOL, "estimate", csv], [TOOL, "--help"],
                        [SIM, SOURCE / "sim/scenes/line.textproto", "--csv", "-"]):
            with open("/dev/full", "w") as full:
                done = subprocess.run(list(map(str, command)), stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, 1, command)
            self.assertIn("standard output: cannot be written: No space left on device", done.stderr)
        os.symlink("/dev/full", self.folder / "plot.svg")
        code, _, err = run(TOOL, "fit", csv, "--plot", self.folder / "plot.svg")
        self.assertEqual(code, 1)
        self.assertIn("cannot be written: No space left on device", err)
        for option in ("--csv", "--truth"):
            files = {"--csv": self.folder / "s.csv", "--truth": self.folder / "s.json"} | {option: "/dev/full"}
            code, _, err = run(SIM, SOURCE / "sim/scenes/line.textproto", *(word for pair in files.items() for word in pair))
            self.assertEqual(code, 1)
            self.assertIn("/dev/full: cannot be written: No space left on device", err)


if __name__ == "__main__":
    unittest.main()
