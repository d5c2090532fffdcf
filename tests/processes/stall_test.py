"""Recognitions that take long: nobody else waits for them, and neither does the end."""
import gzip
import json
import signal
import statistics
import time
import unittest

from bus import Bus, Probe, latency_s, wait_for
from programs import SOURCE, TOOL, run

SLOW = SOURCE / "tests/data/hostile/slow_34440_samples.csv.gz"
COPIES = 32  # of the slow input, as patches of one group: several times as long as a stop may take (kFinishTime)
SLOW_GROUPS = 3  # more than there may be cores
NAP_S = 0.01


def naps_until_stopped(node):
    """Tells it to stop. Its exit code, and how many naps one can take meanwhile: a machine that stands still for a
    while, as virtual ones do, lets nobody nap either."""
    node.send_signal(signal.SIGTERM)
    naps = 0
    while node.poll() is None and naps * NAP_S < 60:
        time.sleep(NAP_S)
        naps += 1
    return node.poll(), naps


class Stall(unittest.TestCase):
    def slow_files(self, folder):
        """A file for each slow group."""
        header, *rows = gzip.decompress(SLOW.read_bytes()).decode().splitlines()
        files = [folder / f"slow{number}.csv" for number in range(SLOW_GROUPS)]
        fields = [row.split(",") for row in rows]
        patches = 1 + max(int(patch) for _, patch, *_ in fields)
        for number, path in enumerate(files):
            lines = [",".join([f"s{number}{probe}", str(int(patch) + copy * patches), *more[:-1], f"slow{number}"])
                     for copy in range(COPIES) for probe, patch, *more in fields]
            path.write_text("\n".join([header, *lines]))
        return files

    def slow_recognition_s(self, file):
        """What waiting for one slow recognition costs, on this machine and beside what else it does now."""
        code, out, err = run(TOOL, "fit", file, "--format", "json", timeout=600)
        self.assertEqual(code, 0, err)
        return 1e-9 * int(json.loads(out)["compute_ns"])

    def test_the_good_are_served_and_the_stop_is_heard(self):
        with Bus() as bus:
            files = self.slow_files(bus.folder)
            before_s = self.slow_recognition_s(files[0])
            # All patches of a group, as fit keeps them, and nothing that comes faster than it is recognised rejected.
            node = bus.start_node("--most-patches", "1024", "--max-waiting-bytes", str(1 << 30))
            planner = bus.subscriber("recognition/good/", "status/")
            good = Probe(bus.publisher(), "good")

            def latency(object_number):
                return latency_s(good, planner, object_number)

            def play_all_slow():
                """When it returns, the last slow group's whole input is still to be recognised."""
                players = [bus.start(TOOL, "replay", path, "--contacts", bus.contacts, "--fast", "--batch", "1000")
                           for path in files]
                for player in players:
                    self.assertEqual(player.wait(120), 0)

            quiet = [latency(1 + n) for n in range(100)]
            play_all_slow()
            beside = [latency(1000 + n) for n in range(100)]
            start = time.monotonic()
            wait_for(planner, lambda m: hasattr(m, "messages_received"), 60)
            status_s = time.monotonic() - start
            play_all_slow()  # as new objects; what came first may have been recognised
            code, naps = naps_until_stopped(node)
            stop_s = naps * NAP_S
            slow_s = max(before_s, self.slow_recognition_s(files[0]))
            print(f"answer in {1e3 * statistics.median(quiet):.2f} ms (median) and "
                  f"{1e3 * sorted(quiet)[-2]:.2f} ms (p99) quiet, "
                  f"{1e3 * statistics.median(beside):.2f} and {1e3 * sorted(beside)[-2]:.2f} ms beside "
                  f"{SLOW_GROUPS} slow groups; status within {status_s:.2f} s, stop in {stop_s:.2f} s; "
                  f"a slow recognition takes {slow_s:.2f} s")
            self.assertEqual(code, 0)
            log = node.log_path.read_text()
            # There was something to wait for: the stop came while slow groups were being recognised.
            self.assertIn("stopped before all recognitions had ended", log)
            self.assertNotIn("rejected", log)  # a slow group is recognised whole
            # Whoever waits for one waits for about as long as it takes, and a busy machine delays both alike.
            self.assertLess(max(beside), 0.5 * slow_s)
            self.assertLess(status_s, 1.0 + 0.5 * slow_s)  # they come once a second
            self.assertLess(stop_s, 0.5 * slow_s)


if __name__ == "__main__":
    unittest.main()
