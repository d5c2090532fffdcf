"""palpate calibrate and fit --probe, called as a user calls them."""
import json
import math
import pathlib
import random
import re
import tempfile
import unittest
import xml.dom.minidom

from google.protobuf import json_format, text_format

from palpate.v1 import curve_pb2, probe_pb2, recognition_pb2
from programs import TOOL, run

TIP = 0.002
SIGMA = 5e-6


def lobes(phi):
    return -3e-5 + 4e-5 * math.cos(2 * phi)


def ellipse(a, b, seed, count=400, probe="p", turn=2 * math.pi, tip=TIP, more=0.0):
    """Centres of a tip all around an ellipse, as a probe with two lobes says them; `more`: in this set-up, farther out."""
    rng = random.Random(seed)
    text = "probe,patch,x_m,y_m,tip_radius_m\n"
    for i in range(count):
        t = turn * i / count
        phi = math.atan2(a * math.sin(t), b * math.cos(t))
        off = tip + lobes(phi) + more + rng.gauss(0, SIGMA)
        text += f"{probe},0,{a * math.cos(t) + off * math.cos(phi)!r},{b * math.sin(t) + off * math.sin(phi)!r},{tip}\n"
    return text


def touched(radius, inside, seed, turn=2 * math.pi):
    """A pin or a bore as a CMM says it: the centres of a tip with lobes and noise in mm, two columns, no word of a tip."""
    rng = random.Random(seed)
    text = "x_mm,y_mm\n"
    for i in range(400):
        t = turn * i / 400
        phi = t + math.pi if inside else t  # the normal out of the material
        off = TIP + lobes(phi) + rng.gauss(0, SIGMA)
        text += f"{12 + 1e3 * (radius * math.cos(t) + off * math.cos(phi)):.5f},"
        text += f"{-4 + 1e3 * (radius * math.sin(t) + off * math.sin(phi)):.5f}\n"
    return text


class Calibrate(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_a_bore_that_the_tips_contradict_is_told(self):
        ring = ellipse(0.025, 0.025, 1)
        code, out, err = run(TOOL, "calibrate", "--circle", "0.025", "--bore", "-", text_in=ring)
        self.assertEqual(code, 0, err)
        self.assertIn("--bore is not used", err)
        self.assertNotIn("--bore", run(TOOL, "calibrate", "--circle", "0.025", "-", text_in=ring)[2])

    def test_help_says_the_unit_of_every_artefact(self):
        _, out, _ = run(TOOL, "calibrate", "--help")
        for artefact, unit in (("circle A", "[m]"), ("ellipse A,B", "[m]"), ("parabola A", "in powers of metres"),
                               ("cubic-spline A,B,C", "in powers of metres")):
            self.assertRegex(out, f"--{artefact}.*{re.escape(unit)}")

    def test_patches_that_take_turns_in_a_file_are_strokes(self):
        """A lag is told by strokes that run both ways."""
        header, *rows = ellipse(0.03, 0.02, 1).splitlines(keepends=True)
        back = [row.replace("p,0,", "p,1,") for row in reversed(rows)]
        answers = []
        for text in (rows + back, [row for pair in zip(rows, back) for row in pair]):
            code, out, err = run(TOOL, "calibrate", "--ellipse", "0.03,0.02", "--format", "json", "-",
                                 text_in=header + "".join(text))
            self.assertEqual(code, 0, err)
            answers.append(out)
        self.assertIn("lag", answers[0])
        self.assertEqual(*answers)

    def test_the_words_of_a_picture_stay_on_its_page(self):
        plot = self.folder / "lobes.svg"
        # More samples than are drawn, which takes a sentence more.
        code, _, err = run(TOOL, "calibrate", "--circle", "0.025", "--plot", plot, "-",
                           text_in=ellipse(0.025, 0.025, 1, count=5000, probe="p" * 64))
        self.assertEqual(code, 0, err)
        page = xml.dom.minidom.parse(str(plot)).documentElement
        width = float(page.getAttribute("viewBox").split()[2])
        for text in page.getElementsByTagName("text"):
            words = text.firstChild.data
            size = float(text.getAttribute("font-size") or 12)
            if text.getAttribute("text-anchor"):
                continue
            # Half its height is what a letter takes at least, on average.
            self.assertLess(float(text.getAttribute("x")) + 0.5 * size * len(words), width, words)

    def calibrated(self, *more):
        path = self.folder / "p.probe"
        code, out, err = run(TOOL, "calibrate", "--circle", "0.025", "--same-setup", "--output", str(path), *more, "-",
                             text_in=ellipse(0.025, 0.025, 1))
        self.assertEqual(code, 0, err)
        return path, out

    def test_a_ring_tells_offset_and_lobes(self):
        plot = self.folder / "p.svg"
        path, out = self.calibrated("--plot", str(plot))
        self.assertIn("sufficient", out)
        self.assertIn("2 lobes", out)
        probe = text_format.Parse(path.read_text(), probe_pb2.Probe())
        self.assertEqual(probe.name, "p")
        self.assertEqual(probe.artefact, "circle 0.025")
        self.assertEqual(probe.verdict, probe_pb2.QUALIFICATION_VERDICT_SUFFICIENT)
        deviation = math.sqrt(probe.offset_covariance_m2[0])
        self.assertLess(abs(probe.offset_m + 3e-5), 4 * deviation)
        self.assertLess(deviation, SIGMA)
        self.assertEqual([harmonic.order for harmonic in probe.harmonics][0], 2)
        self.assertAlmostEqual(probe.harmonics[0].cosine_m, 4e-5, delta=3e-6)
        self.assertAlmostEqual(probe.sigma_m.value, SIGMA, delta=4 * probe.sigma_m.deviation)
        self.assertFalse(probe.HasField("lag_m"))
        self.assertEqual(xml.dom.minidom.parse(str(plot)).documentElement.tagName, "svg")

    def test_a_bore_that_is_not_told_of_is_noticed(self):
        for tip, noticed in ((-TIP, True), (TIP, False), (0.0, False)):
            centres = ellipse(0.025, 0.025, 1, tip=tip).replace(f",{tip}\n", ",0\n")
            for bore in ((), ("--bore",)):
                code, _, err = run(TOOL, "calibrate", "--circle", "0.025", *bore, "-", text_in=centres)
                self.assertEqual(code, 0, err)
                within = noticed if not bore else tip > 0
                self.assertEqual("within the material" in err, within, (tip, bore, err))

    def test_the_plot_shows_lobes_without_the_mean(self):
        # Three lobes of 20 um on a ring. Where no tip radius was stated the mean offset, 2 mm, must not hide them.
        rng = random.Random(7)
        text = "x_m,y_m\n"
        for i in range(400):
            phi = 2 * math.pi * i / 400
            r = 0.025 + TIP + 2e-5 * math.cos(3 * phi) + rng.gauss(0, 2e-6)
            text += f"{r * math.cos(phi)!r},{r * math.sin(phi)!r}\n"
        for stated, mean in ((), "with no tip radius stated: 2.0"), (("--tip-radius", TIP), "beyond the tip radius of 2 mm: "):
            path = self.folder / "lobes.svg"
            code, _, err = run(TOOL, "calibrate", "--circle", "0.025", *stated, "--plot", path, "-", text_in=text)
            self.assertEqual(code, 0, err)
            svg = path.read_text()
            self.assertIn("mean offset " + mean, svg)
            middle, circle = 240, float(re.search(r'<circle cx="240.0" cy="240.0" r="([\d.]+)" fill="none"', svg)[1])
            points = [tuple(map(float, point.split(","))) for point in re.search(r'points="([^"]+)"', svg)[1].split()]
            height = [math.hypot(x - middle, y - middle) - circle for x, y in points]
            # The scale's bar: its length on paper and in words.
            left, right, length = re.search(r'M([\d.]+),[\d.]+ v8 m0,-4 H([\d.]+).*\n<text[^>]*>([\d.]+) um</text>', svg).groups()
            um = (float(right) - float(left)) / float(length)
            self.assertAlmostEqual(max(height) / um, 20, delta=1)
            self.assertAlmostEqual(min(height) / um, -20, delta=1)
            self.assertGreater(max(height), circle / 4)
            above = [h > 0 for h in height]
            self.assertEqual(sum(a != b for a, b in zip(above, above[1:] + above[:1])), 6)

    def test_json_says_what_the_file_says(self):
        path, out = self.calibrated("--format", "json")
        written = text_format.Parse(path.read_text(), probe_pb2.Probe())
        self.assertEqual(json_format.Parse(out, probe_pb2.Probe()), written)

    def fit(self, *arguments, text):
        code, out, err = run(TOOL, "fit", "--format", "json", *arguments, "-", text_in=text)
        self.assertEqual(code, 0, err)
        message = json.loads(out)
        notes = message.pop("notes", [])
        return json_format.ParseDict(message, recognition_pb2.Recognition()), notes

    def test_a_part_is_measured_with_it(self):
        path, _ = self.calibrated()
        part = ellipse(0.03, 0.02, 2)
        plain, _ = self.fit(text=part)
        self.assertEqual(list(plain.probe_files), [])
        answer, notes = self.fit("--probe", str(path), text=part)
        self.assertEqual(list(answer.probe_files), [str(path)])
        self.assertEqual(answer.curve_class, curve_pb2.CURVE_CLASS_ELLIPSE)
        self.assertEqual(answer.status, recognition_pb2.RECOGNITION_STATUS_RECOGNIZED)
        self.assertEqual(notes, [])
        # As it came b is off by offset and lobes together, 7e-5.
        self.assertAlmostEqual(plain.parameters.b, 0.02 - 7e-5, delta=1e-5)
        for value, truth, i in ((answer.parameters.a, 0.03, 0), (answer.parameters.b, 0.02, 1)):
            self.assertLess(abs(value - truth), 4 * math.sqrt(answer.covariance[i * 5 + i]))
            self.assertLess(math.sqrt(answer.covariance[i * 5 + i]), 1e-5)

    def test_a_tip_that_nobody_stated_is_on_the_side_that_is_touched(self):
        for inside in (False, True):
            ring, part, path = self.folder / "ring.csv", self.folder / "part.csv", self.folder / "stylus.probe"
            ring.write_text(touched(0.025, inside, 1))
            part.write_text(touched(0.015, inside, 2, turn=2.0))
            code, out, err = run(TOOL, "calibrate", ring, "--circle", "0.025", *["--bore"] * inside, "--output", path)
            self.assertEqual(code, 0, err)
            self.assertIn("tip radius   1.97", out)
            self.assertIn("estimated: the samples state none; an error of the artefact's size is in it", out)
            side = ("--touched-from", "inside" if inside else "outside")

            def fit(*options):
                code, out, err = run(TOOL, "fit", part, "--format", "json", "--probe", path, *options)
                self.assertEqual(code, 0, err)
                answer = json.loads(out)
                return answer.get("recognition", answer), answer.get("notes", [])

            for options in (side, (*side, "--tip-radius", "0.002"), (*side, "--class", "circle")):
                answer, notes = fit(*options)
                self.assertEqual(answer["curve_class"], "CURVE_CLASS_CIRCLE", options)
                self.assertEqual(answer["status"], "RECOGNITION_STATUS_RECOGNIZED", options)
                deviation = math.sqrt(answer["covariance"][0])
                self.assertLess(abs(answer["parameters"]["a"] - 0.015), 4 * deviation)
                self.assertLess(deviation, 1e-4)
                # The radius is in the file: another one is not taken off too, and this is said.
                said = [note for note in notes if "tip radius" in note]
                self.assertEqual(len(said), 1 if "--tip-radius" in options else 0, notes)
                self.assertTrue(all(f"of {path}, 1.97" in note and "the samples, 2 mm" in note for note in said), said)
            # Where nothing tells the side, a pin and a bore fit alike.
            self.assertNotEqual(fit()[0]["status"], "RECOGNITION_STATUS_RECOGNIZED")

    def test_surface_points_and_a_tip_contradict_one_another(self):
        # Less its tip, the probe tells points of the surface, 30 um too deep: no tip has such a radius.
        path, part = self.folder / "p.probe", ellipse(0.03, 0.02, 2, tip=0.0)
        code, _, err = run(TOOL, "calibrate", "--circle", "0.025", "--output", path, "-", text_in=ellipse(0.025, 0.025, 1, tip=0.0))
        self.assertEqual(code, 0, err)
        self.assertNotIn("tip_radius_m", path.read_text())
        for tip, said in ((), 0), (("--tip-radius", "0.002"), 1):
            _, notes = self.fit("--probe", path, *tip, text=part.replace(",0.0\n", ",\n"))
            self.assertEqual(sum("points of the surface" in note for note in notes), said, notes)

    def test_the_picture_shows_samples_as_they_were_measured(self):
        # Lobes of 40 um, eight times the noise, and an offset of 2 mm where nobody stated the tip.
        for inside in (False, True):
            path, part, svg = self.folder / "p.probe", self.folder / "part.csv", self.folder / "part.svg"
            code, _, err = run(TOOL, "calibrate", "--circle", "0.025", *["--bore"] * inside, "--output", path, "-",
                               text_in=touched(0.025, inside, 1))
            self.assertEqual(code, 0, err)
            part.write_text(touched(0.015, inside, 2, turn=2.0))
            for options in ((), ("--class", "circle")):
                code, _, err = run(TOOL, "fit", part, "--probe", path, "--touched-from", "inside" if inside else "outside",
                                   "--plot", svg, *options)
                self.assertEqual(code, 0, err)
                picture = svg.read_text()
                self.assertIn("residuals, ", picture)
                self.assertNotIn("beyond 5 sigma", picture)
                self.assertEqual(re.search(r'<path class="far"[^>]* d="([^"]*)"', picture)[1], "")
        # A sample that is off is crossed out, with a probe file too.
        rows = part.read_text().splitlines()
        x, y = map(float, rows[200].split(","))
        rows[200] = f"{x + 0.5},{y + 0.5}"
        part.write_text("\n".join(rows) + "\n")
        code, _, err = run(TOOL, "fit", part, "--probe", path, "--touched-from", "inside", "--plot", svg, "--class", "circle")
        self.assertEqual(code, 0, err)
        self.assertIn("1 beyond 5 sigma", svg.read_text())

    def test_recordings_tell_what_set_ups_differ_by(self):
        rings = [self.folder / f"ring{i}.csv" for i in range(4)]
        for i, ring in enumerate(rings):
            ring.write_text(ellipse(0.025, 0.025, i, more=(4e-5, -3e-5, 1e-5, -2e-5)[i]))
        path = self.folder / "p.probe"
        part = ellipse(0.03, 0.02, 9, more=3e-5)
        sizes = []
        for files, guess in ((rings[:1], True), (rings, False)):
            code, out, err = run(TOOL, "calibrate", "--circle", "0.025", "--output", str(path), *map(str, files))
            self.assertEqual(code, 0, err)
            self.assertIn("set-ups", out)
            self.assertEqual("a guess" in out, guess)
            probe = text_format.Parse(path.read_text(), probe_pb2.Probe())
            sizes.append(probe.setup_m.value)
            answer, _ = self.fit("--probe", str(path), text=part)
            deviation = math.sqrt(answer.covariance[0])
            self.assertGreater(deviation, 0.9 * probe.setup_m.value)
            self.assertLess(abs(answer.parameters.a - 0.03), 2.5 * deviation)
        # The four lie 3.2e-5 about their mean; of a guess only the lobes, 4e-5, are known.
        self.assertTrue(2e-5 < sizes[1] < 8e-5, sizes)
        self.assertGreater(sizes[0], 4e-5)

    def test_the_text_names_the_file(self):
        path, _ = self.calibrated()
        code, out, _ = run(TOOL, "fit", "--format", "text", "--probe", str(path), "-", text_in=ellipse(0.03, 0.02, 2))
        self.assertEqual(code, 0)
        self.assertIn(f"probe file   {path}\n", out)

    def test_of_several_files_each_is_for_its_probe(self):
        path, _ = self.calibrated()
        other = self.folder / "other.probe"
        other.write_text(path.read_text().replace('name: "p"', 'name: "q"'))
        answer, notes = self.fit("--probe", str(path), "--probe", str(other), text=ellipse(0.03, 0.02, 2, probe="q"))
        self.assertEqual(list(answer.probe_files), [str(other)])
        _, notes = self.fit("--probe", str(path), "--probe", str(other), text=ellipse(0.03, 0.02, 2, probe="r"))
        self.assertTrue(any("no probe file is of probe r" in note for note in notes))
        # As on a node: one without a name is for all others, and no probe has two files.
        rest = self.folder / "rest.probe"
        rest.write_text(path.read_text().replace('name: "p"', 'name: ""'))
        answer, _ = self.fit("--probe", str(path), "--probe", str(rest), text=ellipse(0.03, 0.02, 2, probe="r"))
        self.assertEqual(list(answer.probe_files), [str(rest)])
        answer, _ = self.fit("--probe", str(path), "--probe", str(rest), text=ellipse(0.03, 0.02, 2))
        self.assertEqual(list(answer.probe_files), [str(path)])
        code, _, err = run(TOOL, "fit", "--probe", path, "--probe", path, "-", text_in=ellipse(0.03, 0.02, 2))
        self.assertEqual(code, 2)
        self.assertIn("a probe has one file", err)

    def test_two_tips_are_not_one_probe(self):
        text = ellipse(0.025, 0.025, 1) + ellipse(0.025, 0.025, 2, tip=0.003).replace("p,0,", "p,1,").partition("\n")[2]
        code, out, err = run(TOOL, "calibrate", "--circle", "0.025", "-", text_in=text)
        self.assertEqual((code, out), (1, ""))
        self.assertIn("different tip radii", err)

    def test_a_short_arc_does_not_suffice(self):
        code, out, err = run(TOOL, "calibrate", "--circle", "0.025", "-", text_in=ellipse(0.025, 0.025, 1, turn=0.5))
        self.assertEqual(code, 1)
        self.assertIn("insufficient", out)
        self.assertIn("not touched", out)
        self.assertIn("do not suffice", err)

    def test_an_artefact_of_another_size_is_not_taken_for_an_offset(self):
        # A ring of 25 mm, typed as 26 mm.
        path = self.folder / "p.probe"
        code, out, err = run(TOOL, "calibrate", "--circle", "0.026", "--output", path, "-", text_in=ellipse(0.025, 0.025, 1))
        self.assertEqual(code, 1, out)
        self.assertIn("circle 0.026: insufficient", out)
        self.assertRegex(out, "verdict .*the offset is more than a tenth of the tip radius")
        self.assertIn("the artefact or the tip has rather another size than circle 0.026 and a tip radius of 2 mm", err)
        self.assertIn("QUALIFICATION_VERDICT_INSUFFICIENT", path.read_text())
        _, notes = self.fit("--probe", path, text=ellipse(0.03, 0.02, 2))
        self.assertIn(f"WARNING: {path}: its qualification was insufficient", notes)
        # Half of the step to the next tip, either way.
        for off, code in ((-0.09, 0), (-0.11, 1), (0.09, 0), (0.11, 1)):
            text = ellipse(0.025, 0.025, 1, more=3e-5 + off * TIP)
            done = run(TOOL, "calibrate", "--circle", "0.025", "-", text_in=text)
            self.assertEqual(done[0], code, (off, done))

    def test_what_is_no_qualification_is_refused(self):
        ring = ellipse(0.025, 0.025, 1)
        for arguments, text, code, why in (
                ((), ring, 2, "--circle"),
                (("--circle", "0.025", "--ellipse", "0.03,0.02"), ring, 2, "one artefact"),
                (("--circle", "-1"), ring, 2, "out of the range"),
                (("--ellipse", "0.02,0.03"), ring, 2, "a >= b"),
                (("--circle", "0.025"), "probe,patch,x_m,y_m\np,0,nan,0\n", 2, "standard input:2:5:"),
                (("--circle", "0.025"), ellipse(0.025, 0.025, 1, count=6), 1, "fewer than 12"),
                (("--circle", "0.025", "--output", "/dev/null/p"), ring, 1, "/dev/null/p: cannot be written: Not a directory"),
                (("--circle", "0.025", "--plot", "/dev/null/p"), ring, 1, "/dev/null/p: cannot be written: Not a directory"),
                (("--circle", "0.025"), ring + ellipse(0.025, 0.025, 1, probe="q").partition("\n")[2], 2, "p q")):
            done = run(TOOL, "calibrate", *arguments, "-", text_in=text)
            self.assertEqual(done[0], code, (arguments, done))
            self.assertIn(why, done[2])

    def test_a_bad_probe_file_is_named_by_line_and_field(self):
        good = "tip_radius_m: 0.002\noffset_m: 1e-5\n"
        for text, why in (
                (good + "nonsense: 3\n", ":3:"),
                (good + "sigma_m { value: -1 }\n", ":3: sigma_m:"),
                (good + "sigma_m { value: nan }\n", ":3: sigma_m:"),
                ("offset_m: inf\n", ":1: offset_m:"),
                ("\ntip_radius_m: -2\n", ":2: tip_radius_m:"),
                (good + "harmonics { order: 3 cosine_m: 1e-5 }\n", ":3: harmonics[0]: order must be 2"),
                (good + "\nharmonics { order: 2 cosine_m: nan }\n", ":4: harmonics[0]:"),
                (good + "offset_covariance_m2: [1, 2]\n", ":3: offset_covariance_m2[0]: must be 1"),
                (good + "offset_covariance_m2: -1\n", ":3: offset_covariance_m2[0]: is no covariance"),
                (good + "spike_probability { value: 2 }\n", ":3: spike_probability:"),
                (good + "deviation_m { value: 1e-6 }\n", ":3: deviation_m:"),
                (good + "lag_m { value: 1e-3 deviation: -1 }\n", ":3: lag_m:")):
            path = self.folder / "bad.probe"
            path.write_text(text)
            code, out, err = run(TOOL, "fit", "--probe", str(path), "-", text_in=ellipse(0.03, 0.02, 2))
            self.assertEqual((code, out), (2, ""), text)
            self.assertIn(f"{path}{why}", err)
        # What is no probe file at all: the parser's words, for programmers, do not come first.
        for text, place in ((ellipse(0.03, 0.02, 2), ":1:6: "), ("0.1 0.2\n", ":1:1: ")):
            path.write_text(text)
            code, out, err = run(TOOL, "fit", "--probe", str(path), "-", text_in=ellipse(0.03, 0.02, 2))
            self.assertEqual((code, out), (2, ""), err)
            self.assertIn(f"palpate: {path}{place}this is no line of a probe file; palpate calibrate --output writes", err)

    def test_an_incomplete_probe_file_is_refused(self):
        path, _ = self.calibrated()
        whole = path.read_text()
        part = ellipse(0.03, 0.02, 2)
        self.assertEqual(run(TOOL, "fit", "--probe", path, "-", text_in=part)[0], 0)
        for text, field in (
                ("", "artefact"),
                ("# nothing but words\n", "artefact"),
                (re.sub(r"verdict: .*\n", "", whole), "verdict"),
                (whole.partition("offset_covariance_m2")[0], "offset_covariance_m2"),
                (whole.partition("sigma_m {")[0], "sigma_m"),
                (whole.partition("deviation_m {")[0], "deviation_m"),
                (re.sub(r"deviation_m {[^}]*}", "deviation_m {}", whole.partition("deviation_length_m {")[0]), "deviation_length_m"),
                (whole.partition("spike_probability {")[0], "spike_probability"),
                (whole.partition("setup_m {")[0], "setup_m")):
            self.assertNotEqual(text, whole, field)
            path.write_text(text)
            code, out, err = run(TOOL, "fit", "--probe", path, "-", text_in=part)
            self.assertEqual((code, out), (2, ""), (field, err))
            self.assertIn(f"palpate: {path}: {field}: is missing", err)
        # Wherever a file is cut off between two lines.
        lines = whole.splitlines(keepends=True)
        for count in range(len(lines)):
            path.write_text("".join(lines[:count]))
            code, out, _ = run(TOOL, "fit", "--probe", path, "-", text_in=part)
            self.assertEqual((code, out), (2, ""), count)


if __name__ == "__main__":
    unittest.main()
