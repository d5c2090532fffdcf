"""palpate-node --given-class: what palpate fit --class says, on the bus, with measured normals and covariances."""
import json
import math
import time
import unittest

from bus import Bus, Probe, receive, wait_for
from palpate.v1 import curve_pb2, given_fit_pb2, recognition_pb2
from programs import SIM, TOOL, run

# Twelve touches of a tip on an ellipse, in no order, and a stroke; nobody tells the side.
TOUCHES = "".join(f"  patches {{ start_t: {(5 * i) % 12 * 0.5} arc_m: 1e-6 spacing_m: 1e-3 }}\n" for i in range(12))
SCENE = """
seed: 4
curve { curve_class: CURVE_CLASS_ELLIPSE parameters { a: 0.03 b: 0.02 } }
pose { x_m: 0.2 y_m: -0.1 theta_rad: 0.4 }
noise { NOISE }
probes {
  name: "trigger"
  tip_radius_m: 0.002
  hide_material_side: true
""" + TOUCHES + """  patches { start_t: 1 arc_m: 0.01 spacing_m: 2e-4 }
}
"""
DETAILED = "cov_xx_m2: 4e-8 cov_xy_m2: -1e-8 cov_yy_m2: 1e-8 normal_sigma_rad: 0.0175"


class GivenClass(unittest.TestCase):
    def done(self, *command):
        code, out, err = run(*command, timeout=120)
        self.assertEqual(code, 0, err)
        return out

    def scene(self, folder, noise):
        """The scene's file and its samples as CSV."""
        path, csv = folder / "touches.textproto", folder / "touches.csv"
        path.write_text(SCENE.replace("NOISE", noise))
        self.done(SIM, path, "--csv", csv)
        return path, csv

    def compare(self, live, offline):
        """To the rounding of decimals: the same samples, the same arithmetic."""
        there = offline["recognition"]
        self.assertEqual(recognition_pb2.RecognitionStatus.Name(live.status), there["status"])
        self.assertEqual(curve_pb2.CurveClass.Name(live.curve_class), there["curve_class"])
        self.assertEqual(given_fit_pb2.GivenClassStatus.Name(live.given.status), offline["status"])
        covariance = there["covariance"]
        self.assertEqual(len(live.covariance), len(covariance))
        size = math.isqrt(len(covariance))
        deviations = [math.sqrt(covariance[i * (size + 1)]) for i in range(size)]
        for i, (one, two) in enumerate(zip(live.covariance, covariance)):
            self.assertLess(abs(one - two), 1e-9 * deviations[i // size] * deviations[i % size], i)
        found = [live.parameters.a, live.parameters.b, live.pose.x_m, live.pose.y_m, live.pose.theta_rad]
        other = [there["parameters"][name] for name in "ab"]
        other += [there["pose"][name] for name in ("x_m", "y_m", "theta_rad")]
        for one, two, deviation in zip(found, other, deviations):
            self.assertLess(abs(one - two), 1e-9 * deviation)
        self.assertAlmostEqual(live.hypotheses[0].chi2 / there["hypotheses"][0]["chi2"], 1.0, delta=1e-9)
        self.assertEqual(live.hypotheses[0].dof, there["hypotheses"][0]["dof"])
        self.assertAlmostEqual(live.given.rms_m / offline["rms_m"], 1.0, delta=1e-9)
        self.assertAlmostEqual(live.given.peak_to_valley_m / offline["peak_to_valley_m"], 1.0, delta=1e-9)
        self.assertEqual(live.given.sigma_stated, offline["sigma_stated"])
        self.assertEqual(live.given.normal_count, int(offline["normal_count"]))

    def test_the_planner_reads_what_fit_says(self):
        with Bus() as bus:
            bus.start_node("--given-class", "ellipse")
            planner = bus.subscriber()
            widths = {}
            for noise in (DETAILED, "sigma_m: 2e-4", "sigma_m: 2e-4 hide_sigma: true"):
                _, csv = self.scene(bus.folder, noise)
                rows = len(csv.read_text().splitlines()) - 1
                offline = json.loads(self.done(TOOL, "fit", csv, "--class", "ellipse", "--format", "json"))
                self.done(TOOL, "replay", csv, "--contacts", bus.contacts, "--fast")
                live = wait_for(planner, lambda a: a.sample_count == rows)
                self.compare(live, offline)
                self.assertEqual(live.given.status, given_fit_pb2.GIVEN_CLASS_STATUS_FITTED)
                self.assertEqual(live.given.normal_count, rows if noise == DETAILED else 0)
                self.assertEqual(live.simplified_count, 0)
                self.assertLess(abs(live.parameters.a - 0.03), 4 * math.sqrt(live.covariance[0]))
                widths[noise] = math.sqrt(live.covariance[0])
            print(f"deviation of a: {1e6 * widths[DETAILED]:.0f} um with normals of 1 degree and the covariance, "
                  f"{1e6 * widths['sigma_m: 2e-4']:.0f} um without")

    def test_what_a_recording_keeps_is_answered_alike(self):
        with Bus() as bus:
            path, csv = self.scene(bus.folder, DETAILED)
            rows = len(csv.read_text().splitlines()) - 1
            offline = json.loads(self.done(TOOL, "fit", csv, "--class", "ellipse", "--format", "json"))
            kept = bus.folder / "kept.rec"
            record = bus.start(TOOL, "record", kept, "--contacts", bus.contacts, "--seconds", "2")
            self.done(SIM, path, "--contacts", bus.contacts, "--fast", "--quiet")
            self.assertEqual(record.wait(20), 0)
            bus.start_node("--given-class", "ellipse")
            planner = bus.subscriber()
            self.done(TOOL, "replay", kept, "--contacts", bus.contacts, "--fast")
            self.compare(wait_for(planner, lambda a: a.sample_count == rows), offline)

    def test_where_the_class_is_sought_all_counts(self):
        with Bus() as bus:
            _, csv = self.scene(bus.folder, DETAILED)
            rows = len(csv.read_text().splitlines()) - 1
            bus.start_node()
            planner = bus.subscriber()
            self.done(TOOL, "replay", csv, "--contacts", bus.contacts, "--fast")
            live = wait_for(planner, lambda a: a.sample_count == rows)
            self.assertEqual(live.simplified_count, 0)
            self.assertFalse(live.HasField("given"))

    def test_too_few_touches_are_no_curve(self):
        with Bus() as bus:
            bus.start_node("--given-class", "circle")
            planner = bus.subscriber()
            probe = Probe(bus.publisher())
            message = probe.batch(0, count=2)
            probe.send(message)
            live = wait_for(planner, lambda a: a.sample_count == 2)
            self.assertEqual(live.given.status, given_fit_pb2.GIVEN_CLASS_STATUS_TOO_FEW_POINTS)
            self.assertEqual(live.status, recognition_pb2.RECOGNITION_STATUS_AMBIGUOUS)
            self.assertFalse(live.HasField("parameters"))

    def test_bad_normals_and_covariances_are_counted_by_their_reasons(self):
        with Bus() as bus:
            bus.start_node("--status-period-s", "0.2")
            planner = bus.subscriber("recognition/", "status/")
            probe = Probe(bus.publisher())

            def publish(**fields):
                message = probe.batch(0)
                for name, value in fields.items():
                    setattr(message.samples[5], name, value)
                probe.send(message)

            publish(normal_x=0.0, normal_y=0.0, normal_sigma_rad=0.1)
            publish(normal_x=1.0, normal_y=0.0, normal_sigma_rad=0.0)
            publish(normal_x=1.0)
            publish(cov_xx_m2=1e-9, cov_xy_m2=1e-8, cov_yy_m2=1e-9)
            publish(cov_xx_m2=float("nan"), cov_xy_m2=0.0, cov_yy_m2=1e-9)
            publish(normal_x=1.0, normal_y=0.0, normal_sigma_rad=0.1)
            deadline = time.monotonic() + 10
            counts = {}
            while time.monotonic() < deadline:
                message = receive(planner, 1.0)
                if message is None or not hasattr(message, "messages_received") or message.messages_received < 6:
                    continue
                counts = {entry.reason: entry.count for entry in message.rejected}
                self.assertEqual(message.messages_received, message.messages_accepted + sum(counts.values()))
                break
            names = message.DESCRIPTOR.file.enum_types_by_name["RejectReason"].values_by_name
            expected = {"NORMAL": 3, "COVARIANCE": 1, "NOT_FINITE": 1}
            self.assertEqual(counts, {names[f"REJECT_REASON_{key}"].number: value for key, value in expected.items()})


if __name__ == "__main__":
    unittest.main()
