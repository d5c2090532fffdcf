"""The plant is away: what waits on disk, what is lost beyond its bound and said, and that the cell does not notice.

    PALPATE_PLANT_AWAY_S=60 ctest --test-dir build/strict -R plant_away --verbose

takes it away for a minute in place of some seconds.
"""
import os
import re
import signal
import statistics
import time
import unittest

from bus import Bus, Probe, receive, stop, wait_for_log
from plant import (EVERY_KIND, Client, Ledger, Servers, carrier, gateway_status, recogniser, skip_where_absent,
                   wait_for_stored)

AWAY_S = float(os.environ.get("PALPATE_PLANT_AWAY_S", "6"))
BATCHES_PER_OBJECT = 20


class Away(unittest.TestCase):
    def test_what_the_disk_holds_comes_later(self):
        """A gateway is killed meanwhile, too: what is on disk is taken up by the next one."""
        with Bus() as bus, Servers(bus.folder) as servers:
            servers.start().wait()
            bus.start_node()
            socket = bus.publisher(high_water_mark=100000)
            gateway = carrier(bus, servers.url, "up", "press", bus.results, *EVERY_KIND)
            probes = [Probe(socket, f"finger.{i}", group="hand") for i in range(4)]
            with Client(servers.url) as client:
                gateway_status(client, "press", "up")
                time.sleep(1.2)  # it holds back at its start

                def stroke(batches):
                    for probe in probes:
                        for _ in range(batches):
                            probe.send(probe.batch(10 * probe.seq, step=0.001))

                stroke(50)
                wait_for_stored(client, "palpate-press-contact", 200)
            servers.kill()
            wait_for_log(gateway, "no connection")
            stroke(50)
            wait_for_log(gateway, "messages wait on disk")
            time.sleep(0.5)
            gateway.kill()
            gateway.wait()
            gateway = carrier(bus, servers.url, "up", "press", bus.results, *EVERY_KIND)
            # What comes before it listens again is lost to the plant: so is what nobody hears.
            time.sleep(1.5)
            stroke(50)
            time.sleep(0.5)
            servers.start().wait()
            with Client(servers.url) as client:
                wait_for_stored(client, "palpate-press-contact", 600)
                Ledger(client, "press").sent_once(self, {probe.name: 150 for probe in probes})
                status = gateway_status(client, "press", "up")
                self.assertEqual((status.up.lost, status.up.missing, status.up.malformed), (0, 0, 0))
                deadline = time.monotonic() + 10
                while gateway_status(client, "press", "up").up.spool_bytes and time.monotonic() < deadline:
                    time.sleep(0.1)
                left = [path.name for path in (bus.folder / "up.spool").glob("*.recording")]
                self.assertLessEqual(len(left), 1, "what is stored is deleted")

    def test_a_gateway_that_is_stopped_keeps_what_is_on_its_way(self):
        """The plant stands still: what the gateway has taken is neither stored nor on disk yet."""
        with Bus() as bus, Servers(bus.folder) as servers:
            servers.start().wait()
            endpoint = f"ipc://{bus.folder}/contacts"
            gateway = carrier(bus, servers.url, "up", "press", "bind:" + endpoint, "--carry", "contact")
            with Client(servers.url) as client:
                gateway_status(client, "press", "up")
                time.sleep(1.2)  # it holds back at its start
                probe = Probe(bus.publisher(high_water_mark=100000))
                probe.send(probe.batch(0))
                wait_for_stored(client, "palpate-press-contact", 1)
            servers.kill(with_signal=signal.SIGSTOP)
            for _ in range(99):
                probe.send(probe.batch(10 * probe.seq, step=0.001))
            time.sleep(0.3)
            self.assertEqual(stop(gateway)[0], 0)
            servers.kill()
            servers.start().wait()
            carrier(bus, servers.url, "up", "press", "bind:" + endpoint, "--carry", "contact")
            with Client(servers.url) as client:
                wait_for_stored(client, "palpate-press-contact", 100)
                Ledger(client, "press").sent_once(self, {probe.name: 100})

    def test_beyond_the_bound_the_oldest_are_lost_and_counted(self):
        bound = 1 << 18
        with Bus() as bus, Servers(bus.folder) as servers:
            servers.start().wait()
            node = bus.start_node()
            socket = bus.publisher(high_water_mark=100000)
            planner = bus.subscriber("recognition/", high_water_mark=0)
            gateway = carrier(bus, servers.url, "up", "press", bus.results, "--spool-bytes", bound, *EVERY_KIND)
            probe = Probe(socket)
            with Client(servers.url) as client:
                gateway_status(client, "press", "up")
                time.sleep(1.2)
                latencies = {"there": self.stroke(probe, planner, 3.0)}
                time.sleep(1)
                servers.kill()
                latencies["away"] = self.stroke(probe, planner, AWAY_S)
            spool = sum(path.stat().st_size for path in (bus.folder / "up.spool").glob("*.recording"))
            self.assertLessEqual(spool, bound + 4096)
            servers.start().wait()
            with Client(servers.url) as client:
                deadline = time.monotonic() + 30
                while True:
                    status = gateway_status(client, "press", "up")
                    if (status.up.spooled + status.up.waiting == 0 and status.up.stored) or time.monotonic() > deadline:
                        break
                contacts = Ledger(client, "press").contacts
                stored = [contacts[key].header.seq for key in sorted(contacts, key=lambda key: key[1])]
                up = status.up
            self.assertEqual(stored, sorted(set(stored)), "each once, in order")
            said = [int(n) for n in re.findall(r"messages lost, (\d+) in all", gateway.log_path.read_text())]
            self.assertGreater(up.lost, 0)
            self.assertEqual(said[-1], up.lost)
            # Of all kinds that are carried: nothing else is missing.
            self.assertEqual(up.received, up.stored + up.stored_before + up.lost + up.refused)
            self.assertEqual(up.missing, 0)
            self.assertLessEqual(probe.seq - len(stored), up.lost)
            # The newest are there.
            self.assertEqual(stored[-1], probe.seq - 1)
            print(f"away for {AWAY_S:.0f} s with {bound} bytes of disk: of {probe.seq} contacts {len(stored)} stored, of all "
                  f"{up.received} messages {up.lost} lost and counted")
            for when, times in latencies.items():
                print(f"  plant {when}: the cell's answer after {1e3 * statistics.median(times):.2f} ms at p50, "
                      f"{1e3 * statistics.quantiles(times, n=100)[98]:.1f} ms at p99")
            # Every contact was answered in the cell, at once; none was waited for (receive() fails after 2 s).
            self.assertIsNone(node.poll())

    def test_a_plant_whose_disk_is_full_has_all_when_it_has_room_again(self):
        """Contacts wait in the cell, answers with their recogniser: none is lost, none twice."""
        count = 600  # some 500 bytes each
        with Bus() as bus, Servers(bus.folder, partitions=1) as servers:
            roomy = servers.file(0).read_text()
            servers.file(0).write_text(roomy.replace("jetstream {", "jetstream { max_file_store: 150KB, "))
            servers.start().wait()
            endpoint = f"ipc://{bus.folder}/contacts"
            up = carrier(bus, servers.url, "up", "press", "bind:" + endpoint, "--carry", "contact")
            down = recogniser(bus, servers.url, "down", ["press:0"])
            with Client(servers.url) as client:
                gateway_status(client, "press", "down")
                probe = Probe(bus.publisher(high_water_mark=100000), group="hand")
                for _ in range(count):
                    probe.send(probe.batch(10 * (probe.seq % BATCHES_PER_OBJECT),
                                           object_number=1 + probe.seq // BATCHES_PER_OBJECT))
                    time.sleep(0.002)
                wait_for_log(up, "messages wait on disk")
                full = client.api("STREAM.INFO.palpate-press-contact")["state"]["messages"]
                self.assertLess(full, count)
            servers.kill()
            servers.file(0).write_text(roomy)
            servers.start().wait()
            with Client(servers.url) as client:
                wait_for_stored(client, "palpate-press-contact", count)
                deadline = time.monotonic() + 20
                while True:
                    ledger = Ledger(client, "press")
                    last = max(seq for _, seq in ledger.contacts)
                    if ledger.answers.get("hand", [(0, 0)])[-1][1] == last or time.monotonic() > deadline:
                        break
                ledger.sent_once(self, {probe.name: count})
                ledger.answered_once(self)
                self.assertEqual(gateway_status(client, "press", "up").up.lost, 0)
            print(f"a plant whose disk is full after {full} of {count} contacts: all stored and answered once when it has room")
            self.assertEqual(stop(down)[0], 0)

    def test_doubles_beyond_the_engines_window_are_rejected(self):
        """Two gateways carry a cell; one stands still for longer than the engine remembers, and then sends what it had."""
        count = 400
        with Bus() as bus, Servers(bus.folder, partitions=1) as servers:
            servers.start().wait()
            bus.start_node()
            carriers = [carrier(bus, servers.url, f"up{i}", "press", bus.results, "--carry", "contact",
                                "--duplicate-window-s", "0.5") for i in range(2)]
            recogniser(bus, servers.url, "down", ["press:0"], "--duplicate-window-s", "0.5")
            with Client(servers.url) as client:
                for name in ("up0", "up1", "down"):
                    gateway_status(client, "press", name)
                time.sleep(1.2)  # they hold back at their start
                probe = Probe(bus.publisher(high_water_mark=100000), group="hand")
                for number in range(count):
                    probe.send(probe.batch(10 * (number % BATCHES_PER_OBJECT), object_number=1 + number // BATCHES_PER_OBJECT))
                    if number == 100:
                        carriers[0].send_signal(signal.SIGSTOP)
                    time.sleep(0.005)
                time.sleep(1)
                carriers[0].send_signal(signal.SIGCONT)
                deadline = time.monotonic() + 20
                while True:
                    stored = client.api("STREAM.INFO.palpate-press-contact")["state"]["messages"]
                    place = gateway_status(client, "press", "down").places[0]
                    if place.contacts == stored == place.answered + place.rejected or time.monotonic() > deadline:
                        break
                doubles = stored - count
                answers = Ledger(client, "press").answers["hand"]
            print(f"{doubles} of {count} contacts stored twice, {place.rejected} rejected, {place.answered} answered")
            self.assertGreater(doubles, 0)  # how many the engine has forgotten is its own affair
            self.assertEqual((place.answered, place.rejected, place.restarts), (count, doubles, 0))
            last = {answer.object: answer.sample_count for _, _, _, answer, _ in answers}
            self.assertEqual(last, {1 + i: 10 * BATCHES_PER_OBJECT for i in range(count // BATCHES_PER_OBJECT)})

    def stroke(self, probe, planner, seconds):
        """One batch after the other; how long each waited for its answer."""
        times = []
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            step = probe.seq % BATCHES_PER_OBJECT
            sent = time.monotonic()
            seq = probe.seq
            probe.send(probe.batch(10 * step, object_number=1 + seq // BATCHES_PER_OBJECT))
            while True:
                answer = receive(planner, 2)
                self.assertIsNotNone(answer, "the cell waits for the plant")
                if answer.newest_batch_seq == seq:
                    break
            times.append(time.monotonic() - sent)
            time.sleep(0.01)
        return times


if __name__ == "__main__":
    skip_where_absent()
    unittest.main()
