"""The planner's side: late ones, slow ones, and what a topic prefix brings."""
import time
import unittest

from bus import Bus, Probe, memory_kb, receive, wait_for
from palpate.v1 import curve_pb2


class Planner(unittest.TestCase):
    def test_a_late_planner_gets_the_latest_of_every_group_at_once(self):
        with Bus() as bus:
            bus.start_node("--status-period-s", "3600")
            early = bus.subscriber()
            socket = bus.publisher()
            for name in ("one", "two"):
                Probe(socket, name).stroke()
                wait_for(early, lambda a: a.group == name and a.sample_count == 200)
            late = bus.subscriber()
            start = time.monotonic()
            groups = {wait_for(late, lambda a: True, 1).group for _ in range(2)}
            self.assertEqual(groups, {"one", "two"})
            self.assertLess(time.monotonic() - start, 0.5)

    def test_the_latest_answer_is_repeated_unchanged_every_status_period(self):
        with Bus() as bus:
            bus.start_node("--status-period-s", "0.1")
            planner = bus.subscriber()
            socket = bus.publisher()
            Probe(socket).stroke()
            answer = wait_for(planner, lambda a: a.sample_count == 200)
            for _ in range(3):
                self.assertEqual(wait_for(planner, lambda a: True), answer)

    def test_a_prefix_does_not_catch_a_longer_name(self):
        with Bus() as bus:
            bus.start_node()
            planner = bus.subscriber("recognition/cup/")
            socket = bus.publisher()
            Probe(socket, "a", "cupboard").stroke()
            Probe(socket, "b", "cup").stroke()
            wait_for(planner, lambda a: a.group == "cup" and a.sample_count == 200)

    def test_a_planner_that_stops_reading_costs_the_node_nothing_and_finds_the_present_again(self):
        with Bus() as bus:
            node = bus.start_node("--results-high-water-mark", "100")
            asleep = bus.subscriber(high_water_mark=100)
            awake = bus.subscriber()
            socket = bus.publisher()
            probe = Probe(socket)
            probe.stroke()
            wait_for(awake, lambda a: a.sample_count == 200)
            before = memory_kb(node)
            latencies = []
            for number in range(2, 1500):
                message = probe.batch(10 * (number % 20), object_number=number)
                start = time.monotonic()
                probe.send(message)
                wait_for(awake, lambda a: a.object == number)
                latencies.append(time.monotonic() - start)
            # 1500 answers of some kilobytes: their backlog would be seen.
            self.assertLess(memory_kb(node) - before, 10 * 1024)
            half = len(latencies) // 2
            first, second = sorted(latencies[:half]), sorted(latencies[half:])
            print(f"median answer {1e3 * first[half // 2]:.2f} ms, later {1e3 * second[half // 2]:.2f} ms")
            self.assertLess(second[half // 2], 3 * first[half // 2])
            # It wakes: what was kept for it is old, then the present comes.
            probe.stroke(object_number=5000)
            newest = wait_for(asleep, lambda a: a.object == 5000 and a.sample_count == 200)
            self.assertEqual(newest.curve_class, curve_pb2.CURVE_CLASS_CIRCLE)


if __name__ == "__main__":
    unittest.main()
