"""Runs node, simulator and clients on private endpoints, for the process tests."""
import json
import math
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time

import zmq
from palpate.v1 import contact_pb2, node_status_pb2, recognition_pb2
from programs import NODE, SIM, TOOL


class Bus:
    """A temporary folder with ipc endpoints (or tcp ports chosen by the system). Kills remaining processes at the end."""

    def __init__(self, transport="ipc"):
        self._folder = tempfile.TemporaryDirectory(prefix="palpate-")
        self.folder = pathlib.Path(self._folder.name)
        self.transport = transport
        self.contacts = f"ipc://{self.folder}/contacts"
        self.results = f"ipc://{self.folder}/results"
        if transport == "tcp":
            self.contacts = self.results = "tcp://127.0.0.1:*"
        self.processes = []
        self.context = zmq.Context()
        self.logs = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.processes:
            if process.poll() is None:
                process.kill()
            process.wait()
        self.context.destroy(linger=0)
        self._folder.cleanup()

    def start(self, program, *arguments, **options):
        # Without the tests' own variables: a node warns of those that it does not read.
        own = ("PALPATE_BUILD", "PALPATE_SOURCE")
        options.setdefault("env", {name: value for name, value in os.environ.items() if name not in own})
        process = subprocess.Popen([str(program), *map(str, arguments)], text=True, **options)
        self.processes.append(process)
        return process

    def start_node(self, *arguments, **options):
        """Starts a node and waits until its sockets are open. Its log is node.log_path."""
        self.logs += 1
        path = self.folder / f"node-{self.logs}.log"
        with open(path, "w") as log:
            node = self.start(NODE, "--contacts", self.contacts, "--results", self.results, *arguments,
                              stderr=log, **options)
        node.log_path = path
        deadline = time.monotonic() + 10
        while time.monotonic() < deadline:
            found = re.search(r"contacts on (\S+), results on ([^\s,]+)", path.read_text())
            if found:
                # The ports that the system chose; a restarted node uses them again.
                self.contacts, self.results = found.groups()
                return node
            if node.poll() is not None:
                break
            time.sleep(0.002)
        raise AssertionError("the node does not start: " + path.read_text())

    def simulate(self, *arguments, timeout=60):
        """Plays scenes with palpate-sim until it ends."""
        subprocess.run([str(SIM), "--contacts", self.contacts, "--quiet", *map(str, arguments)],
                       check=True, timeout=timeout)

    def subscriber(self, *topics, high_water_mark=1000):
        socket = self.context.socket(zmq.SUB)
        socket.setsockopt(zmq.RCVHWM, high_water_mark)
        socket.setsockopt(zmq.RECONNECT_IVL, 10)
        socket.setsockopt(zmq.LINGER, 0)
        for topic in topics or ("recognition/",):
            socket.setsockopt_string(zmq.SUBSCRIBE, topic)
        socket.connect(self.results)
        return socket

    def publisher(self, high_water_mark=1000):
        """The socket of a probe, once the node listens (an XPUB receives the node's subscription)."""
        socket = self.context.socket(zmq.XPUB)
        socket.setsockopt(zmq.SNDHWM, high_water_mark)
        # A restarted node subscribes again over the same pipe; report that too.
        socket.setsockopt(zmq.XPUB_VERBOSE, 1)
        socket.setsockopt(zmq.RECONNECT_IVL, 10)
        socket.setsockopt(zmq.LINGER, 0)
        socket.connect(self.contacts)
        if not socket.poll(5000):
            raise AssertionError("no recognizer listens")
        socket.recv()
        return socket


def receive_any(socket, timeout_s):
    """Returns the next message as (topic, payload); None after the timeout."""
    return socket.recv_multipart() if socket.poll(int(1000 * timeout_s)) else None


def receive(socket, timeout_s):
    """Returns the next result as a protobuf message; None after the timeout."""
    if not socket.poll(int(1000 * timeout_s)):
        return None
    topic, payload = socket.recv_multipart()
    kind = {b"recognition": recognition_pb2.Recognition,
            b"status": node_status_pb2.NodeStatus}[topic.split(b"/")[0]]
    message = kind()
    message.ParseFromString(payload)
    return message


def wait_for(socket, accept, timeout_s=10):
    """Returns the first result that the predicate accepts."""
    deadline = time.monotonic() + timeout_s
    last = None
    while time.monotonic() < deadline:
        message = receive(socket, max(0.0, deadline - time.monotonic()))
        if message is None:
            break
        last = message
        if accept(message):
            return message
    raise AssertionError(f"nothing acceptable within {timeout_s} s; the last: {last}")


class Probe:
    """A probe that strokes a circle of 20 mm radius around (0.3, 0.1)."""

    def __init__(self, socket, name="finger", group="", epoch=1):
        self.socket, self.name, self.group, self.epoch = socket, name, group, epoch
        self.seq = 0

    def batch(self, first, count=10, object_number=1, patch=0, radius=0.02, step=0.01):
        message = contact_pb2.ContactBatch(group=self.group, object=object_number, patch=patch)
        message.header.source = self.name
        message.header.epoch = self.epoch
        message.header.seq = self.seq
        message.header.stamp_ns = time.time_ns()
        self.seq += 1
        for i in range(first, first + count):
            # Repeatable noise of 2e-5 m.
            wobble = 2e-5 * math.sin(12.9898 * i) * math.sqrt(2)
            sample = message.samples.add()
            sample.x_m = 0.3 + (radius + wobble) * math.cos(step * i)
            sample.y_m = 0.1 + (radius + wobble) * math.sin(step * i)
            sample.sigma_m = 2e-5
            sample.stamp_ns = time.time_ns()
        return message

    def send(self, message):
        self.socket.send_multipart([f"contact/{self.name}/".encode(), message.SerializeToString()])

    def stroke(self, batches=20, **options):
        for number in range(batches):
            self.send(self.batch(10 * number, **options))


def latency_s(probe, planner, object_number, timeout_s=60):
    """Seconds until a planner has the answer to a new object's first batch."""
    start = time.monotonic()
    probe.send(probe.batch(0, 20, object_number=object_number))
    wait_for(planner, lambda m: hasattr(m, "curve_class") and m.object == object_number, timeout_s)
    return time.monotonic() - start


def errors_in_sigmas(answer, truth):
    """Errors of parameters and pose, in published standard deviations. `truth`: a SceneTruth in JSON."""
    names = [name for name in "abc" if name in truth.get("parameters", {})]
    found = [getattr(answer.parameters, name) for name in names]
    true = [truth["parameters"][name] for name in names]
    pose = truth.get("pose", {})
    found += [answer.pose.x_m, answer.pose.y_m, answer.pose.theta_rad]
    true += [pose.get(name, 0.0) for name in ("x_m", "y_m", "theta_rad")]
    n = len(found)
    errors = []
    for i in range(n):
        error = found[i] - true[i]
        if i == n - 1:
            error = math.remainder(error, math.pi if answer.pose_symmetry == 2 else 2 * math.pi)
        sigma = math.sqrt(answer.covariance[i * n + i])
        if sigma > 0:  # 0: free, as a circle's theta
            errors.append(error / sigma)
    return errors


def memory_kb(process, of="VmRSS"):
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    return int(re.search(rf"{of}:\s+(\d+)", status).group(1))


def peak_memory_kb(process):
    return memory_kb(process, "VmHWM")


def stop(process, with_signal=signal.SIGTERM, timeout=5):
    """Stops a process by a signal. Returns its exit code and the seconds it took."""
    start = time.monotonic()
    process.send_signal(with_signal)
    code = process.wait(timeout)
    return code, time.monotonic() - start


def wait_for_log(process, text, timeout_s=10):
    """Waits until this text is in its log (process.log_path)."""
    deadline = time.monotonic() + timeout_s
    while text not in process.log_path.read_text():
        if time.monotonic() > deadline:
            raise AssertionError(f"no \"{text}\" in {process.log_path.read_text()}")
        time.sleep(0.01)
