"""Limits that hold before and after hello, whatever carries the bytes: memory, rates, connections, guesses, the log."""

import http.client
import json
import os
import socket
import struct
import subprocess
import tempfile
import time
import unittest

from server import LUMULUS, SCENE, Server, ServiceTest
from raw_websocket import CLOSE, WebSocket
from lumulus_client import ERROR, HEADER, MAGIC, REPLY, TYPES, Client, ServiceError

TOKEN = "correct horse battery staple"


def connect(address):
    host, port = address.rsplit(":", 1)
    connection = socket.create_connection((host, int(port)), 20)
    return connection


def message(kind, request, fields=None, payload=b"", json_bytes=None, payload_bytes=None):
    text = json.dumps(fields or {}).encode()
    return HEADER.pack(MAGIC, 1, TYPES[kind], request, len(text) if json_bytes is None else json_bytes, 0,
                       len(payload) if payload_bytes is None else payload_bytes) + text + payload


def reply(data):
    """(type, id, JSON) of a message."""
    _, _, kind, request, size, _, _ = HEADER.unpack(data[:HEADER.size])
    return kind, request, json.loads(data[HEADER.size:HEADER.size + size])


def received(connection):
    """All that comes until the server ends the connection, and whether it did so in order."""
    data = b""
    try:
        while part := connection.recv(65536):
            data += part
    except ConnectionError:
        return data, False
    return data, True


class Memory(ServiceTest):
    options = {"limits": "requests_per_second = 1000000\nwrite_seconds = 1\nwrite_kilobytes_per_second = 64\n"
                         "memory_megabytes = 256\nhello_seconds = 20"}

    def test_strangers_cost_little(self):
        with self.server.client() as client:  # what grows with the first connection is there
            client.ping()
        before, strangers = self.server.memory(), []
        try:
            for number in range(32):
                if number % 4 == 0:  # a message that lacks its last byte
                    strangers.append(connect(self.server.tcp))
                    strangers[-1].sendall(message("hello", 1, json_bytes=4096)[:HEADER.size] + b" " * 4095)
                elif number % 4 == 1:  # the same in a WebSocket
                    strangers.append(WebSocket(self.server.http))
                    strangers[-1].begin(65536)
                    strangers[-1].socket.sendall(message("hello", 1, json_bytes=4096)[:HEADER.size] + b" " * 4095)
                elif number % 4 == 2:  # a header of HTTP that does not end
                    strangers.append(connect(self.server.http))
                    strangers[-1].sendall(b"GET / HTTP/1.1\r\nX: " + b"y" * 8000)
                else:  # a page that nobody reads
                    strangers.append(connect(self.server.http))
                    strangers[-1].sendall(b"GET /viewer.js HTTP/1.1\r\nHost: localhost\r\n\r\n")
            with self.server.client() as client:  # all of it has come
                client.ping()
            self.assertLess(self.server.memory() - before, 8e6)
        finally:
            for stranger in strangers:
                getattr(stranger, "socket", stranger).close()

    def test_strangers_send_little(self):
        for fields in ({"json_bytes": 65537}, {"payload_bytes": 1}, {"json_bytes": 4097}):
            with connect(self.server.tcp) as stranger:
                stranger.sendall(message("hello", 7, **fields)[:HEADER.size])
                kind, request, body = reply(received(stranger)[0])
                self.assertEqual((kind, request, body["code"]), (ERROR, 7, "too_large"))
        with WebSocket(self.server.http) as stranger:
            stranger.begin((64 << 10) + 1)
            last, kind, payload = stranger.frame()
            self.assertEqual((kind, struct.unpack(">H", payload[:2])[0]), (CLOSE, 1009))

    def hello(self, connection):
        connection.send(message("hello", 1))
        self.assertEqual(reply(connection.message())[0], TYPES["hello"] | REPLY)

    def test_a_message_of_a_websocket_is_read_in_pieces(self):
        """A WebSocket's message of 40,000 pings: answered a few at a time, as the client reads, others meanwhile."""
        count = 40000
        pings = b"".join(message("ping", number + 2) for number in range(count))
        with WebSocket(self.server.http) as crowd, self.server.client() as other:
            self.hello(crowd)
            before = self.server.memory()
            crowd.begin(len(pings))
            crowd.socket.setblocking(False)
            sent, answers, data = 0, 0, b""
            while answers < count:
                try:
                    sent += crowd.socket.send(pings[sent:sent + 65536])
                except BlockingIOError:
                    pass
                try:
                    data = data[-3:] + crowd.socket.recv(1 << 20)  # a piece may end within the four letters
                    answers += data.count(b"LMLS")
                except BlockingIOError:
                    pass
                if answers % 1000 == 0:
                    other.ping()
            self.assertEqual(answers, count)
            self.assertLess(self.server.memory() - before, 16e6)

    def test_limits_hold_within_a_message_of_a_websocket(self):
        with WebSocket(self.server.http) as client:
            self.hello(client)
            upload = message("upload", 9, {"hash": "a" * 64, "size": 1, "offset": 0}, payload_bytes=65 << 20)
            client.send(message("ping", 5) + upload)
            self.assertEqual(reply(client.message())[:2], (TYPES["ping"] | REPLY, 5))
            self.assertEqual(reply(client.message())[2]["code"], "too_large")

    def test_a_slow_reader_is_told_by_its_bytes(self):
        with self.server.client() as slow, self.server.client() as other:
            slow.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            slow.start_stream(width=640, height=480, max_rate=1000, budget={"photons": 0}, encoding="float")
            started = time.monotonic()
            while not any(e["event"] == "disconnected" and e["why"] == "does not read" for e in self.server.log):
                self.assertLess(time.monotonic() - started, 30)
                try:
                    slow.socket.recv(16)  # a sign of life, and no more
                except ConnectionError:
                    pass
                other.ping()
                time.sleep(0.05)

    def test_what_there_is_no_memory_for_is_refused(self):
        with self.server.client() as client, self.server.client() as other:
            with self.assertRaises(ServiceError) as caught:  # 8 Mpixel hold over half a GB until they are encoded
                client.frame(width=3840, height=2160)
            self.assertEqual(caught.exception.code, "busy")
            self.assertTrue(other.frame(width=64, height=48).verify())
            counters = client.statistics()
            self.assertEqual(counters["memory_limit_bytes"], 256 << 20)
            self.assertGreater(counters["memory_refusals_total"], 0)
            self.assertGreater(counters["memory_scenes_bytes"], 1 << 20)
            self.assertLess(counters["memory_bytes"], 256 << 20)
        connection = http.client.HTTPConnection(self.server.http, timeout=10)
        connection.request("GET", "/metrics")
        text = connection.getresponse().read().decode()
        connection.close()
        self.assertIn("lumulus_memory_limit_bytes 268435456", text)


class Listeners(ServiceTest):
    options = {"limits": "connections = 3\nhttp_connections = 3"}

    def test_http_does_not_starve_frames(self):
        crowd = [connect(self.server.http) for _ in range(3)]
        try:
            for connection in crowd:  # they are served
                connection.sendall(b"GET /health HTTP/1.1\r\nHost: localhost\r\n\r\n")
                self.assertIn(b"200 OK", connection.recv(4096))
            with connect(self.server.http) as one:
                one.sendall(b"GET /health HTTP/1.1\r\nHost: localhost\r\n\r\n")
                data, ended = received(one)
                self.assertTrue(data.startswith(b"HTTP/1.1 503 "), data)
                self.assertTrue(ended)
            with self.server.client() as client:
                self.assertTrue(client.frame(width=16, height=16).verify())
        finally:
            for connection in crowd:
                connection.close()

    def test_frames_do_not_starve_http(self):
        crowd = [self.server.client() for _ in range(3)]
        try:
            with self.assertRaises(ServiceError) as caught:
                self.server.client()
            self.assertEqual(caught.exception.code, "busy")
            with connect(self.server.http) as one:
                one.sendall(b"GET /ready HTTP/1.0\r\n\r\n")
                self.assertIn(b"200 OK", received(one)[0])
        finally:
            for client in crowd:
                client.close()


class Http(ServiceTest):
    def ask(self, data):
        with connect(self.server.http) as connection:
            connection.sendall(data)
            data, ended = received(connection)
            self.assertTrue(ended, data)
            return int(data.split()[1]) if data else None

    def test_what_is_no_request(self):
        for data in (b"nonsense\r\n\r\n", b"GET\r\n\r\n", b"GET / HTTP/9.9\r\nHost: localhost\r\n\r\n",
                     b"GET / HTTP/1.1\r\nHost localhost\r\n\r\n", b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n",
                     b"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: x\r\n\r\n",
                     b"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n"):
            self.assertEqual(self.ask(data), 400, data)
        self.assertEqual(self.ask(b"GET / HTTP/1.1\r\nX: " + b"y" * 20000), 431)
        self.assertEqual(self.ask(b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\n" + b"x" * 1000), 413)
        self.assertEqual(self.ask(b"DELETE / HTTP/1.0\r\nHost: localhost\r\n\r\n"), 405)

    def test_host_fields(self):
        self.assertEqual(self.ask(b"GET /health HTTP/1.0\r\n\r\n"), 200)
        self.assertEqual(self.ask(b"GET /health HTTP/1.1\r\nConnection: close\r\n\r\n"), 200)
        self.assertEqual(self.ask(b"GET /ready HTTP/1.0\r\n\r\n"), 200)
        for path in (b"/", b"/health", b"/metrics"):
            for second in (b"localhost", b"evil.example"):
                hosts = b"Host: localhost\r\nHost: " + second + b"\r\nConnection: close\r\n\r\n"
                self.assertEqual(self.ask(b"GET " + path + b" HTTP/1.1\r\n" + hosts), 400)
        self.assertEqual(self.ask(b"GET / HTTP/1.1\r\nConnection: close\r\n\r\n"), 400)
        self.assertEqual(self.ask(b"GET / HTTP/1.0\r\n\r\n"), 403)


class Guesses(unittest.TestCase):
    def test_wrong_tokens_are_slowed_down_and_logged(self):
        folder = tempfile.mkdtemp(prefix="lumulus-guesses-")
        with open(os.path.join(folder, "token"), "w") as file:
            file.write(TOKEN + "\n")
        server = Server(folder=folder, security='token_file = "token"', limits="token_guesses_per_second = 4")
        server.owns = True
        started = time.monotonic()
        for number in range(18):  # ten at once, and then four a second
            with self.assertRaises(ServiceError) as caught:
                server.client(token=f"guess {number}")
            self.assertEqual(caught.exception.code, "unauthorized")
        self.assertGreater(time.monotonic() - started, 1.9)
        # /metrics knows the same token, and asks the same guard
        for _ in range(4):
            connection = http.client.HTTPConnection(server.http, timeout=10)
            connection.request("GET", "/metrics", headers={"Authorization": "Bearer guess"})
            self.assertEqual(connection.getresponse().status, 401)
            connection.close()
        self.assertGreater(time.monotonic() - started, 2.9)
        with server.client(token=TOKEN) as client:
            self.assertEqual(client.statistics()["tokens_refused_total"], 22)
        self.assertEqual(server.stop(), 0)
        refused = [event for event in server.log if event["event"] == "token_refused"]
        self.assertEqual(len(refused), 22)
        self.assertTrue(all(event["from"].startswith("127.0.0.1:") for event in refused))


class BlockedLog(unittest.TestCase):
    def test_costs_lines_and_no_client(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "scenes"))
            with open(os.path.join(folder, "scenes", "small.toml"), "w") as file:
                file.write(SCENE)
            path = os.path.join(folder, "frames.sock")
            with open(os.path.join(folder, "service.toml"), "w") as file:
                file.write(f'[listen]\ntcp = ""\nhttp = ""\nunix = "{path}"\n[scenes]\nuploads = "uploads"\n'
                           'default = "small.toml"\n')
            process = subprocess.Popen([LUMULUS, "serve", "--config", file.name], stderr=subprocess.PIPE)
            try:
                deadline = time.monotonic() + 60
                while not os.path.exists(path):
                    self.assertLess(time.monotonic(), deadline)
                    time.sleep(0.05)
                for _ in range(600):  # nobody reads the pipe, which holds 64 KiB
                    Client("unix:" + path, timeout=30).close()
                with Client("unix:" + path, timeout=30) as client:
                    self.assertTrue(client.frame(width=16, height=16).verify())
                    statistics = client.statistics()
                    self.assertGreater(statistics["log_lines_lost_total"], 100)
                    self.assertLess(statistics["io_longest_handler_microseconds"], 10_000)
            finally:
                process.terminate()
                self.assertEqual(process.wait(30), 0)
                process.stderr.close()


if __name__ == "__main__":
    unittest.main()
