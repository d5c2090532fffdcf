"""All attacks at once, in random order, with kills between them: what is promised holds throughout."""
import os
import random
import re
import signal
import socket
import subprocess
import time
import unittest

import zmq
from bus import Bus, Probe, memory_kb, stop, wait_for
from palpate.v1 import contact_pb2
from programs import TOOL

SECONDS = float(os.environ.get("PALPATE_CHAOS_SECONDS", "20"))
# Kept by a node that has been attacked, above what it began with: its bounds on subscriptions (32 MiB) and on
# messages that wait (64 MiB), and as much again for what the allocator holds.
KEPT_KB = 2 * (32 + 64) * 1024


class Chaos(unittest.TestCase):
    def setUp(self):
        self.rng = random.Random(1)
        self.bus = Bus()
        self.addCleanup(self.bus.__exit__)
        self.sockets = []

    def connect(self, kind, address):
        made = self.bus.context.socket(kind)
        made.setsockopt(zmq.SNDHWM, 200)
        made.setsockopt(zmq.LINGER, 0)
        made.connect(address)
        self.sockets.append(made)
        return made

    def send(self, frames, to):
        try:
            to.send_multipart(frames, zmq.DONTWAIT)
        except zmq.Again:
            pass

    def garbage(self):
        to = self.connect(zmq.PUB, self.bus.contacts)
        time.sleep(0.05)
        for _ in range(2000):
            self.send([b"contact/bad/", self.rng.randbytes(self.rng.randrange(300))], to)

    def names(self):
        to = self.connect(zmq.PUB, self.bus.contacts)
        time.sleep(0.05)
        probe = Probe(to, f"bad{self.rng.randrange(100)}", epoch=self.rng.randrange(3))
        for _ in range(300):
            message = probe.batch(0)
            message.group = f"g{self.rng.randrange(500)}"
            message.header.seq = self.rng.choice((probe.seq, 2 ** 64 - 1, 0))
            message.samples[0].stamp_ns = self.rng.choice((0, -2 ** 63, 2 ** 63 - 1))
            self.send([f"contact/{probe.name}/".encode(), message.SerializeToString()], to)

    def large(self):
        to = self.connect(zmq.PUB, self.bus.contacts)
        time.sleep(0.05)
        batch = contact_pb2.ContactBatch(object=self.rng.randrange(3))
        batch.header.source, batch.header.epoch = "large", 1 + self.rng.randrange(2 ** 63)
        for number in range(1000):
            sample = batch.samples.add()
            sample.x_m, sample.y_m = 1e-4 * number, self.rng.random()
        for seq in range(50):
            batch.header.seq, batch.patch = seq, seq
            self.send([b"contact/large/", batch.SerializeToString()], to)
        self.send([b"contact/large/", bytes(1 << 20)], to)

    def subscriptions(self):
        to = self.connect(zmq.XSUB, self.bus.results)
        for _ in range(1000):
            self.send([b"\1" + self.rng.randbytes(self.rng.randrange(900))], to)
            self.send([b"\1"], to)

    def idle_peers(self):
        for address in (self.bus.contacts, self.bus.results):
            for _ in range(100):
                peer = socket.socket(socket.AF_UNIX)
                peer.connect(address.removeprefix("ipc://"))
                self.sockets.append(peer)

    def place(self):
        record = self.bus.start(TOOL, "record", self.bus.folder / f"r{self.rng.random()}", "--contacts",
                                self.bus.contacts, "--seconds", "0.1", stderr=subprocess.DEVNULL)
        self.assertEqual(record.wait(20), 1)

    def leave(self):
        self.rng.shuffle(self.sockets)
        for _ in range(len(self.sockets) // 2):
            self.sockets.pop().close()

    def test_what_is_promised_holds(self):
        bus = self.bus
        node = bus.start_node("--max-peers", "64")
        planner = bus.subscriber("recognition/good/", "status/")
        good = Probe(bus.publisher(), "good", epoch=7)
        number = 0

        def answer(timeout_s=20):
            """A touch of the good probe; sent again, as a new one, where it was lost to a kill."""
            nonlocal number
            deadline = time.monotonic() + timeout_s
            start = time.monotonic()
            while time.monotonic() < deadline:
                number += 1
                good.send(good.batch(0, 20, object_number=number))
                try:
                    wait_for(planner, lambda m: hasattr(m, "curve_class") and m.object == number, 1.0)
                    return time.monotonic() - start
                except AssertionError:
                    continue
            raise AssertionError("the good probe is not served")

        answer()
        before = memory_kb(node)
        attacks = [self.garbage, self.names, self.large, self.subscriptions, self.idle_peers, self.place, self.leave]
        kills, rounds, latencies, peak = 0, 0, [], before
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            self.rng.choice(attacks)()
            latencies.append(answer())
            peak = max(peak, memory_kb(node))
            self.assertIsNone(node.poll(), node.log_path.read_text())
            rounds += 1
            if self.rng.random() < 0.05:
                node.kill()
                node.wait()
                kills += 1
                node = bus.start_node("--max-peers", "64")
                answer()
        while self.sockets:
            self.sockets.pop().close()
        # With all of them gone, it stands as it stood.
        time.sleep(1.0)
        status = wait_for(planner, lambda m: hasattr(m, "messages_received"))
        status = wait_for(planner, lambda m: hasattr(m, "messages_received") and
                          m.header.seq > status.header.seq)
        self.assertEqual(status.messages_accepted + sum(r.count for r in status.rejected), status.messages_received)
        kept = memory_kb(node) - before
        latencies.sort()
        print(f"{rounds} attacks, {kills} kills: the good probe's answer in {1e3 * latencies[len(latencies) // 2]:.1f} ms "
              f"(median), {1e3 * latencies[-1]:.0f} ms at most; memory {before} -> {peak} kB, {kept} kB kept; "
              f"{status.connections_cut} connections cut")
        self.assertLess(kept, KEPT_KB)
        code, seconds = stop(node, signal.SIGTERM)
        self.assertEqual(code, 0)
        self.assertLess(seconds, 0.5)
        self.assertLess(len(re.findall("\n", node.log_path.read_text())), 100 * SECONDS)


if __name__ == "__main__":
    unittest.main()
