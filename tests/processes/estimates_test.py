"""Local estimates on estimate/<probe>/: published where they are asked for, and true."""
import math
import random
import time
import unittest

from bus import Bus, Probe, receive_any, wait_for
from palpate.v1 import contact_pb2, local_estimate_pb2, recognition_pb2

RADIUS_M = 0.02


def estimates_of(socket, timeout_s=1.0):
    """All that come until none has come for so long; statuses, which come for ever, are no estimates."""
    found = []
    deadline = time.monotonic() + timeout_s
    while (message := receive_any(socket, max(0.0, deadline - time.monotonic()))) is not None:
        topic, payload = message
        if topic.startswith(b"estimate/"):
            found.append((topic.decode(), local_estimate_pb2.LocalEstimate.FromString(payload)))
            deadline = time.monotonic() + timeout_s
    return found


class NoisyProbe(Probe):
    """With white noise: Probe's own is a wave of fifteen samples, a form that windows follow."""

    def batch(self, first, **options):
        message = super().batch(first, **options)
        for i, sample in enumerate(message.samples, first):
            radius = RADIUS_M + random.Random(i).gauss(0, 2e-5)
            sample.x_m = 0.3 + radius * math.cos(0.01 * i)
            sample.y_m = 0.1 + radius * math.sin(0.01 * i)
        return message


class Finger:
    """A round tip that strokes the outside of a disc of 50 mm, a sample a millisecond, 0.1 mm apart."""
    DISC_M, TIP_M, SIGMA_M, STEP_M, BATCH = 0.05, 0.002, 2e-5, 1e-4, 10

    def __init__(self, socket, name, turn):
        """turn: +1 with the material on the left, -1 on the right."""
        self.probe, self.turn, self.sent = Probe(socket, name, group="hand"), turn, 0
        self.noise = random.Random(name)

    def send_batch(self):
        message = contact_pb2.ContactBatch(group="hand", object=1, patch=0, tip_radius_m=self.TIP_M)
        message.material_side = contact_pb2.MATERIAL_SIDE_LEFT if self.turn > 0 else contact_pb2.MATERIAL_SIDE_RIGHT
        message.header.source, message.header.epoch, message.header.seq = self.probe.name, 1, self.probe.seq
        message.header.stamp_ns = time.time_ns()
        self.probe.seq += 1
        radius = self.DISC_M + self.TIP_M
        for _ in range(self.BATCH):
            angle = self.turn * self.STEP_M / self.DISC_M * self.sent
            sample = message.samples.add(sigma_m=self.SIGMA_M, stamp_ns=time.time_ns())
            sample.x_m = 0.3 + radius * math.cos(angle) + self.noise.gauss(0, self.SIGMA_M)
            sample.y_m = 0.1 + radius * math.sin(angle) + self.noise.gauss(0, self.SIGMA_M)
            self.sent += 1
        self.probe.send(message)


def stroke(fingers, millimetres):
    """In real time."""
    start = time.monotonic()
    batches = round(millimetres * 1e-3 / (Finger.STEP_M * Finger.BATCH))
    for number in range(batches):
        for finger in fingers:
            finger.send_batch()
        time.sleep(max(0.0, start + 0.001 * Finger.BATCH * (number + 1) - time.monotonic()))


class Strokes(unittest.TestCase):
    """300 mm at 1 kHz by two fingers with round tips, as an outside subscriber sees it."""

    def are_right(self, estimates, turn):
        for e in estimates:
            # On the surface, within four standard deviations, which noise leaves once in 16,000 times: a stroke's
            # windows share their samples, and some twenty of them are independent.
            self.assertLess(abs(math.hypot(e.x_m - 0.3, e.y_m - 0.1) - Finger.DISC_M), 4 * e.normal_sigma_m)
            self.assertLess(abs(e.kappa_per_m - turn / Finger.DISC_M), 4 * e.kappa_sigma_per_m)
            self.assertLess(abs(e.kappa_s_per_m2), 4 * e.kappa_s_sigma_per_m2)

    def arrived(self, listener):
        found = estimates_of(listener, timeout_s=1.5)
        return {name: [e for _, e in found if e.probe == name] for name in ("thumb", "index")}

    def test_every_estimate_comes_once_in_order_and_right(self):
        with Bus() as bus:
            bus.start_node()
            socket = bus.publisher()
            listener = bus.subscriber("estimate/", "status/", high_water_mark=0)
            self.assertIsNotNone(receive_any(listener, 10))
            fingers = [Finger(socket, "thumb", +1), Finger(socket, "index", -1)]
            stroke(fingers, 300)
            found = self.arrived(listener)
            for finger in fingers:
                estimates = found[finger.probe.name]
                # From the sixteenth sample on, every fourth brings one.
                self.assertEqual([e.header.seq for e in estimates], list(range((finger.sent - 16) // 4 + 1)))
                self.are_right(estimates, finger.turn)
                self.assertGreater(estimates[-1].window_samples, 100)

    def test_a_node_that_is_killed_in_the_middle_goes_on_from_what_comes(self):
        with Bus() as bus:
            node = bus.start_node()
            socket = bus.publisher()
            listener = bus.subscriber("estimate/", "status/", high_water_mark=0)
            self.assertIsNotNone(receive_any(listener, 10))
            fingers = [Finger(socket, "thumb", +1), Finger(socket, "index", -1)]
            stroke(fingers, 150)
            before = self.arrived(listener)
            node.kill()
            node.wait()
            bus.start_node()
            self.assertTrue(socket.poll(5000))  # the new node has subscribed
            socket.recv()
            # It has heard of the subscriber once its status arrives there.
            old = before["thumb"][0].header.epoch
            wait_for(listener, lambda m: m.header.epoch != old)
            sent = fingers[0].sent
            stroke(fingers, 150)
            after = self.arrived(listener)
            for finger in fingers:
                name = finger.probe.name
                self.assertEqual(len(before[name]), (sent - 16) // 4 + 1)
                self.assertEqual([e.header.seq for e in after[name]],
                                 list(range((finger.sent - sent - 16) // 4 + 1)))
                self.assertNotEqual(before[name][0].header.epoch, after[name][0].header.epoch)
                self.are_right(before[name] + after[name], finger.turn)


class Estimates(unittest.TestCase):
    def test_they_come_in_order_with_true_uncertainties(self):
        with Bus() as bus:
            bus.start_node()
            socket = bus.publisher()
            listener = bus.subscriber("estimate/", "status/")
            # Estimates are not kept for those who come late: the node must have heard of the planner first.
            self.assertIsNotNone(receive_any(listener, 10))
            names = [f"finger{i}" for i in range(3)]
            for name in names:
                probe = NoisyProbe(socket, name)
                for number in range(20):
                    probe.send(probe.batch(10 * number))
            # Longer than a status period: what is repeated with it would come twice.
            found = estimates_of(listener, timeout_s=2.5)
            self.assertEqual({topic for topic, _ in found}, {f"estimate/{name}/" for name in names})
            for name in names:
                own = [e for topic, e in found if topic == f"estimate/{name}/"]
                seqs = [e.header.seq for e in own]
                # Each once, in order, without holes.
                self.assertEqual(seqs, list(range(len(seqs))))
                newest = own[-1]
                self.assertEqual(newest.probe, name)
                self.assertGreaterEqual(newest.window_samples, 20)
                self.assertAlmostEqual(newest.window_arc_m / (RADIUS_M * 0.01 * newest.window_samples), 1.0,
                                       delta=0.2)
                self.assertAlmostEqual(math.hypot(newest.x_m - 0.3, newest.y_m - 0.1), RADIUS_M, delta=1e-4)
                # Within four standard deviations: of three probes' newest estimates of a normal law,
                # one in five thousand test runs would not be.
                self.assertLess(abs(newest.kappa_per_m - 1.0 / RADIUS_M), 4.0 * newest.kappa_sigma_per_m)
                # At the end of an arc, but it still says that the arc is curved.
                self.assertLess(newest.kappa_sigma_per_m, 0.5 / RADIUS_M)
                self.assertLess(abs(newest.kappa_s_per_m2), 4.0 * newest.kappa_s_sigma_per_m2)

    def test_they_begin_with_the_first_who_asks_and_can_be_forbidden(self):
        for allowed in (True, False):
            with Bus() as bus:
                bus.start_node(*([] if allowed else ["--no-publish-estimates"]))
                socket = bus.publisher()
                answers = bus.subscriber("recognition/", "status/")
                self.assertIsNotNone(receive_any(answers, 10))
                probe = Probe(socket)
                for number in range(10):
                    probe.send(probe.batch(10 * number))
                wait_for(answers, lambda m: isinstance(m, recognition_pb2.Recognition) and m.sample_count >= 100)
                # A planner that comes in the middle of the stroke: windows begin with it.
                late = bus.subscriber("estimate/", "status/")
                self.assertIsNotNone(receive_any(late, 10))
                for number in range(10, 30):
                    probe.send(probe.batch(10 * number))
                found = estimates_of(late, timeout_s=2.0)
                self.assertEqual(bool(found), allowed)
                if not allowed:
                    continue
                self.assertEqual([e.header.seq for _, e in found], list(range(len(found))))
                first = found[0][1]
                # The first window holds samples of after the planner's coming alone.
                angle = math.atan2(first.y_m - 0.1, first.x_m - 0.3)
                self.assertGreater(angle, 0.01 * 100)


if __name__ == "__main__":
    unittest.main()
