"""NATS servers on loopback with a temporary store, and a client of their text protocol."""
import collections
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time

from palpate.v1 import contact_pb2, gateway_status_pb2, recognition_pb2
from programs import BUILD, NODE

GATEWAY = BUILD / "node/gateway/palpate-gateway"
SERVER = shutil.which("nats-server") or "/usr/sbin/nats-server"


def skip_where_absent():
    """Exits with 77, which ctest shows as skipped, and prints why."""
    for program in (GATEWAY, pathlib.Path(SERVER)):
        if not program.exists():
            print(f"SKIPPED: no {program}: apt-get install nats-server libnats-dev, and build again")
            sys.exit(77)


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Servers:
    """One server or a cluster, with a mapping of the contacts of each cell to partitions."""

    def __init__(self, folder, count=1, partitions=0, extra=""):
        self.folder, self.count = pathlib.Path(folder), count
        self.ports = free_ports(2 * count)
        self.processes = [None] * count
        self.access = {}  # what a Client needs beyond the address
        mapping = ""
        if partitions:
            mapping = ('mappings = { "palpate.*.contact.*.*": "palpate.{{wildcard(1)}}.contact.{{partition(%d,2)}}.'
                       '{{wildcard(2)}}.{{wildcard(3)}}" }' % partitions)
        for i in range(count):
            routes = ", ".join(f"nats-route://127.0.0.1:{port}" for port in self.ports[count:])
            cluster = f'cluster {{ name: plant, listen: "127.0.0.1:{self.ports[count + i]}", routes: [{routes}] }}'
            self.file(i).write_text(
                f'server_name: s{i}\nlisten: "127.0.0.1:{self.ports[i]}"\nmax_payload: 2MB\n'
                f'jetstream {{ store_dir: "{self.folder}/store{i}" }}\n{cluster if count > 1 else ""}\n{mapping}\n{extra}\n')

    def file(self, i):
        return self.folder / f"s{i}.conf"

    @property
    def url(self):
        return ",".join(f"nats://127.0.0.1:{port}" for port in self.ports[:self.count])

    def start(self, i=None):
        for number in range(self.count) if i is None else [i]:
            with open(self.folder / f"s{number}.log", "a") as log:
                self.processes[number] = subprocess.Popen([SERVER, "-c", str(self.file(number))], stderr=log, stdout=log)
        return self

    def reload(self, i=0):
        """Makes the server read its configuration again."""
        self.processes[i].send_signal(signal.SIGHUP)

    def kill(self, i=0, with_signal=signal.SIGKILL):
        self.processes[i].send_signal(with_signal)
        if with_signal == signal.SIGKILL:
            self.processes[i].wait()

    def wait(self, timeout_s=30):
        """Waits until JetStream answers."""
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            try:
                with Client(self.url, timeout_s=2, **self.access) as client:
                    if "error" not in client.api("INFO", {}):
                        return self
            except (OSError, TimeoutError):
                pass
            time.sleep(0.1)
        raise AssertionError("the servers do not come up: " + (self.folder / "s0.log").read_text()[-2000:])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.processes:
            if process is not None:
                process.kill()
                process.wait()


Message = collections.namedtuple("Message", "subject reply headers payload")


class Client:
    """The part of the protocol that tests need: publish, subscribe, request. Uses any server that is up. `tls`: an
    ssl.SSLContext. `login`: returns the fields of CONNECT, given the server's INFO."""

    def __init__(self, url, timeout_s=10, tls=None, login=None):
        self.url, self.timeout_s = url, timeout_s
        error = None
        for address in url.split(","):
            host, port = address.removeprefix("nats://").split(":")
            try:
                self.socket = socket.create_connection((host, int(port)), timeout=timeout_s)
                break
            except OSError as refused:
                error = refused
        else:
            raise error
        self.file = self.socket.makefile("rb")
        self.inbox = f"_INBOX.{os.getpid()}x{id(self)}"
        self.sids, self.kept = 0, collections.deque()
        info = json.loads(self.file.readline().removeprefix(b"INFO "))
        if tls is not None:
            self.socket = tls.wrap_socket(self.socket, server_hostname=host)
            self.file = self.socket.makefile("rb")
        said = {"verbose": False, "pedantic": False, "headers": True, "no_responders": True, "lang": "test", "version": "1",
                "protocol": 1} | (login(info) if login else {})
        self.write(b"CONNECT " + json.dumps(said).encode() + b"\r\nPING\r\n")
        self.subscribe(self.inbox + ".*")
        self.requests = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.file.close()
        self.socket.close()

    def write(self, data):
        self.socket.sendall(data)

    def subscribe(self, subject):
        self.sids += 1
        self.write(f"SUB {subject} {self.sids}\r\n".encode())

    def publish(self, subject, payload=b"", reply="", headers=None):
        if isinstance(subject, str):
            subject = subject.encode()
        if headers is None:
            self.write(b"PUB %s %s %d\r\n%s\r\n" % (subject, reply.encode(), len(payload), payload))
        else:
            block = ("NATS/1.0\r\n" + "".join(f"{k}: {v}\r\n" for k, v in headers.items()) + "\r\n").encode()
            self.write(b"HPUB %s %s %d %d\r\n%s%s\r\n" % (subject, reply.encode(), len(block), len(block) + len(payload),
                                                        block, payload))

    def _read(self):
        """Returns the next message; None after the timeout."""
        while True:
            try:
                line = self.file.readline()
            except TimeoutError:
                # A timed-out file object reads no more: a new one, nothing of a line was taken.
                self.file = self.socket.makefile("rb")
                return None
            if not line:
                raise ConnectionError("the server has gone")
            if line.startswith(b"PING"):
                self.write(b"PONG\r\n")
            elif line.startswith(b"-ERR"):
                raise ConnectionError(line.decode())
            elif line.startswith((b"MSG", b"HMSG")):
                words = line.split()
                has_headers = words[0] == b"HMSG"
                sizes = [int(word) for word in words[-(2 if has_headers else 1):]]
                named = words[3:-len(sizes)]
                body = self.file.read(sizes[-1] + 2)[:-2]
                headers = {}
                if has_headers:
                    lines = body[:sizes[0]].decode("latin-1").split("\r\n")
                    headers = {"status": lines[0][8:].strip()} if lines[0][8:].strip() else {}
                    headers |= dict(line.split(":", 1) for line in lines[1:] if ":" in line)
                    headers = {key: value.strip() for key, value in headers.items()}
                    body = body[sizes[0]:]
                return Message(words[1].decode(), named[0].decode() if named else "", headers, body)

    def receive(self, timeout_s=None):
        if self.kept:
            return self.kept.popleft()
        self.socket.settimeout(self.timeout_s if timeout_s is None else max(timeout_s, 1e-3))
        return self._read()

    def request(self, subject, payload=b"", headers=None):
        self.requests += 1
        reply = f"{self.inbox}.{self.requests}"
        self.publish(subject, payload, reply, headers)
        self.socket.settimeout(self.timeout_s)
        while (message := self._read()) is not None:
            if message.subject == reply:
                return message
            self.kept.append(message)
        raise TimeoutError(f"{subject}: no answer")

    def api(self, subject, body=None):
        answer = self.request("$JS.API." + subject, json.dumps(body).encode() if body is not None else b"")
        return json.loads(answer.payload) if answer.payload else {"error": answer.headers}

    def stream(self, name, filter_subject="", batch=500):
        """Returns all messages of a stream in order, with their sequence numbers."""
        config = {"deliver_policy": "all", "ack_policy": "none", "inactive_threshold": 30_000_000_000}
        if filter_subject:
            config["filter_subject"] = filter_subject
        made = self.api(f"CONSUMER.CREATE.{name}", {"stream_name": name, "config": config})
        assert "error" not in made, made
        left = made["num_pending"]
        found = []
        while left > 0:
            self.requests += 1
            reply = f"{self.inbox}.{self.requests}"
            take = min(left, batch)
            self.publish(f"$JS.API.CONSUMER.MSG.NEXT.{name}.{made['name']}",
                         json.dumps({"batch": take, "expires": 5_000_000_000}).encode(), reply)
            for _ in range(take):
                self.socket.settimeout(self.timeout_s)
                while (message := self._read()) is not None:
                    if message.reply.startswith("$JS.ACK.") or message.headers.get("status"):
                        break
                    self.kept.append(message)
                if message is None or message.headers.get("status"):
                    raise AssertionError(f"{name}: {left} messages do not come: {message and message.headers}")
                found.append((int(message.reply.split(".")[-4]), message))
                left -= 1
        self.api(f"CONSUMER.DELETE.{name}.{made['name']}")
        return found


def start_gateway(bus, url, name, *arguments):
    """Starts a gateway. Appends its log to process.log_path."""
    path = bus.folder / f"{name}.log"
    with open(path, "a") as log:
        gateway = bus.start(GATEWAY, "--plant", url, "--name", name, *arguments, stderr=log)
    gateway.log_path = path
    return gateway


def recogniser(bus, url, name, places, *arguments):
    """Starts a gateway that takes places, with a folder for its nodes' endpoints."""
    folder = bus.folder / name
    folder.mkdir(exist_ok=True)
    taken = [word for place in places for word in ("--take", place)]
    node = () if "--node" in arguments else ("--node", NODE)
    return start_gateway(bus, url, name, *node, "--run-folder", folder, *taken, *arguments)


# What a gateway can carry up; by default not the recognitions.
EVERY_KIND = ("--carry", "contact", "--carry", "recognition", "--carry", "status")


def carrier(bus, url, name, cell, endpoint, *arguments):
    """Starts a gateway that forwards a cell's messages to the plant."""
    return start_gateway(bus, url, name, "--from", endpoint, "--cell", cell, "--spool", bus.folder / f"{name}.spool",
                         *arguments)


def gateway_status(client, cell, name, timeout_s=5):
    """Returns its next status."""
    with Client(client.url) as listener:
        listener.subscribe(f"palpate.{cell}.gateway.{name}")
        message = listener.receive(timeout_s)
        if message is None:
            raise AssertionError(f"{name} says nothing")
        status = gateway_status_pb2.GatewayStatus()
        status.ParseFromString(message.payload)
        return status


def wait_for_stored(client, stream, count, timeout_s=30):
    deadline = time.monotonic() + timeout_s
    state = {}
    while time.monotonic() < deadline:
        answer = client.api(f"STREAM.INFO.{stream}")
        state = answer.get("state", answer)
        if state.get("messages", 0) >= count:
            return state
        time.sleep(0.05)
    raise AssertionError(f"{stream}: {state}, expected {count} messages")


class Ledger:
    """The messages that the plant holds of a cell: contacts by their position in the stream, and the answers that cover them."""

    def __init__(self, client, cell):
        self.contacts = {}   # (group, stream_seq): ContactBatch
        self.answers = {}    # group: [(from, through, begin, Recognition, seconds since 1970)]
        cell = cell.replace(".", "=2E")
        for seq, message in client.stream(f"palpate-{cell}-contact"):
            batch = contact_pb2.ContactBatch()
            batch.ParseFromString(message.payload)
            group = batch.group or batch.header.source
            self.contacts[group, seq] = batch
        for _, message in client.stream(f"palpate-{cell}-recognition"):
            answer = recognition_pb2.Recognition()
            answer.ParseFromString(message.payload)
            if "Palpate-From" not in message.headers:
                continue  # the cell's own node's
            numbers = [int(message.headers[f"Palpate-{name}"]) for name in ("From", "Through", "Begin")]
            stored_s = int(message.reply.split(".")[-2]) * 1e-9
            self.answers.setdefault(answer.group, []).append((*numbers, answer, stored_s))

    def sent_once(self, test, sent):
        """Checks that all batches are stored once and in order. `sent`: {probe: number of batches}, of one epoch each."""
        found = {}
        for (_, _), batch in sorted(self.contacts.items(), key=lambda item: item[0][1]):
            found.setdefault(batch.header.source, []).append(batch.header.seq)
        test.assertEqual({probe: list(range(count)) for probe, count in sent.items()}, found)

    def answered_once(self, test):
        """Checks that every contact is covered by exactly one answer: the spans of a group follow each other and name its
        contacts, and the newest contact of an answer is the one that it states, of its object. Returns {(group, seq):
        (answer, time of storing)}."""
        held = {}
        for group, answers in self.answers.items():
            last = 0
            for begin_span, through, begin, answer, stored_s in answers:
                test.assertGreater(begin_span, last, group)
                test.assertGreaterEqual(through, begin_span)
                test.assertLessEqual(begin, through)
                newest = self.contacts[group, through]
                test.assertEqual((answer.newest_batch_source, answer.newest_batch_epoch, answer.newest_batch_seq),
                                 (newest.header.source, newest.header.epoch, newest.header.seq))
                for (name, seq), batch in self.of_group(group, last + 1, through):
                    test.assertGreaterEqual(seq, begin_span, "a contact between two answers")
                    test.assertEqual(batch.object, answer.object)
                    test.assertNotIn((name, seq), held)
                    held[name, seq] = answer, stored_s
                # All samples of the object up to there, whoever recognised them.
                samples = sum(len(batch.samples) for _, batch in self.of_group(group, begin, through)
                              if batch.object == answer.object)
                test.assertEqual(answer.sample_count, samples, (group, begin, through))
                last = through
        test.assertEqual(len(held), len(self.contacts), "contacts without an answer: "
                         f"{sorted(set(self.contacts) - set(held))[:5]}")
        return held

    def of_group(self, group, first, last):
        if not hasattr(self, "_by_group"):
            self._by_group = {}
            for key in sorted(self.contacts, key=lambda key: key[1]):
                self._by_group.setdefault(key[0], []).append(key)
        return [(key, self.contacts[key]) for key in self._by_group.get(group, []) if first <= key[1] <= last]

    def last_answers(self):
        """Returns {(group, object): its last answer}."""
        return {(group, answer.object): answer for group, answers in self.answers.items()
                for _, _, _, answer, _ in answers}
