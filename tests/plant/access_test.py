"""Who may do what on the plant's side: the users and TLS of the shipped configuration, and the engine's credentials files."""
import base64
import binascii
import json
import pathlib
import re
import ssl
import subprocess
import time
import unittest

from bus import Bus, Probe, stop, wait_for_log
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat, PublicFormat
from plant import Client, Ledger, Servers, carrier, recogniser, skip_where_absent, start_gateway, wait_for_stored
from programs import SOURCE

CONFIGURATION = SOURCE / "node/package/plant/nats-single.conf"
BATCHES = 50


def certificates(folder):
    """An authority, and a server's and a gateway's certificate of it: PEM files of these names."""
    def openssl(*arguments):
        subprocess.run(["openssl", *arguments], cwd=folder, check=True, capture_output=True)

    openssl("req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-keyout", "ca.key",
            "-out", "ca.pem", "-subj", "/CN=test authority", "-days", "2")
    (folder / "extensions").write_text("subjectAltName=IP:127.0.0.1\n")
    for name in ("server", "gateway"):
        openssl("req", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-keyout", f"{name}.key",
                "-out", f"{name}.request", "-subj", f"/CN={name}")
        openssl("x509", "-req", "-in", f"{name}.request", "-CA", "ca.pem", "-CAkey", "ca.key", "-CAcreateserial",
                "-out", f"{name}.pem", "-days", "2", "-extfile", "extensions")


class Keys:
    """Of NATS: an operator's, account's or user's, by its letter's prefix byte."""

    PREFIX = {"operator": 14 << 3, "account": 0, "user": 20 << 3}

    def __init__(self, kind):
        self.kind, self.private = kind, Ed25519PrivateKey.generate()
        prefix = self.PREFIX[kind]
        self.public = self.encode(bytes([prefix]) + self.private.public_key().public_bytes(Encoding.Raw, PublicFormat.Raw))
        seed = self.private.private_bytes(Encoding.Raw, PrivateFormat.Raw, NoEncryption())
        self.seed = self.encode(bytes([18 << 3 | prefix >> 5, (prefix & 31) << 3]) + seed)

    @staticmethod
    def encode(data):
        return base64.b32encode(data + binascii.crc_hqx(data, 0).to_bytes(2, "little")).decode().rstrip("=")

    def sign(self, data):
        return base64.urlsafe_b64encode(self.private.sign(data)).decode().rstrip("=")

    def token(self, of, name, **claims):
        """What this one says of another (or of itself), as a JSON web token."""
        def part(value):
            return base64.urlsafe_b64encode(json.dumps(value).encode()).decode().rstrip("=")
        said = {"jti": name, "iat": int(time.time()), "iss": self.public, "name": name, "sub": of.public,
                "nats": claims | {"type": of.kind, "version": 2}}
        text = part({"typ": "JWT", "alg": "ed25519-nkey"}) + "." + part(said)
        return text + "." + self.sign(text.encode())

    def credentials(self, token):
        """The text of a .creds file."""
        return (f"-----BEGIN NATS USER JWT-----\n{token}\n------END NATS USER JWT------\n\n"
                f"-----BEGIN USER NKEY SEED-----\n{self.seed}\n------END USER NKEY SEED------\n")


class Access(unittest.TestCase):
    def stroke_and_answers(self, bus, client):
        """Contacts of a cell are stored and answered by the plant."""
        probe = Probe(bus.publisher(high_water_mark=100000), "finger", "hand")
        probe.stroke(BATCHES)
        wait_for_stored(client, "palpate-press-contact", BATCHES)
        deadline = time.monotonic() + 20
        while True:
            ledger = Ledger(client, "press")
            if ledger.answers and ledger.answers["hand"][-1][1] == max(seq for _, seq in ledger.contacts):
                break
            self.assertLess(time.monotonic(), deadline, "no answer")
            time.sleep(0.1)
        ledger.sent_once(self, {"finger": BATCHES})
        ledger.answered_once(self)

    def test_users_and_tls_of_the_shipped_configuration(self):
        """Its section for beyond this machine, as it stands behind its comment signs."""
        with Bus() as bus, Servers(bus.folder) as servers:
            certificates(bus.folder)
            text = CONFIGURATION.read_text()
            text, beyond = text.split("# Beyond this machine. ")
            beyond = re.sub("(?m)^# ?", "", beyond.split("\n", 1)[1].split("# A gateway gives")[0])
            for pattern, replacement in (("127.0.0.1:4222", f"127.0.0.1:{servers.ports[0]}"), ('http: .*', ""),
                                         ("/var/lib/nats", f"{bus.folder}/store"), ("200GB", "1GB")):
                text = re.sub(pattern, replacement, text)
            beyond = beyond.replace("/etc/nats", str(bus.folder)).replace('"..."', '"secret"')
            beyond = beyond.replace("users = [", 'users = [ { user: "test", password: "secret" },')
            servers.file(0).write_text(text + beyond)
            tls = ssl.create_default_context(cafile=bus.folder / "ca.pem")
            tls.load_cert_chain(bus.folder / "gateway.pem", bus.folder / "gateway.key")
            servers.access = {"tls": tls, "login": lambda _: {"user": "test", "pass": "secret"}}
            servers.start().wait()

            def url(user, password="secret"):
                return f"nats://{user}:{password}@127.0.0.1:{servers.ports[0]}"

            own = ["--tls-ca", bus.folder / "ca.pem", "--tls-cert", bus.folder / "gateway.pem",
                   "--tls-key", bus.folder / "gateway.key"]
            endpoint = f"ipc://{bus.folder}/contacts"
            up = carrier(bus, url("press"), "up", "press", "bind:" + endpoint, "--carry", "contact", "--carry", "status", *own)
            down = recogniser(bus, url("recogniser"), "down", ["press:0"], *own)
            for process in (up, down):
                wait_for_log(process, "connected to the plant")
            with Client(servers.url, **servers.access) as client:
                self.stroke_and_answers(bus, client)
                # Nobody was refused anything.
                for process in (up, down):
                    self.assertNotIn("warning", process.log_path.read_text())

                # The cell may not answer in a recogniser's place, nor be another cell; a recogniser brings no contacts.
                before = {name: client.api(f"STREAM.INFO.palpate-press-{name}")["state"]["last_seq"]
                          for name in ("recognition", "contact")}
                for user, subjects in (("press", ["palpate.press.recognition.hand", "palpate.mill.contact.0.hand.finger",
                                                  "$JS.API.STREAM.DELETE.palpate-press-contact"]),
                                       ("recogniser", ["palpate.press.contact.0.hand.finger", "palpate.press.status.node"])):
                    for subject in subjects:
                        stranger = Client(servers.url, tls=tls, login=lambda _, user=user: {"user": user, "pass": "secret"})
                        stranger.publish(subject, b"x")
                        with self.assertRaisesRegex(ConnectionError, "(?i)permissions violation"):
                            stranger.receive(5)
                        stranger.close()
                for name, seq in before.items():
                    self.assertEqual(client.api(f"STREAM.INFO.palpate-press-{name}")["state"]["last_seq"], seq)

                # Who has no certificate, or another's password, is refused; a gateway says so, and asks again.
                strange = start_gateway(bus, url("press", "guessed"), "strange", "--cell", "press", "--from",
                                        f"bind:ipc://{bus.folder}/other", "--spool", bus.folder / "other.spool", *own)
                bare = start_gateway(bus, url("press"), "bare", "--cell", "press", "--from", f"bind:ipc://{bus.folder}/third",
                                     "--spool", bus.folder / "third.spool", "--tls-ca", bus.folder / "ca.pem")
                wait_for_log(strange, "the plant: Authorization Violation")
                wait_for_log(bare, "the plant: ")
                # A server that takes the password after all.
                servers.file(0).write_text((text + beyond).replace('"press", password: "secret"', '"press", password: "guessed"'))
                servers.reload()
                wait_for_log(strange, "connected to the plant")
                wait_for_log(up, "the plant: Authorization Violation")
                self.assertNotIn("connected", bare.log_path.read_text())
            for process in (up, down, strange, bare):
                self.assertEqual(stop(process)[0], 0)

    def test_credentials_files(self):
        """An operator's account with a user for each gateway, as the engine's own tools would write them."""
        with Bus() as bus, Servers(bus.folder) as servers:
            operator, system, account = Keys("operator"), Keys("account"), Keys("account")
            no_limits = dict.fromkeys(("subs", "data", "payload", "imports", "exports", "conn", "leaf"), -1) | {"wildcards": True}
            streams = dict.fromkeys(("mem_storage", "disk_storage", "streams", "consumer"), -1)
            resolver = "\n".join(f"  {of.public}: {operator.token(of, name, limits=limits)}"
                                 for of, name, limits in ((system, "system", no_limits),
                                                          (account, "plant", no_limits | streams)))
            servers.file(0).write_text(f'{servers.file(0).read_text()}\noperator: {operator.token(operator, "operator")}\n'
                                       f'system_account: {system.public}\nresolver: MEMORY\nresolver_preload: {{\n{resolver}\n}}\n')
            files = {}
            for name in ("test", "up", "down"):
                user = Keys("user")
                token = account.token(user, name, pub={}, sub={}, subs=-1, data=-1, payload=-1)
                files[name] = bus.folder / f"{name}.creds"
                files[name].write_text(user.credentials(token))
                if name == "test":
                    servers.access = {"login": lambda info, user=user, token=token: {"jwt": token, "sig": user.sign(
                        info["nonce"].encode())}}
            servers.start().wait()
            endpoint = f"ipc://{bus.folder}/contacts"
            up = carrier(bus, servers.url, "up", "press", "bind:" + endpoint, "--credentials", files["up"])
            down = recogniser(bus, servers.url, "down", ["press"], "--credentials", files["down"])
            foreign, other = Keys("user"), Keys("account")
            (bus.folder / "foreign.creds").write_text(foreign.credentials(other.token(foreign, "foreign", pub={}, sub={})))
            strange = start_gateway(bus, servers.url, "strange", "--cell", "press", "--from", f"bind:ipc://{bus.folder}/other",
                                    "--spool", bus.folder / "other.spool", "--credentials", bus.folder / "foreign.creds")
            for process in (up, down):
                wait_for_log(process, "connected to the plant")
            with Client(servers.url, **servers.access) as client:
                self.stroke_and_answers(bus, client)
            wait_for_log(strange, "the plant: Authorization Violation")
            for process in (up, down, strange):
                self.assertEqual(stop(process)[0], 0)


if __name__ == "__main__":
    skip_where_absent()
    unittest.main()
