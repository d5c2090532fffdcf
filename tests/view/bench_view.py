"""What palpate view costs, and what it costs the node: touch to pixel, the server's share of a core, the node's
latency with ten browsers beside none. Ends with 1 where a figure is beyond its bound.

usage: bench_view.py [--seconds S] [--turns N] [--rounds N]   (environment as tests/view/README.md says)

Prints CSV: what, value, unit, at_most (empty: told, not bounded).
"""
import argparse
import contextlib
import csv
import os
import pathlib
import random
import socket
import statistics
import subprocess
import sys
import threading
import time

import browser as chromium
from browser import Browser
from bus import Bus, Probe, memory_kb
from hostile_view_test import frame, open_feed
from programs import BUILD, SOURCE
from view_process import start_view

GROUPS, RATE_HZ = 16, 30
BROWSERS, FROZEN = 10, 2
PLAYS = 25  # of a scene of some eight pictures: of fewer than a hundred the worst one is no 99th percentile
# What a person takes for at once; what may be left to whoever looks on; what the node may not notice.
MOST_TOUCH_TO_PIXEL_MS, MOST_SHARE_PERCENT, MOST_LATENCY_RATIO = 150, 10, 1.05
LATENCY = BUILD / "tests/bench/processes/bench_latency"


def interval_of_median(values, draws=2000):
    """Where the median lies, 95 %: of the values drawn anew again and again (bootstrap, percentiles)."""
    rng = random.Random(1)
    medians = [statistics.median(rng.choices(values, k=len(values))) for _ in range(draws)]
    return part(medians, 0.025), part(medians, 0.975)


class Report:
    """Rows of CSV as they are known."""

    def __init__(self):
        self._rows = csv.writer(sys.stdout, lineterminator="\n")
        self._rows.writerow(["what", "value", "unit", "at_most"])
        self.beyond = []

    def add(self, what, value, unit, at_most=None):
        self._rows.writerow([what, f"{value:.4g}", unit, "" if at_most is None else at_most])
        sys.stdout.flush()
        if at_most is not None and value > at_most:
            self.beyond.append(f"{what}: {value:.4g} {unit}, at most {at_most}")


def part(values, fraction):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(fraction * len(ordered)))]


def computed_s(process):
    """What its threads have had of the cores, to the nanosecond."""
    return 1e-9 * sum(int((task / "schedstat").read_text().split()[0])
                      for task in pathlib.Path(f"/proc/{process.pid}/task").iterdir())


def touch_to_pixel(report):
    with Bus() as bus, Browser() as browser:
        bus.start_node()
        _, url = start_view(bus)
        browser.open(url)
        browser.wait("return document.querySelector('#link-state').textContent === 'live'")
        browser.command("Performance.enable")

        def metrics():
            return {m["name"]: m["value"] for m in browser.command("Performance.getMetrics")["metrics"]}

        before = metrics()
        for _ in range(PLAYS):
            bus.simulate(SOURCE / "sim/scenes/two_finger_grasp.textproto")
        after = metrics()
        latencies = browser.run("return window.palpateLatenciesMs")
        report.add("pictures drawn", len(latencies), "")
        report.add("touch to pixel, p50", part(latencies, 0.5), "ms")
        report.add("touch to pixel, p99", part(latencies, 0.99), "ms", MOST_TOUCH_TO_PIXEL_MS)
        for name in ("ScriptDuration", "RecalcStyleDuration", "LayoutDuration", "TaskDuration"):
            report.add(f"in the page, a picture: {name.removesuffix('Duration').lower()}",
                       1e3 * (after[name] - before[name]) / len(latencies), "ms")


class Looking(contextlib.ExitStack):
    """Browsers as the server sees them: each asks for a group and, where it is awake, for the next message as soon
    as it has had one. They leave with the block."""

    def __init__(self, port, groups, frozen):
        super().__init__()
        self._threads = []
        self._had = [0] * len(groups)
        for number, group in enumerate(groups):
            connection, _ = open_feed(port)
            connection.settimeout(None)
            connection.sendall(frame(group))
            self.callback(connection.close)
            if number >= frozen:
                thread = threading.Thread(target=self._look, args=(number, connection, frame(group)))
                thread.start()
                self._threads.append(thread)
                self.callback(thread.join)
                self.callback(connection.shutdown, socket.SHUT_RDWR)

    @property
    def messages(self):
        """Had by all of them."""
        return sum(self._had)

    def _look(self, number, connection, ready):
        # A browser takes what it takes, mostly of another machine: here it gives way to what is measured.
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), 19)
        reader = connection.makefile("rb")
        try:
            while head := reader.read(2):
                size = head[1]
                if size >= 126:
                    size = int.from_bytes(reader.read(2 if size == 126 else 8), "big")
                reader.read(size)
                if head[0] & 0x0F == 1:
                    self._had[number] += 1
                    connection.sendall(ready)
        except OSError:  # the view has gone
            pass


def port_of(url):
    return int(url.rsplit(":", 1)[1])


def share_of_a_core(report, browsers, frozen, seconds):
    """Each browser looks at another group."""
    with Bus() as bus:
        bus.start_node()
        view, url = start_view(bus)
        socket_of_probes = bus.publisher()
        probes = [Probe(socket_of_probes, name=f"finger-{i}") for i in range(GROUPS)]
        for probe in probes:
            probe.stroke()
        with Looking(port_of(url), [probes[i % GROUPS].name for i in range(browsers)], frozen) as looking:
            time.sleep(1)
            start, used, had = time.monotonic(), computed_s(view), looking.messages
            rounds = 0
            while time.monotonic() - start < seconds:
                for probe in probes:
                    probe.send(probe.batch(200 + 10 * rounds))
                rounds += 1
                time.sleep(max(0.0, start + rounds / RATE_HZ - time.monotonic()))
            taken = time.monotonic() - start
            what = f"{GROUPS} groups at {rounds / taken:.0f} updates a second, {browsers} browsers"
            if frozen:
                what += f" of which {frozen} are frozen"
            report.add(f"{what}: share of a core", 100 * (computed_s(view) - used) / taken, "%", MOST_SHARE_PERCENT)
            if browsers > frozen:
                # Where the machine is busy they are served less, which makes the server's share no merit.
                report.add(f"{what}: messages a browser has a second",
                           (looking.messages - had) / taken / (browsers - frozen), "Hz")
            report.add(f"{what}: memory", memory_kb(view) / 1000, "MB")


def latency_of(bus, rounds):
    """What bench_latency says of the running node: quantiles by row. [us]"""
    done = subprocess.run([LATENCY, "--rounds", str(rounds), "--contacts", bus.contacts, "--results", bus.results],
                          check=True, capture_output=True, text=True)
    return {row["what"]: (float(row["p50_us"]), float(row["p99_us"])) for row in csv.DictReader(done.stdout.splitlines())}


@contextlib.contextmanager
def beside(bus, who):
    """Who looks on while the node is measured."""
    if who == "nobody":
        yield
    elif who == "a subscriber":
        # Asks for all that the view asks for, and does nothing with it: what it costs to be listened to.
        listener = bus.subscriber("recognition/", "contact/", "status/")
        stop = threading.Event()

        def listen():
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), 19)
            while not stop.is_set():
                while listener.poll(10):
                    listener.recv_multipart()

        thread = threading.Thread(target=listen)
        thread.start()
        try:
            yield
        finally:
            stop.set()
            thread.join()
            listener.close()
    else:
        view, url = start_view(bus)
        with Looking(port_of(url), [""] * (BROWSERS if who != "the view" else 0), FROZEN):
            yield
        view.terminate()
        view.wait()


def latency_beside_browsers(report, turns, rounds):
    """The same node with nobody beside it, a plain subscriber, the view, and the view with its browsers, turn by turn.
    Short turns see the same machine: a turn is compared with the one beside nobody next to it. Latency is the machine's too: whoever looks on computes on the same cores. What
    the node itself computes for a batch is its own cost."""
    browsers = f"the view and {BROWSERS} browsers of which {FROZEN} are frozen"
    everybody = ["nobody", "a subscriber", "the view", browsers]
    latencies = {who: [] for who in everybody}
    computed_us = {who: [] for who in everybody}
    with Bus() as bus:
        node = bus.start_node()
        for turn in range(turns):
            # There and back: what drifts falls on all.
            for who in everybody if turn % 2 == 0 else reversed(everybody):
                with beside(bus, who):
                    before = computed_s(node)
                    latencies[who].append(latency_of(bus, rounds))
                    computed_us[who].append(1e6 * (computed_s(node) - before) / rounds)
    for row in ("publish to recognition", "less its computation", "bare relay"):
        for index, quantile in enumerate(("p50", "p99")):
            values = {who: statistics.median(turn[row][index] for turn in latencies[who]) for who in everybody}
            for who in everybody:
                report.add(f"{row}, {quantile}: beside {who}", values[who], "us")
                bounded = (row, quantile, who) == ("publish to recognition", "p50", browsers)
                if who != "nobody":
                    ratios = [there[row][index] / alone[row][index]
                              for there, alone in zip(latencies[who], latencies["nobody"])]
                    low, high = interval_of_median(ratios)
                    what = f"{row}, {quantile}: beside {who} over nobody"
                    report.add(what, statistics.median(ratios), "")
                    # Beyond its bound is what is so for certain; a high end beyond it asks for more turns.
                    report.add(f"{what}, low end of 95 %", low, "", MOST_LATENCY_RATIO if bounded else None)
                    report.add(f"{what}, high end of 95 %", high, "")
    alone = statistics.median(computed_us["nobody"])
    for who in everybody:
        value = statistics.median(computed_us[who])
        report.add(f"node's computing a batch: beside {who}", value, "us")
        if who != "nobody":
            report.add(f"node's computing a batch: beside {who} over nobody", value / alone, "")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("--seconds", type=float, default=5.0, help="of each load on the server")
    parser.add_argument("--turns", type=int, default=20, help="of the node's latency, beside each who looks on")
    parser.add_argument("--rounds", type=int, default=300, help="batches a turn")
    options = parser.parse_args()
    report = Report()
    if chromium.available():
        touch_to_pixel(report)
    else:
        print("no chromium and chromedriver here: touch to pixel is not measured", file=sys.stderr)
    for browsers, frozen in ((0, 0), (1, 0), (BROWSERS, FROZEN)):
        share_of_a_core(report, browsers, frozen, options.seconds)
    if LATENCY.exists():
        latency_beside_browsers(report, options.turns, options.rounds)
    else:
        print(f"{LATENCY} is not built: the node's latency is not measured", file=sys.stderr)
    for line in report.beyond:
        print(f"beyond its bound: {line}", file=sys.stderr)
    return 1 if report.beyond else 0


if __name__ == "__main__":
    sys.exit(main())
