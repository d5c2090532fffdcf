"""palpate estimate, called as a user calls it."""
import csv
import io
import math
import re
import unittest

from programs import TOOL, run

RADIUS = 0.02


def circle(samples=200, step=0.01):
    rows = ["probe,patch,x_m,y_m\n"]
    for i in range(samples):
        t = step * i
        rows.append(f"p,4,{RADIUS * math.cos(t)!r},{RADIUS * math.sin(t)!r}\n")
    return "".join(rows)


class Estimate(unittest.TestCase):
    def rows(self, *arguments, text=None):
        code, out, err = run(TOOL, "estimate", "-", *arguments, text_in=text or circle())
        self.assertEqual((code, err), (0, ""))
        return list(csv.DictReader(io.StringIO(out)))

    def test_every_estimator_gives_the_circles_curvature(self):
        # On a window that turns by 0.3 rad: chords and parabolas err by a few per cent, a circle not
        # at all, a polynomial of degree 4 by the fourth power of the turn.
        for name, tolerance in (("finite-difference", 0.3 ** 2), ("circle", 1e-9),
                                ("two-round", 0.3 ** 2), ("jet", 0.3 ** 4)):
            rows = self.rows("--estimator", name, "--window", 31, "--shift", 10)
            self.assertGreater(len(rows), 3, name)
            for row in rows:
                self.assertEqual((row["probe"], row["patch"]), ("p", "4"))
                self.assertLess(abs(float(row["kappa_per_m"]) * RADIUS - 1), tolerance, name)

    def test_probes_that_take_turns_in_a_file_have_patches_of_their_own(self):
        header, *rows = circle().replace("\n", ",part\n").replace("y_m,part", "y_m,group").splitlines(keepends=True)
        others = ["q" + row[1:] for row in rows]
        in_turn = self.rows("--window", 31, text=header + "".join(a + b for a, b in zip(rows, others)))
        self.assertEqual(in_turn, self.rows("--window", 31, text=header + "".join(rows + others)))
        self.assertGreater(len(in_turn), 10)

    def test_windows_follow_one_another_by_the_shift(self):
        rows = self.rows("--window", 51, "--shift", 7)
        first = [int(row["first_sample"]) for row in rows]
        self.assertEqual(first, list(range(0, 200 - 51 + 1, 7)))
        self.assertEqual({row["window_samples"] for row in rows}, {"51"})

    def test_sigma_that_the_file_overrules_is_told(self):
        rows = "".join(f"p,0,{1e-4 * i},{1e-6 * i * i},2e-5\n" for i in range(80))
        _, _, err = run(TOOL, "estimate", "--sigma", "1e-3", "-", text_in="probe,patch,x_m,y_m,sigma_m\n" + rows)
        self.assertIn("palpate: -: --sigma is not used", err)

    def test_standard_deviations_grow_with_the_stated_noise(self):
        one = self.rows("--sigma", "1e-6")[0]
        ten = self.rows("--sigma", "1e-5")[0]
        for column in ("tangent_sigma_rad", "kappa_sigma_per_m", "kappa_s_sigma_per_m2"):
            self.assertAlmostEqual(float(ten[column]) / float(one[column]), 10.0, places=3)

    def test_a_patch_shorter_than_a_window_is_said_to_be(self):
        code, out, err = run(TOOL, "estimate", "-", "--window", 75, text_in=circle(samples=20))
        self.assertEqual(code, 0)
        self.assertEqual(len(out.splitlines()), 1)
        self.assertIn("20 samples, an estimate takes 75", err)

    def test_windows_without_an_estimate_are_counted_not_told_one_by_one(self):
        dwell = "probe,patch,x_m,y_m\n" + "".join(f"p,3,{1e-3 * (i // 400)},0\n" for i in range(4000))
        code, out, err = run(TOOL, "estimate", "-", "--window", 75, text_in=dwell)
        self.assertEqual(code, 1)
        self.assertLess(len(err.splitlines()), 5)
        told = sum(map(int, re.findall(r"palpate: (\d+) windows? gives? no estimate, first p, patch 3, sample \d+: ", err)))
        self.assertEqual(told + len(out.splitlines()) - 1, len(range(0, 4000 - 75 + 1, 4)))

    def test_bad_usage_and_bad_files_exit_with_2(self):
        for arguments in (["-", "--estimator", "guess"], ["-", "--window", "2"], []):
            code, _, err = run(TOOL, "estimate", *arguments, text_in=circle())
            self.assertEqual(code, 2, arguments)
            self.assertTrue(err)
        code, _, err = run(TOOL, "estimate", "-", text_in="probe,patch,x_m,y_m\np,0,1,\n")
        self.assertEqual(code, 2)
        self.assertIn("standard input:2:", err)


if __name__ == "__main__":
    unittest.main()
