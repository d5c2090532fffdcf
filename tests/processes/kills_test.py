"""kill -9 in random order of node, probe, planner and recorder, each a process of its own: the system finds itself
again within a second, and of the recordings every whole record can be read.

PALPATE_KILLS: how many (CTest: 24; `PALPATE_KILLS=1000 ctest --verbose -R kills`)."""
import json
import os
import random
import select
import signal
import statistics
import struct
import subprocess
import time
import unittest
import zlib

from bus import Bus, stop
from programs import SIM, SOURCE, TOOL, run

KILLS = int(os.environ.get("PALPATE_KILLS", "24"))
SCENE = SOURCE / "sim/scenes/circle.textproto"
RECOVERY_S = 1.0


class Lines:
    """Lines of a process as they come."""

    def __init__(self, process):
        self.file = process.stdout.fileno()
        os.set_blocking(self.file, False)
        self.rest = b""

    def next(self, timeout_s):
        deadline = time.monotonic() + timeout_s
        while b"\n" not in self.rest:
            left = deadline - time.monotonic()
            if left <= 0 or not select.select([self.file], [], [], left)[0]:
                return None
            piece = os.read(self.file, 1 << 20)
            if not piece:
                return None
            self.rest += piece
        line, self.rest = self.rest.split(b"\n", 1)
        return json.loads(line)


class Kills(unittest.TestCase):
    def start(self, bus, who):
        if who == "node":
            self.running[who] = bus.start_node()
        elif who == "probe":
            # For ever, each time a new object; in a tenth of a second.
            self.running[who] = bus.start(SIM, SCENE, "--contacts", bus.contacts, "--repeat", "0", "--speed", "10",
                                          "--pause", "0", "--wait", "60", "--quiet")
        elif who == "planner":
            planner = bus.start(TOOL, "watch", "--results", bus.results, "--format", "json", stdout=subprocess.PIPE)
            if who in self.running:
                self.running[who].stdout.close()
            self.running[who] = planner
            self.lines = Lines(planner)
        else:
            self.recordings.append(bus.folder / f"{len(self.recordings)}.rec")
            self.running[who] = bus.start(TOOL, "record", self.recordings[-1], "--results", bus.results,
                                          stderr=subprocess.DEVNULL)

    def whole_answer(self, timeout_s, after_object=None):
        """The first answer of an object that no answer before was of, of all of its samples."""
        deadline = time.monotonic() + timeout_s
        begun = after_object
        while (left := deadline - time.monotonic()) > 0:
            message = self.lines.next(left)
            if message is None or "curve_class" not in message:
                continue
            if message["object"] not in self.seen:
                self.seen.add(message["object"])
                begun = message["object"]
            if message["object"] == begun and int(message["sample_count"]) >= self.enough:
                return message
        return None

    def test_everybody_is_found_again(self):
        rng = random.Random(1)
        self.running, self.recordings, self.seen = {}, [], set()
        self.enough = 100  # of a scene's 222 samples: a whole curve has been stroked, whoever came in between
        times = {who: [] for who in ("node", "probe", "planner", "recorder")}
        with Bus() as bus:
            for who in times:
                self.start(bus, who)
            self.assertIsNotNone(self.whole_answer(10), "no answer before the first kill")
            for _ in range(KILLS):
                who = rng.choice(list(times))
                # Anywhere in what it does.
                time.sleep(rng.uniform(0.0, 0.02))
                victim = self.running[who]
                victim.send_signal(signal.SIGKILL)
                victim.wait()
                bus.processes.remove(victim)
                begin = time.monotonic()
                self.start(bus, who)
                if who == "recorder":
                    path = self.recordings[-1]
                    while not path.exists() or path.stat().st_size < 1000:
                        self.assertLess(time.monotonic() - begin, RECOVERY_S, "nothing is recorded")
                        time.sleep(0.002)
                else:
                    answer = self.whole_answer(5)
                    self.assertIsNotNone(answer, f"after the {who}'s kill")
                    self.assertEqual(answer["curve_class"], "CURVE_CLASS_CIRCLE")
                times[who].append(time.monotonic() - begin)
            for process in self.running.values():
                process.kill()
                process.wait()
            self.running["planner"].stdout.close()
            broken = self.read_recordings(bus)
        for who, taken in times.items():
            if taken:
                print(f"{len(taken):4d} kills of the {who}: median {1e3 * statistics.median(taken):.0f} ms, worst "
                      f"{1e3 * max(taken):.0f} ms")
        print(f"{len(self.recordings)} recordings, each read to its last whole record; {broken} ended within one")
        self.assertLess(max(max(taken) for taken in times.values() if taken), RECOVERY_S)

    def test_a_recognizer_that_is_gone_at_the_end_is_told(self):
        with Bus() as bus:
            for comes_back in (False, True):
                node = bus.start_node()
                probe = bus.start(SIM, SCENE, "--contacts", bus.contacts, "--speed", "0.5", stderr=subprocess.PIPE)
                time.sleep(0.5)
                node.send_signal(signal.SIGKILL)
                node.wait()
                bus.processes.remove(node)
                node = bus.start_node() if comes_back else None
                _, err = probe.communicate(timeout=30)
                bus.processes.remove(probe)
                self.assertEqual(probe.returncode, 0 if comes_back else 1, err)
                went = f"the recognizer at {bus.contacts} has gone"
                self.assertEqual(f"{went}: what was published since is lost" in err, not comes_back)
                self.assertEqual(err.count(f"{went}: what was on its way") + err.count(f"{went} and is back"), 1, err)
                self.assertEqual("is back: if it was started anew, it has forgotten what came before" in err, comes_back)

    def test_what_is_published_to_nobody_is_told(self):
        with Bus() as bus:
            points = bus.folder / "points.csv"
            self.assertEqual(run(SIM, SCENE, "--csv", points)[0], 0)
            for number, command in enumerate(((SIM, SCENE), (TOOL, "replay", points))):
                address = f"ipc://{bus.folder}/{number}"
                bus.contacts = "connect:" + address
                node = bus.start_node()
                probe = bus.start(*command, "--contacts", "bind:" + address, "--speed", "0.3", stderr=subprocess.PIPE)
                time.sleep(0.5)
                stop(node)
                time.sleep(0.5)
                bus.contacts = "connect:" + address
                node = bus.start_node()
                _, err = probe.communicate(timeout=30)
                stop(node)
                self.assertEqual(probe.returncode, 1, err)
                self.assertIn("has gone: nobody listens, and what is published meanwhile is lost", err)
                self.assertIn(" is back", err)
                self.assertRegex(err, r"\d+ messages lost: nobody listened at bind:ipc://")

    def read_recordings(self, bus):
        """Each is records whose checksums are right, and at most the beginning of one more; `palpate replay` plays all
        contacts of them. Gives how many were broken off."""
        bus.start_node()
        broken = replayed = 0
        for path in self.recordings:
            contacts, is_whole = self.records_of(path.read_bytes())
            broken += not is_whole
            if contacts == 0:
                continue
            code, _, err = run(TOOL, "replay", path, "--contacts", bus.contacts, "--fast")
            self.assertEqual(code, 0 if is_whole else 1, err)
            self.assertNotIn("damaged", err)
            self.assertIn(f"{contacts} messages", err)
            replayed += contacts
        self.assertGreater(replayed, 0)
        return broken

    def records_of(self, recording):
        """How many messages of contacts it has, and whether it ends with a whole record. Reads the format anew, from
        node/files/recording.h."""
        if len(recording) < 8:
            return 0, not recording
        self.assertEqual(recording[:8], b"palpate2")
        head = struct.Struct("<4sqIIII")
        at, contacts = 8, 0
        while len(recording) >= at + head.size:
            mark, _, _, topic, payload, checksum = head.unpack_from(recording, at)
            self.assertEqual(mark, b"\xa7rec")
            end = at + head.size + topic + payload
            if len(recording) < end:
                break
            body = recording[at + head.size:end]
            self.assertEqual(zlib.crc32(body, zlib.crc32(recording[at + 4:at + head.size - 4])), checksum)
            contacts += body.startswith(b"contact/")
            at = end
        return contacts, at == len(recording)


if __name__ == "__main__":
    unittest.main()
