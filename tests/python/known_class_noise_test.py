"""Strokes whose neighbouring samples err alike, fitted as a known class by palpate.models."""
import json
import math
import sys
import unittest

from programs import BUILD, TOOL, run

sys.path.insert(0, str(BUILD / "node/python"))
import numpy as np

import palpate

RADIUS, CENTRE, SIGMA = 0.02, np.array([0.1, -0.05]), 2e-5  # [m]
STROKES, COUNT, RHO = 2, 100, 0.8
Circle = palpate.models.model("circle")


def scenes(count, seed, rho=RHO):
    """`count` lists of strokes on the circle, arrays (n, 2) in metres. Each sample keeps rho of the noise of the one before."""
    noise = np.random.default_rng(seed).normal(0, SIGMA, (count, STROKES, COUNT, 2))
    for i in range(1, COUNT):
        noise[:, :, i] = rho * noise[:, :, i - 1] + math.sqrt(1 - rho**2) * noise[:, :, i]
    t = np.array([0.3, 2.6])[:, np.newaxis] + np.linspace(0, 1.8, COUNT)
    return list(CENTRE + RADIUS * np.stack([np.cos(t), np.sin(t)], axis=-1) + noise)


def squares(circle):
    """Of the truth's distances from the fit, in its stated deviations: of the radius, and of radius and centre together."""
    error = circle.params[:3] - [RADIUS, *CENTRE]
    covariance = circle.covariance[:3, :3]
    return error[0]**2 / covariance[0, 0], error @ np.linalg.solve(covariance, error)


def expected_within():
    """How often the truth lies within the 95 % interval of the radius, and within the 95 % region of radius and centre, if
    deviations are told by the residuals of such strokes.

    Of so many samples each (1 + RHO) / (1 - RHO) are worth one. From what these leave, each of the three unknowns takes a
    variance, and as much of the correlation (core/README.md, "Noise that neighbours share"), which the residuals cannot put
    back. And the correlation time is itself a mean over few: summed over W neighbours on either side it has the relative
    variance 2 (2 W + 1) / n (N. Madras and A. D. Sokal, 1988), as a variance of n / (2 W + 1) degrees of freedom has. The sum
    ends where the correlation RHO^W is as small as the chance of correlations of n such samples (Bartlett, 1946)."""
    n = STROKES * COUNT
    worth = n * (1 - RHO) / (1 + RHO)
    chance = math.sqrt((1 + RHO**2) / (1 - RHO**2) / n)
    freedom = n / (2 * math.log(chance) / math.log(RHO) + 1)
    rng = np.random.default_rng(1)
    draws = 200000
    told = (worth - 2 * 3) / worth * rng.chisquare(freedom, draws) / freedom
    square = rng.normal(size=(draws, 3))**2
    # The 95 % quantiles of chi-square with one and with three degrees of freedom.
    return (square[:, 0] / told < 3.841459).mean(), (square.sum(axis=1) / told < 7.814728).mean()


class SharedNoise(unittest.TestCase):
    def test_the_truth_lies_in_the_stated_region(self):
        count = 200
        of_scenes = scenes(count, seed=1)
        for sigma in (None, SIGMA):
            within = np.zeros(2)
            for strokes in of_scenes:
                circle = Circle()
                self.assertTrue(circle.estimate(strokes, sigma), circle.status)
                of_radius, of_all = squares(circle)
                within += of_radius < 3.841459, of_all < 7.814728
            for hits, expected in zip(within, expected_within()):
                band = 3.2905 * math.sqrt(count * expected * (1 - expected))  # 99.9 % of binomial counts
                self.assertLess(abs(hits - count * expected), band, (sigma, within, expected))

    def test_deviations_are_those_of_the_tool(self):
        for strokes in scenes(3, seed=2):
            text = "patch,x_m,y_m\n" + "".join(
                f"{number},{float(x)!r},{float(y)!r}\n" for number, stroke in enumerate(strokes) for x, y in stroke)
            for sigma in (None, SIGMA, 3 * SIGMA):  # of the last little is known to be shared
                stated = () if sigma is None else ("--sigma", sigma)
                code, out, err = run(TOOL, "fit", "-", "--class", "circle", "--format", "json", *stated, text_in=text)
                self.assertEqual(code, 0, err)
                told = json.loads(out)["recognition"]
                circle = Circle()
                self.assertTrue(circle.estimate(strokes, sigma), circle.status)
                np.testing.assert_allclose(circle.covariance.ravel(), told["covariance"], rtol=1e-9)
                self.assertGreater(circle.noise_correlation, 0)
                self.assertAlmostEqual(circle.noise_correlation / told["noise_correlation_m"], 1, places=9)

    def test_only_strokes_have_neighbours(self):
        for strokes in scenes(3, seed=3):
            along, touched, apart = Circle(), Circle(), Circle()
            self.assertTrue(along.estimate(strokes))
            self.assertTrue(touched.estimate(np.concatenate(strokes)))
            self.assertTrue(apart.estimate([point[np.newaxis] for stroke in strokes for point in stroke]))
            np.testing.assert_allclose(along.params, touched.params, rtol=1e-12)
            np.testing.assert_array_equal(apart.covariance, touched.covariance)
            self.assertEqual((touched.noise_correlation, apart.noise_correlation), (0, 0))
            # All of the covariance by one factor.
            shape = along.covariance[:3, :3] / touched.covariance[:3, :3]
            self.assertGreater(shape[0, 0], 2)
            np.testing.assert_allclose(shape, shape[0, 0], rtol=1e-9)
            # The unit makes no difference.
            larger = Circle()
            self.assertTrue(larger.estimate([1e3 * stroke for stroke in strokes]))
            self.assertAlmostEqual(larger.noise_correlation / (1e3 * along.noise_correlation), 1, places=6)
        self.assertTrue(math.isnan(Circle().noise_correlation))

    def test_white_noise_is_none_that_neighbours_share(self):
        for strokes in scenes(3, seed=4, rho=0):
            along, touched = Circle(), Circle()
            self.assertTrue(along.estimate(strokes))
            self.assertTrue(touched.estimate(np.concatenate(strokes)))
            self.assertEqual(along.noise_correlation, 0)
            np.testing.assert_allclose(along.covariance[:3, :3], touched.covariance[:3, :3], rtol=1e-9)


if __name__ == "__main__":
    unittest.main()
