#!/usr/bin/python3
"""How long a stream of three servers accepts no messages after its leader is killed. NATS alone, without our programs.

    PALPATE_SOURCE=$PWD PALPATE_BUILD=$PWD/build/strict \\
      PYTHONPATH=$PWD/tests/support:$PWD/build/strict/proto/python \\
      /usr/bin/python3 tests/bench/plant/election.py [--kills N]
"""
import argparse
import pathlib
import tempfile
import time

from plant import Client, Servers


def leader(url):
    with Client(url) as client:
        while True:
            info = client.api("STREAM.INFO.press").get("cluster", {})
            if info.get("leader") and all(replica.get("current") for replica in info["replicas"]):
                return int(info["leader"].removeprefix("s"))
            time.sleep(0.1)


def silence_s(servers):
    """Time from the kill to the next message stored."""
    dead = leader(servers.url)
    servers.kill(dead)
    killed = time.monotonic()
    others = ",".join(url for number, url in enumerate(servers.url.split(",")) if number != dead)
    with Client(others, timeout_s=0.1) as client:
        while True:
            try:
                if b'"seq"' in client.request("press.contact", b"x").payload:
                    break
            except TimeoutError:
                pass
    silent = time.monotonic() - killed
    servers.start(dead)
    return silent


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=10)
    kills = parser.parse_args().kills
    with tempfile.TemporaryDirectory() as name, Servers(pathlib.Path(name), 3) as servers:
        servers.start().wait(60)
        with Client(servers.url) as client:
            made = client.api("STREAM.CREATE.press", {"name": "press", "subjects": ["press.>"], "num_replicas": 3})
            assert "error" not in made, made
        times = sorted(silence_s(servers) for _ in range(kills))
        print(f"nats-server alone, {kills} leaders killed: silent for {times[0]:.1f} s at least, {times[kills // 2]:.1f} s at p50, "
              f"{times[-1]:.1f} s at worst")


if __name__ == "__main__":
    main()
