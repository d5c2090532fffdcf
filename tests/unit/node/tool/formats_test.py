"""Files as people have them: read for what they are, or refused by file, line and field; nothing in silence."""
import json
import math
import pathlib
import random
import re
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
        for header, scale in (("x_m,y_m", 1), ("x_mm,y_mm", 1e3), ("X [mm],Y [mm]", 1e3), ("X in mm,Y in mm", 1e3), ("x (um),y (um)", 1e6),
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
        # In the first column it is no comment, that would leave the row out in silence.
        for cell in ("#N/A", "#DIV/0!", "#VALUE!"):
            self.assertIn(f"FILE:3:1: x '{cell}': not a number", self.refused(f"x_mm,y_mm\n1,2\n{cell},3\n"))

    def test_numbers_as_machines_write_them(self):
        # Fortran's exponents; commas between quotes, where commas part the columns too.
        self.check("x_m,y_m\n" + self.rows(digits="{:.9E}").replace("E", "D"))
        self.check('"Nr","X [mm]","Y [mm]"\r\n' + "".join(
            f'"{k}","{1e3 * x:.5f}","{1e3 * y:.5f}"\r\n'.replace(".", ",") for k, (x, y) in enumerate(WHOLE)))
        self.assertIn("commas are read as decimal points", self.notes)
        self.check('"X, mm";"Y, mm";"a ""note"""\n' + self.rows(1e3, ";").replace("\n", ';"5"" tip; long"\n'))
        # Whole numbers as numpy and pandas write them, by our own names and by others.
        for names in ("probe,patch,stamp_ns,x_m,y_m\n", "probe,stroke,stamp_ns,x_m,y_m\n"):
            self.check(names + "".join(f"p,0.0,{1.7e18 + 1e6 * k:.18e},{x!r},{y!r}\n" for k, (x, y) in enumerate(WHOLE)))
            for bad in ("0.5", "-1.0", "4294967296", "nan", "1e300"):
                self.assertIn(f"FILE:2:3: patch '{bad}': ", self.refused(names + f"p,{bad},1,0,0\n"))
        # What ROS prints of a pose's topic.
        self.check("%time,field.header.seq,field.pose.position.x,field.pose.position.y,field.pose.orientation.x\n" +
                   "".join(f"17{k},{k},{x!r},{y!r},0\n" for k, (x, y) in enumerate(WHOLE)))
        self.assertIn("columns ignored: time, field.header.seq, field.pose.orientation.x", self.notes)

    def test_marks_of_thousands_are_not_taken_for_decimal_marks(self):
        self.assertIn("FILE:3:2: x '1,234': numbers before have a decimal point",
                      self.refused('x_mm,y_mm\n"987.5","1"\n"1,234","1"\n'))
        self.assertIn("FILE:3:1: x '1.234': numbers before have a decimal comma",
                      self.refused("x_mm;y_mm\n987,5;1\n1.234;1\n"))

    def test_a_line_of_names_that_comes_again_begins_a_stroke(self):
        first, second = ("".join(f"{1e3 * x:.6f};{1e3 * y:.6f}\n" for x, y in stroke) for stroke in ellipse())
        for names in ("x_mm;y_mm\n", "X;Y\nmm;mm\n", "# x_mm;y_mm\n"):
            answer = self.check(names + first + names + second)
            self.assertIn("part the rows into 2 patches", self.notes)
            self.assertEqual({c["patch"] for c in answer["contacts"]}, {0, 1})
        # Where patches have numbers, it is not known whether they are the same.
        for names in ("patch,x_m,y_m\n", "probe,patch,x_m,y_m\n"):
            row = "0,0,1\n" if names.startswith("patch") else "p,0,0,1\n"
            self.assertIn("FILE:3:1: the names of the columns come again", self.refused(names + row + names + row))

    def test_point_numbers_without_a_name_are_not_taken_for_x(self):
        numbered = "".join(f"{k} {1e3 * x:.6f} {1e3 * y:.6f}\n" for k, (x, y) in enumerate(WHOLE, 1))
        self.assertIn("are these point numbers?", self.refused(numbered, "--unit", "mm"))
        self.check("n x_mm y_mm\n" + numbered)
        # As x is scanned by even steps: y is held still.
        self.fit("".join(f"{k} 0 {5 + math.sin(k / 10):.6f}\n" for k in range(60)), "--unit", "mm")
        self.assertIn("the plane is xz", self.notes)

    def test_files_that_are_no_text(self):
        for start, told in ((b"\x1f\x8b\x08", "gunzip -c"), (b"PK\x03\x04", "save the sheet as CSV"),
                            (b"\xd0\xcf\x11\xe0", "save the sheet as CSV"), (b"%PDF-1.7", "export the points"),
                            (b"palpate2\xa7rec", "is a recording of palpate, no table of points: palpate replay"),
                            (b"palpate1", "is a recording of palpate, no table of points: palpate replay")):
            path = self.folder / "points.bin"
            path.write_bytes(start + bytes(100))
            code, out, err = run(TOOL, "fit", path)
            self.assertEqual((code, out), (2, ""))
            self.assertIn(told, err)
            self.assertIn(str(path), err)
            self.assertEqual(err.count("\n"), 1, err)

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

    def detailed(self, names, normal_scale=1.0, length=1.0, blank=False):
        """The ellipse with a measured normal and a covariance of every sample."""
        text = names + "\n"
        for patch, stroke in enumerate(ellipse(count=40)):
            for x, y in stroke:
                t = math.atan2((y + 0.01) / B, (x - 0.03) / A)
                n = math.hypot(math.cos(t) / A, math.sin(t) / B)
                normal = (math.cos(t) / A / n * normal_scale, math.sin(t) / B / n * normal_scale)
                area = (SIGMA / length) ** 2
                text += f"{patch},{x / length!r},{y / length!r},{normal[0]!r},{normal[1]!r},0.02,{area!r},0,{area!r}\n"
        return text

    def test_normals_and_covariances_stand_beside_any_unit(self):
        for unit, length, area in (("mm", 1e-3, "cov_xx_mm2,cov_xy_mm2,cov_yy_mm2"), ("um", 1e-6, "cov_xx,cov_xy,cov_yy"),
                                   ("m", 1.0, "cov_xx_m2,cov_xy_m2,cov_yy_m2"), ("mm", 1e-3, "Cov XX [mm^2],Cov XY [mm^2],Cov YY [mm^2]")):
            answer = self.check(self.detailed(f"patch,x_{unit},y_{unit},normal_x,normal_y,normal_sigma_rad,{area}", length=length))
            self.assertNotIn("ignored", self.notes)
            self.assertNotIn("not used", self.notes)
            self.assertAlmostEqual(answer["sigma_m"], SIGMA, delta=0.3 * SIGMA)
            given = self.fit(self.detailed(f"patch,x_{unit},y_{unit},normal_x,normal_y,normal_sigma_rad,{area}", length=length),
                             "--class", "ellipse")
            self.assertEqual(int(given["normal_count"]), 80)
            self.assertTrue(given["sigma_stated"])
        # Degrees, and --unit in place of all that the columns say.
        text = self.detailed("patch,x_m,y_m,normal_x,normal_y,normal_sigma_deg,cov_xx_m2,cov_xy_m2,cov_yy_m2", length=1e-3)
        given = self.fit(text, "--class", "ellipse", "--unit", "mm")
        self.assertAlmostEqual(given["recognition"]["parameters"]["a"], A, delta=1e-4)
        self.assertTrue(given["sigma_stated"])

    def test_normals_and_covariances_that_say_too_little_are_told_or_refused(self):
        whole = "patch,x_mm,y_mm,normal_x,normal_y,normal_sigma_rad,cov_xx_mm2,cov_xy_mm2,cov_yy_mm2"
        for name, note in (("normal_sigma_rad", "normals are not used: they need the columns normal_x, normal_y and normal_sigma_rad"),
                           ("normal_y", "normals are not used"), ("cov_yy_mm2", "covariances are not used: they need the columns cov_xx and cov_yy")):
            self.check(self.detailed(whole.replace(name, "else"), length=1e-3))
            self.assertIn(note, self.notes)
        self.check(self.detailed(whole, length=1e-3).replace("normal_sigma_rad", "z").replace(",0.02,", ",0,"), "--plane", "xy")
        self.assertIn("covariances are not used: they are read beside the two coordinates x and y alone", self.notes)
        for text, why in ((self.detailed(whole, 0.5, 1e-3), ":2:"), (self.detailed(whole, length=1e-3).replace(",0.02,", ",0,"), ":2:"),
                          (self.detailed(whole, length=1e-3).replace(",0.02,", ",much,"), "much"),
                          (self.detailed(whole, length=1e-3).replace(",0.02,", ",nan,"), "finite"),
                          (self.detailed(whole, length=1e-3).replace(",0.02,", ",0.02,-"), "no positive definite covariance")):
            path = self.folder / "bad.csv"
            path.write_text(text)
            code, out, err = run(TOOL, "fit", path)
            self.assertEqual((code, out), (2, ""), err)
            self.assertIn(why, err)

    def test_a_length_keeps_the_unit_of_its_name_beside_another_for_the_rest(self):
        """Centres of a 2 mm tip in millimetres, its radius in metres."""
        tip = 2.0
        rows = ""
        for i in range(222):
            t = 5.5 * i / 221
            a, b = 1e3 * A, 1e3 * B
            x, y = a * math.cos(t), b * math.sin(t)
            slope = math.hypot(b * math.cos(t), a * math.sin(t))
            rows += f"{x + tip * b * math.cos(t) / slope!r},{y + tip * a * math.sin(t) / slope!r},{1e-3 * tip!r},left\n"
        for names in ("x,y", "x_mm,y_mm"):
            self.check(f"{names},tip_radius_m,material_side\n" + rows, "--unit", "mm")
            self.assertIn("column tip_radius is taken in m, as its name says, not in the unit of --unit", self.notes)
        # Who contradicts the coordinates' names contradicts them all.
        self.check("x_m,y_m,tip_radius_m,material_side\n" + rows.replace(",0.002,", ",2,"), "--unit", "mm")
        self.assertIn("the unit is taken from --unit, not from the columns' names", self.notes)

    def test_coordinates_of_two_units_are_refused(self):
        rows = "".join(f"{1e3 * x!r},{1e3 * y!r}\n" for x, y in WHOLE)
        for names in ("x_mm,y_m\n", "x [um],y [mm]\n", "x,y\nmm,m\n", "# x_mm,y_m\n"):
            path = self.folder / "two.csv"
            path.write_text(names + rows)
            for command in ("fit", "check", "estimate"):
                code, out, err = run(TOOL, command, path)
                self.assertNotEqual(code, 0, (names, command))
                self.assertIn("the coordinates have different units", out + err)
            self.check(names + rows, "--unit", "mm")
        # The names may be a comment, lines before the data.
        path.write_text("# a part\n  # x_mm y_um\n\n1 2\n2 3\n")
        _, _, err = run(TOOL, "fit", path)
        self.assertIn(f"{path}:2:4: the coordinates have different units", err)
        # A unit that one column names holds for the other, and the same unit may be called twice.
        for names, told in (("x_mm,y\n", "column y names no unit: taken as mm, as x is (else --unit"), ("x_mm,y [mm]\n", "")):
            self.check(names + rows)
            self.assertEqual("names no unit" in self.notes, bool(told))
            self.assertIn(told, self.notes)
        self.check("x,y_mm,sigma\n" + rows.replace("\n", ",0.02\n"))
        self.assertIn("columns x, sigma name no unit: taken as mm, as y is (else --unit", self.notes)

    def test_a_mil_is_not_guessed(self):
        rows = "".join(f"{1e3 * x!r},{1e3 * y!r},0.02\n" for x, y in WHOLE)
        for names, told in (("x_mil,y_mil,sigma", "x_mil"), ("x_mm,y [mils],sigma", "y [mils]"), ("x_mm,y_mm,sigma_mil", "sigma_mil")):
            self.assertIn(f"FILE:1:1: column {told}: a mil is a thousandth of an inch, but to some a millimetre",
                          self.refused(f"{names}\n{rows}"))
            self.check(f"{names}\n{rows}", "--unit", "mm")

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
        self.assertIn("left out: 1 probing cycle that touched nothing", self.notes)
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

    def test_a_side_of_tips_that_are_none_is_told(self):
        for more, told in (((), True), (("--class", "ellipse"), True), (("--tip-radius", "0.001"), False)):
            path = self.folder / "points.csv"
            path.write_text("x_m,y_m\n" + self.rows())
            code, out, err = run(TOOL, "fit", path, "--format", "text", "--touched-from", "inside", *more)
            self.assertEqual(code, 0, err)
            self.assertEqual("note         WARNING: --touched-from is not used: no sample is the centre" in out, told, more)
            self.assertEqual("WARNING: --touched-from" in err, told, more)

    def test_a_tip_may_be_told_by_its_diameter(self):
        outside = [(0.02 + 0.017 * math.cos(t), 0.017 * math.sin(t)) for t in (2 * math.pi * i / 40 for i in range(40))]
        text = "x_m,y_m,material_side,Ball diameter [mm]\n" + "".join(f"{x},{y},left,4\n" for x, y in outside)
        answer = self.fit(text, "--sigma", "1e-6")
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
        self.assertIn("1 jump of", self.err)
        self.assertIn("column patch", self.err)

    def test_strokes_whose_rows_were_sorted_by_a_coordinate_are_told(self):
        # Round an end of the ellipse, where both ways of the stroke have the same x.
        strokes = ellipse(patches=((-0.8, 0.9), (2.3, 3.6)))
        for order in (False, True):
            rows = [(x, y, k) for k, stroke in enumerate(strokes) for x, y in (sorted(stroke) if order else stroke)]
            self.fit("x_m,y_m,patch\n" + "".join(f"{x},{y},{k}\n" for x, y, k in rows))
            self.assertEqual("go to and fro over" in self.err or "goes to and fro over" in self.err, order, self.err)

    def test_a_dozen_touches_in_no_order_are_of_the_part(self):
        turns = [k / 12 for k in range(12)]
        random.Random(3).shuffle(turns)
        text = "x_m,y_m\n" + "".join(f"{A * math.cos(2 * math.pi * t)},{B * math.sin(2 * math.pi * t)}\n" for t in turns)
        self.check(text)
        self.assertIn("each is taken as a touch of its own", self.err)

    def test_rows_in_no_order_are_told(self):
        rows = WHOLE[:]
        random.Random(2).shuffle(rows)
        shuffled = "x_m,y_m\n" + "".join(f"{x},{y}\n" for x, y in rows)
        self.check(shuffled)
        self.assertIn("WARNING", self.err)
        self.assertIn("each is taken as a touch of its own", self.err)
        self.assertIn("WARNING: the rows lead to and fro", self.notes)
        for arguments, text in ((("--strokes",), shuffled),
                                ((), "x_m,y_m,patch\n" + "".join(f"{x},{y},0\n" for x, y in rows))):
            self.fit(text, *arguments)
            self.assertIn("1 patch goes to and fro over the whole extent", self.err)
            self.assertIn("in no order are --touches", self.notes)
        self.check(shuffled, "--touches")
        self.assertEqual(self.err, "")
        # So many that touches would take minutes stay a stroke, and that it is none is told.
        self.fit("x_m,y_m\n" + "".join(f"{x},{y}\n" for x, y in rows * 100))
        self.assertIn("1 patch goes to and fro over the whole extent", self.err)
        path = self.folder / "shuffled.csv"
        path.write_text(shuffled)
        code, out, _ = run(TOOL, "check", path)
        self.assertEqual(code, 1)
        self.assertIn("1 patch goes to and fro", out)
        # Once round the part, densely sampled with much noise between: that is an order.
        dense = "x_m,y_m\n" + "".join(f"{A * math.cos(t)},{B * math.sin(t)}\n" for t in
                                      (2 * math.pi * i / 40 for i in range(40)))
        self.fit(dense)
        self.assertEqual(self.err, "")

    def test_two_strokes_row_by_row_are_told_apart_from_one(self):
        # Means of neighbours, of more than 1024, would lie between the strokes: an ellipse of less than half the size.
        strokes = ellipse(count=1000)
        self.check("x_m,y_m\n" + "".join(f"{x!r},{y!r}\n" for pair in zip(*strokes) for x, y in pair))
        self.assertIn("in no order along it", self.err)

    def test_a_tip_radius_in_millimetres_where_metres_are_asked_is_told(self):
        text = "x_m,y_m\n" + self.rows()
        self.fit(text, "--tip-radius", 3)
        self.assertIn("WARNING: a tip radius of 3 m is larger than all that is touched", self.notes)
        self.assertIn("--tip-radius is metres", self.err)
        # A ball of 20 mm nearly fills a bore.
        self.fit("x_m,y_m\n" + "".join(f"{0.0004 * math.cos(k)},{0.0004 * math.sin(k)}\n" for k in range(40)),
                 "--touches", "--tip-radius", 0.01)
        self.assertNotIn("larger than all", self.err)

    def test_a_tip_radius_that_the_file_has_already_counts_and_that_is_told(self):
        text = "x_mm,y_mm,tip_radius_mm\n" + "".join(f"{1e3 * x},{1e3 * y},2\n" for x, y in WHOLE)
        self.fit(text, "--tip-radius", 0.003)
        self.assertIn(f"--tip-radius is not used for {len(WHOLE)} samples: the tip radius that the file states counts", self.notes)
        self.fit(text, "--tip-radius", 0.002)
        self.assertNotIn("--tip-radius is not used", self.err)

    def test_what_is_told_names_its_object_and_patch(self):
        text = "object,patch,x_m,y_m\n"
        for thing in (3, 8):
            for k, stroke in enumerate(ellipse(patches=((-0.8, 0.9), (2.3, 3.6)))):
                rows = sorted(stroke) if (thing, k) == (8, 0) else stroke
                text += "".join(f"{thing},{k},{x!r},{y!r}\n" for x, y in rows)
        path = self.folder / "things.csv"
        path.write_text(text)
        whose = r"object 8: .*goes to and fro over the whole extent \(patch 0\)"
        code, out, _ = run(TOOL, "check", path)
        self.assertRegex(out, whose)
        self.assertNotIn("object 3: things: 1 patch", out)
        self.assertRegex(run(TOOL, "fit", path)[2], "things.csv: group .*" + whose)

    def test_strokes_that_were_saved_twice_are_told(self):
        stroke = ellipse()[0]
        text = "x_m,y_m,patch\n" + "".join(f"{x!r},{y!r},{k}\n" for k in (0, 3) for x, y in stroke)
        self.fit(text)
        self.assertIn("1 patch is a copy of others, sample by sample (patch 3 is one of patch 0)", self.err)

    def test_strokes_may_each_have_a_clock_of_their_own(self):
        def stamped(patches):
            return "x_m,y_m,patch,t_s\n" + "".join(f"{x!r},{y!r},{patches * k},{0.001 * i}\n" for k, stroke in
                                                   enumerate(ellipse()) for i, (x, y) in enumerate(stroke))
        self.check(stamped(1))
        self.assertEqual(self.err, "")
        self.fit(stamped(0))
        self.assertIn("1 stamp earlier than the one before in its patch", self.err)

    def test_stamps_that_tell_no_time_are_told(self):
        path = self.folder / "points.csv"
        for last, told in ((7, True), (8, False)):
            rows = [f"{x!r},{y!r},{k},7\n" for k, stroke in enumerate(ellipse()) for x, y in stroke]
            path.write_text("x_m,y_m,patch,stamp_ns\n" + "".join(rows[:-1]) + rows[-1].replace(",7\n", f",{last}\n"))
            code, out, _ = run(TOOL, "check", path)
            self.assertEqual(code, 0, out)
            self.assertEqual("WARNING  probe: all 222 stamps are equal: they tell no time\n" in out, told, out)

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
        text = "x_mm,y_mm\n" + "".join(f"{int(35 * math.cos(t) + 10)},{int(24 * math.sin(t) - 3)}\n"
                                       for t in (0.3 + 0.9 * i / 99 for i in range(100)))
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
        self.assertIn("forgotten: 234 samples of the oldest of 90 patches", self.notes)

    def test_what_is_merged_or_dropped_is_said(self):
        self.fit("x_m,y_m\n" + self.rows() + self.rows().splitlines()[-1] + "\n")
        self.assertIn("dropped: 1 sample at exactly the place", self.notes)
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
                              ("x_mm;y_mm\n1;2\n1;nan\n", "FILE:3:3: y 'nan': not a finite number; leave out rows"),
                              ("x_mm,y_mm\n1,2\n1,\n", "FILE:3:3: y '': nothing is there; leave out rows"),
                              ("1 2\n3 4 5\n", "FILE:2:5: 3 fields instead of 2"),
                              ("1 2 3 4\n", "FILE:1:1: 4 columns without a line of names"),
                              ("1\n2\n", "FILE:1:1: 1 column without a line of names"),
                              ("x_mm,y_mm\n1,5,2,5\n", "FILE:2:5: 4 fields instead of 2; are these decimal commas?"),
                              ("1,5,2,5\n", "cov_yy_mm2); are these decimal commas? Then part the columns by semicolons or tabs\n"),
                              ("x_mm,y_mm\n1.5,2.5,3\n", "FILE:2:9: 3 fields instead of 2\n"),
                              ("probe,patch,x_m,y_m\np,0,1,5,2,5\n", "more than 4 fields; are these decimal commas?"),
                              ("x,force\n1,2\n", "FILE:1:1: no columns of two coordinates"),
                              ("x,y,x_pos\n1,2,3\n", "FILE:1:1: column x_pos comes twice"),
                              ("x,y,patch\n1,2,one\n", "FILE:2:5: patch 'one': not a whole number"),
                              ("x,y,patch\n1,2,-1\n", "FILE:2:5: patch '-1': not a whole number >= 0"),
                              ("x,y,patch\n1,2,4294967296\n", "FILE:2:5: patch '4294967296': out of range"),
                              ("x,y,stamp_ns\n1,2,9223372036854775808\n", "stamp_ns '9223372036854775808': out of range"),
                              ("x,y,stamp_ns\n1,2,0.5\n", "stamp_ns '0.5': not a whole number\n"),
                              ("x,y,time_s\n1,2,1e300\n", "time '1e300': out of range: a stamp lies within 292 years of 1970"),
                              ("x,y,time_s\n1,2,9223372037\n", "time '9223372037': out of range"),
                              ("x,y,time_s\n1,2,inf\n", "time 'inf': not a finite number"),
                              ("x,y,time_s\n1,2,noon\n", "time 'noon': not a number"),
                              ("x,y,tip_radius_mm,tip_diameter_mm\n1,2,1,2\n", "tip_diameter_mm comes twice"),
                              ("x,y,tip_radius_mm,patch\n1,2,1,0\n1,3,2,0\n", "FILE:3: tip_radius changes within patch 0"),
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
        for told in ("1 jump of", "221 stamps earlier", "extend over", "--unit mm", "not fit"):
            self.assertIn(told, out)
        self.assertEqual(run(TOOL, "check", self.folder / "absent")[0], 2)
        # Whoever is to state the noise is told how; and these are options that there are.
        self.assertIn("no noise is stated: it is estimated\n         state it where it is known (--sigma of fit and replay, or a column sigma)", out)
        for command in ("fit", "replay"):
            self.assertIn("--sigma", run(TOOL, command, "--help")[1])
        # Too few places for an answer, however many samples lie there.
        path.write_text("x_m,y_m\n" + 9 * "0.01,0.02\n" + "0.02,0.02\n")
        code, out, _ = run(TOOL, "check", path)
        self.assertIn("only 2 places touched", out)

    def approached(self, count, names="x_mm,y_mm", parts=1, seed=2):
        """Circles of 20 mm that begin and end with so many samples in the air: rows in millimetres."""
        rng = random.Random(seed)
        radii = [20 + 0.3 * k for k in range(count, 0, -1)] + 200 * [20] + [20 + 0.3 * k for k in range(1, count + 1)]
        angles = count * [0.2] + [0.2 + 0.015 * k for k in range(200)] + count * [0.2 + 0.015 * 199]
        return names + "\n" + "".join(
            (f"{part}," if parts > 1 else "") + f"{r * math.cos(t) + rng.gauss(0, 0.01):.6f},{r * math.sin(t) + rng.gauss(0, 0.01):.6f}\n"
            for part in range(parts) for r, t in zip(radii, angles))

    def test_an_approach_that_was_recorded_is_told_with_the_option_that_leaves_it_out(self):
        path = self.folder / "approached.csv"
        path.write_text(self.approached(10))
        told = r"1 stroke runs straight at an end and meets the rest at a corner \(patch 0: the first 1[01] samples " \
               r"\(1-1[01]\) at (8|9)\d degrees, the last 1[01] samples \((209|210|211)-220\) at (8|9)\d degrees\)"
        code, out, _ = run(TOOL, "check", path)
        self.assertEqual(code, 0)
        self.assertRegex(out, "WARNING  " + told)
        self.assertIn("fit for the recognizer, but see the warnings", out)
        advised = re.search(r"fit (--leave-out) (\S+)\n", out).groups()
        answer = self.fit(path.read_text(), "--sigma", "1e-5")
        self.assertEqual(answer["curve_class"], "CURVE_CLASS_UNCLASSIFIED")
        self.assertRegex(self.notes, told)
        self.assertRegex(self.err, told)
        self.fit(path.read_text(), "--class", "circle")
        self.assertRegex(self.notes, told)
        # What is advised does it, and then nothing is left to be told.
        answer = self.fit(path.read_text(), "--sigma", "1e-5", *advised)
        self.assertEqual(answer["curve_class"], "CURVE_CLASS_CIRCLE")
        self.assertLess(abs(answer["parameters"]["a"] / 0.02 - 1), 1e-3)
        self.assertIn(int(answer["sample_count"]), range(198, 202))
        self.assertRegex(self.notes, r"^left out: (19|20|21|22) samples \(--leave-out\)$")
        self.assertNotIn("straight", self.err)
        code, out, err = run(TOOL, "fit", path, "--class", "circle", *advised)
        self.assertEqual((code, err), (0, ""))
        # Half of it left out: the advice names the whole.
        self.fit(path.read_text(), "--class", "circle", advised[0], advised[1].split(",")[0])
        self.assertIn(f"{advised[0]} {advised[1]}", self.notes)

    def test_a_short_approach_makes_the_answer_doubt_and_is_told(self):
        # Six samples at either end are set aside; they may as well be an edge and a corner of the part.
        path = self.folder / "approached.csv"
        path.write_text(self.approached(6, seed=1))
        self.assertIn("straight at an end", run(TOOL, "check", path)[1])
        answer = self.fit(path.read_text(), "--sigma", "1e-5")
        self.assertEqual((answer["curve_class"], answer["status"], answer["doubt"]),
                         ("CURVE_CLASS_CIRCLE", "RECOGNITION_STATUS_AMBIGUOUS", "RECOGNITION_DOUBT_MISFIT"))
        advised = re.search(r"fit (--leave-out) (\S+)$", self.notes).groups()
        answer = self.fit(path.read_text(), "--sigma", "1e-5", *advised)
        self.assertEqual((answer["curve_class"], answer["status"]), ("CURVE_CLASS_CIRCLE", "RECOGNITION_STATUS_RECOGNIZED"))
        self.assertNotIn("straight", self.notes)

    def test_the_approaches_of_two_objects_are_told_without_an_option_that_would_not_do(self):
        path = self.folder / "two.csv"
        path.write_text(self.approached(10, names="object,x_mm,y_mm", parts=2))
        code, out, _ = run(TOOL, "check", path)
        self.assertEqual(out.count("straight at an end"), 2, out)
        self.assertEqual(out.count("take its rows out of the file"), 2, out)
        self.assertNotIn("--leave-out", out)
        self.assertIn("--leave-out: for one group and object only, here are 2", run(TOOL, "fit", path, "--leave-out", "1")[2])

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

    def test_an_object_without_a_curve_to_export_costs_no_other_its_answer(self):
        path = self.folder / "two.csv"
        circle = "".join(f"2,{0.015 * math.cos(t / 9)!r},{0.015 * math.sin(t / 9)!r}\n" for t in range(60))
        path.write_text("object,x_m,y_m\n" + "".join(f"1,{0.001 * t!r},{0.002 * t!r}\n" for t in range(9)) + circle)
        code, out, err = run(TOOL, "fit", path, "--class", "circle", "--export", self.folder / "curve.csv")
        self.assertEqual(code, 1)
        self.assertIn("curve.csv: not written: no curve was found", err)
        self.assertEqual(len(out.splitlines()), 2)
        self.assertEqual([p.name for p in self.folder.glob("curve*")], ["curve-2.csv"])


if __name__ == "__main__":
    unittest.main()
