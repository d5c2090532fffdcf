"""palpate record, check and replay: beside a running node, under floods, with keys, with damage."""
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

import zmq
from bus import Bus, Probe, memory_kb, stop, wait_for
from palpate.v1 import contact_pb2
from programs import SIM, SOURCE, TOOL, run

SCENE = SOURCE / "sim/scenes/ellipse.textproto"


class Place(unittest.TestCase):
    def test_the_path_of_a_running_node_is_not_taken(self):
        with Bus() as bus:
            bus.start_node()
            for command in (("check", "--seconds", "0.2"), ("record", bus.folder / "r", "--seconds", "0.2")):
                code, _, err = run(TOOL, *command, "--contacts", bus.contacts)
                self.assertEqual(code, 1, err)
                self.assertIn("another process has bound it", err)
            # It still hears.
            planner = bus.subscriber()
            Probe(bus.publisher()).stroke(batches=2)
            wait_for(planner, lambda a: a.sample_count == 20)

    def test_nothing_is_open_to_the_network_unless_it_is_said(self):
        with Bus() as bus:
            code, _, err = run(TOOL, "record", bus.folder / "r", "--contacts", "tcp://0.0.0.0:*", "--seconds", "1")
            self.assertEqual(code, 2, err)
            self.assertIn("open to the network", err)
            code, _, err = run(TOOL, "record", bus.folder / "r", "--contacts", "tcp://0.0.0.0:*", "--insecure",
                               "--seconds", "0.1")
            self.assertEqual(code, 0, err)

    def test_probes_with_keys_are_recorded_in_the_nodes_place(self):
        with Bus() as bus:
            for name in ("node", "friend", "stranger"):
                self.assertEqual(run(TOOL, "keygen", bus.folder / name)[0], 0)
            (bus.folder / "allowed").write_text((bus.folder / "friend.public").read_text())
            for player, expected in (("friend", 1), ("stranger", 0)):
                file = bus.folder / f"{player}.rec"
                record = bus.start(TOOL, "record", file, "--contacts", bus.contacts, "--curve-secret-key",
                                   bus.folder / "node.secret", "--allow-clients", bus.folder / "allowed",
                                   "--seconds", "1.5", stderr=subprocess.PIPE)
                run(SIM, SCENE, "--contacts", bus.contacts, "--fast", "--wait", "1", "--curve-secret-key",
                    bus.folder / f"{player}.secret", "--curve-server-key", bus.folder / "node.public")
                _, err = record.communicate(timeout=10)
                self.assertEqual(record.returncode, 0, err)
                self.assertEqual(file.stat().st_size > 8, expected == 1, player)


class Floods(unittest.TestCase):
    def flood(self, bus, listener):
        """Sends as fast as it can until the listener ends; gives the seconds that it ran."""
        socket = bus.publisher()
        start = time.monotonic()
        message = [b"contact/p/", b"x" * 200]
        while listener.poll() is None and time.monotonic() - start < 15:
            for _ in range(500):
                socket.send_multipart(message)
        return time.monotonic() - start

    def test_the_end_comes_in_time(self):
        for command in ("record", "check"):
            with Bus() as bus:
                file = [bus.folder / "r"] if command == "record" else []
                listener = bus.start(TOOL, command, *file, "--contacts", bus.contacts, "--seconds", "1",
                                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                self.assertLess(self.flood(bus, listener), 3.0, command)

    def test_a_stop_is_heard(self):
        with Bus() as bus:
            listener = bus.start(TOOL, "record", bus.folder / "r", "--contacts", bus.contacts,
                                 stderr=subprocess.DEVNULL)
            socket = bus.publisher()
            for _ in range(100_000):
                socket.send_multipart([b"contact/p/", b"x" * 200])
            code, seconds = stop(listener, signal.SIGTERM)
            self.assertEqual(code, 0)
            self.assertLess(seconds, 1.0)

    def test_a_huge_message_is_not_taken_in(self):
        with Bus() as bus:
            listener = bus.start(TOOL, "record", bus.folder / "r", "--contacts", bus.contacts,
                                 stderr=subprocess.DEVNULL)
            socket = bus.publisher()
            before = memory_kb(listener)
            socket.send_multipart([b"contact/p/", bytes(200 << 20)])
            time.sleep(1.0)
            self.assertLess(memory_kb(listener) - before, 32 * 1024)
            self.assertEqual(stop(listener)[0], 0)
            self.assertEqual((bus.folder / "r").stat().st_size, 8)


class Replays(unittest.TestCase):
    def replay(self, bus, file, *arguments):
        return run(TOOL, "replay", file, "--contacts", bus.contacts, "--wait", "5", *arguments)

    def test_what_is_no_message_is_recorded_and_left_out(self):
        with Bus() as bus:
            file = bus.folder / "mixed.rec"
            record = bus.start(TOOL, "record", file, "--contacts", bus.contacts, "--count", "7",
                               stderr=subprocess.PIPE)
            socket = bus.publisher()
            probe = Probe(socket)
            probe.send(probe.batch(0))
            socket.send_multipart([b"contact/\xff\xfe/", b"payload"])
            socket.send_multipart([b"contact/p/", b"\x12\x05ab"])
            socket.send_multipart([b"contact/one_frame/"])
            for first in (10, 20, 30):
                probe.send(probe.batch(first))
            self.assertEqual(record.wait(10), 0)
            record.stderr.close()
            bus.start_node()
            planner = bus.subscriber()
            code, _, err = self.replay(bus, file, "--fast")
            self.assertEqual(code, 0, err)
            self.assertIn("4 messages, 40 samples", err)
            self.assertIn("3 messages left out", err)
            wait_for(planner, lambda a: a.sample_count == 40)
            code, _, err = self.replay(bus, file, "--unit", "mm")
            self.assertEqual(code, 2, err)
            self.assertIn("--unit: for a file of points", err)
            # A damaged byte costs its message, and is said.
            damaged = bytearray(file.read_bytes())
            damaged[len(damaged) // 2] ^= 1
            file.write_bytes(damaged)
            code, _, err = self.replay(bus, file, "--fast")
            self.assertEqual(code, 1, err)
            self.assertIn("damaged in 1 places", err)

    def test_what_was_lost_before_the_recording_stays_lost(self):
        with Bus() as bus:
            file = bus.folder / "gaps.rec"
            record = bus.start(TOOL, "record", file, "--contacts", bus.contacts, "--count", "8",
                               stderr=subprocess.PIPE)
            probe = Probe(bus.publisher())
            messages = [probe.batch(10 * number) for number in range(10)]
            # 3, 6 and 8 never arrive, 5 does twice.
            for number in (0, 1, 2, 4, 5, 5, 7, 9):
                probe.send(messages[number])
            _, err = record.communicate(timeout=10)
            self.assertIn("8 messages; 3 messages missing", err.decode() if isinstance(err, bytes) else err)
            batches = self.replayed(file, "--fast")
            numbers = [batch.header.seq - batches[0].header.seq for batch in batches]
            self.assertEqual(numbers, [0, 1, 2, 4, 5, 7, 9])
            with Bus() as other:
                other.start_node()
                code, _, err = self.replay(other, file, "--fast")
                self.assertEqual(code, 0, err)
                self.assertIn("3 messages of the probes not in it", err)
                self.assertIn("1 message left out: not newer", err)

    def test_stamps_of_strangers(self):
        with Bus() as bus:
            bus.start_node()
            code, _, err = self.replay(bus, SOURCE / "tests/data/hostile/stamps_ub.rec")
            self.assertIn("messages", err)
            self.assertEqual(code, 0, err)

    def replayed(self, file, *arguments):
        """The batches that a recognizer gets."""
        with Bus() as bus:
            socket = bus.context.socket(zmq.SUB)
            socket.setsockopt(zmq.LINGER, 0)
            socket.setsockopt_string(zmq.SUBSCRIBE, "contact/")
            socket.bind(bus.contacts)
            replay = bus.start(TOOL, "replay", file, "--contacts", bus.contacts, *arguments, stderr=subprocess.PIPE)
            while replay.poll() is None:
                socket.get(zmq.EVENTS)  # libzmq's reader accepts and subscribes while it is asked for something
                time.sleep(0.01)
            self.assertEqual(replay.returncode, 0, replay.communicate()[1])
            batches = []
            while socket.poll(200):
                batches.append(contact_pb2.ContactBatch.FromString(socket.recv_multipart()[1]))
            return batches

    def test_samples_without_a_stamp_stay_without_one_and_in_their_place(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "stamped.csv"
            start = 1_700_000_000_000_000_000
            stamps = [*range(start, start + 6_000_000, 1_000_000)]
            stamps[1] = stamps[3] = ""  # 3: the last one of a message
            path.write_text("x_m,y_m,stamp_ns\n" + "".join(f"{i},0,{stamp}\n" for i, stamp in enumerate(stamps)))
            for pace in ("--speed", "1"), ("--fast",):
                batches = self.replayed(path, "--batch", "2", *pace)
                samples = [sample for batch in batches for sample in batch.samples]
                self.assertEqual([sample.x_m for sample in samples], [0, 1, 2, 3, 4, 5])
                self.assertEqual([i for i, sample in enumerate(samples) if sample.stamp_ns == 0], [1, 3])
                self.assertTrue(all(sample.stamp_ns >= start for sample in samples if sample.stamp_ns))
            # Times may count from 0, which is one of them.
            path.write_text("x_m,y_m,time_s\n" + "".join(f"{i},0,{0.001 * i}\n" for i in range(4)))
            stamps = [sample.stamp_ns for batch in self.replayed(path) for sample in batch.samples]
            self.assertEqual(len(stamps), 4)
            for before, after in zip(stamps, stamps[1:]):
                self.assertLessEqual(abs(after - before - 1_000_000), 1000)  # rounded as a double of nanoseconds

    def test_a_first_sample_without_a_time_gets_none_and_waits_for_its_run(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "timed.csv"
            path.write_text("x_m,y_m,time_s,group\n0,0,,late\n1,0,0.3,late\n2,0,0,early\n3,0,0.1,early\n")
            samples = [sample for batch in self.replayed(path, "--batch", "1") for sample in batch.samples]
            self.assertEqual([sample.x_m for sample in samples], [2, 3, 0, 1])
            self.assertEqual([sample.stamp_ns == 0 for sample in samples], [False, False, True, False])

    def test_a_speed_that_is_no_number(self):
        for value in ("nan", "inf", "0", "-1", "fast"):
            code, _, err = run(TOOL, "replay", "absent", "--speed", value)
            self.assertEqual(code, 2, err)
            self.assertIn("--speed", err)
        self.assertEqual(run(TOOL, "check", "--seconds", "nan")[0], 2)
        self.assertEqual(run(TOOL, "record", "never", "--seconds", "nan")[0], 2)


if __name__ == "__main__":
    unittest.main()
