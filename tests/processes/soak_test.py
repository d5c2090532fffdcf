"""A long run: many probes, changing objects, nothing lost, no memory taken.

    PALPATE_SOAK_S=3600 ctest --test-dir build/strict -R soak --verbose

runs for an hour in place of 20 seconds.
"""
import os
import signal
import threading
import time
import unittest

import zmq
from bus import Bus, Probe, memory_kb, receive, stop, wait_for

SECONDS = float(os.environ.get("PALPATE_SOAK_S", "20"))
PROBES = 16
# Of each probe: 20 batches of 10 samples and then another object, 1000 samples a second.
BATCHES_PER_S = 100
BATCHES_PER_OBJECT = 20
WARM_UP_S = min(5.0, SECONDS / 4)
MOST_GROWTH_KB = 10 * 1024


class Soak(unittest.TestCase):
    def test_nothing_is_lost_and_nothing_grows(self):
        with Bus() as bus:
            node = bus.start_node()
            socket = bus.publisher()
            planner = bus.subscriber("recognition/", "status/", high_water_mark=0)
            probes = [Probe(socket, f"finger{i}") for i in range(PROBES)]
            # A ready-made object; only what changes from batch to batch is written anew.
            ready = [Probe(socket, "x").batch(10 * i) for i in range(BATCHES_PER_OBJECT)]
            sent = 0
            answered = {}  # group: newest object
            oldest_answer_s = 0.0
            last_answer = time.monotonic()
            warm_kb = None
            start = time.monotonic()
            turn = 0
            while time.monotonic() < start + SECONDS:
                for probe in probes:
                    message = ready[turn % BATCHES_PER_OBJECT]
                    message.object = 1 + turn // BATCHES_PER_OBJECT
                    message.header.source = probe.name
                    message.header.seq = probe.seq
                    probe.seq += 1
                    probe.send(message)
                    sent += 1
                turn += 1
                while (answer := receive(planner, 0)) is not None:
                    if answer.DESCRIPTOR.name != "Recognition":
                        continue
                    now = time.monotonic()
                    oldest_answer_s = max(oldest_answer_s, now - last_answer)
                    last_answer = now
                    self.assertGreaterEqual(answer.object, answered.get(answer.group, 0))
                    answered[answer.group] = answer.object
                if warm_kb is None and time.monotonic() > start + WARM_UP_S:
                    warm_kb = memory_kb(node)
                time.sleep(max(0.0, start + turn / BATCHES_PER_S - time.monotonic()))
            self.assertEqual(len(answered), PROBES)
            self.assertLess(oldest_answer_s, 1.0)
            status = wait_for(planner, lambda s: s.DESCRIPTOR.name == "NodeStatus"
                              and s.messages_received == sent, 5)
            # The ledger: every message is received, and none is missing or rejected.
            self.assertEqual(status.messages_accepted, sent)
            self.assertEqual(status.missing + status.gaps + status.malformed, 0)
            self.assertEqual(status.samples_received, 10 * sent)
            for probe in status.probes:
                self.assertEqual(probe.messages, turn)
            growth_kb = memory_kb(node) - warm_kb
            print(f"{sent} messages of {PROBES} probes in {SECONDS:.0f} s "
                  f"({10 * sent / SECONDS:.0f} samples/s), {status.recognitions_published} recognitions, "
                  f"memory {warm_kb / 1024:.1f} MB after {WARM_UP_S:.0f} s, {growth_kb / 1024:+.1f} MB at the end")
            self.assertLess(growth_kb, MOST_GROWTH_KB)

    def test_stops_in_time_beside_a_planner_that_has_stopped(self):
        with Bus("tcp") as bus:
            node = bus.start_node()
            socket = bus.publisher()
            watch = bus.start("/usr/bin/python3", "-c",
                              "import sys, time, zmq; s = zmq.Context().socket(zmq.SUB); s.connect(sys.argv[1]);"
                              "s.subscribe(b''); print(len(s.recv_multipart()), flush=True); time.sleep(60)",
                              bus.results, stdout=-1)
            probe = Probe(socket)
            feeding = threading.Event()

            def feed():
                while not feeding.is_set():
                    probe.stroke(batches=5)
                    time.sleep(0.01)

            feeder = threading.Thread(target=feed)
            feeder.start()
            watch.stdout.readline()
            watch.send_signal(signal.SIGSTOP)
            time.sleep(0.3)
            code, seconds = stop(node)
            feeding.set()
            feeder.join()
            watch.kill()
            watch.wait()
            watch.stdout.close()
            self.assertEqual(code, 0)
            self.assertLess(seconds, 0.5)


if __name__ == "__main__":
    unittest.main()
