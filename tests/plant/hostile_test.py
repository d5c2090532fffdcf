"""Strangers on the plant's side and in the cell: any subject, any payload; they change counters and nothing else."""
import random
import time
import unittest

from bus import Bus, Probe, memory_kb, stop
from palpate.v1 import contact_pb2, gateway_status_pb2
from plant import (EVERY_KIND, Client, Ledger, Servers, carrier, gateway_status, recogniser, skip_where_absent,
                   wait_for_stored)

HOSTILE = 3000
MOST_GROWTH_KB = 64 * 1024


class Hostile(unittest.TestCase):
    def test_on_the_plants_side(self):
        rng = random.Random(1)
        with Bus() as bus, Servers(bus.folder, partitions=1) as servers:
            servers.start().wait()
            down = recogniser(bus, servers.url, "down", ["press:0"])
            with Client(servers.url) as client:
                gateway_status(client, "press", "down")
                deadline = time.monotonic() + 10
                while not (begun := gateway_status(client, "press", "down")).places:
                    self.assertLess(time.monotonic(), deadline)
                # A server that has just started may be slow to make the consumer.
                restarts_before = begun.places[0].restarts
                before_kb = memory_kb(down)
                honest = Probe(None, "finger", "hand")
                sent = 0
                for number in range(HOSTILE):
                    subject, payload = self.hostile(rng)
                    client.publish(subject, payload, headers=self.hostile_headers(rng) if number % 3 == 0 else None)
                    if number % 10 == 0:
                        batch = honest.batch(10 * (sent % 20), object_number=1 + sent // 20)
                        answer = client.request("palpate.press.contact.hand.finger", batch.SerializeToString(),
                                                {"Nats-Msg-Id": f"finger/1/{sent}"})
                        self.assertNotIn(b"error", answer.payload)
                        sent += 1
                    if number % 7 == 0:
                        client.publish("palpate.press.place.0", rng.randbytes(rng.randrange(30)))
                        client.publish("palpate.press.recognition." + self.token(rng), rng.randbytes(50),
                                       headers=self.hostile_headers(rng))
                last = sent - 1
                deadline = time.monotonic() + 40
                while True:
                    spans = []
                    for _, message in client.stream("palpate-press-recognition", "palpate.press.recognition.hand"):
                        spans.append((int(message.headers["Palpate-From"]), int(message.headers["Palpate-Through"])))
                    honest_seqs = [seq for seq, message in client.stream("palpate-press-contact",
                                                                         "palpate.press.contact.*.hand.finger")
                                   if self.is_honest(message.payload)]
                    if spans and spans[-1][1] >= honest_seqs[-1] or time.monotonic() > deadline:
                        break
                self.assertEqual(len(honest_seqs), last + 1)
                for seq in honest_seqs:
                    self.assertEqual(sum(first <= seq <= through for first, through in spans), 1, seq)
                status = gateway_status(client, "press", "down")
                growth_kb = memory_kb(down) - before_kb
                place = status.places[0]
                print(f"{place.hostile} hostile messages on the place's subjects, {place.rejected} rejected by the node, "
                      f"{place.answered} contacts answered, {place.restarts - restarts_before} new beginnings, {growth_kb / 1024:+.1f} MB")
                self.assertGreater(place.hostile, HOSTILE / 10)
                self.assertEqual(place.restarts, restarts_before, down.log_path.read_text())
                self.assertIsNone(down.poll())
                self.assertLess(growth_kb, MOST_GROWTH_KB)
                self.assertEqual(stop(down)[0], 0)

    def test_a_stream_that_is_made_again(self):
        """Its contacts have the numbers of others, which were refused."""
        refused = 3
        with Bus() as bus, Servers(bus.folder, partitions=1) as servers:
            servers.start().wait()
            recogniser(bus, servers.url, "down", ["press:0"])
            with Client(servers.url) as client:
                def place():
                    places = gateway_status(client, "press", "down").places
                    return places[0] if places else gateway_status_pb2.GatewayPlaceStatus()

                def publish(payload, seq):
                    answer = client.request("palpate.press.contact.hand.finger", payload, {"Nats-Msg-Id": f"finger/1/{seq}"})
                    self.assertIn(b'"seq"', answer.payload)

                def wait_until(is_so):
                    deadline = time.monotonic() + 20
                    while not is_so(place()):
                        self.assertLess(time.monotonic(), deadline, place())

                wait_until(lambda said: said.cell)
                while "error" in client.api("STREAM.INFO.palpate-press-contact"):
                    time.sleep(0.05)
                for seq in range(refused):
                    publish(b"nonsense", seq)
                wait_until(lambda said: said.hostile == refused)
                config = client.api("STREAM.INFO.palpate-press-contact")["config"]
                client.api("STREAM.DELETE.palpate-press-contact")
                self.assertNotIn("error", client.api("STREAM.CREATE.palpate-press-contact", config))
                honest = Probe(None, "finger", "hand")
                for seq in range(refused):
                    publish(honest.batch(10 * seq).SerializeToString(), seq)
                wait_until(lambda said: said.answered == refused)
                self.assertEqual(place().contacts, refused)

    def token(self, rng):
        return rng.choice(["a", "=2E", "=2e", "=", "=41", "%", "a=2", "\\", "'", "x" * 200, "=00", "\u00e4"])

    def hostile(self, rng):
        """A subject that the place hears of, or nearly, and any payload; or an honest one that does not fit it."""
        kind = rng.randrange(6)
        subject = f"palpate.press.contact.{self.token(rng)}.{self.token(rng)}"
        payload = rng.randbytes(rng.randrange(200))
        batch = Probe(None, "finger", "hand").batch(0)
        if kind == 1:
            subject = "palpate.press.contact.hand.finger"
        elif kind == 2:  # another's name
            subject, payload = "palpate.press.contact.hand.thumb", batch.SerializeToString()
        elif kind == 3:  # another group
            subject, payload = "palpate.press.contact.foot.finger", batch.SerializeToString()
        elif kind == 4:  # too long for the node
            batch.samples.extend([batch.samples[0]] * rng.randrange(1500, 3000))
            subject, payload = "palpate.press.contact.hand.finger", batch.SerializeToString()
        elif kind == 5:  # a batch that the node has no use for, of a probe of its own
            batch.header.source, batch.group = "wild", "wild"
            batch.header.seq = rng.randrange(1 << 62)
            batch.samples[0].x_m = rng.choice([float("nan"), float("inf"), 1e300])
            subject, payload = "palpate.press.contact.wild.wild", batch.SerializeToString()
        return subject.encode(), payload

    def hostile_headers(self, rng):
        return {rng.choice(["Palpate-Through", "Palpate-Begin", "Palpate-From", "Status", "Nats-Sequence"]):
                rng.choice(["-1", "18446744073709551615", "x", "", "99999999999999999999999"])}

    def is_honest(self, payload):
        batch = contact_pb2.ContactBatch()
        try:
            batch.ParseFromString(payload)
        except Exception:
            return False
        return len(payload) < 65536 and batch.header.source == "finger" and len(batch.samples) == 10

    def test_in_the_cell(self):
        """At an endpoint that the gateway binds, where no node has judged what comes."""
        rng = random.Random(2)
        with Bus() as bus, Servers(bus.folder) as servers:
            servers.start().wait()
            endpoint = f"ipc://{bus.folder}/contacts"
            up = carrier(bus, servers.url, "up", "press", "bind:" + endpoint, *EVERY_KIND)
            with Client(servers.url) as client:
                gateway_status(client, "press", "up")
                socket = bus.publisher(high_water_mark=100000)
                probe = Probe(socket, "finger.of *>", "hand")  # no name of the contract
                hostile = 0
                for _ in range(HOSTILE):
                    frames = [rng.choice([b"contact/finger/", b"contact//", b"contact/a b/", b"recognition/x/", b"status/n/",
                                          b"contact/>/", b"contact/*/", b"contact/" + b"x" * 100 + b"/"]),
                              rng.randbytes(rng.randrange(100)), b"more"][:rng.choice([1, 2, 2, 2, 3])]
                    socket.send_multipart(frames)
                    hostile += 1
                for name in (b"contact/finger.of *>/", b"contact/thumb/"):
                    socket.send_multipart([name, probe.batch(0).SerializeToString()])
                    hostile += 1
                honest = Probe(socket, "a.b", "c.d-e_F")
                honest.stroke(100)
                wait_for_stored(client, "palpate-press-contact", 100)
                time.sleep(0.5)
                ledger = Ledger(client, "press")
                ledger.sent_once(self, {"a.b": 100})
                subjects = {message.subject for _, message in client.stream("palpate-press-contact")}
                self.assertEqual(subjects, {"palpate.press.contact.c=2Ed-e_F.a=2Eb"})
                status = gateway_status(client, "press", "up").up
                # Bytes may be a message by chance, of no samples, but hardly with a header.
                self.assertEqual(status.malformed, hostile)
                self.assertEqual(status.stored, 100)
                self.assertEqual(stop(up)[0], 0)


if __name__ == "__main__":
    skip_where_absent()
    unittest.main()
