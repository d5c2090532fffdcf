"""Local estimates on estimate/<probe>/: published where they are asked for, and true."""
import math
import time
import unittest

from bus import Bus, Probe, receive_any
from palpate.v1 import local_estimate_pb2

RADIUS_M = 0.02


def estimates_of(socket, timeout_s=1.0):
    """All that come until nothing new has come for so long: the latest are repeated with each status."""
    found, known = [], set()
    deadline = time.monotonic() + timeout_s
    while (message := receive_any(socket, max(0.0, deadline - time.monotonic()))) is not None:
        topic, payload = message
        estimate = local_estimate_pb2.LocalEstimate.FromString(payload)
        found.append((topic.decode(), estimate))
        place = (topic, estimate.header.epoch, estimate.header.seq)
        if place not in known:
            known.add(place)
            deadline = time.monotonic() + timeout_s
    return found


class Estimates(unittest.TestCase):
    def test_they_come_in_order_with_true_uncertainties(self):
        with Bus() as bus:
            bus.start_node("--publish-estimates")
            socket = bus.publisher()
            listener = bus.subscriber("estimate/")
            names = [f"finger{i}" for i in range(3)]
            # A planner is heard of late: the first answers only say that it is.
            Probe(socket, "first").stroke(batches=3)
            self.assertTrue(estimates_of(listener))
            for name in names:
                probe = Probe(socket, name)
                for number in range(20):
                    probe.send(probe.batch(10 * number))
            found = [(t, e) for t, e in estimates_of(listener) if t != "estimate/first/"]
            self.assertEqual({topic for topic, _ in found}, {f"estimate/{name}/" for name in names})
            for name in names:
                own = [e for topic, e in found if topic == f"estimate/{name}/"]
                seqs = [e.header.seq for e in own]
                # Repeated with each status until another comes, never out of order, without holes.
                self.assertEqual(sorted(set(seqs)), list(range(len(set(seqs)))))
                self.assertEqual(seqs, sorted(seqs))
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

    def test_none_without_being_asked(self):
        with Bus() as bus:
            bus.start_node()
            socket = bus.publisher()
            everything = bus.subscriber("")
            # Contacts are not kept for those who come late: the node must have heard of the planner first.
            self.assertIsNotNone(receive_any(everything, 10))
            Probe(socket).stroke()
            topics = set()
            deadline = time.monotonic() + 3.0
            while (message := receive_any(everything, max(0.0, deadline - time.monotonic()))) is not None:
                topics.add(message[0].split(b"/")[0])
            self.assertEqual(topics, {b"status", b"recognition", b"contact"})


if __name__ == "__main__":
    unittest.main()
