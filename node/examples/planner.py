#!/usr/bin/env python3
"""Example of a planner: prints each recognised curve and where it lies.

Needs python3-zmq, python3-protobuf and the generated package on the path:
  PYTHONPATH=build/release/proto/python python3 node/examples/planner.py
"""
import argparse
import sys

import zmq
from palpate.v1 import recognition_pb2
from palpate.v1.curve_pb2 import CurveClass
from zmq.auth import load_certificate


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--endpoint", default="tcp://127.0.0.1:5582", help="the recognizer's results")
    parser.add_argument("--once", action="store_true", help="end with the first recognised object")
    parser.add_argument("--curve-secret-key", metavar="FILE", help="CURVE: our own key (palpate keygen)")
    parser.add_argument("--curve-server-key", metavar="FILE", help="CURVE: the recognizer's public key")
    options = parser.parse_args()
    if (options.curve_secret_key is None) != (options.curve_server_key is None):
        parser.error("--curve-secret-key and --curve-server-key: give both or neither")

    socket = zmq.Context().socket(zmq.SUB)
    socket.setsockopt(zmq.SUBSCRIBE, b"recognition/")  # or b"recognition/cup/" for one group
    socket.setsockopt(zmq.RECONNECT_IVL, 10)
    # Notices a cut cable. Not HEARTBEAT_IVL: with it, libzmq 4.3 can abort a reader that pauses.
    socket.setsockopt(zmq.TCP_KEEPALIVE, 1)
    socket.setsockopt(zmq.TCP_KEEPALIVE_IDLE, 1)  # [s]
    if options.curve_secret_key is not None:
        socket.curve_publickey, socket.curve_secretkey = load_certificate(options.curve_secret_key)
        socket.curve_serverkey, _ = load_certificate(options.curve_server_key)
    socket.connect(options.endpoint)

    print(f"listening to {options.endpoint} (palpate-node)", file=sys.stderr)

    newest = {}  # by group: (epoch, seq)
    while True:
        _, payload = socket.recv_multipart()
        answer = recognition_pb2.Recognition.FromString(payload)
        stamp = (answer.header.epoch, answer.header.seq)
        if newest.get(answer.group) == stamp:
            continue  # the recognizer repeats its latest answers for late subscribers
        newest[answer.group] = stamp

        name = CurveClass.Name(answer.curve_class).removeprefix("CURVE_CLASS_").lower()
        status = recognition_pb2.RecognitionStatus.Name(answer.status).rsplit("_", 1)[1].lower()
        line = f"{answer.group}: {status} {name}, {answer.sample_count} samples"
        if answer.HasField("pose"):
            sizes = {f.name: v for f, v in answer.parameters.ListFields()}
            pose = answer.pose
            line += "".join(f" {k}={v:.5g}" for k, v in sizes.items())
            line += f" at x={pose.x_m:.5f} m y={pose.y_m:.5f} m theta={pose.theta_rad:.4f} rad"
        print(line, flush=True)
        if options.once and answer.status == recognition_pb2.RECOGNITION_STATUS_RECOGNIZED:
            break


if __name__ == "__main__":
    main()
