#!/usr/bin/python3
"""Answers per second of a node with one worker and with two, under constant load from 64 groups.

    PALPATE_SOURCE=$PWD PALPATE_BUILD=$PWD/build/strict PYTHONPATH=$PWD/tests/support:$PWD/build/strict/proto/python \\
      /usr/bin/python3 tests/bench/processes/two_workers.py [--rounds N] [--seconds S]

Each group sends its next batch of 10 samples as soon as the last one has been answered, so every answer takes the same
work. Rounds with one worker and with two alternate. Besides answers per second it prints the processor time of each thread
per answer, which a busy machine hardly changes. On two cores, the node's own thread, libzmq and this program use a share;
so it also prints the answers per second that cores with nothing else to do would give by these times.
"""
import argparse
import os
import pathlib
import statistics
import time

import zmq
from bus import Bus, Probe
from palpate.v1 import contact_pb2

GROUPS = 64
BATCHES_PER_OBJECT = 12
SAMPLES = 10
WARM_UP_S = 1.0


def thread_times_s(process):
    """Processor time so far, by kind of thread."""
    times = {"workers": 0.0, "node": 0.0, "libzmq": 0.0}
    for task in pathlib.Path(f"/proc/{process.pid}/task").iterdir():
        name = (task / "comm").read_text()
        what = ("workers" if name.startswith(("recognize", "slow")) else "libzmq" if name.startswith("ZMQ") else "node")
        times[what] += 1e-9 * int((task / "schedstat").read_text().split()[0])
    return times


class Asking:
    """All groups; each sends its next batch as soon as it has been answered."""

    def __init__(self, bus):
        self._out = bus.publisher(high_water_mark=0)
        self._answers = bus.subscriber("recognition/", high_water_mark=0)
        time.sleep(0.2)  # the subscription
        drawing = Probe(None)
        # A message's fields may come in any order and in parts: samples are written once.
        self._samples = []
        for number in range(BATCHES_PER_OBJECT):
            batch = contact_pb2.ContactBatch(samples=drawing.batch(SAMPLES * number, SAMPLES).samples)
            self._samples.append(batch.SerializeToString())
        self._sent = {f"group-{i}": 0 for i in range(GROUPS)}
        for group in self._sent:
            self._send(group)

    def _send(self, group):
        count = self._sent[group]
        self._sent[group] += 1
        head = contact_pb2.ContactBatch(object=1 + count // BATCHES_PER_OBJECT)
        head.header.source, head.header.epoch, head.header.seq = group, 1, count
        self._out.send_multipart([f"contact/{group}/".encode(),
                                  head.SerializeToString() + self._samples[count % BATCHES_PER_OBJECT]])

    def serve(self, seconds):
        """Number of answers within that time."""
        answers, end = 0, time.monotonic() + seconds
        while time.monotonic() < end:
            if not self._answers.poll(1000):
                raise SystemExit("a group has had no answer for a second")
            while True:
                try:
                    topic, _ = self._answers.recv_multipart(zmq.NOBLOCK)
                except zmq.Again:
                    break
                answers += 1
                self._send(topic.decode().split("/")[1])
        return answers


def play_round(workers, seconds):
    with Bus() as bus:
        node = bus.start_node("--workers", workers, "--max-groups", GROUPS)
        asking = Asking(bus)
        asking.serve(WARM_UP_S)
        before, own_before, start = thread_times_s(node), time.process_time(), time.monotonic()
        answers = asking.serve(seconds)
        taken_s = time.monotonic() - start
        cost_us = {what: 1e6 * (time_s - before[what]) / answers for what, time_s in thread_times_s(node).items()}
        cost_us["asking"] = 1e6 * (time.process_time() - own_before) / answers
        return answers / taken_s, cost_us


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=6, help="with each number of workers")
    parser.add_argument("--seconds", type=float, default=3.0, help="a round")
    options = parser.parse_args()
    print("workers,answers_per_s,workers_us,node_us,libzmq_us,asking_us")
    rates, costs = {1: [], 2: []}, {1: [], 2: []}
    for number in range(options.rounds):
        for workers in (1, 2) if number % 2 == 0 else (2, 1):
            rate, cost_us = play_round(workers, options.seconds)
            rates[workers].append(rate)
            costs[workers].append(cost_us)
            print(f"{workers},{rate:.0f}," + ",".join(f"{value:.1f}" for value in cost_us.values()), flush=True)
    gain = statistics.median(two / one for one, two in zip(rates[1], rates[2]))
    print(f"two workers give {gain:.2f} times the answers of one (median of {options.rounds} pairs of rounds)")
    cost = {what: statistics.median(cost_us[what] for cost_us in costs[2]) for what in costs[2][0]}
    cores = len(os.sched_getaffinity(0))
    others = sum(cost.values()) - cost["workers"]
    most = 1e6 * min(2 / cost["workers"], cores / (cost["workers"] + others))
    print(f"an answer costs {cost['workers']:.0f} us of a worker and {others:.0f} us of all else: {cores} cores that did nothing "
          f"else would give {most:.0f} a second, {100 * statistics.median(rates[2]) / most:.0f} % of them came")


if __name__ == "__main__":
    main()
