"""palpate.fit and Recognizer warn of what palpate check and fit find wrong with a file."""
import math
import sys
import unittest
import warnings

from programs import BUILD

sys.path.insert(0, str(BUILD / "node/python"))
import numpy as np

import palpate

A, B, SIGMA = 30.0, 20.0, 0.02  # [mm]


def stroke(start, end, n=100, seed=1):
    t = np.linspace(start, end, n)
    return np.column_stack([A * np.cos(t), B * np.sin(t)]) + np.random.default_rng(seed).normal(0, SIGMA, (n, 2))


def with_approach(points, n=7, step=0.35, angle=math.radians(60)):
    """Before the stroke come n samples at a slant to it, from outside."""
    travel = (points[9] - points[0]) / np.linalg.norm(points[9] - points[0])
    outward = np.array([travel[1], -travel[0]])
    way = math.cos(angle) * travel - math.sin(angle) * outward
    approach = points[0] - step * np.arange(n, 0, -1)[:, np.newaxis] * way
    return np.concatenate([approach + np.random.default_rng(9).normal(0, SIGMA, (n, 2)), points])


STROKES = [stroke(0.3, 1.5), stroke(2.3, 3.6, seed=2)]


class DataWarnings(unittest.TestCase):
    def said_by(self, call):
        """The result of a call, and the warnings."""
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = call()
        for warning in caught:
            self.assertIs(warning.category, palpate.DataWarning)
            self.assertEqual(warning.filename, __file__)  # where it was called
        return result, "\n".join(str(warning.message) for warning in caught)

    def warned(self, points, **arguments):
        return self.said_by(lambda: palpate.fit(points, **{"sigma": SIGMA, "unit": "mm"} | arguments))

    def test_nothing_is_said_of_sound_points(self):
        t = np.random.default_rng(3).permutation(np.linspace(0, 2 * math.pi, 13)[:-1])
        touches = 15 * np.column_stack([np.cos(t), np.sin(t)])
        for points, arguments in ((STROKES, {}), (STROKES[0], {}), (touches, dict(touches=True))):
            self.assertEqual(self.warned(points, **arguments)[1], "")

    def test_strokes_in_one_patch_and_lost_samples_are_jumps(self):
        lost = np.delete(STROKES[1], slice(40, 65), axis=0)
        for points, patch in ((np.concatenate(STROKES), ""), ([STROKES[0], lost], r" \(patch 1\)")):
            said = self.warned(points)[1]
            self.assertRegex(said, f"^1 jump of more than 20 spacings within a patch{patch}: "
                             "give each stroke an array of its own")
            self.assertNotIn("--", said)  # no options of a program that nobody runs

    def test_points_in_no_order_are_told(self):
        points = np.random.default_rng(4).permutation(stroke(0, 6))
        self.assertIn("touches=True", self.warned(points)[1])
        self.assertEqual(self.warned(points, touches=True)[1], "")

    def test_a_unit_that_was_forgotten_is_told(self):
        said = self.warned([STROKES[0], -STROKES[0]], unit="m")[1]
        self.assertRegex(said, r'the samples extend over 69.8\d* m: were these millimetres\? Then say unit="mm"')
        self.assertIn("tip_radius", self.warned(STROKES, tip_radius=2000)[1])

    def test_a_stroke_that_came_twice_is_told(self):
        self.assertIn("1 patch is a copy of others, sample by sample (patch 2 is one of patch 1)",
                      self.warned([*STROKES, STROKES[1]])[1])

    def test_an_approach_is_told_where_no_class_is_recognised(self):
        result, said = self.warned([with_approach(points) for points in STROKES])
        self.assertEqual(result.curve_class, "unclassified")
        self.assertRegex(said, r"straight at an end and meets? the rest at a corner \(patch 0: the first \d samples at \d+ degrees")
        self.assertIn("leave these samples out", said)
        # Set aside, but as well an edge and a corner.
        result, said = self.warned([with_approach(STROKES[0], n=5, angle=math.radians(90)), STROKES[1]])
        self.assertEqual((result.curve_class, result.doubt), ("ellipse", "misfit"))
        self.assertIn("leave these samples out", said)

    def test_strokes_without_patch_numbers_are_told_as_they_come(self):
        for numbers, jumps in (((0, 0), True), ((0, 1), False)):
            recognizer = palpate.Recognizer(sigma=SIGMA, unit="mm")
            said = []
            for number, points in zip(numbers, STROKES):
                for start in range(0, 100, 7):
                    recognizer.add(points[start:start + 7], patch=number)
                    said.append(self.said_by(recognizer.recognize)[1])
            self.assertEqual(set(said[:15]), {""})
            self.assertEqual(any("1 jump" in sentence and "patch number of its own" in sentence for sentence in said), jumps)
            self.assertEqual(self.said_by(recognizer.recognize)[1], "")  # nothing has come since
        recognizer.reset()
        recognizer.add(STROKES[0])
        self.assertEqual(self.said_by(recognizer.recognize)[1], "")

    def test_the_probe_is_named_and_a_long_stream_is_judged_by_its_newest(self):
        recognizer = palpate.Recognizer(sigma=SIGMA, unit="mm")
        recognizer.add(np.concatenate(STROKES), patch=0, probe=7)
        recognizer.add(STROKES[0], patch=1, probe=8)
        self.assertRegex(self.said_by(recognizer.recognize)[1], "^probe 7: 1 jump")
        for patch in range(2, 12):
            recognizer.add(stroke(0.3, 1.5, n=10_000, seed=patch), patch=patch, probe=8)
        self.assertEqual(self.said_by(recognizer.recognize)[1], "")

    def test_a_warning_may_be_made_an_error(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error", palpate.DataWarning)
            with self.assertRaisesRegex(palpate.DataWarning, "1 jump"):
                palpate.fit(np.concatenate(STROKES), sigma=SIGMA, unit="mm")


if __name__ == "__main__":
    unittest.main()
