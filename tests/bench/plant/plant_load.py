#!/usr/bin/python3
"""A simulated plant on this machine: its capacity, and its cost and latency compared with a bare node.

    PALPATE_SOURCE=$PWD PALPATE_BUILD=$PWD/build/strict PYTHONPATH=$PWD/tests/support:$PWD/build/strict/proto/python \\
      /usr/bin/python3 tests/bench/plant/plant_load.py [--probes N] [--seconds S] [--replicas 1|3]

Each probe is a group of its own and sends 100 samples a second in batches of ten: circle after circle, of twelve batches
each. The run is done once with a bare palpate-node, and once through the plant: a gateway to the servers, a second gateway
with a node of its own, and the answers back to the servers. Prints whether every contact was stored and answered, the
processor time of each process per thousand samples, and for all contacts the time from sending it to receiving the first
answer that covers it.
"""
import argparse
import os
import pathlib
import statistics
import threading
import time

from bus import Bus, Probe
from palpate.v1 import contact_pb2, recognition_pb2
from plant import Client, Servers, carrier, recogniser, wait_for_stored

BATCHES_PER_OBJECT = 12
SAMPLES = 10
BATCHES_PER_S = 10


def processor_s(*processes):
    """Processor time of these processes and their children."""
    total = 0.0
    for process in processes:
        pids = [process if isinstance(process, int) else process.pid]
        while pids:
            pid = pids.pop()
            fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
            total += (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
            pids += [int(child) for child in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    return total


def children_of(process):
    return [int(child) for child in pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()]


class Feed(threading.Thread):
    def __init__(self, socket, probes, seconds):
        super().__init__()
        self.socket, self.probes, self.seconds = socket, probes, seconds
        self.sent_at = {}
        drawing = Probe(None)
        # A message's fields may come in any order and in parts: samples are written once.
        self.samples = [contact_pb2.ContactBatch(samples=drawing.batch(SAMPLES * n, SAMPLES).samples).SerializeToString()
                        for n in range(BATCHES_PER_OBJECT)]
        self.worst_late_s = 0.0

    def run(self):
        start = time.monotonic()
        head = contact_pb2.ContactBatch()
        head.header.epoch = 1
        for turn in range(int(self.seconds * BATCHES_PER_S)):
            head.object, head.header.seq = 1 + turn // BATCHES_PER_OBJECT, turn
            body = self.samples[turn % BATCHES_PER_OBJECT]
            for number in range(self.probes):
                due = start + (turn + number / self.probes) / BATCHES_PER_S
                now = time.monotonic()
                if now < due:
                    time.sleep(due - now)
                else:
                    self.worst_late_s = max(self.worst_late_s, now - due)
                head.header.source = f"p{number}"
                self.sent_at[head.header.source, turn] = time.monotonic()
                self.socket.send_multipart([f"contact/p{number}/".encode(), head.SerializeToString() + body])


class Ear(threading.Thread):
    """The first answer that covers each contact."""

    def __init__(self, read, feed, contacts):
        super().__init__()
        self.read, self.feed, self.contacts = read, feed, contacts
        self.heard = {}
        self.latencies = []
        self.answers = 0
        self.over = threading.Event()

    def run(self):
        while not self.over.is_set() and len(self.latencies) < self.contacts:
            payload = self.read()
            if payload is None:
                continue
            now = time.monotonic()
            answer = recognition_pb2.Recognition.FromString(payload)
            source, seq = answer.newest_batch_source, answer.newest_batch_seq
            last = self.heard.get(source, -1)
            if seq <= last:
                continue
            self.answers += 1
            self.heard[source] = seq
            self.latencies += [now - self.feed.sent_at[source, held] for held in range(last + 1, seq + 1)]


def report(name, feed, ear, costs, samples):
    answered = len(ear.latencies)
    late = statistics.quantiles(ear.latencies, n=100) if answered > 1 else [float("nan")] * 99
    print(f"{name}: {samples} samples in {samples // SAMPLES} contacts, {answered} answered by {ear.answers} answers; contact to "
          f"answer {1e3 * late[49]:.1f} ms at p50, {1e3 * late[98]:.1f} ms at p99; sender late by {feed.worst_late_s:.2f} s at worst")
    for who, seconds in costs.items():
        print(f"  {who}: {1e6 * seconds / samples:.1f} ms of processor a 1,000 samples")


def settle(feed, ear, timeout_s=60):
    feed.start()
    ear.start()
    feed.join()
    deadline = time.monotonic() + timeout_s
    while ear.is_alive() and time.monotonic() < deadline:
        time.sleep(0.1)
    ear.over.set()
    ear.join()


def node_options(probes):
    return ["--max-probes", max(256, probes), "--max-groups", max(256, probes)]


def bare(probes, seconds):
    with Bus() as bus:
        node = bus.start_node(*node_options(probes), "--results-high-water-mark", 100000)
        planner = bus.subscriber("recognition/", high_water_mark=0)
        feed = Feed(bus.publisher(high_water_mark=0), probes, seconds)
        contacts = probes * int(seconds * BATCHES_PER_S)
        ear = Ear(lambda: planner.recv_multipart()[1] if planner.poll(100) else None, feed, contacts)
        before = processor_s(node)
        settle(feed, ear)
        report("bare node", feed, ear, {"node": processor_s(node) - before}, SAMPLES * contacts)


def plant(probes, seconds, replicas):
    with Bus() as bus, Servers(bus.folder, 3 if replicas > 1 else 1) as servers:
        servers.start().wait(60)
        config = bus.folder / "node.textproto"
        config.write_text(f"max_probes: {max(256, probes)}\nmax_groups: {max(256, probes)}\n")
        endpoint = f"ipc://{bus.folder}/contacts"
        up = carrier(bus, servers.url, "up", "press", "bind:" + endpoint, "--replicas", replicas)
        down = recogniser(bus, servers.url, "down", ["press"], "--node-config", config, "--replicas", replicas)
        bus.contacts = endpoint
        socket = bus.publisher(high_water_mark=0)
        while "from contact" not in down.log_path.read_text():
            time.sleep(0.1)
        time.sleep(2)
        with Client(servers.url) as client:
            client.subscribe("palpate.press.recognition.*")
            feed = Feed(socket, probes, seconds)
            contacts = probes * int(seconds * BATCHES_PER_S)

            def read():
                message = client.receive(0.1)
                return message.payload if message is not None else None

            ear = Ear(read, feed, contacts)
            who = {"servers": [p for p in servers.processes if p], "gateway up": [up]}
            node = children_of(down)
            before = {name: processor_s(*processes) for name, processes in who.items()}
            before_down, before_node = processor_s(down), processor_s(*node)
            settle(feed, ear, 120)
            costs = {name: processor_s(*processes) - before[name] for name, processes in who.items()}
            costs["its node"] = processor_s(*node) - before_node
            costs["gateway down"] = processor_s(down) - before_down - costs["its node"]
            report(f"by the plant, {replicas} replica(s)", feed, ear, costs, SAMPLES * contacts)
        with Client(servers.url) as client:
            state = wait_for_stored(client, "palpate-press-contact", contacts)
            print(f"  stored: {state['messages']} of {contacts} contacts, {state['bytes'] / contacts:.0f} bytes each")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--probes", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--replicas", type=int, choices=(1, 3), default=1)
    options = parser.parse_args()
    bare(options.probes, options.seconds)
    plant(options.probes, options.seconds, options.replicas)


if __name__ == "__main__":
    main()
