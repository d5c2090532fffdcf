"""Health of the inputs: alive, silent, gaps, restarts, and a frozen process."""
import signal
import time
import unittest

from bus import Bus, Probe, wait_for
from programs import SIM, SOURCE


def probe_of(status, name):
    return next((p for p in status.probes if p.probe == name), None)


class Liveness(unittest.TestCase):
    def test_a_frozen_probe_is_shown_within_a_second(self):
        with Bus() as bus:
            bus.start_node()
            planner = bus.subscriber("status/")
            sim = bus.start(SIM, "--contacts", bus.contacts, "--quiet", "--repeat", "0", "--pause", "0",
                            SOURCE / "sim/scenes/circle.textproto")
            wait_for(planner, lambda s: (p := probe_of(s, "finger")) and p.alive)
            sim.send_signal(signal.SIGSTOP)
            start = time.monotonic()
            wait_for(planner, lambda s: not probe_of(s, "finger").alive)
            taken = time.monotonic() - start
            print(f"frozen probe shown after {taken:.2f} s")
            self.assertLess(taken, 1.0)
            sim.send_signal(signal.SIGCONT)
            start = time.monotonic()
            wait_for(planner, lambda s: probe_of(s, "finger").alive)
            self.assertLess(time.monotonic() - start, 1.5)

    def test_gaps_and_restarts_are_counted(self):
        with Bus() as bus:
            bus.start_node()
            planner = bus.subscriber("status/")
            socket = bus.publisher()
            probe = Probe(socket)
            probe.send(probe.batch(0))
            probe.seq += 3
            probe.send(probe.batch(10))
            again = Probe(socket, epoch=2)
            again.send(again.batch(20))
            # From before the restart: not used.
            probe.send(probe.batch(30))
            status = wait_for(planner, lambda s: (p := probe_of(s, "finger")) and p.rejected == 1)
            finger = probe_of(status, "finger")
            self.assertEqual((finger.gaps, finger.missing, finger.restarts), (1, 3, 1))
            self.assertEqual((finger.messages, finger.samples), (3, 30))
            self.assertEqual(status.messages_received, 4)
            self.assertEqual(status.messages_accepted, 3)


if __name__ == "__main__":
    unittest.main()
