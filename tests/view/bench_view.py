"""What palpate view costs: touch to pixel, the page's work a picture, the server's with 16 groups.

usage: bench_view.py [SECONDS]   (environment as tests/view/README.md says)
"""
import os
import sys
import threading
import time

import browser as chromium
from browser import Browser
from bus import Bus, Probe, memory_kb
from hostile_view_test import frame, open_feed, receive_frame
from programs import SOURCE
from view_process import start_view

GROUPS, RATE_HZ, VIEWERS, FROZEN = 16, 30, 10, 2


def part(values, fraction):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(fraction * len(ordered)))]


def busy_s(process):
    fields = open(f"/proc/{process.pid}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def touch_to_pixel():
    with Bus() as bus, Browser() as browser:
        bus.start_node()
        _, url = start_view(bus)
        browser.open(url)
        browser.wait("return document.querySelector('#link-state').textContent === 'live'")
        browser.command("Performance.enable")

        def metrics():
            return {m["name"]: m["value"] for m in browser.command("Performance.getMetrics")["metrics"]}

        before = metrics()
        for _ in range(5):
            bus.simulate(SOURCE / "sim/scenes/two_finger_grasp.textproto")
        after = metrics()
        latencies = browser.run("return window.palpateLatenciesMs")
        print(f"touch to pixel: p50 {part(latencies, 0.5):.0f} ms, p99 {part(latencies, 0.99):.0f} ms of "
              f"{len(latencies)} pictures; in the page, ms a picture: " + ", ".join(
                  f"{name.removesuffix('Duration').lower()} {1e3 * (after[name] - before[name]) / len(latencies):.1f}"
                  for name in ("ScriptDuration", "RecalcStyleDuration", "LayoutDuration", "TaskDuration")))


def view_with(viewers, frozen, seconds):
    """A core's share that the server takes; each viewer looks at another group."""
    with Bus() as bus:
        node = bus.start_node()
        view, url = start_view(bus)
        port = int(url.rsplit(":", 1)[1])
        socket = bus.publisher()
        probes = [Probe(socket, name=f"finger-{i}") for i in range(GROUPS)]
        for probe in probes:
            probe.stroke()
        stop = threading.Event()

        def look(number):
            connection, _ = open_feed(port)
            name = probes[number % GROUPS].name
            connection.sendall(frame(name))
            while number >= frozen and not stop.is_set():
                receive_frame(connection)
                connection.sendall(frame(name))
            stop.wait()
            connection.close()

        threads = [threading.Thread(target=look, args=(number,)) for number in range(viewers)]
        for thread in threads:
            thread.start()
        time.sleep(1)
        start, used, node_used = time.monotonic(), busy_s(view), busy_s(node)
        number = 20
        while time.monotonic() - start < seconds:
            for probe in probes:
                probe.send(probe.batch(10 * number))
            number += 1
            time.sleep(max(0.0, start + (number - 20) / RATE_HZ - time.monotonic()))
        taken = time.monotonic() - start
        share, node_share = (busy_s(view) - used) / taken, (busy_s(node) - node_used) / taken
        print(f"{GROUPS} groups at {(number - 20) / taken:.0f} batches a second, {viewers} browsers, {frozen} of them frozen: "
              f"view {100 * share:.1f} % of a core, {memory_kb(view) / 1000:.0f} MB; node {100 * node_share:.1f} %")
        stop.set()
        for thread in threads:
            thread.join()


def main(seconds):
    if chromium.available():
        touch_to_pixel()
    view_with(0, 0, seconds)
    view_with(1, 0, seconds)
    view_with(VIEWERS, FROZEN, seconds)


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 5.0)
