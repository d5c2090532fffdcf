"""palpate fit --part, called as a user calls it."""
import math
import pathlib
import random
import tempfile
import unittest

from google.protobuf import json_format

from palpate.v1 import part_match_pb2
from programs import TOOL, run

POINTS = [(0.030, 0.000), (0.012, 0.034), (-0.032, 0.022), (-0.028, -0.024), (0.010, -0.030)]
POSE = (0.3, -0.1, 0.6)
SIGMA = 1e-6
MODEL = "closed_spline {\n%s}\n" % "".join(
    f"  control_points {{ x_m: {x} y_m: {y} }}\n" for x, y in POINTS)


def position(t):
    """Of the uniform cubic B-spline, by its basis functions."""
    segment, u = int(t % 5), t % 1
    basis = [(1 - u) ** 3 / 6, (3 * u ** 3 - 6 * u ** 2 + 4) / 6,
             (-3 * u ** 3 + 3 * u ** 2 + 3 * u + 1) / 6, u ** 3 / 6]
    x, y = (sum(b * POINTS[(segment + k) % 5][i] for k, b in enumerate(basis)) for i in (0, 1))
    c, s = math.cos(POSE[2]), math.sin(POSE[2])
    return POSE[0] + c * x - s * y, POSE[1] + s * x + c * y


def stroke(patch, t0, t1, count=111, seed=1):
    rng = random.Random(seed + patch)
    rows = []
    for i in range(count):
        x, y = position(t0 + (t1 - t0) * i / (count - 1))
        rows.append(f"finger,{patch},{x + rng.gauss(0, SIGMA)!r},{y + rng.gauss(0, SIGMA)!r},{SIGMA!r}\n")
    return "".join(rows)


HEADER = "probe,patch,x_m,y_m,sigma_m\n"


class Part(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.model = self.write("part.textproto", MODEL)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def match(self, samples):
        code, out, err = run(TOOL, "fit", "--format", "json", "--part", self.model,
                             self.write("part.csv", HEADER + samples))
        self.assertEqual((code, err), (0, ""))
        (line,) = out.splitlines()
        return json_format.Parse(line, part_match_pb2.PartMatch())

    def test_patches_of_one_part_over_a_joint_and_against_t(self):
        match = self.match(stroke(0, 1.4025, 2.4025, 201) + stroke(1, 4.9, 4.2))
        self.assertEqual(match.status, part_match_pb2.PART_MATCH_STATUS_DETERMINED)
        best = match.placements[0]
        for i, (found, truth) in enumerate(
                zip((best.pose.x_m, best.pose.y_m, best.pose.theta_rad), POSE)):
            self.assertLess(abs(found - truth), 4 * math.sqrt(best.covariance[4 * i]))
        first, second = best.patches
        self.assertEqual((first.segment, second.segment), (1, 4))
        self.assertTrue(first.along_increasing_t)
        self.assertFalse(second.along_increasing_t)
        # The joint t = 2 is half-way between two samples, 150 micrometres apart; the place is known to
        # some micrometres.
        self.assertEqual(list(first.beyond), list(range(120, 201)))
        self.assertEqual(list(second.beyond), [])
        for i, t in enumerate(first.t):
            self.assertAlmostEqual(t, 1.4025 + i / 200, delta=1e-3)
        # Without the model: one joint, where it is.
        self.assertEqual(len(match.joints[1].joints), 0)
        (joint,) = match.joints[0].joints
        self.assertLessEqual(joint.earliest, 120)
        self.assertGreaterEqual(joint.latest, 120)

    def test_text_names_segment_pose_and_samples_beyond_the_joint(self):
        samples = self.write("part.csv", HEADER + stroke(0, 1.4025, 2.4025, 201))
        code, out, err = run(TOOL, "fit", "--format", "text", "--part", self.model, samples)
        self.assertEqual((code, err), (0, ""))
        self.assertIn(", finger: determined\n", out)
        self.assertRegex(out, r"patch finger/0    segment 1, t 1\.40\d\d to 2\.40\d\d; "
                              r"beyond a joint: samples 120-200\n")
        self.assertRegex(out, r"part         x (300\.0|299\.9)\d+ \+- 0\.\d+ mm, y ")

    def test_text_says_what_is_not_in_the_deviations_where_no_noise_is_stated(self):
        told = "estimated: +- counts white noise alone, a probe's drift or lobes are not in it\n"
        rows = stroke(0, 1.4025, 2.4025, 201)
        unstated = "probe,patch,x_m,y_m\n" + "".join(row.rsplit(",", 1)[0] + "\n" for row in rows.splitlines())
        for text, options, is_told in ((HEADER + rows, (), False), (unstated, (), True), (unstated, ("--sigma", SIGMA), False)):
            code, out, err = run(TOOL, "fit", "--format", "text", "--part", self.model, self.write("part.csv", text), *options)
            self.assertEqual((code, err), (0, ""))
            self.assertEqual(told in out, is_told, out)

    def touches(self, count):
        """Rows x,y of single touches all round the part, in no order."""
        rng = random.Random(count)
        places = [5 * (i + rng.uniform(-0.3, 0.3)) / count for i in range(count)]
        rng.shuffle(places)
        rows = [tuple(c + rng.gauss(0, SIGMA) for c in position(t % 5)) for t in places]
        return self.write("touches.csv", "x_m,y_m\n" + "".join(f"{x!r},{y!r}\n" for x, y in rows))

    def test_single_touches_may_be_in_any_order(self):
        for count in (8, 12, 20):
            code, out, err = run(TOOL, "fit", "--format", "json", "--touches", "--sigma", str(SIGMA),
                                 "--part", self.model, self.touches(count))
            self.assertEqual((code, err), (0, ""))
            match = json_format.Parse(out, part_match_pb2.PartMatch())
            self.assertEqual(match.status, part_match_pb2.PART_MATCH_STATUS_DETERMINED)
            best = match.placements[0]
            self.assertEqual([len(patch.t) for patch in best.patches], [1] * count)
            for i, (found, truth) in enumerate(
                    zip((best.pose.x_m, best.pose.y_m, best.pose.theta_rad), POSE)):
                self.assertLess(abs(found - truth), 5 * math.sqrt(best.covariance[4 * i]))
            # Their rows say by themselves that they follow no path.
            code, out, err = run(TOOL, "fit", "--format", "text", "--sigma", str(SIGMA), "--part", self.model,
                                 self.touches(count))
            self.assertEqual(code, 0)
            self.assertIn("each is taken as a touch of its own", err)
            self.assertIn(": determined\n", out)
            self.assertEqual(out.count("  touch "), count)
            self.assertNotIn("joints of", out)

    def test_single_touches_need_a_stated_noise(self):
        code, out, err = run(TOOL, "fit", "--format", "text", "--touches", "--part", self.model, self.touches(12))
        self.assertEqual((code, err), (0, ""))
        self.assertIn("nothing shows their noise, state it (--sigma, column sigma)", out)

    def test_another_curve_is_no_match(self):
        rows = "".join(f"finger,0,{0.03 * math.cos(i / 60)!r},{0.02 * math.sin(i / 60)!r},{SIGMA!r}\n"
                       for i in range(111))
        self.assertEqual(self.match(rows).status, part_match_pb2.PART_MATCH_STATUS_NO_MATCH)

    def test_options_that_make_no_difference_are_refused(self):
        samples = self.write("part.csv", HEADER + stroke(0, 1.1, 1.9))
        for option, told in ((("--classes", "ellipse"), "--classes: not with --part"),
                             (("--touched-from", "inside"), "--touched-from: not with --part"),
                             (("--determined-fraction", "0.1"), "--determined-fraction: not with --part"),
                             (("--export", self.folder / "curve.csv"), "--export")):
            code, out, err = run(TOOL, "fit", "--part", self.model, samples, *option)
            self.assertEqual((code, out), (2, ""), option)
            self.assertIn(told, err)
        self.assertFalse((self.folder / "curve.csv").exists())
        code, _, err = run(TOOL, "fit", "--part", self.model, samples, "--recognized-probability", "0.9",
                           "--false-outlier-probability", "0.02")
        self.assertEqual((code, err), (0, ""))

    def test_bad_models_are_named(self):
        samples = self.write("part.csv", HEADER + stroke(0, 1.1, 1.9))
        few = MODEL.replace("  control_points { x_m: 0.03 y_m: 0.0 }\n", "").replace(
            "  control_points { x_m: 0.012 y_m: 0.034 }\n", "")
        for text, why in (("curve { curve_class: CURVE_CLASS_LINE }", "has no closed_spline"),
                          ("closed_spline { control_points { x_m: nan } }", "is not finite"),
                          ("closed_spline { control_points { x_m: 1e8 } }", "beyond 10,000 km"),
                          (f"closed_spline {{ {257 * 'control_points { x_m: 1 } '} }}", "at most 256"),
                          (few, "at least four"), ("closed_spine {}", ":1:14: this is no line of a scene file")):
            model = self.write("bad.textproto", text)
            code, out, err = run(TOOL, "fit", "--part", model, samples)
            self.assertEqual((code, out), (2, ""))
            self.assertIn(str(model), err)
            self.assertIn(why, err)
        code, _, err = run(TOOL, "fit", "--part", self.folder / "none", samples)
        self.assertEqual(code, 2)
        self.assertIn("cannot be read", err)


if __name__ == "__main__":
    unittest.main()
