"""palpate view against requests that no page of its own makes. Needs no browser."""
import base64
import json
import os
import random
import socket
import subprocess
import time
import unittest
import urllib.request

from bus import Bus, Probe, memory_kb
from programs import TOOL
from view_process import start_view

REQUESTS = 10000


def exchange(port, request, timeout=5):
    """Sends bytes and gives what comes back until the other side has said all."""
    with socket.create_connection(("127.0.0.1", port), timeout=timeout) as connection:
        reply = b""
        try:
            connection.sendall(request)
            connection.shutdown(socket.SHUT_WR)
            while part := connection.recv(65536):
                reply += part
        except OSError:  # let go before all was said
            pass
        return reply


def status_of(reply):
    return int(reply.split(b" ", 2)[1]) if reply.startswith(b"HTTP/1.1 ") else None


def request_for(port, target="/", method="GET", host=None, **headers):
    lines = [f"{method} {target} HTTP/1.1", f"Host: {host or f'127.0.0.1:{port}'}"]
    lines += [f"{name.replace('_', '-')}: {value}" for name, value in headers.items()]
    return "\r\n".join([*lines, "Connection: close", "", ""]).encode("latin-1")


def open_feed(port, origin=None, host=None):
    """Asks for the live feed as a browser does; gives the socket and the first line of the answer."""
    connection = socket.create_connection(("127.0.0.1", port), timeout=5)
    host = host or f"127.0.0.1:{port}"
    headers = [f"GET /live HTTP/1.1", f"Host: {host}", "Upgrade: websocket", "Connection: Upgrade",
               "Sec-WebSocket-Version: 13", "Sec-WebSocket-Key: " + base64.b64encode(os.urandom(16)).decode()]
    if origin != "":
        headers.append(f"Origin: {origin or f'http://{host}'}")
    connection.sendall("\r\n".join([*headers, "", ""]).encode())
    reply = b""
    while b"\r\n\r\n" not in reply:
        part = connection.recv(1)
        if not part:
            break
        reply += part
    return connection, status_of(reply)


def frame(text):
    """A browser's text frame: masked."""
    mask = os.urandom(4)
    body = bytes(byte ^ mask[i % 4] for i, byte in enumerate(text.encode()))
    return bytes([0x81, 0x80 | len(body)]) + mask + body


def receive_frame(connection):
    """The server's next text frame; pings are passed over."""
    def exactly(count):
        got = b""
        while len(got) < count:
            part = connection.recv(count - len(got))
            if not part:
                raise EOFError
            got += part
        return got

    while True:
        first, size = exactly(2)
        if size == 126:
            size = int.from_bytes(exactly(2), "big")
        elif size == 127:
            size = int.from_bytes(exactly(8), "big")
        body = exactly(size)
        if first & 0x0F == 1:
            return json.loads(body)
        if first & 0x0F == 8:
            raise EOFError


class HostileView(unittest.TestCase):
    def start(self, bus):
        bus.start_node()
        view, url = start_view(bus)
        return view, int(url.rsplit(":", 1)[1])

    def test_the_page_is_served_with_a_strict_policy(self):
        with Bus() as bus:
            _, port = self.start(bus)
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/") as reply:
                policy = reply.headers["Content-Security-Policy"]
                self.assertIn(b"<title>palpate view</title>", reply.read())
            self.assertIn("default-src 'none'", policy)
            self.assertNotIn("unsafe", policy)
            for name in ("main.js", "style.css", "plane.js"):
                self.assertEqual(status_of(exchange(port, request_for(port, "/" + name))), 200)
            # Every other host that means this machine, with the right port.
            for host in (f"localhost:{port}", f"127.0.0.2:{port}", f"[::1]:{port}"):
                self.assertEqual(status_of(exchange(port, request_for(port, host=host))), 200, host)

    def test_other_sites_may_not_look_dns_rebinding_included(self):
        with Bus() as bus:
            _, port = self.start(bus)
            for host in ("evil.example", f"evil.example:{port}", f"127.0.0.1:{port + 1}", "127.0.0.1", "",
                         f"127.0.0.1.evil.example:{port}", f"localhost.evil:{port}", f"[::1:{port}", ":",
                         f"127.0.0.1:{port}:1", f"2130706433:{port}"):
                reply = exchange(port, request_for(port, host=host or " "))
                self.assertEqual(status_of(reply), 403, host)
                self.assertNotIn(b"<title>", reply)
            own = f"http://127.0.0.1:{port}"
            self.assertEqual(status_of(exchange(port, request_for(port, Origin=own))), 200)
            for origin in ("null", "http://evil.example", f"https://127.0.0.1:{port}", own + ".evil.example",
                           f"http://localhost:{port}"):
                self.assertEqual(status_of(exchange(port, request_for(port, Origin=origin))), 403, origin)
                connection, status = open_feed(port, origin=origin)
                connection.close()
                self.assertEqual(status, 403, origin)
            connection, status = open_feed(port, origin="")
            connection.close()
            self.assertEqual(status, 403)
            # Two hosts are one too many.
            twice = f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nHost: evil.example\r\n\r\n".encode()
            self.assertIn(status_of(exchange(port, twice)), (400, 403))

    def test_ten_thousand_hostile_requests_bring_errors_and_nothing_else(self):
        rng = random.Random(7)
        with Bus() as bus:
            view, port = self.start(bus)

            def noise(longest):
                return bytes(rng.randrange(256) for _ in range(rng.randrange(longest)))

            def hostile():
                kind = rng.randrange(7)
                if kind == 0:
                    return noise(300)
                if kind == 1:
                    path = rng.choice(["/../../etc/passwd", "/%2e%2e/x", "//", "/main.js/", "/samples/.csv",
                                       "/samples/a b.csv", "/samples/../x.csv", "/answer/%00.json", "*",
                                       "/answer/nobody.json", "/moments/a/b.json", "/moment/-1/x.json",
                                       "/moment/99999999999999999999/x.json", "/moment/1/nobody.json", "/live", "/" + "a" * rng.randrange(300), "/\x80"])
                    return request_for(port, path)
                if kind == 2:
                    return request_for(port, method=rng.choice(["POST", "PUT", "DELETE", "OPTIONS", "TRACE", "get",
                                                                "X" * 40]))
                if kind == 3:  # a body that nobody asked for, its length a lie or not
                    return (f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: "
                            f"{rng.choice(['5', '-1', '99999999999999999999', 'x'])}\r\n\r\n").encode() + noise(200)
                if kind == 4:
                    return request_for(port, **{f"H{i}": "v" * rng.randrange(400) for i in range(rng.randrange(60))})
                if kind == 5:
                    return (f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nTransfer-Encoding: chunked\r\n\r\n"
                            f"{rng.choice(['5', 'ffffffffffffffff', '-1'])}\r\n").encode() + noise(50)
                return request_for(port, "/live", Upgrade="websocket", Sec_WebSocket_Version="99",
                                   Origin=f"http://127.0.0.1:{port}", Sec_WebSocket_Key="x")

            exchange(port, request_for(port))
            before = memory_kb(view)
            statuses = {}
            for number in range(REQUESTS):
                request = hostile()
                status = status_of(exchange(port, request))
                statuses[status] = statuses.get(status, 0) + 1
                if status == 200:
                    # Only what asks for the page itself may get it.
                    self.assertTrue(request.startswith(b"GET / HTTP/1.1"), request)
                self.assertIn(status, (None, 200, 400, 403, 404, 405, 431), request)
            print(f"{REQUESTS} hostile requests: {statuses}, memory {before} to {memory_kb(view)} kB")
            self.assertIsNone(view.poll())
            self.assertLess(memory_kb(view) - before, 20_000)
            self.assertEqual(status_of(exchange(port, request_for(port))), 200)

    def test_slow_requests_keep_nobody_out(self):
        with Bus() as bus:
            _, port = self.start(bus)
            slow = [socket.create_connection(("127.0.0.1", port)) for _ in range(100)]
            for connection in slow:
                connection.sendall(b"GET / HTTP/1.1\r\nHo")
            self.assertEqual(status_of(exchange(port, request_for(port))), 200)
            # They are let go: the other side ends the connection.
            slow[0].settimeout(20)
            self.assertEqual(slow[0].recv(1), b"")
            for connection in slow:
                connection.close()

    def test_a_frozen_browser_costs_one_message_and_delays_nobody(self):
        with Bus() as bus:
            view, port = self.start(bus)
            probe = Probe(bus.publisher())
            probe.stroke()
            frozen = []
            for _ in range(20):
                connection, status = open_feed(port)
                self.assertEqual(status, 101)
                connection.sendall(frame(""))
                frozen.append(connection)
            awake, _ = open_feed(port)
            awake.sendall(frame("finger"))
            while "picture" not in receive_frame(awake):
                awake.sendall(frame("finger"))
            before = memory_kb(view)
            for number in range(300):
                probe.send(probe.batch(200 + 10 * number))
                time.sleep(0.005)
            deadline = time.monotonic() + 10
            counts = set()
            while time.monotonic() < deadline and 3200 not in counts:
                awake.sendall(frame("finger"))
                picture = receive_frame(awake).get("picture")
                if picture:
                    counts.add(picture["sampleCount"])
            self.assertIn(3200, counts)
            self.assertLess(memory_kb(view) - before, 10_000)
            # A frozen one that wakes is told how things are now, not what has happened.
            late = frozen[0]
            messages = [receive_frame(late)]
            late.sendall(frame("finger"))
            messages.append(receive_frame(late))
            self.assertEqual(messages[-1]["picture"]["sampleCount"], 3200)
            for connection in [*frozen, awake]:
                connection.close()

    def test_a_browser_that_talks_nonsense_is_let_go(self):
        with Bus() as bus:
            view, port = self.start(bus)
            for words in ("<script>", "a/b", "x" * 65, "\x00"):
                connection, status = open_feed(port)
                self.assertEqual(status, 101)
                connection.sendall(frame(words))
                with self.assertRaises((EOFError, ConnectionError), msg=words):
                    while True:
                        receive_frame(connection)
                connection.close()
            self.assertIsNone(view.poll())

    def test_an_address_that_others_can_reach_must_be_asked_for_aloud(self):
        for address in ("0.0.0.0:0", "[::]:0"):
            done = subprocess.run([TOOL, "view", "--listen", address], capture_output=True, text=True, timeout=10)
            self.assertEqual(done.returncode, 2)
            self.assertIn("--insecure", done.stderr)
        for address in ("8090", "example.org:80", "127.0.0.1:99999", "127.0.0.1:", "::1:80"):
            done = subprocess.run([TOOL, "view", "--listen", address], capture_output=True, text=True, timeout=10)
            self.assertEqual(done.returncode, 2, address)
        with Bus() as bus:
            bus.start_node()
            process = bus.start(TOOL, "view", "--results", bus.results, "--listen", "0.0.0.0:0", "--insecure",
                                stdout=subprocess.PIPE)
            line = process.stdout.readline()
            process.stdout.close()
            port = int(line.rsplit(":", 1)[1])
            self.assertEqual(status_of(exchange(port, request_for(port))), 200)
            # The port is taken now: said, and the exit code tells.
            _, again = start_view(bus)
            taken = subprocess.run([TOOL, "view", "--listen", f"127.0.0.1:{again.rsplit(':', 1)[1]}"],
                                   capture_output=True, text=True, timeout=10)
            self.assertEqual(taken.returncode, 1)
            self.assertIn("in use", taken.stderr)


if __name__ == "__main__":
    unittest.main()
