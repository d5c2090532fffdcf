"""Accepted contacts on the results endpoint: the bytes as they came, and nothing that was refused."""
import time
import unittest

from bus import Bus, Probe, receive_any, wait_for
from palpate.v1 import contact_pb2


class Contacts(unittest.TestCase):
    def test_what_is_accepted_goes_on_as_it_came_and_nothing_else(self):
        with Bus() as bus:
            bus.start_node()
            status = bus.subscriber("status/")
            watcher = bus.subscriber("contact/finger/", "status/")
            # Contacts are not kept for those who come late: the node must have heard of the watcher first.
            self.assertIsNotNone(receive_any(watcher, 10))
            probe = Probe(bus.publisher())
            # Unknown fields, as a newer probe would send them, are part of the bytes.
            sent = [probe.batch(10 * i).SerializeToString() + b"\xf8\x07\x2a" for i in range(20)]
            topic = b"contact/finger/"
            for payload in sent:
                probe.socket.send_multipart([topic, payload])
            not_finite = probe.batch(0)
            not_finite.samples[0].x_m = float("nan")
            for refused in (sent[3], b"\xff\xff", b"", not_finite.SerializeToString()):
                probe.socket.send_multipart([topic, refused])
            other = Probe(probe.socket, name="other")
            other.send(other.batch(0))
            last = probe.batch(200)
            probe.send(last)
            sent.append(last.SerializeToString())
            received = []
            deadline = time.monotonic() + 10
            while not received or received[-1] != sent[-1]:
                message = receive_any(watcher, 5)
                self.assertIsNotNone(message, f"{len(received)} of {len(sent)}")
                self.assertLess(time.monotonic(), deadline, f"{len(received)} of {len(sent)}")
                if message[0].startswith(b"status/"):
                    continue
                self.assertEqual(message[0], topic)
                received.append(message[1])
            self.assertEqual(received, sent)
            counted = wait_for(status, lambda s: s.messages_received == 26)
            self.assertEqual(counted.messages_accepted, 22)
            self.assertEqual(contact_pb2.ContactBatch.FromString(received[0]).header.source, "finger")

    def test_a_planner_that_asks_for_recognitions_gets_no_contacts(self):
        with Bus() as bus:
            bus.start_node()
            planner = bus.subscriber("recognition/", "status/")
            everything = bus.subscriber("")
            self.assertIsNotNone(receive_any(everything, 10))
            probe = Probe(bus.publisher())
            probe.stroke()
            kinds = set()
            deadline = time.monotonic() + 10
            while b"contact" not in kinds or b"recognition" not in kinds:
                message = receive_any(everything, 5)
                self.assertIsNotNone(message)
                self.assertLess(time.monotonic(), deadline, kinds)
                kinds.add(message[0].split(b"/")[0])
            answer = wait_for(planner, lambda m: getattr(m, "sample_count", 0) == 200)
            self.assertEqual(answer.group, "finger")


if __name__ == "__main__":
    unittest.main()
