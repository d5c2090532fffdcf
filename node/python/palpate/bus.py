"""Clients of a running palpate-node: probes and planners. Needs pyzmq and protobuf."""
from __future__ import annotations

import fcntl
import operator
import os
import random
import re
import time
from typing import Iterator

import numpy as np
import zmq
from zmq.auth import load_certificate
from zmq.utils.monitor import recv_monitor_message

from palpate.v1 import contact_pb2, recognition_pb2

from . import _core
from .details import details, numbers
from .result import units

CONTACTS = "tcp://127.0.0.1:5581"
RESULTS = "tcp://127.0.0.1:5582"
# Of a message: a node accepts 1024 samples and 65,536 bytes by default; what is not samples takes less than 500 bytes.
_MOST_SAMPLES = 1000
_MOST_BYTES = 65_000
_MOST_OBJECT = (1 << 64) - 1  # greatest number of an object, as on the wire


def _secure(socket: zmq.Socket, secret_key: str | None, server_key: str | None) -> None:
    """Sets CURVE keys from certificate files, as `palpate keygen`, CZMQ and zmq.auth.create_certificates write them."""
    if secret_key is None and server_key is None:
        return
    if secret_key is None or server_key is None:
        raise ValueError("CURVE needs both secret_key and server_key")
    public, secret = load_certificate(secret_key)
    if secret is None:
        raise ValueError(f"{secret_key}: no secret key in it")
    socket.curve_publickey, socket.curve_secretkey = public, secret
    socket.curve_serverkey, _ = load_certificate(server_key)


def _name(what: str, name: str) -> str:
    """Raises ValueError for a name that the recognizer would reject."""
    if not re.fullmatch(r"[A-Za-z0-9_.-]{1,64}", name):
        raise ValueError(f"{what}: {name!r}: a name is 1 to 64 of A-Z a-z 0-9 _ . -")
    return name


def _object_number(value: int) -> int:
    """Raises ValueError for what is no number of an object."""
    try:
        number = operator.index(value)
    except TypeError:
        number = -1
    if not 0 <= number <= _MOST_OBJECT:
        raise ValueError(f"object: {value!r} is no whole number from 0 to {_MOST_OBJECT}")
    return number


def _address_of(endpoint: str) -> tuple[bool, str]:
    """Whether "bind:ADDRESS" or "connect:ADDRESS" binds, and the address. An address alone is connected to."""
    for word, binds in (("bind:", True), ("connect:", False)):
        if endpoint.startswith(word):
            return binds, endpoint[len(word):]
    return False, endpoint


def _path_lock(address: str) -> int | None:
    """Locks the file beside an ipc:// path until it is closed, as all of palpate's programs do: libzmq would take a bound path
    from its owner without a word."""
    path = address.removeprefix("ipc://")
    if path == address or path == "*" or path.startswith("@"):
        return None
    lock = os.open(path + ".lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(lock)
        raise OSError(f"cannot bind to {address}: another process has bound it") from None
    return lock


class _Peer:
    def __init__(self, kind: int, endpoint: str, secret_key: str | None, server_key: str | None) -> None:
        self._binds, self._address = _address_of(endpoint)
        self._lock: int | None = None
        if self._address.startswith("inproc://"):
            raise ValueError(f"{endpoint!r}: inproc:// reaches only within one process, and no recognizer is in this one; use ipc://PATH")
        self._context = zmq.Context()
        self._socket = self._context.socket(kind)
        self._socket.setsockopt(zmq.LINGER, 200)  # [ms] longest wait at the end if nobody listens
        self._socket.setsockopt(zmq.RECONNECT_IVL, 10)
        self._socket.setsockopt(zmq.TCP_KEEPALIVE, 1)
        self._socket.setsockopt(zmq.TCP_KEEPALIVE_IDLE, 1)  # [s]
        _secure(self._socket, secret_key, server_key)
        # libzmq reports a refusal only once and does not try again. A peer that disagrees on CURVE may close without one.
        self._refusals = self._socket.get_monitor_socket(zmq.EVENT_HANDSHAKE_FAILED_AUTH |
                                                         zmq.EVENT_HANDSHAKE_FAILED_PROTOCOL |
                                                         zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL |
                                                         zmq.EVENT_HANDSHAKE_SUCCEEDED)
        self._closed_in_a_row = 0
        self.endpoint = endpoint

    def _attach(self) -> None:
        """Binds or connects. Closes everything if that fails."""
        try:
            if self._binds:
                self._lock = _path_lock(self._address)
                self._socket.bind(self._address)
            else:
                self._socket.connect(self._address)
        except (OSError, zmq.ZMQError):
            self.close()
            raise

    def _wait(self, timeout: float) -> bool:
        """Waits for a message. False after timeout; raises ConnectionRefusedError if the recognizer refuses us."""
        poller = zmq.Poller()
        poller.register(self._socket, zmq.POLLIN)
        poller.register(self._refusals, zmq.POLLIN)
        end = time.monotonic() + timeout
        while True:
            ready = dict(poller.poll(max(0, int(1000 * (end - time.monotonic())))))
            if self._refusals not in ready:
                return bool(ready)
            self._hear(recv_monitor_message(self._refusals)["event"])

    def _hear(self, event: int) -> None:
        closed_in_a_row = 8  # a peer that starts or ends at that moment closes one or two
        why = ("and we do not agree on CURVE: one of us has keys and the other none, "
               "or the server key that we were given is not its own")
        if event == zmq.EVENT_HANDSHAKE_SUCCEEDED:
            self._closed_in_a_row = 0
            return
        if event == zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL:
            self._closed_in_a_row += 1
            if self._closed_in_a_row < closed_in_a_row:
                return
            why += "; or it takes no more peers"
        elif event == zmq.EVENT_HANDSHAKE_FAILED_AUTH:
            why = "refuses our key: it is not on its list of clients"
        raise ConnectionRefusedError(f"the recognizer at {self.endpoint} {why}")

    def close(self) -> None:
        """Closes the connection. Closing it again does nothing."""
        if self._socket.closed:
            return
        self._socket.disable_monitor()
        self._refusals.close()
        self._socket.close()
        self._context.term()
        if self._lock is not None:
            os.close(self._lock)

    def _check_open(self) -> None:
        if self._socket.closed:
            raise ValueError(f"the connection to {self.endpoint} is closed")

    def __enter__(self):
        return self

    def __exit__(self, *_) -> None:
        self.close()


class _Details:
    """Message fields of normals and covariances of so many points."""

    def __init__(self, count: int, normals: np.ndarray, normal_sigma: np.ndarray, covariances: np.ndarray) -> None:
        self._normals = normals
        self._sigmas = np.broadcast_to(normal_sigma, count) if normal_sigma.size else normal_sigma
        self._covariances = np.broadcast_to(covariances, (count, 2, 2)) if covariances.size else covariances

    def most_bytes(self) -> int:
        """Most bytes of a sample in a message (contact.proto)."""
        return 40 + (27 if self._normals.size else 0) + (27 if self._covariances.size else 0)

    def of(self, i: int) -> dict[str, float]:
        fields = {}
        if self._normals.size and self._normals[i].any():
            fields = {"normal_x": self._normals[i, 0], "normal_y": self._normals[i, 1], "normal_sigma_rad": self._sigmas[i]}
        if self._covariances.size:
            (xx, xy), (_, yy) = self._covariances[i]
            fields |= {"cov_xx_m2": xx, "cov_xy_m2": xy, "cov_yy_m2": yy}
        return fields


class Probe(_Peer):
    """A probe: publishes touched points to a recognizer.

        with palpate.Probe("finger", sigma=0.02, unit="mm") as probe:
            probe.send(points)
            probe.lift_off()

    Several probes of one object need the same group and the same number of the object:

        with palpate.Probe("left", group="hand", object=7) as left, palpate.Probe("right", group="hand", object=7) as right:
            ...
            left.new_object()
            right.new_object()
    """

    def __init__(self, name: str, endpoint: str = CONTACTS, group: str = "", sigma: float = 0.0, unit: str = "m",
                 tip_radius: float = 0.0, timeout: float = 10.0, secret_key: str | None = None,
                 server_key: str | None = None, *, object: int | None = None) -> None:
        """Connects and waits until a recognizer listens. Raises TimeoutError after `timeout` seconds,
        ConnectionRefusedError if the recognizer refuses our keys, OSError or zmq.ZMQError if an address cannot be bound or
        connected to, and ValueError for invalid arguments.

        name: of the probe, 1 to 64 of A-Z a-z 0-9 _ . -
        endpoint: an address, tcp://HOST:PORT or ipc://PATH. "bind:ADDRESS" binds it, and recognizers come
        (palpate-node --contacts connect:ADDRESS): then several may share this probe. The first one is waited for.
        group: probes of one group touch the same object; empty = the probe's own name. Another name needs `object`.
        sigma: standard deviation of a point, in `unit`; 0 = not known.
        unit: "m", "mm", "cm", "um", "nm" or "in"; of points, sigma and tip_radius.
        tip_radius: radius of a round tip whose centres the points are; 0 = points of the surface.
        secret_key, server_key: for CURVE, our secret key file and the recognizer's public one; both or neither.
        object: number of the object, 0 to 2^64 - 1. Probes of one group must be given the same one: the recognizer drops
        the samples of a probe that begins with another number while the others send. When a probe goes on to another
        number, a new object begins and the recognizer forgets the old one. None: the time in milliseconds, which suits
        a probe alone."""
        self._scale = units(unit)
        _name("name", name)
        if group:
            _name("group", group)
        if group not in ("", name) and object is None:
            raise ValueError(f"group: {group!r}: give object=NUMBER too, the same to all probes of the group; the recognizer "
                             "drops the samples of those whose number is another one")
        number = time.time_ns() // 1_000_000 if object is None else _object_number(object)
        for what, value in (("sigma", sigma), ("tip_radius", tip_radius)):
            if not 0 <= value < float("inf"):
                raise ValueError(f"{what}: must be finite and not below 0")
        _core.check_sendable_lengths(self._scale * sigma, self._scale * tip_radius)
        super().__init__(zmq.XPUB, endpoint, secret_key, server_key)
        self._topic = f"contact/{name}/".encode()
        self._sigma = sigma
        self._batch = batch = contact_pb2.ContactBatch()
        batch.header.source = name
        batch.header.epoch = random.getrandbits(64)
        batch.group = group
        batch.object = number
        batch.tip_radius_m = self._scale * tip_radius
        self._attach()
        try:
            if not self._wait(timeout):
                raise TimeoutError(f"no recognizer has come to {self._address} (palpate-node --contacts connect:{self._address})"
                                   if self._binds else f"no recognizer listens at {self._address} (palpate-node)")
        except OSError:
            self.close()
            raise
        self._socket.recv()

    def send(self, points, normals=None, normal_sigma=None, covariances=None) -> None:
        """Publishes points (n, 2) of the present patch, in their order along the part. normals, normal_sigma and
        covariances: see Recognizer.add. No points: nothing is sent. Never blocks; messages that the recognizer does not
        read in time are lost. Raises ValueError, and sends nothing, for invalid arguments, for values that a recognizer
        with its default limits would reject, and after close()."""
        self._check_open()
        points = numbers(points)
        points = points.reshape(0, 2) if points.shape == (0,) else np.atleast_2d(points)
        if points.ndim != 2 or points.shape[1] != 2 or not np.isfinite(points).all():
            raise ValueError("points must be finite, of shape (n, 2)")
        points = self._scale * points
        stated = details(normals, normal_sigma, covariances, self._scale)
        _core.check_sendable_points(points, *stated)
        said = _Details(len(points), *stated)
        most = min(_MOST_SAMPLES, _MOST_BYTES // said.most_bytes())  # samples of a message
        for start in range(0, len(points), most):
            del self._batch.samples[:]
            now = time.time_ns()
            for i, (x, y) in enumerate(points[start:start + most], start):
                self._batch.samples.add(stamp_ns=now, x_m=x, y_m=y, sigma_m=self._scale * self._sigma, **said.of(i))
            self._batch.header.stamp_ns = now
            self._socket.send_multipart([self._topic, self._batch.SerializeToString()])
            self._batch.header.seq += 1

    def lift_off(self) -> None:
        """Begins a new patch: call it at each lift-off."""
        self._batch.patch += 1

    @property
    def object(self) -> int:
        """Number of the present object."""
        return self._batch.object

    def new_object(self, number: int | None = None) -> None:
        """Begins a new object; the recognizer forgets the old one. Call it for every probe of a group: what the others
        still send of the old object is dropped.

        number: of the new object; None = the present one plus 1. Raises ValueError if it is not greater than the present
        one, or above 2^64 - 1."""
        number = _object_number(self.object + 1 if number is None else number)
        if number <= self.object:
            raise ValueError(f"object: {number} is not greater than the present one, {self.object}")
        self._batch.object = number
        self._batch.patch = 0


class Planner(_Peer):
    """A planner: receives the answers of a recognizer.

        with palpate.Planner() as planner:
            answer = planner.receive(timeout=5)    # a palpate.v1.Recognition
    """

    def __init__(self, endpoint: str = RESULTS, group: str | None = None, secret_key: str | None = None,
                 server_key: str | None = None) -> None:
        """Connects, or binds "bind:ADDRESS". group: the group whose answers are received; None = all. secret_key, server_key: see Probe."""
        if group is not None:
            _name("group", group)
        super().__init__(zmq.SUB, endpoint, secret_key, server_key)
        self._newest: dict[str, tuple[int, int]] = {}
        self._socket.setsockopt(zmq.SUBSCRIBE, b"recognition/" + (f"{group}/".encode() if group is not None else b""))
        self._attach()

    def receive(self, timeout: float = 10.0) -> recognition_pb2.Recognition:
        """Returns the next new answer (SI units); timeout 0: one that waits. Raises TimeoutError after `timeout` seconds and
        ConnectionRefusedError if the recognizer refuses our keys. Raises ValueError after close()."""
        self._check_open()
        deadline = time.monotonic() + timeout
        while True:
            if not self._wait(max(0.0, deadline - time.monotonic())):
                raise TimeoutError(f"no answer from {self.endpoint} within {timeout:g} s (palpate-node, a probe?)")
            frames = self._socket.recv_multipart()
            answer = recognition_pb2.Recognition.FromString(frames[1])
            stamp = (answer.header.epoch, answer.header.seq)
            if self._newest.get(answer.group) != stamp:  # else a repeat for late subscribers
                self._newest[answer.group] = stamp
                return answer

    def __iter__(self) -> Iterator[recognition_pb2.Recognition]:
        """Yields new answers; ends when none has come for ten seconds."""
        while True:
            try:
                yield self.receive()
            except TimeoutError:
                return
