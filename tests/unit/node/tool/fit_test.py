"""palpate fit, called as a user calls it."""
import json
import math
import pathlib
import random
import re
import tempfile
import unittest
import xml.etree.ElementTree

from google.protobuf import json_format

from palpate.v1 import curve_pb2, recognition_pb2
from programs import TOOL, run

A, B, SIGMA = 0.025, 0.0175, 2e-5
POSE = (0.3, -0.1, 0.6)


def ellipse(patches=((0.3, 1.5), (2.3, 3.6)), object_number=1, seed=1, sigma=SIGMA):
    """CSV rows of patches of 111 samples each, between two curve parameters."""
    rng = random.Random(seed)
    rows = []
    for number, (start, end) in enumerate(patches):
        for i in range(111):
            t = start + (end - start) * i / 110
            u, v = A * math.cos(t), B * math.sin(t)
            x = POSE[0] + math.cos(POSE[2]) * u - math.sin(POSE[2]) * v + rng.gauss(0, sigma)
            y = POSE[1] + math.sin(POSE[2]) * u + math.cos(POSE[2]) * v + rng.gauss(0, sigma)
            rows.append(f"finger,{number},{x!r},{y!r},{sigma!r},{object_number}\n")
    return "".join(rows)


HEADER = "probe,patch,x_m,y_m,sigma_m,object\n"


class Fit(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def answers(self, *arguments, text_in=None):
        code, out, err = run(TOOL, "fit", "--format", "json", *arguments, text_in=text_in)
        self.assertEqual((code, err), (0, ""))
        lines = out.splitlines()
        # Every line is a whole message of the wire contract.
        return [json_format.Parse(line, recognition_pb2.Recognition()) for line in lines], lines

    def check_ellipse(self, answer):
        self.assertEqual(answer.status, recognition_pb2.RECOGNITION_STATUS_RECOGNIZED)
        truth = [A, B, *POSE]
        found = [answer.parameters.a, answer.parameters.b, answer.pose.x_m, answer.pose.y_m,
                 answer.pose.theta_rad]
        for i, (f, t) in enumerate(zip(found, truth)):
            self.assertLess(abs(f - t), 4 * math.sqrt(answer.covariance[6 * i]), i)

    def test_json_is_the_wire_contract_with_truth_within_four_sigma(self):
        answers, lines = self.answers(self.write("part.csv", HEADER + ellipse()))
        self.check_ellipse(answers[0])
        self.assertEqual(answers[0].group, "finger")
        self.assertEqual(answers[0].object, 1)
        self.assertEqual(answers[0].sample_count, 222)
        self.assertGreater(answers[0].compute_ns, 0)
        self.assertEqual(len(answers[0].covariance), 25)
        # Field names as in the contract, zeros not left out.
        self.assertEqual(json.loads(lines[0])["contacts"][0]["patch"], 0)

    def test_many_files_and_objects_in_one_call_in_their_order(self):
        one = self.write("one.csv", HEADER + ellipse(object_number=5) + ellipse(object_number=3))
        two = self.write("two.csv", HEADER + ellipse(seed=2))
        answers, _ = self.answers(one, two)
        self.assertEqual([(a.header.source, a.object) for a in answers],
                         [(str(one), 5), (str(one), 3), (str(two), 1)])
        for answer in answers:
            self.check_ellipse(answer)

    def test_standard_input(self):
        answers, _ = self.answers("-", text_in=HEADER + ellipse())
        self.check_ellipse(answers[0])

    def test_text_says_class_parameters_and_status(self):
        path = self.write("part.csv", HEADER + ellipse())
        code, out, err = run(TOOL, "fit", "--format", "text", path)
        self.assertEqual((code, err), (0, ""))
        self.assertIn("ellipse", out)
        self.assertRegex(out, r"status +recognized")
        self.assertRegex(out, r"a +\d\d\.\d+ \+- 0\.\d+ mm")
        self.assertRegex(out, r"theta 3\d\.\d+ \+- .* deg \(or that \+ 180\)")

    def test_text_says_what_is_free(self):
        rng = random.Random(7)
        # However it lies: along an axis, a place along it once told metres of deviation.
        for turn in (0.0, 1e-5, 0.5, math.pi / 2):
            rows = []
            for i in range(120):
                along, across = 0.1 + 5e-4 * i, rng.gauss(0, SIGMA)
                x = along * math.cos(turn) - across * math.sin(turn)
                y = along * math.sin(turn) + across * math.cos(turn)
                rows.append(f"{i // 60},{x!r},{y!r}\n")
            path = self.write("line.csv", "patch,x_m,y_m\n" + "".join(rows))
            stated = ("--sigma", SIGMA)
            for more in (stated, (), ("--class", "line", *stated), ("--method", "tree", *stated)):
                code, out, err = run(TOOL, "fit", "--format", "text", *more, path)
                self.assertEqual(code, 0, err)
                pose = next(line for line in out.splitlines() if line.startswith("  pose "))
                self.assertRegex(pose, r"theta .* deg; free along itself$", more)
                lengths = pose.split(", theta")[0]
                self.assertIn(" mm", lengths)
                self.assertNotRegex(lengths, r"e[-+]\d\d")
                for sigma_mm in re.findall(r"\+- ([0-9.e+-]+)", lengths):
                    self.assertLess(float(sigma_mm), 0.02 if more else 0.2, f"{turn} {more}: {pose}")
            for more in (stated, ()):
                answer = self.answers(*more, path)[0][0]
                xx, xy, yy = (answer.covariance[i] for i in (0, 1, 4))
                c, s = math.cos(answer.pose.theta_rad), math.sin(answer.pose.theta_rad)
                across = s * s * xx - 2 * s * c * xy + c * c * yy
                self.assertGreater(across, 0)
                self.assertLess(abs(c * c * xx + 2 * s * c * xy + s * s * yy), 1e-6 * across, f"{turn} {more}")
        ring = "".join(f"finger,0,{0.02 * math.cos(t / 20)!r},{0.02 * math.sin(t / 20)!r},{SIGMA!r},1\n"
                       for t in range(120))
        for more in ((), ("--class", "circle"), ("--method", "tree")):
            _, out, _ = run(TOOL, "fit", "--format", "text", *more, "-", text_in=HEADER + ring)
            self.assertIn(", theta free\n", out)

    def test_no_advice_asks_for_what_was_stated(self):
        rng = random.Random(8)
        rows = "".join(f"{1e-3 * i!r},{rng.gauss(0, SIGMA)!r}\n" for i in range(60))
        path = self.write("line.csv", "x_m,y_m\n" + rows)
        tip = ("--tip-radius", 0.002, "--sigma", SIGMA)
        for more in ((), ("--touched-from", "outside")):
            plot = self.folder / "line.svg"
            _, out, _ = run(TOOL, "fit", "--format", "text", *tip, *more, "--plot", plot, path)
            self.assertRegex(out, "status +ambiguous: two shapes")
            for words in (re.search("advice .*", out).group(), plot.read_text()):
                self.assertIn("material side", words)
                self.assertNotIn("touched_from", words)
        sided = "x_m,y_m,material_side\n" + rows.replace("\n", ",left\n")
        _, out, _ = run(TOOL, "fit", "--format", "text", *tip, "-", text_in=sided)
        self.assertRegex(out, "status +recognized")
        # Six touches of a circle: its noise is stated, or is not.
        few = "x_m,y_m\n" + "".join(f"{0.02 * math.cos(t)!r},{0.02 * math.sin(t)!r}\n" for t in range(6))
        for more, asks in (((), True), (("--sigma", 1e-3), False)):
            _, out, _ = run(TOOL, "fit", "--format", "text", "--touches", *more, "-", text_in=few)
            advice = re.search("advice .*", out).group()
            self.assertEqual("state their noise" in advice, asks, advice)

    def test_text_gives_the_reason_of_a_doubt(self):
        short = ellipse(patches=((0.3, 0.4),), sigma=1e-4)
        _, out, _ = run(TOOL, "fit", "--format", "text", "-", text_in=HEADER + short)
        self.assertRegex(out, r"status +ambiguous: \w+")

    def test_no_class_that_is_ambiguous_names_what_is_not_excluded(self):
        rng = random.Random(3)
        rows = [f"finger,{number},{x + rng.gauss(0, SIGMA)!r},{y + rng.gauss(0, SIGMA)!r},"
                f"{SIGMA!r},1\n"
                for number, wall in enumerate(
                    ([(0.001 * i, 0.0) for i in range(30)], [(0.035, 0.005 + 0.001 * i)
                                                            for i in range(30)]))
                for x, y in wall]
        path = self.write("walls.csv", HEADER + "".join(rows))
        code, out, _ = run(TOOL, "fit", "--format", "text", str(path))
        self.assertEqual(code, 0)
        self.assertIn("ambiguous: most probably of no class, but one is not excluded", out)
        self.assertNotIn("Several classes", out)
        self.assertRegex(out, "do not exclude an? ")

    def test_sigma_is_used_where_the_file_has_none(self):
        text = "".join(line.rsplit(",", 2)[0] + "\n"
                       for line in (HEADER + ellipse()).splitlines())
        for given in (1.5e-5, 4e-5):
            answers, _ = self.answers("--sigma", given, "-", text_in=text)
            self.assertAlmostEqual(answers[0].sigma_m / given, 1.0)
        code, out, err = run(TOOL, "fit", "--format", "text", "--sigma", 2e-7, "-", text_in=text)
        self.assertEqual(code, 0)
        for told in (out, err):
            self.assertRegex(told, r"WARNING: .*the stated noise is 0\.2 um, the samples scatter by (19|2\d)\.\d+ um")
        estimated, _ = self.answers("-", text_in=text)
        self.assertLess(abs(estimated[0].sigma_m / SIGMA - 1), 5 / math.sqrt(2 * 217))

    def test_a_probe_of_unknown_noise_may_hide_more_than_that(self):
        path = self.write("unstated.csv", HEADER.replace("sigma_m,", "") + "".join(
            ",".join(row.split(",")[:4] + row.split(",")[5:]) + "\n" for row in ellipse().splitlines()))
        untold, noise_alone, stated, said = (self.answers(path, *flags)[0][0] for flags in (
            (), ("--no-unqualified-probe",), ("--sigma", SIGMA), ("--sigma", SIGMA, "--unqualified-probe")))
        self.assertEqual([a.unqualified_probe for a in (untold, noise_alone, stated, said)],
                         [True, False, False, True])
        for answer in (untold, said):
            self.check_ellipse(answer)
            self.assertLess(answer.noise_covariance[0], answer.covariance[0])
        self.assertEqual(len(noise_alone.noise_covariance), 0)
        _, out, _ = run(TOOL, "fit", "--format", "text", path)
        self.assertRegex(out, r"probe +not qualified: .* by noise alone a \+- [0-9.]+ mm, b \+- [0-9.]+ mm")

    def test_sigma_that_the_file_overrules_is_told(self):
        stated = HEADER + ellipse()
        mixed = HEADER + "".join(line.replace(repr(SIGMA), "") if i < 10 else line
                                 for i, line in enumerate(ellipse().splitlines(keepends=True)))
        none = HEADER + "".join(line.replace(repr(SIGMA), "") for line in ellipse().splitlines(keepends=True))
        for text, sigma, told in ((stated, 1e-3, "--sigma is not used: the noise that the file states for every sample (column sigma) holds"),
                                  (mixed, 1e-3, "--sigma is used for 10 samples of 222:"),
                                  (stated, SIGMA, ""), (none, SIGMA, "")):
            code, out, err = run(TOOL, "fit", "--format", "json", "--sigma", sigma, "-", text_in=text)
            self.assertEqual(code, 0, err)
            notes = json.loads(out).get("notes", [])
            if told:
                self.assertIn("palpate: -: " + told, err)
                self.assertTrue(any(note.startswith(told) for note in notes), notes)
            self.assertEqual("--sigma is" in err, bool(told), err)
        self.assertNotIn("--sigma is", run(TOOL, "fit", "-", text_in=stated)[2])

    def test_classes_restricts_the_hypotheses(self):
        answers, _ = self.answers("--classes", "circle,parabola", "-", text_in=HEADER + ellipse())
        names = {h.curve_class for h in answers[0].hypotheses}
        self.assertEqual(names, {curve_pb2.CURVE_CLASS_UNCLASSIFIED, curve_pb2.CURVE_CLASS_CIRCLE,
                                 curve_pb2.CURVE_CLASS_PARABOLA})

    def test_the_tree_alone_answers_too(self):
        answers, _ = self.answers("--method", "tree", "-", text_in=HEADER + ellipse(sigma=1e-9))
        self.assertEqual(answers[0].curve_class, curve_pb2.CURVE_CLASS_ELLIPSE)
        self.assertAlmostEqual(answers[0].parameters.a / A, 1, places=2)

    def test_the_papers_pipeline_from_samples_to_pose(self):
        # Strokes of four times 111 samples; the two-round fit's windows take 111 of them each. Without noise to speak of
        # what is left is the method's bias, W^2 / 56 of the curvature's second derivative.
        strokes = [(start, start + 0.6) for start in (0.2, 1.0, 2.3, 3.4)]
        pipeline = ["--method", "tree", "--estimator", "two-round", "--window", "75", "--shift", "4",
                    "--relative-tolerance", "0.05"]
        answers, _ = self.answers(*pipeline, "-", text_in=HEADER + ellipse(strokes, sigma=1e-9))
        answer = answers[0]
        self.assertEqual(answer.curve_class, curve_pb2.CURVE_CLASS_ELLIPSE)
        self.assertEqual([c.patch for c in answer.contacts], [0, 1, 2, 3])
        self.assertLess(abs(answer.parameters.a / A - 1), 0.05)
        self.assertLess(abs(answer.parameters.b / B - 1), 0.05)
        self.assertLess(math.hypot(answer.pose.x_m - POSE[0], answer.pose.y_m - POSE[1]), 0.05 * A)
        self.assertTrue(all(0 < answer.covariance[6 * i] < 1e-6 for i in range(5)))
        # With noise it may come to another class: every entry has its deviation all the same.
        answers, _ = self.answers(*pipeline[:-1], "0.5", "-", text_in=HEADER + ellipse(strokes))
        size = math.isqrt(len(answers[0].covariance))
        self.assertTrue(all(answers[0].covariance[(size + 1) * i] > 0 for i in range(size)))
        self.assertTrue(answers[0].decisions)

    def test_an_estimator_that_is_none_is_told(self):
        path = self.write("part.csv", HEADER + ellipse())
        code, out, err = run(TOOL, "fit", path, "--estimator", "magic")
        self.assertEqual((code, out), (2, ""))
        self.assertIn("two-round", err)

    def test_plots_are_svg_one_a_group(self):
        path = self.write("part.csv", HEADER + ellipse() + ellipse(object_number=2))
        self.answers("--plot", self.folder / "plot.svg", "--plot-invariants", self.folder / "invariants.svg", path)
        for name in ("plot.svg", "plot-2.svg", "invariants.svg", "invariants-2.svg"):
            root = xml.etree.ElementTree.parse(self.folder / name).getroot()
            self.assertTrue(root.tag.endswith("svg"))
        # A dot of the folder is none of the file's.
        folder = self.folder / "a.b"
        folder.mkdir()
        self.answers("--plot", folder / "plot", path)
        self.assertEqual(sorted(each.name for each in folder.iterdir()), ["plot", "plot-2"])

    def test_a_bad_file_is_named_by_line_and_column_and_nothing_is_half_done(self):
        good = self.write("good.csv", HEADER + ellipse())
        bad = self.write("bad.csv", "probe,patch,x_m,y_m\na,0,1,2\na,0,1,zwei\n")
        code, out, err = run(TOOL, "fit", good, bad, self.folder / "absent.csv")
        self.assertEqual((code, out), (2, ""))
        self.assertIn(f"{bad}:3:7: y_m", err)
        self.assertIn("absent.csv: cannot be read", err)

    def test_bad_usage_exits_with_2(self):
        path = self.write("part.csv", HEADER + ellipse())
        for arguments in (["fit"], ["fit", path, "--classes", "sphere"], ["fit", path, "--sigma", "-1"],
                          ["fit", path, "--method", "magic"], ["fit", path, "--nonsense"],
                          ["fit", path, "--touches=maybe"], ["fit", path, "--unqualified-probe=maybe"], []):
            code, out, err = run(TOOL, *arguments)
            self.assertEqual((code, out), (2, ""), arguments)
            self.assertTrue(err, arguments)

    def test_a_class_that_is_none_gets_the_list(self):
        path = self.write("part.csv", HEADER + ellipse())
        for option, wrong, shown in (("--class", "cirle", "cirle"), ("--classes", "circle,foo", "foo"),
                                     ("--class", "unclassified", "unclassified")):
            code, out, err = run(TOOL, "fit", path, option, wrong)
            self.assertEqual((code, out), (2, ""))
            self.assertIn(f'palpate: {option}: "{shown}" is no curve class: line, circle, ellipse, parabola, hyperbola, '
                          "cubical_parabola, semi_cubical_parabola, cubic_spline", err)
        self.assertEqual(run(TOOL, "fit", path, "--classes", "Semi-cubical Parabola,circle")[0], 0)

    def test_lists_may_have_blanks_after_their_commas(self):
        path = self.write("part.csv", HEADER + ellipse())
        for option, close, wide in (("--classes", "circle,ellipse", " circle, ellipse "), ("--leave-out", "3,17-19", "3, 17-19")):
            answers = []
            for words in (close, wide):
                code, out, err = run(TOOL, "fit", path, "--format", "json", option, words)
                self.assertEqual((code, err), (0, ""))
                answers.append(json.loads(out) | {"compute_ns": 0})
            self.assertEqual(*answers)
        code, _, err = run(TOOL, "fit", path, "--classes", "circle, ")
        self.assertEqual(code, 2)
        self.assertIn('"" is no curve class', err)

    def test_a_plot_that_is_no_svg_is_refused_before_the_work(self):
        for command in (["fit", "absent.csv", "--plot"], ["fit", "absent.csv", "--plot-invariants"],
                        ["calibrate", "absent.csv", "--circle", "0.025", "--plot"]):
            picture = self.folder / "x.png"
            code, out, err = run(TOOL, *command, picture)
            self.assertEqual((code, out), (2, ""))
            self.assertIn(f'{command[-1]}: "{picture}" does not end in .svg: pictures are written as SVG only', err)
            self.assertNotIn("absent.csv", err)
            self.assertFalse(picture.exists())
        path = self.write("part.csv", HEADER + ellipse())
        for name in ("x.SVG", "no_ending"):
            self.assertEqual(run(TOOL, "fit", path, "--plot", self.folder / name)[0], 0)

    def test_a_plot_that_cannot_be_written_fails(self):
        path = self.write("part.csv", HEADER + ellipse())
        for option in ("--plot", "--plot-invariants"):
            code, _, err = run(TOOL, "fit", path, option, self.folder / "absent" / "plot.svg")
            self.assertEqual(code, 1)
            self.assertIn("cannot be written", err)

    def test_too_few_samples_collect(self):
        answers, _ = self.answers("-", text_in="probe,patch,x_m,y_m\na,0,0,0\na,0,1,0\n")
        self.assertEqual(answers[0].status, recognition_pb2.RECOGNITION_STATUS_COLLECTING)

    def test_noise_that_is_stated_is_known(self):
        # Larger than the part: no two of its places can be told apart, and that is why there is no answer.
        path = self.write("part.csv", "x_m,y_m\n" + "".join(f"{0.001 * i},{0.0001 * i * i}\n" for i in range(20)))
        _, out, _ = run(TOOL, "fit", path, "--sigma", "0.1", "--format", "text")
        self.assertRegex(out, "status +collecting")
        self.assertRegex(out, "noise +sigma 100 mm\n")
        path.write_text("x_m,y_m\n0,0\n0.001,0\n")
        self.assertRegex(run(TOOL, "fit", path, "--format", "text")[1], "noise +not known yet\n")


if __name__ == "__main__":
    unittest.main()
