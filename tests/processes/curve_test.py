"""CURVE: the right key works, a wrong one or none gets nothing and is counted."""
import os
import signal
import subprocess
import time
import unittest

import zmq
import zmq.auth
from zmq.auth import create_certificates, load_certificate

from bus import Bus
from palpate.v1 import contact_pb2, node_status_pb2
from programs import BUILD, SIM, SOURCE, TOOL, run


def keyed_socket(bus, kind, name, server):
    """A client's socket with its key of palpate keygen; not connected yet."""
    socket = bus.context.socket(kind)
    socket.linger = 0
    socket.curve_publickey, socket.curve_secretkey = load_certificate(bus.folder / f"{name}.secret")
    socket.curve_serverkey = server
    return socket


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

    def test_a_key_publishes_as_its_probes_alone(self):
        with Bus("tcp") as bus:
            for name in ("node", "left", "right", "planner"):
                self.assertEqual(run(TOOL, "keygen", bus.folder / name)[0], 0)
            keys = {name: zmq.auth.load_certificate(bus.folder / f"{name}.public")[0].decode()
                    for name in ("left", "right", "planner")}
            allowed = bus.folder / "allowed"
            allowed.write_text(f"# one line a client\n{keys['left']} probes=left,other\n"
                               f"{keys['planner']} probes=\n" + (bus.folder / "right.public").read_text())
            node = bus.start_node("--curve-secret-key", bus.folder / "node.secret", "--allow-clients", allowed,
                                  "--status-period-s", "0.2")
            server, _ = load_certificate(bus.folder / "node.public")

            def connect(kind, key, endpoint):
                socket = keyed_socket(bus, kind, key, server)
                socket.connect(endpoint)
                return socket

            def said(text):
                deadline = time.monotonic() + 10
                while text not in node.log_path.read_text():
                    self.assertLess(time.monotonic(), deadline, (text, node.log_path.read_text()))
                    time.sleep(0.01)

            status = connect(zmq.SUB, "planner", bus.results)
            status.subscribe(b"status/")

            def counts():
                while True:
                    self.assertTrue(status.poll(5000))
                    message = node_status_pb2.NodeStatus.FromString(status.recv_multipart()[1])
                    yield ({count.reason: count.count for count in message.rejected},
                           {probe.probe: (probe.messages, probe.rejected) for probe in message.probes})

            def wait_until(reached):
                deadline = time.monotonic() + 10
                for rejected, probes in counts():
                    if reached(rejected.get(node_status_pb2.REJECT_REASON_NOT_ALLOWED, 0), probes):
                        return
                    self.assertLess(time.monotonic(), deadline, (rejected, probes, node.log_path.read_text()))

            publishers = {key: connect(zmq.XPUB, key, bus.contacts) for key in keys}
            for key, publisher in publishers.items():
                self.assertTrue(publisher.poll(5000), key)
                publisher.recv()
            seq = {"left": 0, "other": 0, "right": 0, "third": 0}

            def send(key, probe):
                batch = contact_pb2.ContactBatch()
                batch.header.source, batch.header.epoch, batch.header.seq = probe, 7, seq[probe]
                batch.samples.add(stamp_ns=time.time_ns(), x_m=0.001 * seq[probe], sigma_m=1e-5)
                seq[probe] += 1
                publishers[key].send_multipart([f"contact/{probe}/".encode(), batch.SerializeToString()])

            send("left", "left")
            send("left", "other")
            send("right", "right")  # without rights named: as anybody
            send("right", "third")
            wait_until(lambda refused, probes: set(probes) == {"left", "other", "right", "third"} and refused == 0)
            # In the name of others: refused, counted and named, and no blemish on the other's record.
            send("left", "right")
            send("planner", "left")
            send("planner", "third")
            wait_until(lambda refused, probes: refused == 3 and
                       all(probe == (1, 0) for probe in probes.values()))
            said(f"NOT_ALLOWED, the last of probe third, which the key {keys['planner']} may not publish as")
            # Read again, the list holds for connections that stand.
            allowed.write_text(f"{keys['left']} probes=left\n{keys['planner']} probes=third\n{keys['right']}\n")
            node.send_signal(signal.SIGHUP)
            said("3 allowed clients reread")
            seq["third"] = 1  # those refused were never heard
            send("planner", "third")
            send("left", "other")
            wait_until(lambda refused, probes: refused == 4 and probes["third"] == (2, 0))
            for line, why in ((f"{keys['left']} groups=a", "what a client reads cannot be restricted"),
                               (f"{keys['left']} probes=a b", "expected nothing or probes=NAME,NAME"),
                               (f"{keys['left']} probes=a/b", "names are 1 to 64"),
                               (f"{keys['left']} probes=a\n{keys['left']} probes=b", ":2: this key has other probes")):
                allowed.write_text(line + "\n")
                node.send_signal(signal.SIGHUP)
                said(why)

    def test_who_is_refused_hears_why(self):
        with Bus("tcp") as bus:
            for name in ("node", "friend", "stranger"):
                self.assertEqual(run(TOOL, "keygen", bus.folder / name)[0], 0)
            allowed = bus.folder / "allowed"
            allowed.write_text((bus.folder / "friend.public").read_text())
            bus.start_node("--curve-secret-key", bus.folder / "node.secret", "--allow-clients", allowed)
            scene = SOURCE / "sim/scenes/circle.textproto"
            stranger = ("--curve-secret-key", bus.folder / "stranger.secret", "--curve-server-key",
                        bus.folder / "node.public")
            points = bus.folder / "points.csv"
            points.write_text("x_m,y_m\n" + "".join(f"{0.001 * i},0\n" for i in range(30)))
            for keys, said in ((stranger, "refuses our key: it is not on its list of clients"),
                               ((), "we do not agree on CURVE")):
                for program in ((SIM, scene, "--contacts", bus.contacts, "--wait", "30"),
                                (TOOL, "replay", points, "--contacts", bus.contacts, "--wait", "30"),
                                (TOOL, "watch", "--results", bus.results, "--timeout", "30"),
                                (TOOL, "hz", "--results", bus.results, "--seconds", "30"),
                                (TOOL, "list", "--results", bus.results, "--seconds", "30"),
                                (TOOL, "record", bus.folder / f"{len(keys)}.recording", "--results", bus.results,
                                 "--seconds", "30")):
                    begin = time.monotonic()
                    code, out, err = run(*program, *keys)
                    took = time.monotonic() - begin
                    print(f"refused: {program[1]} said so after {took:.2f} s")
                    self.assertEqual((code, out), (1, ""), program)
                    self.assertIn(said, err, program)
                    self.assertLess(took, 15.0, program)  # half of what it would wait for somebody to listen

    def test_a_key_that_could_not_be_used_is_refused(self):
        # Else what is meant to be secret would go out in the clear, and nothing would say so.
        with Bus("tcp") as bus:
            for name in ("node", "us"):
                self.assertEqual(run(TOOL, "keygen", bus.folder / name)[0], 0)
            secret, public = bus.folder / "us.secret", bus.folder / "node.public"
            points = bus.folder / "points.csv"
            points.write_text("x_m,y_m\n" + "".join(f"{0.001 * i},0\n" for i in range(30)))
            clients = [(SIM, SOURCE / "sim/scenes/circle.textproto", "--contacts", bus.contacts, "--wait", "0"),
                       (TOOL, "replay", points, "--contacts", bus.contacts, "--wait", "0"),
                       (TOOL, "watch", "--results", bus.results, "--timeout", "0.1"),
                       (TOOL, "view", "--results", bus.results, "--listen", "127.0.0.1:0"),
                       (TOOL, "hz", "--results", bus.results, "--seconds", "0.1"),
                       (TOOL, "list", "--results", bus.results, "--seconds", "0.1"),
                       (TOOL, "record", bus.folder / "new.recording", "--results", bus.results, "--seconds", "0.1")]
            gateway = BUILD / "node/gateway/palpate-gateway"
            if gateway.exists():
                clients.append((gateway, "--from", bus.results, "--cell", "a", "--spool", bus.folder))
            for program in clients:
                for keys, missing in ((("--curve-secret-key", secret), "--curve-server-key"),
                                      (("--curve-server-key", public), "--curve-secret-key"),
                                      (("--curve-secret-key", "", "--curve-server-key", ""), "name of a key file is empty")):
                    code, out, err = run(*program, *keys)
                    self.assertEqual((code, out), (2, ""), (program, keys, err))
                    self.assertIn(missing, err, program)
                code, _, err = run(*program, "--curve-secret-key", bus.folder / "us.public", "--curve-server-key", public)
                self.assertEqual(code, 2, program)
                self.assertIn("us.public: holds no secret key", err, program)
            in_its_place = (TOOL, "record", bus.folder / "new.recording", "--contacts", bus.contacts, "--seconds", "0.1")
            for keys, missing in ((("--curve-secret-key", secret), "--allow-clients"),
                                  (("--allow-clients", public), "--curve-secret-key")):
                code, _, err = run(*in_its_place, *keys)
                self.assertEqual(code, 2, (keys, err))
                self.assertIn(f"requires {missing}", err)
            code, _, err = run(*clients[6], "--curve-secret-key", secret, "--curve-server-key", public, "--allow-clients", public)
            self.assertEqual(code, 2, err)
            self.assertIn("requires --contacts", err)

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

    def test_who_stays_on_the_list_stays_connected(self):
        with Bus("tcp") as bus:
            names = ("finger", "idle", "planner", "gone")
            for name in ("node", *names):
                self.assertEqual(run(TOOL, "keygen", bus.folder / name)[0], 0)
            allowed = bus.folder / "allowed"
            allowed.write_text("".join((bus.folder / f"{name}.public").read_text() for name in names))
            node = bus.start_node("--curve-secret-key", bus.folder / "node.secret", "--allow-clients", allowed,
                                  "--status-period-s", "0.2")
            server, _ = load_certificate(bus.folder / "node.public")

            def connect(kind, key, endpoint):
                socket = keyed_socket(bus, kind, key, server)
                if kind == zmq.SUB:
                    socket.subscribe(b"status/")
                cuts = socket.get_monitor_socket(zmq.EVENT_DISCONNECTED)
                socket.connect(endpoint)
                return socket, cuts

            peers = {("finger", zmq.XPUB): None, ("idle", zmq.XPUB): None, ("gone", zmq.XPUB): None,
                     ("planner", zmq.SUB): None, ("gone", zmq.SUB): None}
            for key, kind in peers:
                peers[key, kind] = connect(kind, key, bus.contacts if kind == zmq.XPUB else bus.results)
            status, _ = peers["planner", zmq.SUB]

            def wait_until(reached):
                deadline = time.monotonic() + 10
                while True:
                    self.assertTrue(status.poll(5000))
                    message = node_status_pb2.NodeStatus.FromString(status.recv_multipart()[1])
                    if reached(message):
                        return
                    self.assertLess(time.monotonic(), deadline, (message, node.log_path.read_text()))

            def send(probe, seq):
                batch = contact_pb2.ContactBatch()
                batch.header.source, batch.header.epoch, batch.header.seq = probe, 7, seq
                batch.samples.add(stamp_ns=time.time_ns(), x_m=0.001 * seq, sigma_m=1e-5)
                peers[probe, zmq.XPUB][0].send_multipart([f"contact/{probe}/".encode(), batch.SerializeToString()])

            for (key, kind), (socket, _) in peers.items():
                self.assertTrue(socket.poll(5000), key)  # of the node: what it subscribes to, or its status
                if kind == zmq.XPUB:
                    socket.recv()
            send("finger", 0)
            send("gone", 0)
            wait_until(lambda message: {probe.probe for probe in message.probes} == {"finger", "gone"})
            allowed.write_text("".join((bus.folder / f"{name}.public").read_text() for name in names[:3]))
            node.send_signal(signal.SIGHUP)
            wait_until(lambda message: message.connections_cut > 0)
            send("finger", 1)
            seq = iter(range(1000))

            def all_are_heard(message):
                # Of who had sent nothing the key was not known: cut too, and back.
                send("idle", next(seq))
                heard = {probe.probe: probe.messages for probe in message.probes}
                return heard["finger"] == 2 and heard.get("idle", 0) > 0 and message.connections_cut == 3

            wait_until(all_are_heard)
            for (key, kind), (_, cuts) in peers.items():
                self.assertEqual(cuts.poll(5000 if key in ("gone", "idle") else 0) != 0, key in ("gone", "idle"), (key, kind))
            log = node.log_path.read_text()
            self.assertRegex(log, "2 connections to contacts cut, the last of 127.0.0.1:[0-9]+: its key has been taken off the list")
            self.assertRegex(log, "1 connections to results cut, the last of 127.0.0.1:[0-9]+: its key has been taken off the list")

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
