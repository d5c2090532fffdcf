"""A million hostile messages beside a well-behaved probe."""
import math
import random
import statistics
import struct
import unittest

import zmq
from bus import Bus, Probe, latency_s, memory_kb, wait_for
from palpate.v1 import contact_pb2

MESSAGES = 1_000_000


def hostile_messages(rng):
    """A few thousand kinds, to be sent over and over: making them costs more than sending them."""
    def valid(name="bad"):
        batch = contact_pb2.ContactBatch(object=1)
        batch.header.source, batch.header.epoch, batch.header.seq = name, 1, rng.randrange(2 ** 63)
        for _ in range(3):
            sample = batch.samples.add()
            sample.x_m, sample.y_m, sample.sigma_m = rng.random(), rng.random(), 1e-5
        return batch

    def spoilt(change):
        batch = valid()
        change(batch)
        return [b"contact/bad/", batch.SerializeToString()]

    def set_x(value):
        def change(batch):
            batch.samples[1].x_m = value
        return change

    def set_sigma(value):
        def change(batch):
            batch.samples[0].sigma_m = value
        return change

    def set_detail(names, values):
        def change(batch):
            for name, value in zip(names, values):
                setattr(batch.samples[2], name, value)
        return change

    whole = valid().SerializeToString()
    many = valid()
    for _ in range(1100):
        many.samples.add().x_m = 1.0
    kinds = [[b"contact/bad/", rng.randbytes(rng.randrange(200))] for _ in range(500)]
    kinds += [[b"contact/bad/", whole[:n]] for n in range(len(whole))]
    kinds += [[b"contact/bad/", many.SerializeToString()]]
    kinds += [[topic, whole] for topic in (b"contact/bad", b"contact//", b"contact/a b/", b"contact/",
                                           b"contact/" + b"x" * 65 + b"/", b"contact/\xff/")]
    kinds += [[b"contact/bad/"], [b"contact/bad/", whole, b"third"], [b"contact/bad/", b""]]
    for value in (math.nan, math.inf, -math.inf, 1e308, -1e308):
        kinds.append(spoilt(set_x(value)))
        kinds.append(spoilt(set_sigma(value)))
    kinds.append(spoilt(set_sigma(-1.0)))
    # Normals and covariances that are none, whole and in part.
    for normal in ((0.0, 0.0, 0.1), (1.0, 0.0, 0.0), (1.0, 0.0, -1.0), (2.0, 0.0, 0.1), (math.nan, 0.0, 0.1), (1.0,)):
        kinds.append(spoilt(set_detail(("normal_x", "normal_y", "normal_sigma_rad"), normal)))
    for covariance in ((0.0, 0.0, 0.0), (1e-9, 1e-8, 1e-9), (-1e-9, 0.0, 1e-9), (math.inf, 0.0, 1e-9), (1e-9,)):
        kinds.append(spoilt(set_detail(("cov_xx_m2", "cov_xy_m2", "cov_yy_m2"), covariance)))
    # Unknown enum value (field 6 of ContactBatch is guessed by trying all), absurd lengths.
    for field in range(1, 12):
        kinds.append([b"contact/bad/", whole + struct.pack("BB", field << 3, 99)])
        kinds.append([b"contact/bad/", whole + struct.pack("B", (field << 3) | 2) + b"\xff\xff\xff\xff\x07"])
    kinds += [[f"contact/name{n}/".encode(), valid(f"name{n}").SerializeToString()]
              for n in range(10_000)]
    return kinds


class Hostile(unittest.TestCase):
    def test_the_node_stays_up_counts_right_and_serves_the_good(self):
        rng = random.Random(1)
        with Bus() as bus:
            node = bus.start_node()
            planner = bus.subscriber("recognition/good/", "status/")
            good = Probe(bus.publisher(), "good")

            def latency(object_number):
                return latency_s(good, planner, object_number)

            quiet = [latency(1 + n) for n in range(200)]
            before = memory_kb(node)
            attacker = bus.publisher(high_water_mark=0)
            kinds = hostile_messages(rng)
            order = [rng.randrange(len(kinds)) for _ in range(100_000)]
            sent, beside, number = 0, [], 1000
            peak = before
            while sent < MESSAGES:
                for _ in range(2000):
                    attacker.send_multipart(kinds[order[sent % len(order)]])
                    sent += 1
                if sent % 50_000 == 0:
                    number += 1
                    beside.append(latency(number))
                    peak = max(peak, memory_kb(node))
            expected = sent + 200 + len(beside)
            status = wait_for(planner, lambda m: hasattr(m, "messages_received") and
                              m.messages_received >= expected, 60)
            self.assertIsNone(node.poll())
            ledger = status.messages_accepted + sum(r.count for r in status.rejected)
            self.assertEqual(status.messages_received, ledger)
            self.assertEqual(status.messages_received, expected)
            after = [latency(5000 + n) for n in range(200)]
            print(f"{sent} hostile messages; memory {before} -> {peak} kB; median answer "
                  f"{1e3 * statistics.median(quiet):.2f} ms before, "
                  f"{1e3 * statistics.median(beside):.2f} ms beside, "
                  f"{1e3 * statistics.median(after):.2f} ms after")
            self.assertLess(peak - before, 64 * 1024)
            self.assertEqual(status.groups, min(status.groups, 64))
            self.assertLess(statistics.median(after), 2 * statistics.median(quiet) + 0.002)


if __name__ == "__main__":
    unittest.main()
