#!/usr/bin/env python3
"""Example of a probe: publishes touched points. Replace `touch()` by your own driver.

Needs python3-zmq, python3-protobuf and the generated package on the path:
  PYTHONPATH=build/release/proto/python python3 node/examples/probe.py
"""
import argparse
import math
import random
import sys
import time

import zmq
from palpate.v1.contact_pb2 import ContactBatch
from zmq.auth import load_certificate


def touch():
    """Stands for a driver: yields points of an ellipse with half axes of 40 mm and 25 mm, one about every 0.5 mm."""
    for i in range(240):
        t = 0.4 + 0.012 * i
        yield 0.3 + 0.040 * math.cos(t), 0.1 + 0.025 * math.sin(t)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--endpoint", default="tcp://127.0.0.1:5581", help="the recognizer's contacts")
    parser.add_argument("--name", default="finger", help="this probe's name")
    parser.add_argument("--rate", type=float, default=200.0, help="samples a second")
    parser.add_argument("--curve-secret-key", metavar="FILE", help="CURVE: our own key (palpate keygen)")
    parser.add_argument("--curve-server-key", metavar="FILE", help="CURVE: the recognizer's public key")
    options = parser.parse_args()
    if (options.curve_secret_key is None) != (options.curve_server_key is None):
        parser.error("--curve-secret-key and --curve-server-key: give both or neither")

    socket = zmq.Context().socket(zmq.XPUB)
    socket.setsockopt(zmq.LINGER, 200)  # [ms] longest wait at exit if nobody listens
    socket.setsockopt(zmq.RECONNECT_IVL, 10)
    if options.curve_secret_key is not None:
        socket.curve_publickey, socket.curve_secretkey = load_certificate(options.curve_secret_key)
        socket.curve_serverkey, _ = load_certificate(options.curve_server_key)
    socket.connect(options.endpoint)
    print(f"waiting for a recognizer at {options.endpoint} (palpate-node)", file=sys.stderr)
    socket.recv()  # the recognizer's subscription; messages sent before it are lost

    batch = ContactBatch()
    batch.header.source = options.name
    batch.header.epoch = random.getrandbits(64)  # a new number shows that this probe has restarted
    batch.object = 1  # a new number = a new object
    batch.patch = 0  # add 1 at each lift-off
    topic = f"contact/{options.name}/".encode()
    for x, y in touch():
        sigma = 2e-5
        batch.samples.add(
            stamp_ns=time.time_ns(),
            x_m=random.gauss(x, sigma),
            y_m=random.gauss(y, sigma),
            sigma_m=sigma,
        )
        if len(batch.samples) == 10:
            batch.header.stamp_ns = time.time_ns()
            socket.send_multipart([topic, batch.SerializeToString()])
            batch.header.seq += 1
            del batch.samples[:]
        time.sleep(1.0 / options.rate)
    socket.close()


if __name__ == "__main__":
    main()
