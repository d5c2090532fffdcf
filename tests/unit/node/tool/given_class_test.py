"""palpate fit --class, called as a user calls it."""
import json
import math
import random
import unittest

from google.protobuf import json_format

from palpate.v1 import curve_pb2, given_class_pb2, recognition_pb2
from programs import TOOL, run

HEADER = "probe,patch,x_m,y_m\n"


def touches(points):
    """One patch a touch, as a trigger probe gives them."""
    return HEADER + "".join(f"p,{i},{x!r},{y!r}\n" for i, (x, y) in enumerate(points))


def fit(text, *arguments):
    code, out, err = run(TOOL, "fit", "--format", "json", *arguments, "-", text_in=text)
    return code, [json_format.Parse(line, given_class_pb2.GivenClassAnswer(), ignore_unknown_fields=True)
                  for line in out.splitlines()], err


def notes_of(text, *arguments):
    code, out, err = run(TOOL, "fit", "--format", "json", *arguments, "-", text_in=text)
    assert code == 0, err
    return "\n".join(json.loads(out).get("notes", []))


SQUARE = [(0.51, 0.2), (0.5, 0.21), (0.49, 0.2), (0.5, 0.19)]


class GivenClass(unittest.TestCase):
    def test_four_touches_are_a_circle(self):
        code, answers, err = fit(touches(SQUARE), "--class", "circle")
        self.assertEqual((code, err, len(answers)), (0, "", 1))
        answer = answers[0]
        recognition = answer.recognition
        self.assertEqual(answer.status, given_class_pb2.GIVEN_CLASS_STATUS_FITTED)
        self.assertEqual(recognition.curve_class, curve_pb2.CURVE_CLASS_CIRCLE)
        self.assertEqual(recognition.status, recognition_pb2.RECOGNITION_STATUS_RECOGNIZED)
        self.assertAlmostEqual(recognition.parameters.a, 0.01, delta=1e-16)
        self.assertAlmostEqual(recognition.pose.x_m, 0.5, delta=1e-15)
        self.assertEqual(len(answer.residual_m), 4)
        self.assertFalse(answer.sigma_stated)

    def test_probes_that_take_turns_in_a_file_draw_strokes(self):
        """Neighbours along a stroke, and its direction of travel, whatever the order of the rows of two probes."""
        rng = random.Random(7)
        rows = {}
        for probe, start in (("l", 0.0), ("r", 2.5)):
            noise = 0.0
            rows[probe] = []
            for i in range(150):
                t = start + 0.012 * i
                noise = 0.9 * noise + rng.gauss(0, 2e-6)
                radius = 0.02 + 0.001 + noise  # the tip's centres lie outside
                rows[probe].append(f"{probe},0,{radius * math.cos(t)!r},{radius * math.sin(t)!r},1e-6,0.001,left,part\n")
        header = "probe,patch,x_m,y_m,sigma_m,tip_radius_m,material_side,group\n"
        in_turn = [row for pair in zip(rows["l"], rows["r"]) for row in pair]
        _, (strokes,), _ = fit(header + "".join(rows["l"] + rows["r"]), "--class", "circle", "--leave-out", "2")
        _, (turns,), _ = fit(header + "".join(in_turn), "--class", "circle", "--leave-out", "3")
        self.assertGreater(strokes.recognition.noise_correlation_m, 0)
        self.assertEqual(turns.recognition.noise_correlation_m, strokes.recognition.noise_correlation_m)
        self.assertEqual(turns.recognition.parameters, strokes.recognition.parameters)
        self.assertEqual(turns.recognition.covariance, strokes.recognition.covariance)
        self.assertEqual(list(turns.left_out), [3])
        self.assertEqual(turns.residual_m[0::2], strokes.residual_m[:150])
        self.assertEqual(turns.residual_m[1::2], strokes.residual_m[150:])
        self.assertEqual(turns.recognition.sample_count, 299)

    def test_form_and_chi_square_are_told(self):
        points = [(0.01 * math.cos(i) * (1 + 1e-3 * (-1) ** i), 0.01 * math.sin(i) * (1 + 1e-3 * (-1) ** i))
                  for i in range(12)]
        _, (answer,), _ = fit(touches(points), "--class", "circle", "--sigma", "1e-6")
        self.assertTrue(answer.sigma_stated)
        self.assertAlmostEqual(answer.peak_to_valley_m, 2e-5, delta=2e-6)
        self.assertAlmostEqual(answer.rms_m, 1e-5, delta=1e-6)
        hypothesis = answer.recognition.hypotheses[0]
        self.assertEqual(hypothesis.dof, 9)
        self.assertAlmostEqual(hypothesis.chi2, 12 * (answer.rms_m / 1e-6) ** 2, delta=1e-6)
        code, text, _ = run(TOOL, "fit", "--format", "text", "--class", "circle", "-", text_in=touches(points))
        self.assertEqual(code, 0)
        self.assertIn("peak to valley", text)

    def test_residuals_beyond_the_stated_noise_are_no_circle_that_is_known(self):
        points = [(0.02 * math.cos(t), 0.02 * math.sin(t)) for t in (2 * math.pi * i / 12 for i in range(12))]
        points[4] = (points[4][0] * 1.05, points[4][1] * 1.05)
        for sigma, status, doubt in (("1e-3", recognition_pb2.RECOGNITION_STATUS_RECOGNIZED,
                                      recognition_pb2.RECOGNITION_DOUBT_UNSPECIFIED),
                                     ("1e-5", recognition_pb2.RECOGNITION_STATUS_AMBIGUOUS,
                                      recognition_pb2.RECOGNITION_DOUBT_MISFIT)):
            _, (answer,), _ = fit(touches(points), "--class", "circle", "--sigma", sigma)
            self.assertEqual((answer.recognition.status, answer.recognition.doubt), (status, doubt))
            self.assertEqual(answer.status, given_class_pb2.GIVEN_CLASS_STATUS_FITTED)
        notes = notes_of(touches(points), "--class", "circle", "--sigma", "1e-5")
        self.assertRegex(notes, r"WARNING: the residuals are larger than the stated noise .* Sample 5 lies furthest off")
        # Without it the circle is known again; three touches leave no residual, but rounding's.
        _, (answer,), _ = fit(touches(points), "--class", "circle", "--sigma", "1e-5", "--leave-out", "5")
        self.assertEqual(answer.recognition.status, recognition_pb2.RECOGNITION_STATUS_RECOGNIZED)
        _, (answer,), _ = fit(touches(points), "--class", "circle", "--sigma", "1e-5", "--leave-out", "1,4-6")
        self.assertEqual(list(answer.left_out), [1, 4, 5, 6])
        _, (answer,), _ = fit(touches(points[:3]), "--class", "circle", "--sigma", "1e-9")
        self.assertNotEqual(answer.recognition.doubt, recognition_pb2.RECOGNITION_DOUBT_MISFIT)

    def test_the_side_of_tips_on_a_circle_is_never_left_to_rounding(self):
        # Centres of tips of 1 mm at 9 mm: a pin of 8 mm, or a bore of 10 mm, by rounding alone.
        for count in range(4, 24):
            points = [(0.05 + 0.009 * math.cos(t), 0.009 * math.sin(t))
                      for t in (0.3 + 2 * math.pi * i / count for i in range(count))]
            for arguments in (("--class", "circle"), ("--class", "circle", "--sigma", "1e-5")):
                _, (answer,), _ = fit(touches(points), "--tip-radius", "0.001", *arguments)
                self.assertAlmostEqual(answer.recognition.parameters.a, 0.008, delta=1e-12)
        for arguments in (("--class", "circle"), ("--sigma", "1e-5")):
            notes = notes_of(touches(points), "--tip-radius", "0.001", *arguments)
            self.assertIn("taken to lie within the circle (a pin); of a bore the radius is 10 mm", notes)
            self.assertNotIn("WARNING", notes_of(touches(points), *arguments))
        bore = ("--tip-radius", "0.001", "--touched-from", "inside")
        self.assertEqual(answer.recognition.status, recognition_pb2.RECOGNITION_STATUS_AMBIGUOUS)
        self.assertEqual(answer.recognition.doubt, recognition_pb2.RECOGNITION_DOUBT_TWO_SHAPES)
        for arguments in (("--class", "circle"), ("--class", "circle", "--sigma", "1e-5"), ("--sigma", "1e-5")):
            code, out, _ = run(TOOL, "fit", "--format", "json", *bore, *arguments, "-", text_in=touches(points))
            told = json.loads(out)
            told = told.get("recognition", told)
            self.assertEqual((code, told["status"]), (0, "RECOGNITION_STATUS_RECOGNIZED"))
            self.assertAlmostEqual(told["parameters"]["a"], 0.010, delta=1e-9)
            self.assertNotIn("WARNING", notes_of(touches(points), *bore, *arguments))
        code, _, err = run(TOOL, "fit", *bore[:3], "within", "-", text_in=touches(points))
        self.assertEqual(code, 2)
        self.assertIn("--touched-from: expected outside, inside or unknown", err)
        stroke = "probe,patch,x_m,y_m,material_side\n" + "".join(f"p,0,{x!r},{y!r},right\n" for x, y in points)
        _, (answer,), _ = fit(stroke, "--tip-radius", "0.001", "--class", "circle")
        self.assertAlmostEqual(answer.recognition.parameters.a, 0.010, delta=1e-12)
        self.assertNotIn("WARNING", notes_of(stroke, "--tip-radius", "0.001", "--class", "circle"))

    def test_measured_normals_count_where_the_noise_is_known(self):
        rows = [(0.02 * math.cos(t) + 0.1, 0.02 * math.sin(t), math.cos(t), math.sin(t)) for t in (0.3, 1.5)]
        text = ("probe,patch,x_m,y_m,normal_x,normal_y,normal_sigma_rad\n" +
                "".join(f"p,{i},{x!r},{y!r},{u!r},{v!r},0.01\n" for i, (x, y, u, v) in enumerate(rows)))
        # Two touches with normals are a circle.
        code, (answer,), _ = fit(text, "--class", "circle", "--sigma", "1e-5")
        self.assertEqual(code, 0)
        self.assertEqual(answer.status, given_class_pb2.GIVEN_CLASS_STATUS_FITTED)
        self.assertAlmostEqual(answer.recognition.parameters.a, 0.02, delta=1e-9)
        self.assertEqual(answer.normal_count, 2)
        self.assertEqual(answer.recognition.hypotheses[0].dof, 1)
        self.assertEqual(len(answer.residual_normal_rad), 2)
        self.assertLess(max(map(abs, answer.residual_normal_rad)), 1e-6)
        # Without known noise they weigh nothing beside a distance, and that is said.
        _, out, _ = run(TOOL, "fit", "--format", "json", "--class", "circle", "-", text_in=text)
        self.assertIn("the measured normals do not count", out)
        self.assertEqual(json.loads(out)["status"], "GIVEN_CLASS_STATUS_TOO_FEW_POINTS")
        # Where the class is sought they count as well, but where neighbours may err together, and that is said; and
        # normals of another curve are a misfit.
        noise = random.Random(1)
        def stroke(turn):
            angles = [0.05 * i for i in range(40)]
            return text.splitlines()[0] + "\n" + "".join(
                f"p,0,{0.02 * math.cos(t) + noise.gauss(0, 1e-6)!r},{0.02 * math.sin(t) + noise.gauss(0, 1e-6)!r},"
                f"{math.cos(turn * t)!r},{math.sin(turn * t)!r},0.01\n" for t in angles)
        for turn, told, said in ((1, (), False), (1, ("--unqualified-probe",), True), (0, (), False)):
            _, out, _ = run(TOOL, "fit", "--format", "json", "--sigma", "1e-6", *told, "-", text_in=stroke(turn))
            answer = json.loads(out)
            self.assertEqual(any("40 samples have a normal" in note for note in answer.get("notes", [])), said)
            self.assertEqual(answer["doubt"] == "RECOGNITION_DOUBT_MISFIT", turn == 0)
        alone = text.splitlines()[0] + "\n" + "".join(
            f"p,{i},{0.02 * math.cos(0.5 * i)!r},{0.02 * math.sin(0.5 * i)!r},{math.cos(0.5 * i)!r},{math.sin(0.5 * i)!r},0.01\n"
            for i in range(12))
        _, out, _ = run(TOOL, "fit", "--format", "json", "--sigma", "1e-6", "-", text_in=alone)
        self.assertFalse(any("a normal" in note for note in json.loads(out).get("notes", [])))

    def test_a_covariance_weighs_along_the_normal(self):
        # Sure along x, unsure along y: the touches of the sides say how wide it is, whatever the others do.
        text = "probe,patch,x_m,y_m,cov_xx_m2,cov_xy_m2,cov_yy_m2\n" + "".join(
            f"p,{i},{x!r},{y!r},1e-12,0,1e-6\n"
            for i, (x, y) in enumerate([(0.5, 0.002), (0.5, -0.002), (0.54, 0.002), (0.54, -0.002), (0.52, 0.021)]))
        code, (answer,), _ = fit(text, "--class", "circle")
        self.assertEqual(code, 0)
        self.assertTrue(answer.sigma_stated)
        self.assertAlmostEqual(answer.recognition.parameters.a, math.hypot(0.02, 0.002), delta=1e-6)

    def test_deviations_are_wider_where_neighbours_err_together(self):
        """Of a Markov chain with correlation c, n samples are worth n (1 - c) / (1 + c). The radius of 60 full turns."""
        rng = random.Random(1)
        count = 300
        for correlation in (0.0, 0.8):
            squares = []
            for _ in range(60):
                error = rng.gauss(0, 1)
                rows = []
                for k in range(count):
                    radius, angle = 0.03 + 1e-5 * error, 2 * math.pi * k / count
                    rows.append(f"p,0,{radius * math.cos(angle)!r},{radius * math.sin(angle)!r}\n")
                    error = correlation * error + math.sqrt(1 - correlation ** 2) * rng.gauss(0, 1)
                _, (answer,), _ = fit(HEADER + "".join(rows), "--class", "circle")
                recognition = answer.recognition
                squares.append((recognition.parameters.a - 0.03) ** 2 / recognition.covariance[0])
            mean = sum(squares) / len(squares)
            # Four deviations of a mean of 60 chi-squares of one degree of freedom. The fit's three unknowns take of the
            # independent residuals what is not seen of the correlation either. (Before, the mean was 9.)
            worth = count * (1 - correlation) / (1 + correlation)
            four = 4 * math.sqrt(2 / 60)
            self.assertLess(mean, (1 + four) * worth / (worth - 2 * 3))
            self.assertGreater(mean, 1 - four)
            self.assertEqual(recognition.noise_correlation_m > 0, correlation > 0)

    def test_an_outlier_is_left_out_by_its_number(self):
        points = SQUARE[:2] + [(0.7, 0.7)] + SQUARE[2:]
        _, (answer,), _ = fit(touches(points), "--class", "circle", "--leave-out", "3")
        self.assertAlmostEqual(answer.recognition.parameters.a, 0.01, delta=1e-16)
        self.assertEqual(list(answer.left_out), [3])
        self.assertGreater(abs(answer.residual_m[2]), 0.5)

    def test_why_there_is_none_is_told(self):
        straight = [(0.1 * i, 0.2 * i) for i in range(7)]
        for points, status in ((straight, "COLLINEAR"), (SQUARE[:2], "TOO_FEW_POINTS")):
            code, (answer,), _ = fit(touches(points), "--class", "circle")
            self.assertEqual(code, 0)
            self.assertEqual(given_class_pb2.GivenClassStatus.Name(answer.status), "GIVEN_CLASS_STATUS_" + status)
            self.assertEqual(answer.recognition.curve_class, curve_pb2.CURVE_CLASS_CIRCLE)
            self.assertFalse(answer.recognition.HasField("parameters"))

    def test_options_that_make_no_difference_are_refused(self):
        for option in (("--classes", "ellipse"), ("--form-deviation-m", "1e-5"), ("--unqualified-probe",), ("--method", "tree"),
                       ("--no-unqualified-probe",), ("--most-samples-per-patch", "64"), ("--relative-tolerance", "0.1")):
            code, answers, err = fit(touches(SQUARE), "--class", "circle", *option)
            self.assertEqual((code, answers), (2, []), option)
            told = {"--no-unqualified-probe": "--unqualified-probe", "--relative-tolerance": "--tree-relative-tolerance"}
            self.assertIn(f"palpate: {told.get(option[0], option[0])}: not with --class", err)
        code, answers, err = fit(touches(SQUARE), "--class", "circle", "--sigma", "1e-5", "--touched-from", "outside",
                                 "--determined-fraction", "0.2", "--recognized-probability", "0.9")
        self.assertEqual(code, 0, err)

    def test_wrong_words_are_refused(self):
        for arguments, word in ((("--class", "potato"), "potato"), (("--class", "circle", "--leave-out", "9"), "'9'"),
                                (("--class", "circle", "--leave-out", "3-9"), "'3-9'"),
                                (("--class", "circle", "--leave-out", "0-2"), "'0-2'"),
                                (("--class", "circle", "--leave-out", "3-2"), "'3-2'"),
                                (("--class", "circle", "--leave-out", "1-2-3"), "'1-2-3'"),
                                (("--class", "circle", "--leave-out", "x"), "1-5"),
                                (("--class", "circle", "--leave-out", "1-%d" % len(SQUARE)), "leaves none")):
            code, answers, err = fit(touches(SQUARE), *arguments)
            self.assertNotEqual(code, 0)
            self.assertEqual(answers, [])
            self.assertIn(word, err)


if __name__ == "__main__":
    unittest.main()
