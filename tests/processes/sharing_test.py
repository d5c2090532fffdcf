"""Two recognizers that share the probes of one endpoint by the beginning of their names."""
import unittest

import zmq
from bus import Bus, Probe, receive, wait_for


class Sharing(unittest.TestCase):
    def test_each_node_hears_its_own_probes_only(self):
        with Bus() as one, Bus() as other:
            socket = one.context.socket(zmq.XPUB)
            socket.setsockopt(zmq.LINGER, 0)
            endpoint = f"ipc://{one.folder}/probes"
            socket.bind(endpoint)
            for bus, prefix in ((one, "left"), (other, "right")):
                bus.contacts = "connect:" + endpoint
                bus.start_node("--probe-prefixes", prefix)
            subscribed = {socket.recv() for _ in range(2)}
            self.assertEqual(subscribed, {b"\x01contact/left", b"\x01contact/right"})
            planners = [one.subscriber(), other.subscriber()]
            probes = [Probe(socket, "left.1"), Probe(socket, "right.1")]
            for probe in probes:
                probe.stroke()
            for planner, probe in zip(planners, probes):
                answer = wait_for(planner, lambda a: a.sample_count == 200)
                self.assertEqual(answer.group, probe.name)
            for planner in planners:
                while (further := receive(planner, 0.3)) is not None:
                    self.assertEqual(further.sample_count, 200)
            for bus, probe in ((one, "left.1"), (other, "right.1")):
                status = wait_for(bus.subscriber("status/"), lambda s: len(s.probes) > 0)
                self.assertEqual([p.probe for p in status.probes], [probe])


if __name__ == "__main__":
    unittest.main()
