"""Local estimates on estimate/<probe>/: published where they are asked for, and true."""
import math
import time
import unittest

from bus import Bus, Probe, receive_any, wait_for
from palpate.v1 import local_estimate_pb2, recognition_pb2

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
                probe = Probe(socket, name)
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
