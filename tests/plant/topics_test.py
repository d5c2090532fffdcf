"""10,000 topics survive reconnections: of the gateway to its plant, and of the probes to a gateway that was killed."""
import time
import unittest

from bus import Bus, Probe
from plant import Client, Servers, carrier, gateway_status, skip_where_absent, wait_for_stored

TOPICS = 10_000
TIME_S = 300  # for what a busy machine takes; some seconds otherwise


class Topics(unittest.TestCase):
    def test_ten_thousand_topics(self):
        with Bus() as bus, Servers(bus.folder) as servers:
            servers.start().wait()
            # Probes connect to the gateway itself: each subscription is told to each of them again.
            bus.contacts = f"ipc://{bus.folder}/contacts"
            up = carrier(bus, servers.url, "up", "press", "bind:" + bus.contacts)
            socket = bus.publisher(high_water_mark=0)
            probes = [Probe(socket, f"p{i}") for i in range(TOPICS)]
            with Client(servers.url) as client:
                gateway_status(client, "press", "up", 30)
                self.send(probes)
                wait_for_stored(client, "palpate-press-contact", TOPICS, TIME_S)
            # The plant's server dies, and comes again while all of them go on.
            servers.kill()
            self.send(probes)
            servers.start().wait()
            with Client(servers.url) as client:
                wait_for_stored(client, "palpate-press-contact", 2 * TOPICS, TIME_S)
            # The gateway dies; the next one hears all of them.
            while socket.poll(0):
                socket.recv()
            up.kill()
            up.wait()
            up = carrier(bus, servers.url, "up", "press", "bind:" + bus.contacts)
            for _ in range(2):  # contact, status
                self.assertTrue(socket.poll(1000 * TIME_S), "the probes do not find the gateway again")
                socket.recv()
            self.send(probes)
            with Client(servers.url) as client:
                state = wait_for_stored(client, "palpate-press-contact", 3 * TOPICS, TIME_S)
                self.assertEqual((state["messages"], state["num_subjects"]), (3 * TOPICS, TOPICS))
                status = gateway_status(client, "press", "up", 30).up
                self.assertEqual((status.received, status.missing, status.lost), (TOPICS, 0, 0))
            print(f"{TOPICS} topics, three messages of each, over a new server and a new gateway: all stored once")

    def send(self, probes):
        for i, probe in enumerate(probes):
            probe.send(probe.batch(0))
            if i % 100 == 99:
                time.sleep(0.02)  # 5,000 a second


if __name__ == "__main__":
    skip_where_absent()
    unittest.main()
