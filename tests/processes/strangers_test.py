"""Valid and hostile: names, numbers and stamps of strangers, logs that nobody reads, terminals."""
import fcntl
import os
import resource
import subprocess
import time
import unittest

import zmq
from bus import Bus, Probe, stop, wait_for
from palpate.v1 import node_status_pb2, recognition_pb2
from programs import NODE, TOOL, run


class Names(unittest.TestCase):
    def test_a_probe_that_names_five_hundred_groups_takes_no_others_place(self):
        with Bus() as bus:
            bus.start_node()
            planner = bus.subscriber("recognition/good", "status/")
            socket = bus.publisher()
            greedy = Probe(socket, "greedy")
            for number in range(500):
                message = greedy.batch(0)
                message.group = f"g{number}"
                greedy.send(message)
            for number in range(20):
                Probe(socket, f"good{number}").stroke(batches=2)
            seen = set()
            while len(seen) < 20:
                seen.add(wait_for(planner, lambda m: hasattr(m, "curve_class") and m.group not in seen).group)
            status = wait_for(planner, lambda m: hasattr(m, "groups") and m.messages_received >= 540)
            self.assertLessEqual(status.groups, 8 + 20)
            self.assertEqual(status.messages_accepted + sum(r.count for r in status.rejected),
                             status.messages_received)

    def test_a_wild_number_and_a_restart_without_epoch_shut_nobody_out(self):
        with Bus() as bus:
            bus.start_node()
            planner = bus.subscriber()
            socket = bus.publisher()
            probe = Probe(socket)
            probe.stroke(batches=2)
            probe.seq, kept = 2 ** 64 - 1, probe.seq
            probe.send(probe.batch(20))
            probe.seq = kept
            probe.send(probe.batch(20))
            self.assertEqual(wait_for(planner, lambda a: a.sample_count >= 30).sample_count, 30)
            for _ in range(2):
                Probe(socket, "nameless", epoch=0).stroke(batches=2)
            answer = wait_for(planner, lambda a: a.group == "nameless" and a.sample_count >= 40)
            self.assertEqual(answer.sample_count, 40)

    def test_a_message_that_is_too_long_shows_as_missing_only(self):
        # As the contract says of TOO_LARGE: the socket ends the connection before the node has the message.
        with Bus() as bus:
            bus.start_node("--status-period-s", "0.1")
            planner = bus.subscriber("status/")
            socket = bus.publisher()
            probe = Probe(socket)
            probe.send(probe.batch(0))
            wait_for(planner, lambda s: s.messages_received == 1)
            probe.send(probe.batch(10, count=5000))
            self.assertTrue(socket.poll(5000))  # the node's subscription by a new connection
            probe.send(probe.batch(20))
            status = wait_for(planner, lambda s: s.messages_received == 2)
            self.assertEqual((status.messages_accepted, list(status.rejected), status.gaps, status.missing), (2, [], 1, 1))

    def test_a_wild_stamp_does_not_stay(self):
        with Bus() as bus:
            bus.start_node()
            planner = bus.subscriber()
            probe = Probe(bus.publisher())
            message = probe.batch(0)
            message.samples[3].stamp_ns = 2 ** 63 - 1
            probe.send(message)
            probe.send(probe.batch(10))
            answer = wait_for(planner, lambda a: a.sample_count == 20)
            self.assertLess(abs(answer.newest_sample_stamp_ns - time.time_ns()), 10 ** 10)


class Logs(unittest.TestCase):
    def test_malformed_messages_are_counted_not_printed_one_by_one(self):
        with Bus() as bus:
            node = bus.start_node()
            planner = bus.subscriber("status/")
            socket = bus.publisher(high_water_mark=0)
            for _ in range(20_000):
                socket.send_multipart([b"contact/bad/", b"\x0a\xffinvalid"])
                # A group's name that is no UTF-8: parsed, and complained of by libprotobuf itself.
                socket.send_multipart([b"contact/bad/", b"\x12\x02\xff\xff"])
            wait_for(planner, lambda s: s.messages_received >= 40_000, 30)
            stop(node)
            self.assertLess(len(node.log_path.read_text().splitlines()), 100)

    def test_standard_error_that_nobody_reads_stops_nothing(self):
        with Bus() as bus:
            reader, writer = os.pipe()
            fcntl.fcntl(writer, fcntl.F_SETFL, os.O_NONBLOCK)
            try:
                while True:
                    os.write(writer, b"x" * 4096)
            except BlockingIOError:
                fcntl.fcntl(writer, fcntl.F_SETFL, 0)
            node = bus.start(NODE, "--contacts", bus.contacts, "--results", bus.results, stderr=writer)
            os.close(writer)
            planner = bus.subscriber()
            Probe(bus.publisher()).stroke(batches=2)
            wait_for(planner, lambda a: a.sample_count == 20)
            code, seconds = stop(node)
            os.close(reader)
            self.assertEqual(code, 0)
            self.assertLess(seconds, 0.5)


class Terminals(unittest.TestCase):
    ESCAPE = b"\x1b]0;owned\x07\x1b[2J"

    def say(self, bus, command, messages, *arguments):
        """What a tool shows of a hostile recognizer's messages."""
        socket = bus.context.socket(zmq.XPUB)
        socket.bind(bus.results)
        tool = bus.start(TOOL, command, "--results", bus.results, *arguments,
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertTrue(socket.poll(5000))
        # All its subscriptions.
        while socket.poll(200):
            socket.recv()
        for topic, payload in messages:
            socket.send_multipart([topic, payload])
        out, err = tool.communicate(timeout=10)
        socket.close()
        self.assertNotIn("\x1b", out + err)
        self.assertNotIn("\x07", out + err)
        return out

    def test_no_escape_sequence_reaches_them(self):
        with Bus() as bus:
            topic = b"recognition/" + self.ESCAPE + b"/"
            self.assertIn("\\x1b", self.say(bus, "list", [(topic, b"")], "--seconds", "1"))
        with Bus() as bus:
            self.assertIn("\\x1b", self.say(bus, "hz", [(topic, b"")], "--seconds", "1"))
        with Bus() as bus:
            answer = recognition_pb2.Recognition(group=self.ESCAPE.decode(), status=3, curve_class=3)
            answer.header.epoch = 1
            status = node_status_pb2.NodeStatus()
            status.header.epoch = 1
            status.probes.add().probe = self.ESCAPE.decode()
            out = self.say(bus, "watch", [(b"status/n/", status.SerializeToString()),
                                          (b"recognition/g/", answer.SerializeToString())], "--count", "1")
            self.assertEqual(out.count("\\x1b"), 4)

    def test_a_covariance_that_is_no_matrix_is_not_read(self):
        with Bus() as bus:
            answer = recognition_pb2.Recognition(group="g", curve_class=2, covariance=[1.0] * 3)
            answer.header.epoch = 1
            answer.parameters.a = 0.02
            answer.pose.x_m = 0.3
            out = self.say(bus, "watch", [(b"recognition/g/", answer.SerializeToString())], "--count", "1")
            self.assertIn("+- inf", out)
            self.assertNotIn("+- 1", out)

    def test_a_full_disk_is_an_error(self):
        with Bus() as bus:
            bus.start_node("--status-period-s", "0.1")
            for command in (("list", "--seconds", "0.5"), ("hz", "--seconds", "0.5"),
                            ("watch", "--timeout", "2", "--format", "json")):
                with open("/dev/full", "w") as full:
                    tool = bus.start(TOOL, command[0], "--results", bus.results, *command[1:], stdout=full,
                                     stderr=subprocess.PIPE)
                    _, err = tool.communicate(timeout=20)
                self.assertEqual(tool.returncode, 1, command)
                self.assertIn("standard output: cannot be written: No space left on device", err)
            # A bound of a file's size is a small full disk.
            recorder = bus.start(TOOL, "record", bus.folder / "r.recording", "--results", bus.results, "--seconds", "5",
                                 stderr=subprocess.PIPE, restore_signals=False,
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100)))
            _, err = recorder.communicate(timeout=20)
            self.assertEqual(recorder.returncode, 1)
            self.assertIn("r.recording: cannot be written: File too large", err)


if __name__ == "__main__":
    unittest.main()
