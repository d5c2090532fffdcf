"""CURVE: the right key works, a wrong one or none gets nothing and is counted."""
import os
import signal
import subprocess
import time
import unittest

import zmq
from zmq.auth import create_certificates, load_certificate

from bus import Bus, Probe, wait_for
from programs import SIM, SOURCE, TOOL, run


class Curve(unittest.TestCase):
    def test_right_key_wrong_key_and_none(self):
        with Bus("tcp") as bus:
            for name in ("node", "friend", "stranger"):
                self.assertEqual(run(TOOL, "keygen", bus.folder / name)[0], 0)
            (bus.folder / "allowed").write_text((bus.folder / "friend.public").read_text())
            bus.start_node("--curve-secret-key", bus.folder / "node.secret", "--allow-clients",
                           bus.folder / "allowed")
            scene = SOURCE / "sim/scenes/circle.textproto"

            def play(key):
                keys = [] if key is None else ["--curve-secret-key", bus.folder / f"{key}.secret",
                                               "--curve-server-key", bus.folder / "node.public"]
                return run(SIM, scene, "--contacts", bus.contacts, "--fast", "--wait", "1.5", *keys)[0]

            def watch(key):
                keys = [] if key is None else ["--curve-secret-key", bus.folder / f"{key}.secret",
                                               "--curve-server-key", bus.folder / "node.public"]
                return run(TOOL, "watch", "--results", bus.results, "--timeout", "3", "--count", "1",
                           "--format", "json", *keys)

            self.assertEqual(play("friend"), 0)
            code, out, _ = watch("friend")
            self.assertEqual(code, 0)
            self.assertIn("CURVE_CLASS_CIRCLE", out)
            for key in ("stranger", None):
                self.assertEqual(play(key), 1, key)
                code, out, _ = watch(key)
                self.assertEqual((code, out), (1, ""), key)
            _, out, _ = watch("friend")
            self.assertIn("CURVE_CLASS_CIRCLE", out)

    def test_sighup_rereads_who_may_connect(self):
        with Bus("tcp") as bus:
            for name in ("node", "friend", "other"):
                self.assertEqual(run(TOOL, "keygen", bus.folder / name)[0], 0)
            allowed = bus.folder / "allowed"
            allowed.write_text((bus.folder / "friend.public").read_text())
            node = bus.start_node("--curve-secret-key", bus.folder / "node.secret", "--allow-clients", allowed)

            def play(key):
                return run(SIM, SOURCE / "sim/scenes/circle.textproto", "--contacts", bus.contacts, "--fast",
                           "--wait", "1.5", "--curve-secret-key", bus.folder / f"{key}.secret",
                           "--curve-server-key", bus.folder / "node.public")[0]

            def reread(text, said):
                allowed.write_text(text)
                node.send_signal(signal.SIGHUP)
                deadline = time.monotonic() + 10
                while said not in node.log_path.read_text():
                    self.assertLess(time.monotonic(), deadline, node.log_path.read_text())
                    time.sleep(0.01)

            self.assertEqual((play("friend"), play("other")), (0, 1))
            watch = bus.start(TOOL, "watch", "--results", bus.results, "--timeout", "3", "--curve-secret-key",
                              bus.folder / "friend.secret", "--curve-server-key", bus.folder / "node.public",
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            both = (bus.folder / "friend.public").read_text() + (bus.folder / "other.public").read_text()
            reread(both, "2 allowed clients reread")
            self.assertEqual((play("friend"), play("other")), (0, 0))
            # A file that is none changes nothing.
            reread("nonsense\n", "stay as they were")
            self.assertEqual(play("friend"), 0)
            self.assertIsNone(watch.poll())
            # Who is taken off is cut off, connected as it may be.
            reread((bus.folder / "other.public").read_text(), "1 allowed clients reread")
            self.assertEqual((play("friend"), play("other")), (1, 0))
            self.assertEqual(watch.wait(20), 1)
            self.assertIsNone(node.poll())

    def test_check_takes_the_recognizers_place_with_its_keys(self):
        with Bus() as bus:
            for name in ("node", "friend", "stranger"):
                self.assertEqual(run(TOOL, "keygen", bus.folder / name)[0], 0)
            (bus.folder / "allowed").write_text((bus.folder / "friend.public").read_text())

            def check(player):
                checker = bus.start(TOOL, "check", "--contacts", bus.contacts, "--seconds", "2",
                                    "--curve-secret-key", bus.folder / "node.secret", "--allow-clients",
                                    bus.folder / "allowed", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                run(SIM, SOURCE / "sim/scenes/circle.textproto", "--contacts", bus.contacts, "--fast",
                    "--wait", "1.5", "--curve-secret-key", bus.folder / f"{player}.secret",
                    "--curve-server-key", bus.folder / "node.public")
                out, _ = checker.communicate(timeout=10)
                return checker.returncode, out

            code, out = check("friend")
            self.assertEqual(code, 0, out)
            self.assertIn("fit for the recognizer", out)
            code, out = check("stranger")
            self.assertEqual(code, 1, out)
            self.assertIn("turned away", out)
            code, _, err = run(TOOL, "check", "--contacts", "tcp://0.0.0.0:*", "--seconds", "1")
            self.assertEqual(code, 2)
            self.assertIn("open to the network", err)

    def test_certificates_are_those_of_pyzmq_and_czmq(self):
        with Bus("tcp") as bus:
            self.assertEqual(run(TOOL, "keygen", bus.folder / "node")[0], 0)
            create_certificates(bus.folder, "finger")  # pyzmq's: finger.key, finger.key_secret
            os.chmod(bus.folder / "finger.key_secret", 0o600)
            bus.start_node("--curve-secret-key", bus.folder / "node.secret", "--allow-clients", bus.folder / "finger.key")
            self.assertEqual(run(SIM, SOURCE / "sim/scenes/circle.textproto", "--contacts", bus.contacts, "--fast",
                                 "--wait", "5", "--curve-secret-key", bus.folder / "finger.key_secret",
                                 "--curve-server-key", bus.folder / "node.public")[0], 0)
            public, secret = load_certificate(bus.folder / "node.secret")
            self.assertEqual(zmq.curve_public(secret), public)
            self.assertEqual(load_certificate(bus.folder / "node.public"), (public, None))

    def test_keys_are_never_overwritten(self):
        with Bus() as bus:
            self.assertEqual(run(TOOL, "keygen", bus.folder / "a")[0], 0)
            before = (bus.folder / "a.secret").read_text()
            self.assertEqual((bus.folder / "a.secret").stat().st_mode & 0o777, 0o600)
            self.assertEqual(run(TOOL, "keygen", bus.folder / "a")[0], 1)
            self.assertEqual((bus.folder / "a.secret").read_text(), before)


if __name__ == "__main__":
    unittest.main()
