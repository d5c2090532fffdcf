"""Tools on a recogniser of the plant as on any node, TLS both ways, and what is said of wrong options."""
import json
import subprocess
import tempfile
import time
import unittest

from bus import Bus, Probe
from plant import (GATEWAY, SERVER, Client, Ledger, Servers, carrier, gateway_status, recogniser, skip_where_absent,
                   wait_for_stored)
from programs import SOURCE, TOOL, run


class Causes(unittest.TestCase):
    def said(self, gateway, words):
        deadline = time.monotonic() + 10
        while words not in gateway.log_path.read_text():
            self.assertLess(time.monotonic(), deadline, gateway.log_path.read_text())
            time.sleep(0.1)

    def test_why_a_place_begins_anew_is_said(self):
        with Bus() as bus, Servers(bus.folder) as servers:
            servers.start().wait()
            missing = recogniser(bus, servers.url, "missing", ["press"], "--node", "/no/such/node")
            self.said(missing, "its node cannot be started: /no/such/node")
            alone = recogniser(bus, servers.url, "alone", ["mill"], "--replicas", "3")
            self.said(alone, "a stream cannot be made: palpate-mill-")
            self.said(alone, "replicas > 1 not supported")


    def test_contacts_in_no_partition_are_told(self):
        for partitions in (2, 0):
            with Bus() as bus, Servers(bus.folder, partitions=partitions) as servers:
                servers.start().wait()
                down = recogniser(bus, servers.url, "down", ["press:0", "press:1"])
                carrier(bus, servers.url, "up", "press", f"bind:ipc://{bus.folder}/contacts")
                with Client(servers.url) as client:
                    gateway_status(client, "press", "up")
                    Probe(bus.publisher(), "finger", "hand").stroke(5)
                    wait_for_stored(client, "palpate-press-contact", 5)
                words = "contacts of 1 subjects of the cell are in no partition"
                if partitions:
                    time.sleep(6)
                    self.assertNotIn("in no partition", down.log_path.read_text())
                else:
                    self.said(down, "press:0: " + words)
                    self.said(down, "press:1: " + words)


class Tools(unittest.TestCase):
    def test_they_see_the_recognisers_node_as_any_other(self):
        with Bus() as bus, Servers(bus.folder) as servers:
            servers.start().wait()
            recogniser(bus, servers.url, "down", ["press"])
            endpoint = f"ipc://{bus.folder}/contacts"
            carrier(bus, servers.url, "up", "press", "bind:" + endpoint)
            results = f"ipc://{bus.folder}/down/press.results"
            with Client(servers.url) as client:
                gateway_status(client, "press", "up")
                time.sleep(1.2)
                record = bus.start(TOOL, "record", bus.folder / "plant.rec", "--results", results, stderr=subprocess.DEVNULL)
                planner = bus.start("/usr/bin/python3", SOURCE / "node/examples/planner.py", "--endpoint", results,
                                    "--once", stdout=subprocess.PIPE)
                time.sleep(1)
                probe = Probe(bus.publisher(), "finger", "hand")
                probe.stroke(20)
                wait_for_stored(client, "palpate-press-contact", 20)
                deadline = time.monotonic() + 10
                while True:
                    ledger = Ledger(client, "press")
                    answers = ledger.answers.get("hand", [])
                    if answers and answers[-1][3].sample_count == 200:
                        break
                    self.assertLess(time.monotonic(), deadline)
                    time.sleep(0.1)
                ledger.answered_once(self)
            watch = bus.start(TOOL, "watch", "--results", results, "--format", "json", stdout=subprocess.PIPE)
            line = json.loads(watch.stdout.readline())
            watch.stdout.close()
            self.assertEqual((line["group"], line["curve_class"]), ("hand", "CURVE_CLASS_CIRCLE"))
            code, out, err = run(TOOL, "list", "--results", results)
            self.assertEqual(code, 0, err)
            for topic in ("recognition/hand/", "status/press/"):
                self.assertIn(topic, out)
            said, _ = planner.communicate(timeout=10)
            self.assertIn("hand", said)
            record.terminate()
            record.wait()
            code, _, err = run(TOOL, "replay", bus.folder / "plant.rec", "--contacts", endpoint, "--fast")
            self.assertEqual(code, 0, err)
            self.assertIn("20 messages", err)

    def test_tls_both_ways(self):
        with Bus() as bus:
            folder = bus.folder
            self.certify(folder)
            tls = (f'tls {{ cert_file: "{folder}/server.pem", key_file: "{folder}/server.key", ca_file: "{folder}/ca.pem", '
                   'verify: true }')
            with Servers(folder, extra=tls) as servers:
                servers.start()
                files = "--tls-ca", folder / "ca.pem", "--tls-cert", folder / "client.pem", "--tls-key", folder / "client.key"
                time.sleep(0.5)
                known = carrier(bus, servers.url, "known", "press", f"bind:ipc://{folder}/contacts", *files)
                stranger = carrier(bus, servers.url, "stranger", "press", f"bind:ipc://{folder}/other", "--tls-ca",
                                   folder / "ca.pem")
                deadline = time.monotonic() + 10
                while "connected to" not in known.log_path.read_text():
                    self.assertLess(time.monotonic(), deadline, known.log_path.read_text())
                    time.sleep(0.05)
                time.sleep(1)
                self.assertNotIn("connected to", stranger.log_path.read_text())

    def certify(self, folder):
        def openssl(*arguments):
            subprocess.run(["openssl", *map(str, arguments)], check=True, capture_output=True, cwd=folder)

        openssl("req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", 2, "-subj",
                "/CN=test ca", "-keyout", "ca.key", "-out", "ca.pem")
        (folder / "names").write_text("subjectAltName=IP:127.0.0.1,DNS:localhost\n")
        for who in ("server", "client"):
            openssl("req", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-subj", f"/CN={who}", "-keyout",
                    f"{who}.key", "-out", f"{who}.csr")
            openssl("x509", "-req", "-in", f"{who}.csr", "-CA", "ca.pem", "-CAkey", "ca.key", "-CAcreateserial", "-days", 2,
                    "-extfile", "names", "-out", f"{who}.pem")

    def test_the_configurations_given_are_valid(self):
        folder = SOURCE / "node/package/plant"
        for path in sorted(folder.glob("nats-*.conf")):
            code, out, err = run(SERVER, "-t", "-c", path)
            self.assertEqual(code, 0, out + err)
        for path in sorted(folder.glob("gateway-*.conf")):
            with Bus() as bus:
                # Nobody is there: it goes on, until it is stopped.
                process = bus.start(GATEWAY, "--config", path, "--spool", bus.folder / "spool", "--run-folder", bus.folder,
                                    "--plant", "nats://127.0.0.1:1", stderr=subprocess.PIPE)
                time.sleep(0.5)
                self.assertIsNone(process.poll(), process.stderr.read() if process.poll() is not None else "")
                process.terminate()
                self.assertEqual(process.wait(5), 0)
                process.stderr.close()

    def test_wrong_options(self):
        cases = [
            ([], 2, "one of --from and --take"),
            (["--take", "a:b:c", "--run-folder", "/tmp"], 2, "no CELL or CELL:PARTITION"),
            (["--take", "a b", "--run-folder", "/tmp"], 2, "no CELL or CELL:PARTITION"),
            (["--take", "a"], 2, "--take requires --run-folder"),
            (["--from", "ipc:///tmp/x"], 2, "--from requires --cell"),
            (["--from", "bind:tcp://0.0.0.0:1", "--cell", "c", "--spool", "/tmp/x"], 2, "beyond this machine"),
            (["--from", "ipc:///tmp/x", "--cell", "a/b", "--spool", "/tmp/x"], 2, "no name"),
            (["--take", "a", "--credentials", "/nowhere"], 2, "/nowhere"),
            (["--take", "a", "--tls-ca", "/nowhere"], 2, "/nowhere"),
            (["--from", "ipc:///tmp/x", "--cell", "c", "--spool", "/proc/x"], 1, "/proc/x"),
            (["--take", "a", "--run-folder", "/tmp", "--log-level", "loud"], 2, "--log-level"),
        ]
        with tempfile.NamedTemporaryFile("w", suffix=".conf") as config:
            config.write("spool-byte = 4096\n")
            config.flush()
            cases.append((["--config", config.name, "--take", "a", "--run-folder", "/tmp"], 2, "spool-byte"))
            self.refuses(cases)

    def refuses(self, cases):
        for arguments, expected, said in cases:
            code, out, err = run(GATEWAY, *arguments)
            self.assertEqual(code, expected, (arguments, err))
            self.assertIn(said, out + err)


if __name__ == "__main__":
    skip_where_absent()
    unittest.main()
