"""Files as people have them: read for what they are, or refused by file, line and field; nothing in silence."""
import json
import math
import pathlib
import random
import tempfile
import unittest

from programs import TOOL, run

A, B, SIGMA = 0.025, 0.0175, 2e-5  # of the ellipse that the files hold [m]


def ellipse(patches=((0.3, 1.5), (2.3, 3.6)), count=111, centre=(0.03, -0.01)):
    """Points of strokes on an ellipse, in metres: a list a stroke."""
    rng = random.Random(1)
    strokes = []
    for start, end in patches:
        stroke = []
        for i in range(count):
            t = start + (end - start) * i / max(count - 1, 1)
            stroke.append((centre[0] + A * math.cos(t) + rng.gauss(0, SIGMA),
                           centre[1] + B * math.sin(t) + rng.gauss(0, SIGMA)))
        strokes.append(stroke)
    return strokes


WHOLE = ellipse(patches=((0, 5.5),), count=222)[0]


class Formats(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="palpate-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def fit(self, text, *arguments, encoding="utf-8"):
        path = self.folder / "points.txt"
        path.write_bytes(text.encode(encoding))
        code, out, err = run(TOOL, "fit", path, "--format", "json", *arguments)
        self.assertEqual(code, 0, err)
        self.err = err
        answer = json.loads(out)
        self.notes = "\n".join(answer.setdefault("notes", []))
        return answer

    def check(self, text, *arguments, encoding="utf-8"):
        """The ellipse is found with its size in metres."""
        answer = self.fit(text, *arguments, encoding=encoding)
        self.assertEqual(answer["curve_class"], "CURVE_CLASS_ELLIPSE", answer["notes"])
        for letter, truth in (("a", A), ("b", B)):
            self.assertLess(abs(answer["parameters"][letter] / truth - 1), 0.01)
        return answer

    def refused(self, text, *arguments):
        path = self.folder / "points.txt"
        path.write_text(text)
        code, out, err = run(TOOL, "fit", path, *arguments)
        self.assertEqual((code, out), (2, ""), err)
        self.assertIn(str(path), err)
        return err.replace(str(path), "FILE")

    def rows(self, scale=1.0, separator=",", digits="{:.9g}"):
        return "".join(separator.join(digits.format(scale * v) for v in point) + "\n" for point in WHOLE)

    def test_columns_by_common_names_with_their_units(self):
        for header, scale in (("x_m,y_m", 1), ("x_mm,y_mm", 1e3), ("X [mm],Y [mm]", 1e3), ("x (um),y (um)", 1e6),
                              ("pos_x_in,pos_y_in", 1 / 0.0254), ('"Position X [\u00b5m]","Position Y [\u00b5m]"', 1e6)):
            self.check(header + "\n" + self.rows(scale))
            self.assertNotIn("unit", self.notes, header)

    def test_a_file_that_names_no_unit_is_metres_and_that_is_said(self):
        for text in ("x,y\n" + self.rows(), self.rows(), self.rows(separator=" ")):
            self.check(text)
            self.assertIn("no unit is named: taken as metres", self.notes)
        for unit, scale in (("mm", 1e3), ("um", 1e6), ("in", 1 / 0.0254), ("m", 1)):
            self.check(self.rows(scale), "--unit", unit)
            self.assertNotIn("no unit", self.notes)

    def test_separators_comments_and_decimal_commas(self):
        self.check("# made by a machine\nx_mm;y_mm\n" + self.rows(1e3, ";"))
        self.check("x_mm\ty_mm\n" + self.rows(1e3, "\t"))
        self.check("x_mm  y_mm\r\n" + self.rows(1e3, "   ").replace("\n", "\r\n"))
        self.check("x_mm;y_mm;\n" + self.rows(1e3, ";").replace("\n", ";\n").replace(".", ","))
        self.assertIn("commas are read as decimal points", self.notes)

    def test_what_spreadsheets_write(self):
        names = '"Messpunkt";"X-Wert [mm]";"Y-Wert [mm]";"Bemerkung"\r\n'
        rows = "".join(f"{k};{1e3 * x:.5f};{1e3 * y:.5f};ok\r\n".replace(".", ",") for k, (x, y) in enumerate(WHOLE))
        for encoding in ("utf-8-sig", "utf-16-le", "utf-16-be", "latin-1"):
            mark = "\ufeff" if encoding.startswith("utf-16") else ""
            self.check(mark + names + rows, encoding=encoding)
            self.assertIn("columns ignored: Messpunkt, Bemerkung", self.notes)
        # Its own mark of the separator; a micro sign of Latin-1; rows of nothing; an old Mac's line ends; bars.
        self.check("sep=;\r\n" + names + rows)
        self.check("X [\u00b5m];Y [\u00b5m]\r\n" + self.rows(1e6, ";"), encoding="latin-1")
        answer = self.check(names + rows + ";;;\r\n;;;\r\n")
        self.assertEqual({c["patch"] for c in answer["contacts"]}, {0})
        self.check((names + rows).replace("\r\n", "\r"))
        self.check("x_mm|y_mm\n" + self.rows(1e3, "|"))
        self.assertIn("FILE:3:3: y '#N/A': not a number", self.refused("x_mm,y_mm\n1,2\n3,#N/A\n"))

    def test_titles_above_the_names_and_units_below_them(self):
        self.check("Part: bracket 12\nDate: 2026-11-22, 10:15\n\nx_mm,y_mm\n" + self.rows(1e3))
        self.assertIn("lines ignored before the names of the columns: 2, the first 'Part: bracket 12'", self.notes)
        self.check("X,Y\nmm,mm\n" + self.rows(1e3))
        self.assertNotIn("unit", self.notes)
        self.check("X;Y;Force\n[um];[um];[N]\n" + self.rows(1e6, ";").replace("\n", ";1\n"))
        # Numbers after a title have no names: nothing is guessed of them.
        self.assertIn("FILE:1:1: no columns of two coordinates: 'Part 12'", self.refused("Part 12\n1,2\n3,4\n"))

    def test_what_numpy_writes(self):
        savetxt = self.rows(separator=" ", digits="{:.18e}")
        self.check(savetxt)
        self.check("# x_mm y_mm\n" + self.rows(1e3, " ", "{:.18e}"))
        self.assertIn("names the columns", self.notes)

    def test_empty_lines_part_strokes_and_that_is_said(self):
        text = "\n".join("".join(f"{x:.9g} {y:.9g}\n" for x, y in stroke) for stroke in ellipse())
        answer = self.check(text)
        self.assertIn("2 patches", self.notes)
        self.assertEqual({c["patch"] for c in answer["contacts"]}, {0, 1})

    def test_columns_that_are_not_known_are_ignored_aloud(self):
        self.check("x_m,y_m,force_n,colour\n" + self.rows().replace("\n", ",1,red\n"))
        self.assertIn("columns ignored: force_n, colour", self.notes)

    def test_points_of_space_are_brought_into_their_plane(self):
        def cloud(place):
            return "".join("%.9g,%.9g,%.9g\n" % place(x, y) for x, y in WHOLE)
        self.check(cloud(lambda x, y: (x, y, 0.1)))
        self.assertIn("z is dropped", self.notes)
        self.check("x_mm,y_mm,z_mm\n" + cloud(lambda x, y: (1e3 * x, 5, 1e3 * y)))
        self.assertIn("the plane is xz; y is dropped", self.notes)
        self.check("y_m,z_m\n" + self.rows())
        tilted = cloud(lambda x, y: (x, 0.8 * y, 0.6 * y + 0.2))
        self.assertIn("choose their plane", self.refused(tilted))
        self.check(tilted, "--plane", "fit")
        self.assertIn("normal (", self.notes)
        self.assertIn("--plane", self.refused(self.rows(), "--plane", "xz"))

    def touches(self):
        return [(0.02 + 0.015 * math.cos(t), 0.015 * math.sin(t)) for t in (2 * math.pi * i / 12 for i in range(12))]

    def test_probe_logs_of_linuxcnc_and_grbl_are_touches(self):
        linuxcnc = "".join(f"{1e3 * x:.6f} {1e3 * y:.6f} -5.000000 0.0 0.0 0.0 0.0 0.0 0.0\n" for x, y in self.touches())
        grbl = "Grbl 1.1h ['$' for help]\nok\n" + "".join(
            f"G38.2 X0 F50\n[PRB:{1e3 * x:.3f},{1e3 * y:.3f},-5.000:1]\nok\n" for x, y in self.touches())
        grbl += "[PRB:0.000,0.000,-9.000:0]\n"
        for text in (linuxcnc, grbl):
            answer = self.fit(text, "--sigma", "5e-6")
            self.assertEqual(answer["curve_class"], "CURVE_CLASS_CIRCLE", answer["notes"])
            self.assertLess(abs(answer["parameters"]["a"] - 0.015), 2e-5)
            self.assertEqual(int(answer["sample_count"]), 12)
            self.assertIn("taken as millimetres", self.notes)
            self.assertIn("every row is a touch of its own", self.notes)
        self.assertIn("1 probing cycles that touched nothing", self.notes)
        self.assertIn(f"{2 + 2 * 12} other lines are ignored", self.notes)
        self.assertRegex(self.refused("[PRB:1.0,2.0:1]\n"), r"FILE:1:13: three coordinates")

    def test_touches_all_round_get_no_advice_about_a_short_arc(self):
        text = "x_m,y_m\n" + "".join(f"{x},{y}\n" for x, y in self.touches())
        path = self.folder / "bore.csv"
        path.write_text(text)
        code, out, _ = run(TOOL, "fit", path, "--touches", "--sigma", "2e-4", "--format", "text")
        self.assertEqual(code, 0)
        self.assertNotIn("too short", out)

    def test_a_tip_radius_that_the_file_does_not_say(self):
        outside = [(0.02 + 0.017 * math.cos(t), 0.017 * math.sin(t)) for t in (2 * math.pi * i / 40 for i in range(40))]
        text = "x_m,y_m,material_side\n" + "".join(f"{x},{y},left\n" for x, y in outside)
        answer = self.fit(text, "--tip-radius", "0.002", "--sigma", "1e-6")
        self.assertAlmostEqual(answer["parameters"]["a"], 0.015, places=5)

    def test_millimetres_under_metres_are_told_and_never_changed(self):
        answer = self.fit("x_m,y_m\n" + self.rows(1e3), "--sigma", "0.02")
        self.assertLess(abs(answer["parameters"]["a"] / 25 - 1), 0.01)
        self.assertIn("WARNING", self.err)
        self.assertIn("--unit mm", self.err)
        self.assertIn("WARNING: the samples extend over", self.notes)
        self.check("x_m,y_m\n" + self.rows(1e3), "--unit", "mm")
        self.assertIn("not from the columns' names", self.notes)
        self.assertEqual(self.err, "")

    def test_a_tip_radius_in_millimetres_where_metres_are_asked_is_told(self):
        metres = "x_m,y_m\n" + "".join(f"{x:.7f},{y:.7f}\n" for x, y in WHOLE)
        self.fit(metres, "--tip-radius", 3)
        self.assertIn("centres of a tip of radius 3 m", self.notes)
        self.fit(metres, "--tip-radius", 0.003)
        self.assertNotIn("centres of a tip", self.notes)

    def test_a_noise_in_millimetres_where_metres_are_asked_is_told(self):
        millimetres = "x_mm,y_mm\n" + "".join(f"{1e3 * x:.4f},{1e3 * y:.4f}\n" for x, y in WHOLE)
        for touches in ((), ("--touches",)):
            self.fit(millimetres, "--sigma", 0.02, *touches)
            self.assertIn("noise of 20 mm is no touch probe's", self.err)
            self.assertIn("--sigma is metres", self.notes)
            self.fit(millimetres, "--sigma", 2e-5, *touches)
            self.assertNotIn("no touch probe's", self.err)

    def test_strokes_without_patch_numbers_are_told(self):
        self.fit("x_m,y_m\n" + "".join(f"{x},{y}\n" for stroke in ellipse() for x, y in stroke))
        self.assertIn("jumps", self.err)
        self.assertIn("column patch", self.err)

    def test_rows_in_no_order_are_told(self):
        rows = WHOLE[:]
        random.Random(2).shuffle(rows)
        shuffled = "x_m,y_m\n" + "".join(f"{x},{y}\n" for x, y in rows)
        answer = self.fit(shuffled)
        self.assertIn("1 patches go to and fro over their whole extent", self.err)
        self.assertIn("in no order are --touches", "".join(answer["notes"]))
        self.check(shuffled, "--touches")
        self.assertEqual(self.err, "")
        path = self.folder / "shuffled.csv"
        path.write_text(shuffled)
        self.assertEqual(run(TOOL, "check", path)[0], 1)
        # Once round the part, densely sampled with much noise between: that is an order.
        dense = "x_m,y_m\n" + "".join(f"{A * math.cos(t)},{B * math.sin(t)}\n" for t in
                                      (2 * math.pi * i / 40 for i in range(40)))
        self.fit(dense)
        self.assertEqual(self.err, "")

    def test_the_noise_of_many_samples_is_that_of_one(self):
        # More than 1024 of a patch are used as means: what is said of the noise is of the samples.
        rng = random.Random(4)
        text = "x_m,y_m\n" + "".join(f"{A * math.cos(t) + rng.gauss(0, SIGMA)},{B * math.sin(t) + rng.gauss(0, SIGMA)}\n"
                                     for t in (5.5 * i / 20000 for i in range(20000)))
        for arguments in ((), ("--sigma", SIGMA)):
            picture = self.folder / "picture.svg"
            answer = self.fit(text, "--plot", picture, *arguments)
            # The means are some 625 at least: their own noise is known to 5 / sqrt(2 * 625) of itself.
            self.assertLess(abs(answer["sigma_m"] / SIGMA - 1), 5 / math.sqrt(2 * 625), arguments)
            # Of 20,000 gaussian errors one in a hundred times one is beyond 5 sigma.
            self.assertNotIn("beyond", picture.read_text())

    def test_a_class_at_its_limit_to_another_shows_no_shape(self):
        text = "x_mm,y_mm\n" + "".join(f"{int(25 * math.cos(t) + 10)},{int(17.5 * math.sin(t) - 3)}\n"
                                       for t in (0.2 + 1.2 * i / 99 for i in range(100)))
        answer = self.fit(text)
        best = answer["hypotheses"][0]
        self.assertTrue(best["at_limit"], answer)
        self.assertNotIn("parameters", answer)
        self.assertNotIn("pose", answer)

    def test_no_patch_of_a_file_is_dropped(self):
        # Of 90 patches the first 26 held the part's far end.
        strokes = ellipse(patches=[(0.065 * k, 0.065 * k + 0.05) for k in range(90)], count=9)
        text = "x_m,y_m,patch,sigma_m\n" + "".join(
            f"{x!r},{y!r},{k},{SIGMA}\n" for k, stroke in enumerate(strokes) for x, y in stroke)
        answer = self.check(text)
        self.assertEqual(int(answer["sample_count"]), 90 * 9)
        self.assertNotIn("forgotten", self.notes)
        answer = self.fit(text, "--most-patches", "64")
        self.assertEqual(int(answer["sample_count"]), 64 * 9)
        self.assertIn("234 samples of the oldest of 90 patches are forgotten", self.notes)

    def test_what_is_merged_or_dropped_is_said(self):
        self.fit("x_m,y_m\n" + self.rows() + self.rows().splitlines()[-1] + "\n")
        self.assertIn("1 samples at exactly the place", self.notes)
        self.fit("x_m,y_m\n" + self.rows(), "--most-samples-per-patch", "100")
        self.assertIn("means of neighbours", self.notes)

    def test_chi_square_is_shown_where_the_noise_is_known_only(self):
        path = self.folder / "points.csv"
        path.write_text("x_m,y_m\n" + self.rows())
        _, out, _ = run(TOOL, "fit", path, "--format", "text")
        self.assertNotIn("chi2  ", out)
        self.assertIn("estimated from the samples", out)
        _, out, _ = run(TOOL, "fit", path, "--format", "text", "--sigma", SIGMA)
        self.assertRegex(out, r"probability +chi2 +dof")

    def test_an_error_names_file_line_and_field(self):
        for text, message in (("x,y\n", "FILE:1:1: no samples after the header line"),
                              ("# nothing\n", "FILE:1:1: no samples: the file is empty"),
                              ("x_mm,y_mm\n1,2\n1,two\n", "FILE:3:3: y 'two': not a number"),
                              ("x_mm;y_mm\n1;2\n1;nan\n", "FILE:3:3: y 'nan': not a finite number"),
                              ("1 2\n3 4 5\n", "FILE:2:5: 3 fields instead of 2"),
                              ("1 2 3 4\n", "FILE:1:1: 4 columns without a line of names"),
                              ("1\n2\n", "FILE:1:1: 1 columns without a line of names"),
                              ("x,force\n1,2\n", "FILE:1:1: no columns of two coordinates"),
                              ("x,y,x_pos\n1,2,3\n", "FILE:1:1: column x_pos comes twice"),
                              ("x,y,patch\n1,2,one\n", "FILE:2:5: patch 'one': not a whole number"),
                              ("x,y,tip_radius_mm,patch\n1,2,1,0\n1,3,2,0\n", "tip_radius changes within patch 0"),
                              ("x_m,y_m\n1,2e9\n", "FILE:2:3: y '2e9': must lie in")):
            self.assertIn(message, self.refused(text))
        self.assertIn("none of m, mm", run(TOOL, "fit", "-", "--unit", "furlong", text_in="1,2\n")[2])

    def test_check_of_a_file(self):
        path = self.folder / "points.csv"
        path.write_text("x_m,y_m\n" + self.rows())
        code, out, _ = run(TOOL, "check", path)
        self.assertEqual(code, 0, out)
        self.assertIn("222 samples", out)
        self.assertIn("fit for the recognizer", out)
        path.write_text("x_m,y_m,stamp_ns\n" + "".join(
            f"{1e3 * x},{1e3 * y},{1000 - k}\n" for k, (x, y) in enumerate(p for s in ellipse() for p in s)))
        code, out, _ = run(TOOL, "check", path)
        self.assertEqual(code, 1, out)
        for told in ("jumps", "221 stamps earlier", "extend over", "--unit mm", "not fit"):
            self.assertIn(told, out)
        self.assertEqual(run(TOOL, "check", self.folder / "absent")[0], 2)

    def test_estimate_and_replay_read_them_too(self):
        path = self.folder / "points.txt"
        path.write_text("x_mm;y_mm\n" + self.rows(1e3, ";"))
        code, out, err = run(TOOL, "estimate", path)
        self.assertEqual(code, 0, err)
        self.assertLess(abs(float(out.splitlines()[5].split(",")[3])), 0.1)

    def test_the_curve_is_exported_for_other_programs(self):
        import ezdxf
        path = self.folder / "points.csv"
        for scene, rows in (("ellipse", WHOLE), ("circle", [(0.015 * math.cos(t / 30), 0.015 * math.sin(t / 30)) for t in range(180)]),
                            ("line", [(0.001 * t, 0.0005 * t) for t in range(100)]),
                            ("parabola", [(0.0005 * t, 25 * (0.0005 * t) ** 2) for t in range(-60, 60)])):
            path.write_text("x_m,y_m\n" + "".join(f"{x!r},{y!r}\n" for x, y in rows))
            for ending in ("csv", "json", "dxf"):
                out = self.folder / f"{scene}.{ending}"
                code, _, err = run(TOOL, "fit", path, "--sigma", "2e-5", "--classes", scene, "--export", out)
                self.assertEqual(code, 0, err)
            points = [tuple(map(float, line.split(",")[1:3])) for line in
                      (self.folder / f"{scene}.csv").read_text().splitlines()[1:]]
            self.assertEqual(json.loads((self.folder / f"{scene}.json").read_text())["points_m"][0], list(points[0]))
            # The touched places lie on it: no further than half of the longest chord.
            chord = max(math.dist(a, b) for a, b in zip(points, points[1:]))
            for place in rows:
                self.assertLess(min(math.dist(place, point) for point in points), chord / 2 + 1e-4)
            document = ezdxf.readfile(self.folder / f"{scene}.dxf")
            entity, = document.modelspace()
            self.assertEqual(entity.dxftype(), {"ellipse": "ELLIPSE", "circle": "CIRCLE", "line": "LINE",
                                                "parabola": "LWPOLYLINE"}[scene])
            if scene == "ellipse":
                self.assertLess(abs(entity.dxf.major_axis.magnitude / 1e3 / A - 1), 0.01)
                self.assertLess(abs(entity.dxf.ratio * A / B - 1), 0.01)
            if scene == "circle":
                self.assertLess(abs(entity.dxf.radius - 15), 0.01)
        self.assertEqual(run(TOOL, "fit", path, "--export", self.folder / "curve.step")[0], 2)
        code, _, err = run(TOOL, "fit", path, "--export", self.folder / "absent/curve.csv")
        self.assertEqual(code, 1)
        self.assertIn("cannot be written", err)


if __name__ == "__main__":
    unittest.main()
