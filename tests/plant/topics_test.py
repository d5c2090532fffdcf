"""10,000 topics survive a reconnection, of the gateway to its plant and to its cell."""
import time
import unittest

import zmq
from bus import Bus, Probe
from plant import Client, Servers, carrier, gateway_status, skip_where_absent, wait_for_stored

TOPICS = 10_000


class Topics(unittest.TestCase):
    def test_ten_thousand_topics(self):
        with Bus() as bus, Servers(bus.folder) as servers:
            servers.start().wait()
            bus.start_node("--max-probes", TOPICS, "--max-groups", TOPICS,
                           "--results-high-water-mark", 100000)
            carrier(bus, servers.url, "up", "press", bus.results, "--carry", "contact")
            with Client(servers.url) as client:
                gateway_status(client, "press", "up")
                time.sleep(1.2)
            socket = bus.publisher(high_water_mark=0)
            probes = [Probe(socket, f"p{i}") for i in range(TOPICS)]
            self.send(probes)
            with Client(servers.url) as client:
                wait_for_stored(client, "palpate-press-contact", TOPICS, 60)
            # The plant's server dies, and comes again while all of them go on.
            servers.kill()
            self.send(probes)
            servers.start().wait()
            with Client(servers.url) as client:
                wait_for_stored(client, "palpate-press-contact", 2 * TOPICS, 60)
            # The cell's node dies; the gateway hears all of the next one's.
            node = bus.processes[0]
            node.kill()
            node.wait()
            bus.start_node("--max-probes", TOPICS, "--max-groups", TOPICS,
                           "--results-high-water-mark", 100000)
            time.sleep(1)
            socket.close(linger=0)
            socket = bus.publisher(high_water_mark=0)
            for probe in probes:
                probe.socket = socket
            self.send(probes)
            with Client(servers.url) as client:
                state = wait_for_stored(client, "palpate-press-contact", 3 * TOPICS, 60)
                self.assertEqual(state["messages"], 3 * TOPICS)
                self.assertEqual(state["num_subjects"], TOPICS)
                up = gateway_status(client, "press", "up").up
                self.assertEqual((up.received, up.missing, up.lost), (3 * TOPICS, 0, 0))
                print(f"{TOPICS} topics, three messages of each, over a new server and a new node: all stored once")

    def send(self, probes):
        for i, probe in enumerate(probes):
            probe.send(probe.batch(0))
            if i % 100 == 99:
                time.sleep(0.02)  # 5,000 a second


if __name__ == "__main__":
    skip_where_absent()
    unittest.main()
