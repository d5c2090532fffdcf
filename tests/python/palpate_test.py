"""`import palpate`, as a robotics researcher uses it."""
import math
import os
import pickle
import subprocess
import sys
import threading
import unittest

from programs import BUILD, SOURCE

# The package beside the messages' own folder, which other tests use.
sys.path.insert(0, str(BUILD / "node/python"))
import numpy as np

import palpate

A, B, SIGMA = 25.0, 17.5, 0.02  # [mm]
POSE = (300.0, -100.0, 0.6)


def ellipse(start, end, n=111, seed=1):
    rng = np.random.default_rng(seed)
    t = np.linspace(start, end, n)
    u, v = A * np.cos(t), B * np.sin(t)
    c, s = math.cos(POSE[2]), math.sin(POSE[2])
    return np.column_stack([POSE[0] + c * u - s * v, POSE[1] + s * u + c * v]) + rng.normal(0, SIGMA, (n, 2))


def touches_with_normals(n, normal_sigma, seed):
    """Points anywhere on the ellipse, and the normals out of it as a probe measures them."""
    rng = np.random.default_rng(seed)
    t = rng.uniform(0, 2 * math.pi, n)
    c, s = math.cos(POSE[2]), math.sin(POSE[2])
    turned = np.array([[c, s], [-s, c]])
    points = POSE[:2] + np.column_stack([A * np.cos(t), B * np.sin(t)]) @ turned + rng.normal(0, SIGMA, (n, 2))
    angle = np.arctan2(A * np.sin(t), B * np.cos(t)) + POSE[2] + normal_sigma * rng.normal(0, 1, n)
    return points, np.column_stack([np.cos(angle), np.sin(angle)])


PATCHES = [ellipse(0.3, 1.5), ellipse(2.3, 3.6, seed=2)]


class Fit(unittest.TestCase):
    def check(self, result, scale=1.0):
        self.assertEqual((result.status, result.doubt, result.curve_class), ("recognized", "none", "ellipse"))
        found = np.array([result.params["a"], result.params["b"], *result.pose])
        truth = np.array([A * scale, B * scale, POSE[0] * scale, POSE[1] * scale, POSE[2]])
        self.assertTrue((abs(found - truth) < 4 * np.sqrt(np.diag(result.covariance))).all(), (found, truth))

    def test_patches_in_any_unit_give_the_answer_in_that_unit(self):
        for unit, scale in (("mm", 1.0), ("m", 1e-3), ("um", 1e3), ("in", 1 / 25.4)):
            result = palpate.fit([scale * p for p in PATCHES], sigma=scale * SIGMA, unit=unit)
            self.check(result, scale)
            self.assertEqual(result.sample_count, 222)
            self.assertAlmostEqual(sum(result.probabilities.values()), 1.0)
            self.assertEqual(len(result.probabilities), 9)
            self.assertAlmostEqual(result.sigma / scale, SIGMA)

    def test_the_noise_is_estimated_where_it_is_not_told(self):
        result = palpate.fit(PATCHES, unit="mm")
        self.check(result)
        self.assertLess(abs(result.sigma / SIGMA - 1), 5 / math.sqrt(2 * 217))

    def test_a_probe_that_nobody_has_qualified_is_less_certain(self):
        trusted = palpate.fit(PATCHES, sigma=SIGMA, unit="mm")
        unqualified = palpate.fit(PATCHES, sigma=SIGMA, unit="mm", unqualified_probe=True)
        self.assertEqual(unqualified.curve_class, "ellipse")
        more = np.diag(unqualified.covariance) / np.diag(trusted.covariance)
        self.assertTrue((more > 1.0).all(), more)
        np.testing.assert_allclose(unqualified.noise_covariance, trusted.covariance, rtol=1e-6)
        # Whoever does not state the noise has not measured the probe.
        untold, noise_alone = (palpate.fit(PATCHES, unit="mm", unqualified_probe=u) for u in (None, False))
        self.assertEqual([r.unqualified_probe for r in (trusted, unqualified, untold, noise_alone)],
                         [False, True, True, False])
        np.testing.assert_allclose(untold.noise_covariance, noise_alone.covariance, rtol=1e-6)
        self.assertEqual(pickle.loads(pickle.dumps(untold)).noise_covariance.shape, (5, 5))
        self.assertTrue(palpate.fit(PATCHES, unit="mm", unqualified_probe=np.True_).unqualified_probe)
        for wrong in ("no", 0, np.array([True, False])):
            with self.assertRaisesRegex(ValueError, "unqualified_probe: .* is none of True, False and None"):
                palpate.fit(PATCHES, unit="mm", unqualified_probe=wrong)

    def test_other_powers_of_length(self):
        t = np.linspace(-30, 30, 120)
        points = np.column_stack([t, 2e-4 * t**3])  # y = a x^3, a in 1/mm^2
        result = palpate.fit(points, sigma=1e-3, unit="mm", classes=["cubical_parabola"])
        self.assertAlmostEqual(abs(result.params["a"]) / 2e-4, 1, places=3)

    def test_one_patch_may_be_an_array_a_list_or_not_contiguous(self):
        whole = ellipse(0, 5.5, 200)
        expected = palpate.fit(whole, sigma=SIGMA, unit="mm").params
        for points in (whole.tolist(), np.asfortranarray(whole), np.repeat(whole, 2, axis=0)[::2], [tuple(p) for p in whole]):
            self.assertEqual(palpate.fit(points, sigma=SIGMA, unit="mm").params, expected)
        self.assertEqual(palpate.fit(whole, sigma=np.full(200, SIGMA), unit="mm").params, expected)

    def test_touches_have_no_order(self):
        t = np.random.default_rng(3).permutation(np.linspace(0, 2 * math.pi, 13)[:-1])
        points = 15 * np.column_stack([np.cos(t), np.sin(t)])
        result = palpate.fit(points, sigma=0.005, unit="mm", touches=True)
        self.assertEqual(result.curve_class, "circle")
        self.assertAlmostEqual(result.params["a"], 15, places=2)


    def test_no_touch_is_forgotten_of_a_list_that_is_there_at_once(self):
        rng = np.random.default_rng(7)
        t = rng.uniform(0, 2 * np.pi, 3000)
        points = np.c_[20 * np.cos(t), 20 * np.sin(t)] + rng.normal(0, 0.005, (3000, 2))
        result = palpate.fit(points, sigma=0.005, unit="mm", touches=True)
        self.assertEqual((result.sample_count, result.forgotten_count), (3000, 0))
        self.assertAlmostEqual(result.params["a"], 20, delta=0.001)

    def test_no_patch_of_a_list_is_forgotten(self):
        patches = [ellipse(0.065 * k, 0.065 * k + 0.05, 9, seed=k) for k in range(90)]
        self.assertEqual(palpate.fit(patches, sigma=SIGMA, unit="mm").sample_count, 810)

    def test_a_tip_radius_is_taken_off(self):
        t = np.linspace(0, 5.5, 100)
        result = palpate.fit(17 * np.column_stack([np.cos(t), np.sin(t)]), sigma=1e-3, unit="mm", tip_radius=2,
                             material_side="left")
        self.assertAlmostEqual(result.params["a"], 15, places=2)

    def test_fit_has_more_patience_than_a_stream(self):
        rng = np.random.default_rng(5)
        places = ellipse(0.0, 3.4, 25)
        held = [place + rng.normal(0, SIGMA, (20, 2)) for place in places]
        hasty, patient = palpate.Recognizer(unit="mm"), palpate.Recognizer(unit="mm", patience=8)
        for number, place in enumerate(held):
            for recognizer in (hasty, patient):
                recognizer.add(place, patch=number, tip_radius=1.0)
        self.assertEqual(hasty.recognize().doubt, "work_limit")
        answer = patient.recognize()
        self.assertNotEqual(answer.doubt, "work_limit")
        self.assertEqual(answer.probabilities, palpate.fit(held, unit="mm", tip_radius=1.0).probabilities)
        for patience in (0.5, 0, -1, math.nan, "much"):
            with self.assertRaisesRegex(ValueError, "patience"):
                palpate.Recognizer(patience=patience)

    def test_touched_from_tells_a_bore(self):
        t = np.linspace(0, 6, 200)
        centres = 17 * np.column_stack([np.cos(t), np.sin(t)]) + np.random.default_rng(3).normal(0, 1e-3, (200, 2))
        for touched_from, radius, status in (("unknown", 15, "ambiguous"), ("outside", 15, "recognized"),
                                             ("inside", 19, "recognized")):
            result = palpate.fit(centres, sigma=1e-3, unit="mm", tip_radius=2, touched_from=touched_from)
            self.assertEqual((result.curve_class, result.status), ("circle", status))
            self.assertAlmostEqual(result.params["a"], radius, delta=0.01)
        with self.assertRaisesRegex(ValueError, "touched_from"):
            palpate.fit(centres, touched_from="within")

    def test_residuals_samples_and_feet_lie_on_one_curve(self):
        result = palpate.fit(PATCHES, sigma=SIGMA, unit="mm")
        residuals = result.residuals(np.concatenate(PATCHES))
        self.assertLess(abs(residuals.std() / SIGMA - 1), 0.25)
        points = result.sample(50)
        self.assertEqual(points.shape, (50, 2))
        np.testing.assert_allclose(result.residuals(points), 0, atol=1e-9)
        np.testing.assert_allclose(result.predict_xy(result.nearest(points)), points, atol=1e-9)
        # To the left of increasing t: an ellipse runs counter-clockwise, its centre lies to the left.
        self.assertGreater(result.residuals([POSE[:2]])[0], 0)

    def test_what_is_not_known_is_said(self):
        result = palpate.fit([[0.0, 0.0], [1.0, 0.0]])
        self.assertEqual(result.status, "collecting")
        with self.assertRaisesRegex(ValueError, "no curve was found"):
            result.residuals([[0, 0]])
        for arguments in (dict(unit="furlong"), dict(sigma=-1), dict(sigma=[1, 2]), dict(classes=["sphere"]), dict(classes=None),
                          dict(material_side="up"), dict(sigma=math.nan), dict(tip_radius=-1), dict(tip_radius=math.inf),
                          dict(form_deviation=-1)):
            with self.assertRaises(ValueError, msg=arguments):
                palpate.fit(PATCHES, **arguments)
        for points in ([], [[1.0, math.nan]], [[1.0, 2.0, 3.0]], [1.0, 2.0]):
            with self.assertRaises(ValueError, msg=points):
                palpate.fit(points)

    def test_what_is_wrong_is_named_and_not_guessed(self):
        hidden = np.ma.masked_greater(PATCHES[0], PATCHES[0].max() - 1)
        for named, points, arguments in (
                ("points: there are none", [], {}), ("points: .*not generator", (p for p in PATCHES), {}),
                ("points: .*not NoneType", None, {}), ("points: .*not dict", {"a": PATCHES[0]}, {}),
                ("points: some are masked", hidden, {}), ("points: some are masked", [hidden], dict(touches=True)),
                ("points: complex", PATCHES[0] + 0j, {}), ("sigma: complex", PATCHES, dict(sigma=0.02 + 0j)),
                # As many as the points of each patch: of which patch is not said.
                ("sigma: one number", PATCHES, dict(sigma=np.full(111, SIGMA))),
                ("sigma: one number", PATCHES[0], dict(sigma=np.full(111, SIGMA), touches=True)),
                ("points: there are none", np.empty((0, 2)), {}), ("points: there are none", [np.empty((0, 2))] * 2, {}),
                ("sigma: 0: must be .*above 0; None", PATCHES, dict(sigma=0)), ("sigma: 0.0: must be", PATCHES, dict(sigma=0.0)),
                ("sigma: -0.02: must be finite", PATCHES, dict(sigma=-0.02)), ("sigma: 'thin'", PATCHES, dict(sigma="thin")),
                ("sigma: nan: must be finite", PATCHES, dict(sigma=math.nan)), ("points: could not", [["a", "b"]], {}),
                ("tip_radius: '2': must be", PATCHES, dict(tip_radius="2")), ("tip_radius: None", PATCHES, dict(tip_radius=None)),
                ("form_deviation: None: must be", PATCHES, dict(form_deviation=None)),
                ("touched_from: .*tip_radius is 0", PATCHES, dict(touched_from="inside")),
                ("material_side: .*tip_radius is 0", PATCHES, dict(material_side="left")),
                ("material_side: single touches", PATCHES, dict(material_side="left", tip_radius=1, touches=True)),
                ("is no curve class: line, circle", PATCHES, dict(classes=["elipse"])),
                ("is no curve class", PATCHES, dict(classes="unclassified")),
                ("material_side: .*None", PATCHES, dict(material_side=None)),
                ("most_samples_per_patch: 0 is no whole number from 64", PATCHES, dict(most_samples_per_patch=0)),
                ("most_samples_per_patch: '1e3'", PATCHES, dict(most_samples_per_patch="1e3"))):
            with self.assertRaisesRegex(ValueError, named, msg=(named, arguments)):
                palpate.fit(points, **arguments)
        for wrong in ("no", 0, 1, None, np.array([True, False])):  # a word would count as true
            with self.assertRaisesRegex(TypeError, "touches: .* is neither True nor False"):
                palpate.fit(PATCHES, touches=wrong)
        self.assertEqual(palpate.fit(PATCHES, sigma=SIGMA, unit="mm", touches=np.False_).curve_class, "ellipse")
        with self.assertRaisesRegex(ValueError, "most_patches: 0"):
            palpate.Recognizer(most_patches=0)
        with self.assertRaisesRegex(ValueError, "sigma: 0: must be .*above 0; None"):
            palpate.Recognizer(sigma=0)
        recognizer = palpate.Recognizer()
        with self.assertRaisesRegex(ValueError, "sigma: 0: must be .*above 0; None"):
            recognizer.add(PATCHES[0], sigma=0)
        for wrong in (dict(patch=-1), dict(patch=1 << 32), dict(patch=1.0), dict(probe="left")):
            with self.assertRaisesRegex(ValueError, f"{next(iter(wrong))}: .* is no whole number from 0", msg=wrong):
                recognizer.add(PATCHES[0], **wrong)
        self.assertEqual(recognizer.add(PATCHES[0], patch=np.int64(3)), 111)
        self.check(palpate.fit(PATCHES, sigma=SIGMA, unit="mm", classes="ellipse"))
        nothing_hidden = np.ma.masked_array(PATCHES[0], mask=False)
        self.check(palpate.fit([nothing_hidden, PATCHES[1]], sigma=SIGMA, unit="mm"))

    def test_a_patch_of_a_list_may_have_no_normals(self):
        points, normals = touches_with_normals(9, 0.01, seed=8)
        result = palpate.fit([points[:4], points[4:]], sigma=SIGMA, unit="mm", normals=[None, normals[4:]], normal_sigma=0.01)
        self.assertEqual((result.sample_count, result.simplified_count), (9, 0))
        without = palpate.fit([points[:4], points[4:]], sigma=SIGMA, unit="mm")
        self.assertNotEqual(result.covariance.tolist(), without.covariance.tolist())

    def test_an_answer_goes_to_other_processes(self):
        import copy
        import pickle
        for result in (palpate.fit(PATCHES, sigma=SIGMA, unit="mm"), palpate.fit([[0.0, 0.0], [1.0, 0.0]])):
            has_curve = result.curve_class == "ellipse"
            if has_curve:
                result.sample(5)
            for other in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result), pickle.loads(pickle.dumps(copy.copy(result)))):
                self.assertEqual(repr(other), repr(result))
                self.assertEqual(other.probabilities, result.probabilities)
                self.assertEqual(len(other.contacts), len(result.contacts))
                np.testing.assert_array_equal(other.covariance, result.covariance)
                if has_curve:
                    np.testing.assert_array_equal(other.sample(9), result.sample(9))
                    np.testing.assert_array_equal(other.residuals(PATCHES[0]), result.residuals(PATCHES[0]))
        ellipse_model = palpate.models.model("ellipse")()
        ellipse_model.estimate(PATCHES[0])
        other = pickle.loads(pickle.dumps(ellipse_model))
        self.assertIs(type(other), type(ellipse_model))
        np.testing.assert_array_equal(other.predict_xy([0, 1]), ellipse_model.predict_xy([0, 1]))

    def test_threads_may_share_a_recognizer(self):
        recognizer, failures = palpate.Recognizer(sigma=SIGMA, unit="mm", most_patches=64), []

        def follow(number):
            try:
                for start in range(0, 111, 3):
                    recognizer.add(ellipse(0.4 * number, 0.4 * number + 0.3, seed=number)[start:start + 3], patch=number)
                    recognizer.recognize()
            except Exception as error:
                failures.append(error)

        threads = [threading.Thread(target=follow, args=(number,)) for number in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])
        result = recognizer.recognize()
        self.assertEqual(result.sample_count, 666)
        self.check(result)

    def test_a_distance_that_is_none_is_not_a_number(self):
        result = palpate.fit(PATCHES, sigma=SIGMA, unit="mm")
        residuals = result.residuals([POSE[:2], (math.nan, 0.0), (0.0, math.inf)])
        self.assertEqual(np.isnan(residuals).tolist(), [False, True, True])

    def test_a_class_at_its_limit_to_another_has_no_shape(self):
        t = np.linspace(0.3, 1.2, 100)
        result = palpate.fit(np.column_stack([35 * np.cos(t) + 10, 24 * np.sin(t) - 3]).astype(int), unit="mm")
        self.assertEqual(result.doubt, "several_classes")
        self.assertEqual(result.params, {})
        self.assertTrue(all(map(math.isnan, result.pose)))
        self.assertNotIn("a =", repr(result))

    def test_what_the_package_names(self):
        self.assertRegex(palpate.__version__, r"^\d+\.\d+\.\d+")
        self.assertEqual([name for name in dir(palpate) if not name.startswith("_")],
                         ["DataWarning", "Planner", "Probe", "Recognizer", "Result", "fit", "models"])

    def test_a_stream(self):
        recognizer = palpate.Recognizer(sigma=SIGMA, unit="mm")
        self.assertEqual(recognizer.recognize().status, "collecting")
        for number, patch in enumerate(PATCHES):
            for start in range(0, len(patch), 10):
                recognizer.add(patch[start:start + 10], patch=number)
        self.assertEqual(recognizer.add(PATCHES[1][-1:], patch=1), 0)
        self.assertEqual(recognizer.dropped, 1)
        self.check(recognizer.recognize())
        recognizer.reset()
        self.assertEqual(recognizer.recognize().status, "collecting")

    def test_the_interpreter_is_free_while_it_computes(self):
        # One thread recognises until another says stop. Were the interpreter held, the other could not say it before
        # the last of them: nobody is made to let go.
        many = [ellipse(0.05 * k, 0.05 * k + 0.3, 100, seed=k) for k in range(20)]
        stop, done, most = threading.Event(), [], 200

        def recognise():
            for _ in range(most):
                if stop.is_set():
                    return
                done.append(palpate.fit(many, sigma=SIGMA, unit="mm"))

        before = sys.getswitchinterval()
        sys.setswitchinterval(1000.0)
        try:
            thread = threading.Thread(target=recognise)
            thread.start()
            stop.set()
            thread.join()
        finally:
            sys.setswitchinterval(before)
        self.assertLess(len(done), most)

    def test_what_a_call_costs_beside_the_recognition(self):
        # 40 us at most are meant, the check of the points among them; overhead.py measures them. A test counts what the
        # time is spent on and no other work of the machine changes: calls of functions, of which each takes 0.1 to 0.3
        # us.
        import overhead
        counts = {name: overhead.calls(call) for name, call in overhead.what_is_called().items()}
        print(counts)
        for name, count in counts.items():
            self.assertGreater(count, 0, name)
            self.assertLess(count, 100, name)

    def test_many_small_adds_cost_no_more_than_few(self):
        # A picture's points are kept beside: nothing grows with how often was added.
        recognizer = palpate.Recognizer()
        points = ellipse(0, 5.5, 20000)
        for start in range(0, len(points), 1):
            recognizer.add(points[start:start + 1])
        self.assertEqual(recognizer._drawn, 20000)
        recognizer.add(ellipse(0, 5, 60000))
        self.assertEqual(recognizer._drawn, 40000)

    def test_a_class_that_is_known_in_the_habits_of_scikit_image(self):
        for unit in (1.0, 1e-3):
            points = unit * np.random.default_rng(5).permutation(np.concatenate(PATCHES))
            Ellipse = palpate.models.model("ellipse")
            self.assertEqual((Ellipse.__name__, Ellipse.min_samples), ("EllipseModel", 5))
            ellipse_model = Ellipse()
            self.assertTrue(ellipse_model.estimate(points), ellipse_model.status)
            sigmas = np.sqrt(np.diag(ellipse_model.covariance))
            truth = np.array([A * unit, B * unit, POSE[0] * unit, POSE[1] * unit, POSE[2]])
            self.assertTrue((abs(ellipse_model.params - truth) < 4 * sigmas).all(), ellipse_model.params)
            residuals = ellipse_model.residuals(points)
            self.assertAlmostEqual(np.sqrt((residuals**2).mean()), ellipse_model.rms)
            self.assertAlmostEqual(np.ptp(residuals), ellipse_model.peak_to_valley)
            on_it = ellipse_model.predict_xy(np.linspace(-3, 3, 9))
            np.testing.assert_allclose(ellipse_model.residuals(on_it), 0, atol=1e-9 * unit)
            # Least squares: no neighbour has less.
            for i, step in enumerate(0.3 * sigmas):
                for sign in (-1, 1):
                    other = ellipse_model.params.copy()
                    other[i] += sign * step
                    moved = Ellipse()
                    moved.params = other
                    self.assertGreater((moved.residuals(points)**2).sum(), (residuals**2).sum())
        # As a fit has it: of all points or of each; what is no noise is refused, not left out.
        points = np.concatenate(PATCHES)
        stated = Ellipse()
        self.assertTrue(stated.estimate(points, SIGMA))
        for sigma in (np.full(222, SIGMA), np.full((222, 1), SIGMA)):
            each = Ellipse()
            self.assertTrue(each.estimate(points, sigma))
            np.testing.assert_allclose(each.covariance, stated.covariance, rtol=1e-9)
        half = Ellipse()
        self.assertTrue(half.estimate(points, np.where(np.arange(222) < 111, SIGMA, 1e3 * SIGMA)))
        self.assertGreater(half.covariance[0, 0], stated.covariance[0, 0])
        for nothing in (None, 0.0, []):
            free = Ellipse()
            self.assertTrue(free.estimate(points, nothing))
            self.assertLess(abs(free.sigma / SIGMA - 1), 5 / math.sqrt(2 * 217))
        for sigma in (-SIGMA, math.nan, math.inf, [SIGMA, SIGMA], 1j):
            with self.assertRaisesRegex(ValueError, "sigma"):
                Ellipse().estimate(points, sigma)
        with self.assertRaisesRegex(ValueError, "params: 2 numbers; ellipse has 5"):
            stated.predict_xy([0.0], params=[1.0, 2.0])
        self.assertIs(palpate.models.model("Semi-cubical parabola"), palpate.models.model("semi_cubical_parabola"))
        line = palpate.models.model("line")()
        self.assertFalse(line.estimate([[1.0, 2.0]]))
        self.assertEqual(line.status, "too few points")
        with self.assertRaisesRegex(ValueError, "too few points"):
            line.residuals([[0.0, 0.0]])
        self.assertTrue(math.isnan(line.rms) and math.isnan(line.peak_to_valley) and math.isnan(line.sigma))
        for name in ("sphere", "unclassified", None):
            with self.assertRaisesRegex(ValueError, "is no curve class: line, circle"):
                palpate.models.model(name)

    def test_another_curve_of_a_known_class_is_told(self):
        # Through four points go two parabolas.
        points = np.array([[-1.0, 0.2], [-0.4, 0.0], [0.3, 0.05], [1.0, 0.7]])
        parabola = palpate.models.model("parabola")()
        self.assertTrue(parabola.estimate(points, 1e-6), parabola.status)
        self.assertEqual(len(parabola.rival), 4)
        self.assertGreater(abs(parabola.rival[0] / parabola.params[0] - 1), 0.1)
        other = palpate.models.model("parabola")()
        other.params = parabola.rival
        np.testing.assert_allclose(other.residuals(points), 0, atol=1e-9)
        circle = palpate.models.model("circle")()
        self.assertTrue(circle.estimate(points[:3], 1e-6), circle.status)
        self.assertIsNone(circle.rival)
        self.assertTrue(circle.bounded)

    def test_a_stroke_of_a_known_class_goes_along_it_as_fit_has_it(self):
        # The noise is a tenth of the distance between the arms: a cusp laid across the strokes fits single touches as well.
        import json
        import tempfile

        from programs import TOOL, run
        Cusp = palpate.models.model("semi_cubical_parabola")
        truth, sigma = np.array([0.5, 0.3, 0, 0, 0]), 0.05

        def arm(rng, t):
            t = np.sign(t) * np.sqrt(abs(t))
            return np.column_stack([t**2, truth[0] * t**3 + truth[1] * t**2]) + rng.normal(0, sigma, (len(t), 2))

        for seed in (16, 21, 25, 29):
            rng = np.random.default_rng(seed)
            patches = [arm(rng, np.linspace(0.3, 1.0, 40)), arm(rng, np.linspace(-1.0, -0.3, 40))]
            touched, stroked, listed = Cusp(), Cusp(), Cusp()
            self.assertTrue(touched.estimate(np.concatenate(patches), sigma), touched.status)
            self.assertTrue(stroked.estimate(patches, sigma), stroked.status)
            self.assertGreater(abs(touched.params - truth)[4], 20 * math.sqrt(touched.covariance[4, 4]))
            self.assertTrue((abs(stroked.params - truth) < 4 * np.sqrt(np.diag(stroked.covariance))).all(), stroked.params)
            # Any sequence of arrays is a list of patches; what is told per point is for all of them.
            self.assertTrue(listed.estimate(tuple(patch.tolist() for patch in patches), np.full(80, sigma)))
            np.testing.assert_array_equal(listed.params, stroked.params)
            with tempfile.TemporaryDirectory(prefix="palpate-") as folder:
                with open(f"{folder}/cusp.csv", "w") as file:
                    file.write("patch,x_m,y_m\n")
                    file.writelines(f"{number},{float(x)!r},{float(y)!r}\n" for number, patch in enumerate(patches) for x, y in patch)
                code, out, err = run(TOOL, "fit", f"{folder}/cusp.csv", "--class", "semi_cubical_parabola", "--sigma", sigma, "--format", "json")
            self.assertEqual(code, 0, err)
            told = json.loads(out)["recognition"]
            of_tool = [told["parameters"][name] for name in "ab"] + [told["pose"][name] for name in ("x_m", "y_m", "theta_rad")]
            np.testing.assert_allclose(stroked.params, of_tool, rtol=1e-12)
            np.testing.assert_allclose(stroked.covariance.ravel(), told["covariance"], rtol=1e-9)

    def test_patches_of_a_known_class_are_told_as_to_fit(self):
        Ellipse = palpate.models.model("ellipse")
        t = np.linspace(0.3, 5, 24)
        outward = np.column_stack([B * np.cos(t), A * np.sin(t)])
        outward /= np.linalg.norm(outward, axis=1)[:, None]
        points = np.column_stack([A * np.cos(t), B * np.sin(t)]) + np.random.default_rng(3).normal(0, SIGMA, (24, 2))
        together, apart, half, measured = (Ellipse() for _ in range(4))
        self.assertTrue(together.estimate(points, SIGMA, outward, 0.01))
        self.assertTrue(apart.estimate([points[:9], points[9:]], SIGMA, [outward[:9], outward[9:]], np.full(24, 0.01)))
        np.testing.assert_array_equal(apart.params, together.params)  # a conic has no branches to keep to
        self.assertTrue(half.estimate([points[:9], points[9:]], SIGMA, [None, outward[9:]], 0.01))
        self.assertTrue(measured.estimate(points, SIGMA, np.where(np.arange(24)[:, None] < 9, 0, outward), 0.01))
        np.testing.assert_array_equal(half.params, measured.params)
        self.assertGreater(half.covariance[0, 0], together.covariance[0, 0])
        for normals in ([outward[:9]], outward, [outward[:8], outward[8:]]):
            with self.assertRaisesRegex(ValueError, "normals: not in arrays like the points"):
                Ellipse().estimate([points[:9], points[9:]], SIGMA, normals, 0.01)
        for wrong in ([points, np.zeros(3)], [points, np.zeros((2, 3))], [points, np.zeros((1, 1, 2))]):
            with self.assertRaisesRegex(ValueError, r"shape \(n, 2\)"):
                Ellipse().estimate(wrong)
        for wrong in (dict(data=[]), dict(data=points, sigma=-1.0), dict(data=points, normals=outward)):
            with self.assertRaises(ValueError):
                together.estimate(**wrong)
            self.assertEqual(vars(together).keys(), vars(Ellipse()).keys())
            for name, value in vars(Ellipse()).items():  # nothing of the fit before
                np.testing.assert_array_equal(getattr(together, name), value, name)
            self.assertTrue(together.estimate(points, SIGMA))
        with self.assertRaisesRegex(ValueError, r"shape \(n, 2\)"):
            Ellipse().estimate([])
        for nothing in ([np.empty((0, 2))], np.empty((0, 2))):
            empty = Ellipse()
            self.assertFalse(empty.estimate(nothing))
            self.assertEqual(empty.status, "too few points")

    def test_normals_narrow_what_few_touches_tell_of_a_known_class(self):
        points, normals = touches_with_normals(7, 0.002, seed=4)
        truth = np.array([A, B, *POSE])
        areas = []
        for said in ({}, dict(normals=normals, normal_sigma=0.002), dict(normals=-normals, normal_sigma=np.full(7, 0.002))):
            ellipse_model = palpate.models.model("ellipse")()
            self.assertTrue(ellipse_model.estimate(points, SIGMA, **said), ellipse_model.status)
            sigmas = np.sqrt(np.diag(ellipse_model.covariance))
            self.assertTrue((abs(ellipse_model.params - truth) < 4 * sigmas).all(), ellipse_model.params)
            areas.append(sigmas[0] * sigmas[1])
        self.assertLess(areas[1], areas[0])
        self.assertAlmostEqual(areas[2] / areas[1], 1, places=6)  # a given class has its normals either way round

    def test_a_normal_tells_a_bore_from_a_boss(self):
        t = np.linspace(0, 2 * math.pi, 13)[:-1]
        outward = np.column_stack([np.cos(t), np.sin(t)])
        points = 15 * outward + np.random.default_rng(6).normal(0, 0.002, (12, 2))
        for sign, radius in ((1, 13), (-1, 17)):
            result = palpate.fit(points, sigma=0.002, unit="mm", touches=True, tip_radius=2, classes=["circle"],
                                 normals=sign * outward, normal_sigma=0.02)
            self.assertAlmostEqual(result.params["a"], radius, places=2)

    def test_a_covariance_counts_in_the_units_square(self):
        points = 1e-3 * np.concatenate(PATCHES)
        longer = np.array([[4.0, 1.0], [1.0, 2.0]]) * (1e-3 * SIGMA)**2
        estimated = []
        for unit, scale in (("m", 1.0), ("mm", 1e3)):
            recognizer = palpate.Recognizer(unit=unit, classes=["ellipse"])
            recognizer.add(scale * points[:111], patch=0, covariances=scale**2 * longer)
            recognizer.add(scale * points[111:], patch=1, covariances=np.tile(scale**2 * longer, (111, 1, 1)))
            result = recognizer.recognize()
            self.assertEqual(result.simplified_count, 0)
            least, most = np.sqrt(np.linalg.eigvalsh([[4.0, 1.0], [1.0, 2.0]]))
            self.assertTrue(least < result.sigma / scale / (1e-3 * SIGMA) < most)  # across the curve
            estimated.append((result.params["a"] / scale, result.sigma / scale))
        for one, other in zip(*estimated):
            self.assertAlmostEqual(one / other, 1, places=9)

    def test_details_that_cannot_be_used_are_refused_and_nothing_is_taken(self):
        points, normals = touches_with_normals(5, 0.01, seed=5)
        good = np.eye(2) * SIGMA**2
        recognizer = palpate.Recognizer(sigma=SIGMA, unit="mm")
        for said in (dict(normals=normals), dict(normal_sigma=0.01), dict(normals=normals[:4], normal_sigma=0.01),
                     dict(normals=2 * normals, normal_sigma=0.01), dict(normals=normals, normal_sigma=0),
                     dict(normals=normals, normal_sigma=[0.01, 0.01]), dict(normals=normals, normal_sigma=math.nan),
                     dict(covariances=np.full(5, SIGMA**2)), dict(covariances=-good), dict(covariances=np.stack([good] * 4)),
                     dict(covariances=good, sigma=SIGMA),
                     dict(covariances=good + [[0, SIGMA**2 / 2], [0, 0]]), dict(covariances=np.full((2, 2), math.nan))):
            with self.assertRaises(ValueError, msg=said):
                recognizer.add(points, **said)
        self.assertEqual(recognizer.recognize().sample_count, 0)
        self.assertEqual(recognizer.add(points, normals=np.where(np.arange(5)[:, None] == 2, 0, normals), normal_sigma=0.01), 5)
        self.assertEqual(recognizer.recognize().simplified_count, 4)  # too few for an answer

    def test_stubs_name_what_there_is(self):
        import ast
        core = palpate._core
        tree = ast.parse((SOURCE / "node/python/palpate/_core.pyi").read_text())
        named = {}
        for node in tree.body:
            if isinstance(node, ast.ClassDef):
                named[node.name] = {f.name for f in node.body if isinstance(f, ast.FunctionDef)} - {"__init__"}
            elif isinstance(node, ast.FunctionDef):
                named[node.name] = set()
        real = {name for name in dir(core) if not name.startswith("_")}
        self.assertEqual(set(named), real)
        for name, methods in named.items():
            if methods:
                self.assertEqual(methods, {m for m in vars(getattr(core, name)) if not m.startswith("_")})


class System(unittest.TestCase):
    def lines_said(self, bus, script):
        """What a script says that is run beside the node, with RESULTS and CONTACTS. In a process of its own: this one has
        the messages from another folder."""
        done = subprocess.run([sys.executable, "-c", f"RESULTS, CONTACTS = {bus.results!r}, {bus.contacts!r}\n" + script],
                              env=os.environ | {"PYTHONPATH": str(BUILD / "node/python")}, capture_output=True,
                              text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.splitlines()

    def test_a_probe_and_a_planner(self):
        script = f"""
import palpate, numpy as np
from palpate.v1 import curve_pb2
with palpate.Planner(RESULTS) as planner, palpate.Probe("finger", CONTACTS, sigma=0.02, unit="mm") as probe:
    for k, (start, end) in enumerate([(0.3, 1.5), (2.3, 3.6)]):
        t = np.linspace(start, end, 111)
        probe.send(np.column_stack([25 * np.cos(t), 17.5 * np.sin(t)]) + np.random.default_rng(k).normal(0, 0.02, (111, 2)))
        probe.lift_off()
    while True:
        answer = planner.receive(timeout=20)
        if answer.sample_count == 222:
            break
    print(curve_pb2.CurveClass.Name(answer.curve_class), round(1e3 * answer.parameters.a))
    try:
        planner.receive(timeout=0.2)
    except TimeoutError as error:
        print("silent:", error)
    probe.send([[30.0, 0.0]])
    planner._wait(20)
    print("waiting:", planner.receive(timeout=0).sample_count)
try:
    palpate.Probe("finger", "ipc://" + CONTACTS[6:] + ".nobody", timeout=0.2)
except TimeoutError as error:
    print("nobody:", error)
for wrong in (dict(name="left finger"), dict(name="finger", group="a/b"), dict(name="finger", tip_radius=-1)):
    try:
        palpate.Probe(endpoint=CONTACTS, **wrong)
    except ValueError as error:
        print("wrong:", error)
"""
        from bus import Bus
        with Bus() as bus:
            bus.start_node()
            lines = self.lines_said(bus, script)
        self.assertEqual(lines[0], "CURVE_CLASS_ELLIPSE 25")
        self.assertIn("no answer from", lines[1])
        self.assertEqual(lines[2], "waiting: 223")
        self.assertIn("no recognizer listens at", lines[3])
        self.assertEqual([line.partition("wrong: ")[2].split(":")[0] for line in lines[4:]], ["name", "group", "tip_radius"])

    def test_a_probe_may_bind_and_recognizers_come(self):
        script = """
import palpate, numpy as np
t = np.linspace(0.3, 1.5, 111)
with palpate.Planner("connect:" + RESULTS) as planner, palpate.Probe("finger", "bind:" + CONTACTS, unit="mm") as probe:
    probe.send(np.column_stack([25 * np.cos(t), 17.5 * np.sin(t)]))
    while (count := planner.receive(timeout=20).sample_count) != 111:
        pass
    print(count)
    try:
        palpate.Probe("other", "bind:" + CONTACTS)
    except OSError as error:
        print(error)
again = palpate.Probe("finger", "bind:" + CONTACTS, timeout=20)  # the path is free again, and the recognizer comes back
again.close()
try:
    palpate.Probe("finger", "bind:" + CONTACTS + "-nobody", timeout=0.2)
except TimeoutError as error:
    print(error)
"""
        from bus import Bus
        with Bus() as bus:
            address = f"ipc://{bus.folder}/bound"
            bus.contacts = "connect:" + address
            bus.start_node()
            bus.contacts = address
            lines = self.lines_said(bus, script)
        self.assertEqual(lines[0], "111")
        self.assertEqual(lines[1], f"cannot bind to {address}: another process has bound it")
        self.assertEqual(lines[2], f"no recognizer has come to {address}-nobody (palpate-node --contacts connect:{address}-nobody)")

    def test_probes_of_one_group_touch_one_object(self):
        # Each touches one side of an ellipse: one stroke alone would not show it.
        script = f"""
import palpate, numpy as np
with palpate.Planner(RESULTS, group="hand") as planner, \\
     palpate.Probe("left", CONTACTS, group="hand", sigma=0.02, unit="mm", object=7) as left, \\
     palpate.Probe("right", CONTACTS, group="hand", sigma=0.02, unit="mm", object=np.uint64(7)) as right:
    for number, a in ((7, 25), (8, 30), (20, 40)):
        for k, (probe, start, end) in enumerate([(left, 0.3, 1.5), (right, 2.3, 3.6)]):
            if number == 8:
                probe.new_object()
            elif number == 20:
                probe.new_object(20)
            t = np.linspace(start, end, 111)
            probe.send(np.column_stack([a * np.cos(t), 17.5 * np.sin(t)]) + np.random.default_rng(k).normal(0, 0.02, (111, 2)))
        while True:
            answer = planner.receive(timeout=20)
            if answer.object == number and answer.sample_count == 222:
                break
        print(left.object, right.object, round(1e3 * answer.parameters.a))
    for wrong in (20, 19, -1, 1 << 64, "21", 21.0):
        try:
            left.new_object(wrong)
        except ValueError as error:
            print(error)
    print(left.object)
with palpate.Probe("finger", CONTACTS, object=(1 << 64) - 1) as last:
    try:
        last.new_object()
    except ValueError as error:
        print(error)
with palpate.Probe("finger", CONTACTS, group="finger") as alone:
    before = alone.object
    alone.new_object()
    print(before > 1_600_000_000_000, alone.object - before)
for wrong in (dict(group="hand"), dict(object=-1), dict(object=1 << 64), dict(object=1.5), dict(object="1")):
    try:
        palpate.Probe("finger", CONTACTS, **wrong)
    except ValueError as error:
        print(str(error).split(";")[0])
"""
        none = "object: {} is no whole number from 0 to 18446744073709551615".format
        from bus import Bus
        with Bus() as bus:
            node = bus.start_node()
            lines = self.lines_said(bus, script)
            self.assertNotIn("rejected", node.log_path.read_text())
        self.assertEqual(lines, ["7 7 25", "8 8 30", "20 20 40",
                                 "object: 20 is not greater than the present one, 20", "object: 19 is not greater than the present one, 20",
                                 none(-1), none(1 << 64), none("'21'"), none(21.0), "20", none(1 << 64), "True 1",
                                 "group: 'hand': give object=NUMBER too, the same to all probes of the group",
                                 none(-1), none(1 << 64), none(1.5), none("'1'")])

    def test_a_probe_sends_normals_and_covariances(self):
        # A bore: without its normals the touches of a round tip would be those of a boss.
        script = f"""
import palpate, numpy as np
t = np.linspace(0, 6, 24)
inward = -np.column_stack([np.cos(t), np.sin(t)])
points = -15 * inward + np.random.default_rng(2).normal(0, 1e-3, (24, 2))
with palpate.Planner(RESULTS) as planner, palpate.Probe("finger", CONTACTS, unit="mm", tip_radius=2) as probe:
    for i in range(0, 24, 2):
        probe.send(points[i:i + 1], inward[i:i + 1], 0.02, 1e-6 * np.eye(2))
        probe.lift_off()
        probe.send(points[i + 1:i + 2], inward[i + 1:i + 2], [0.02], [1e-6 * np.eye(2)])
        probe.lift_off()
    while True:
        answer = planner.receive(timeout=20)
        if answer.sample_count == 24:
            break
    print(round(1e3 * answer.parameters.a, 1), answer.simplified_count, round(1e6 * answer.sigma_m, 3))
    # More than a message takes: in two.
    t = np.linspace(0, 6, 900)
    inward_of_many = -np.column_stack([np.cos(t), np.sin(t)])
    probe.new_object()
    probe.send(-15 * inward_of_many, inward_of_many, 0.02, 1e-6 * np.eye(2))
    while answer.sample_count != 900:
        answer = planner.receive(timeout=20)
    try:
        probe.send(points, 2 * inward, 0.02)
    except ValueError as error:
        print(error)
"""
        from bus import Bus
        with Bus() as bus:
            bus.start_node()
            lines = self.lines_said(bus, script)
        self.assertEqual(lines, ["17.0 0 1.0", "normals: number 0 is neither of length 1 nor (0, 0)"])

    def test_what_a_recognizer_would_reject_is_not_sent(self):
        # The node of the default limits counts nothing rejected, and hears what lies within them.
        script = f"""
import palpate, numpy as np
points = np.array([[1.0, 2.0]])
up = np.array([[0.0, 1.0]])
for wrong in (dict(sigma=1e-16), dict(sigma=1001.0), dict(tip_radius=1001.0), dict(sigma=1e6 + 1, unit="mm")):
    try:
        palpate.Probe("finger", CONTACTS, **wrong)
        print("sent:", wrong)
    except ValueError as error:
        print(str(error).split(":")[0])
with palpate.Planner(RESULTS) as planner, palpate.Probe("finger", CONTACTS, sigma=1e-15, tip_radius=1000.0) as probe:
    for wrong in ((1e7 * points,), (points, up, 1e-16), (points, up, 3.2), (points, None, None, 1e-31 * np.eye(2)),
                  (points, None, None, 2e6 * np.eye(2)), ([[np.nan, 0.0]],), ([[[1.0, 2.0]]],)):
        try:
            probe.send(*wrong)
            print("sent:", wrong)
        except ValueError as error:
            print(str(error).split(":")[0])
    probe.send([])
    probe.send(np.empty((0, 2)))
    for good in ((5e6 * points,), (points, up, 1e-15), (2 * points, up, np.pi), (3 * points, None, None, 1e-30 * np.eye(2)),
                 (4 * points, None, None, 1e6 * np.eye(2))):
        probe.send(*good)
    while planner.receive(timeout=20).sample_count != 5:
        pass
"""
        from bus import Bus
        with Bus() as bus:
            node = bus.start_node()
            lines = self.lines_said(bus, script)
            self.assertNotIn("rejected", node.log_path.read_text())
        self.assertEqual(lines,
                         ["sigma", "sigma", "tip_radius", "sigma", "points", "normal_sigma", "normal_sigma", "covariances", "covariances",
                          "points must be finite, of shape (n, 2)", "points must be finite, of shape (n, 2)"])

    def test_a_connection_that_is_closed_says_so(self):
        script = f"""
import palpate
with palpate.Planner(RESULTS) as planner, palpate.Probe("finger", CONTACTS) as probe:
    for peer, use in ((probe, lambda: probe.send([[1.0, 2.0]])), (planner, planner.receive)):
        peer.close()
        peer.close()
        try:
            use()
        except ValueError as error:
            print(str(error).replace(peer.endpoint, "ENDPOINT"))
for peer in (palpate.Planner, lambda endpoint: palpate.Probe("finger", endpoint)):
    try:
        peer("inproc://x")
    except ValueError as error:
        print(str(error).split(",")[0])
"""
        from bus import Bus
        with Bus() as bus:
            bus.start_node()
            lines = self.lines_said(bus, script)
        self.assertEqual(lines, 2 * ["the connection to ENDPOINT is closed"] +
                         2 * ["'inproc://x': inproc:// reaches only within one process"])

    def test_curve_with_the_keys_of_palpate_keygen(self):
        from bus import Bus
        from programs import TOOL
        with Bus("tcp") as bus:
            for name in ("node", "finger"):
                subprocess.run([TOOL, "keygen", bus.folder / name], check=True, stdout=subprocess.DEVNULL)
            bus.start_node("--curve-secret-key", bus.folder / "node.secret", "--allow-clients", bus.folder / "finger.public")
            script = f"""
import palpate, numpy as np
keys = dict(secret_key="{bus.folder}/finger.secret", server_key="{bus.folder}/node.public")
with palpate.Planner({bus.results!r}, **keys) as planner, palpate.Probe("finger", {bus.contacts!r}, sigma=1e-3, unit="mm", **keys) as probe:
    t = np.linspace(0, 5, 100)
    probe.send(15 * np.column_stack([np.cos(t), np.sin(t)]))
    print(round(1e3 * planner.receive(timeout=20).parameters.a, 2))
try:
    palpate.Probe("finger", {bus.contacts!r}, timeout=20)
except ConnectionRefusedError as error:
    print(str(error).split(" ", 4)[4].split(";")[0])
try:
    palpate.Planner({bus.results!r}, secret_key="{bus.folder}/finger.public", server_key="{bus.folder}/node.public")
except ValueError as error:
    print(error)
"""
            done = subprocess.run([sys.executable, "-c", script], env=os.environ | {"PYTHONPATH": str(BUILD / "node/python")},
                                  capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.splitlines(), ["15.0", "and we do not agree on CURVE: one of us has keys and the other none, or the server key that we were given is not its own",
                                                    f"{bus.folder}/finger.public: no secret key in it"])

    def test_a_wheel_is_whole(self):
        import importlib.util
        import pathlib
        import tempfile
        import zipfile
        if any(importlib.util.find_spec(name) is None for name in ("pip", "setuptools", "wheel")):
            self.skipTest("pip, setuptools or wheel is not installed: no wheel was made")
        with tempfile.TemporaryDirectory(prefix="palpate-") as folder:
            # From what is built: PALPATE_BUILD, as all of these tests have it.
            subprocess.run([sys.executable, "-m", "pip", "wheel", "--quiet", "--no-index", "--no-deps", "--no-build-isolation",
                            "--wheel-dir", folder, SOURCE / "node/python"], check=True, timeout=120)
            wheel, = pathlib.Path(folder).glob("*.whl")
            self.assertRegex(wheel.name, r"^palpate-\d+\.\d+\.\d+-cp3\d+-cp3\d+-linux_")
            with zipfile.ZipFile(wheel) as archive:
                archive.extractall(f"{folder}/site")
                names = set(archive.namelist())
            self.assertTrue({"palpate/py.typed", "palpate/_core.pyi", "palpate/v1/recognition_pb2.py",
                             "palpate/v1/recognition_pb2.pyi"} <= names)
            script = "import palpate; from palpate.v1 import contact_pb2; palpate.Probe; print(palpate.__file__, palpate.fit([[0, 0], [1, 0]]))"
            done = subprocess.run([sys.executable, "-c", script], env={"PYTHONPATH": f"{folder}/site"}, capture_output=True,
                                  text=True, cwd="/", timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"{folder}/site", done.stdout)
            self.assertIn("collecting", done.stdout)

    def test_the_tutorial_runs(self):
        done = subprocess.run([sys.executable, SOURCE / "node/examples/tutorial.py", "--no-plot"],
                              env=os.environ | {"PYTHONPATH": str(BUILD / "node/python")}, capture_output=True,
                              text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("ellipse (recognized)", done.stdout)
        self.assertIn("ambiguous", done.stdout)

    def test_the_tutorials_picture(self):
        import importlib.util
        import tempfile
        if importlib.util.find_spec("matplotlib") is None:
            self.skipTest("matplotlib is not installed: no picture was drawn")
        with tempfile.TemporaryDirectory(prefix="palpate-") as folder:
            subprocess.run([sys.executable, SOURCE / "node/examples/tutorial.py", "--plot", f"{folder}/tutorial.svg"],
                           env=os.environ | {"PYTHONPATH": str(BUILD / "node/python"), "MPLBACKEND": "Agg"}, check=True,
                           stdout=subprocess.DEVNULL, timeout=120)
            with open(f"{folder}/tutorial.svg") as picture:
                text = picture.read()
        self.assertIn("ellipse (recognized)", text)
        self.assertGreater(text.count("<use "), 222)  # each point, and ticks


if __name__ == "__main__":
    unittest.main()
