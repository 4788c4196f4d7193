"""Clients that mean no good: wrong tokens, names that climb, bombs, slow senders, too many of them."""

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
from lumulus_client import HEADER, MAGIC, TYPES, Client, ServiceError

TOKEN = "correct horse battery staple"


def connect(address):
    host, port = address.rsplit(":", 1)
    connection = socket.create_connection((host, int(port)), 20)
    connection.settimeout(20)
    return connection


def closed(connection):
    """Whether the server ends it."""
    try:
        while connection.recv(65536):
            pass
        return True
    except ConnectionError:
        return True
    except TimeoutError:
        return False


class Hostile(ServiceTest):
    options = {"security": 'token_file = "token"',
               "limits": "connections = 12\nhello_seconds = 1\nmessage_seconds = 2\nwrite_seconds = 2\nscenes = 2\n"
                         "token_guesses_per_second = 1000000"}  # limits_test.py has the usual number

    @classmethod
    def setUpClass(cls):
        folder = tempfile.mkdtemp(prefix="lumulus-hostile-")
        with open(os.path.join(folder, "token"), "w") as file:
            file.write(TOKEN + "\n")
        cls.server = Server(LUMULUS, folder=folder, **cls.options)
        cls.server.owns = True

    def client(self):
        return self.server.client(token=TOKEN)

    def refused(self, client, kind, fields=None, payload=b""):
        with self.assertRaises(ServiceError) as caught:
            client.ask(kind, fields, payload)
        return caught.exception.code

    def tearDown(self):
        # whatever was done to it, it serves
        deadline = time.monotonic() + 10
        while True:
            try:
                with self.client() as client:
                    self.assertTrue(client.frame(width=16, height=16).verify())
                    return
            except (OSError, ServiceError):  # busy, until those of the test are gone
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.1)

    def test_wrong_tokens_1000_times(self):
        for number in range(1000):
            with self.assertRaises(ServiceError) as caught:
                self.server.client(token=f"guess {number}")
            self.assertEqual(caught.exception.code, "unauthorized")

    def test_names_stay_in_their_folder(self):
        secret = os.path.join(self.server.folder, "secret.toml")
        self.server.write("secret.toml", SCENE)
        os.symlink(secret, os.path.join(self.server.folder, "scenes", "link.toml"))
        with self.client() as client:
            for name in ("../secret.toml", secret, "link.toml", "../service.toml", "/etc/passwd", "..", ".", "/",
                         "small.toml/../../secret.toml", "absent.toml", "small.toml\0.txt", "x" * 200):
                self.assertEqual(self.refused(client, "load_scene", {"name": name}), "not_found", name)
            for vdb in ("/etc/passwd", "../secret.toml", "../../../../../../etc/passwd", "link.toml", "absent.vdb"):
                text = SCENE.replace('procedural = "sphere"\nresolution = 24', f'vdb = "{vdb}"')
                with self.assertRaises(ServiceError) as caught:
                    client.load_scene(toml=text)
                self.assertIn("does not exist", str(caught.exception), vdb)
                self.assertEqual(self.refused(client, "load_scene",
                                              {"name": "small.toml", "set": [f'cloud.0.vdb="{vdb}"']}), "bad_request")

    def test_bombs(self):
        with self.client() as client:
            self.assertEqual(self.refused(client, "load_scene", {}, b"[" * 100000), "bad_request")
            self.assertEqual(self.refused(client, "load_scene", {}, b"a." * 100000 + b"b=1"), "bad_request")
            self.assertEqual(self.refused(client, "load_scene", {}, b"[image]\nwidth = 16384\nheight = 2048"),
                             "bad_request")
            self.assertEqual(self.refused(client, "load_scene", {}, b"[photon_map]\nphotons = 1e12\ngenerations = 1"),
                             "bad_request")
            text = b'{"a":' + b"[" * 30000
            client.socket.sendall(HEADER.pack(MAGIC, 1, TYPES["frame"], 9, len(text), 0, 0) + text)
            with self.assertRaises(ServiceError) as caught:
                client.wait(9)
            self.assertEqual(caught.exception.code, "bad_request")
        with self.client() as client:
            client.socket.sendall(HEADER.pack(MAGIC, 1, TYPES["frame"], 9, 2 ** 32 - 1, 0, 2 ** 64 - 1))
            self.assertEqual(client.receive()[2]["code"], "too_large")
            self.assertTrue(closed(client.socket))

    def test_sizes_and_cameras(self):
        with self.client() as client:
            for fields in ({"width": 0, "height": 0}, {"width": 1e9, "height": 1e9}, {"width": -5},
                           {"budget": {"milliseconds": -1}}, {"budget": {"photons": -1}},
                           {"camera": {"position": [float("nan"), 0, 0]}}, {"tile": [0, 0, 65, 48]},
                           {"camera": {"position": [0, 100, 0], "target": [0, 100, 0]}}):
                self.assertEqual(self.refused(client, "frame", fields), "bad_request", fields)
            for camera in ({"position": [1e9, -1e9, 1e9]}, {"position": [0, 100, 0], "target": [0, 101, 0]},
                           {"frustum": [-1e-9, 1e-9, 999, 1000]}):
                frame = client.frame(camera=camera, width=8, height=8)
                self.assertTrue(all(abs(x) < 1e6 for x in frame.values().flatten()), camera)

    def test_other_protocols_and_versions(self):
        for data in (b"GET / HTTP/1.1\r\nHost: x\r\n\r\n" + bytes(32), bytes(64), b"\xff" * 64,
                     HEADER.pack(MAGIC, 2, 1, 1, 0, 0, 0), HEADER.pack(MAGIC, 1, 1, 1, 0, 1, 0)):
            with connect(self.server.tcp) as connection:
                connection.sendall(data)
                self.assertTrue(closed(connection))

    def test_silent_and_slow_senders_are_ended(self):
        hello = json.dumps({"token": TOKEN}).encode()
        hello = HEADER.pack(MAGIC, 1, 1, 1, len(hello), 0, 0) + hello
        with connect(self.server.tcp) as silent, connect(self.server.tcp) as slow, connect(self.server.tcp) as half:
            half.sendall(hello + hello[:40])
            started = time.monotonic()
            ended = {}
            for number, byte in enumerate(hello):
                for name, connection in (("silent", silent), ("slow", slow), ("half", half)):
                    connection.settimeout(0.02)
                    if name not in ended and closed(connection):
                        ended[name] = time.monotonic() - started
                if len(ended) == 3 or time.monotonic() - started > 8:
                    break
                if "slow" not in ended:
                    try:
                        slow.sendall(bytes([byte]))
                    except OSError:
                        pass
                time.sleep(0.2)
            self.assertEqual(set(ended), {"silent", "slow", "half"})

    def test_who_never_reads_is_ended_and_costs_no_memory(self):
        with self.client() as lazy, self.client() as other:
            lazy.start_stream(width=1024, height=768, max_rate=1000, budget={"photons": 0}, encoding="float")
            started, peak = time.monotonic(), 0
            while not any(e["event"] == "disconnected" and e["why"] == "does not read" for e in self.server.log):
                other.frame(width=16, height=16)
                peak = max(peak, self.server.memory())
                self.assertLess(time.monotonic() - started, 30)
                time.sleep(0.05)
            self.assertLess(peak, self.server.memory() + 150e6)

    def test_too_many_connections(self):
        crowd = []
        try:
            for _ in range(12):
                crowd.append(self.client())
            with self.assertRaises(ServiceError) as caught:
                self.client()
            self.assertEqual(caught.exception.code, "busy")
        finally:
            for client in crowd:
                client.close()

    def test_too_many_scenes(self):
        with self.client() as one, self.client() as two:
            one.load_scene("small.toml", private=True)
            self.assertEqual(self.refused(two, "load_scene", {"name": "small.toml", "private": True}), "busy")
            self.assertTrue(two.frame(width=16, height=16).verify())

    def test_http(self):
        def get(path, **headers):
            connection = http.client.HTTPConnection(self.server.http, timeout=10)
            connection.request("GET", path, headers=headers)
            response = connection.getresponse()
            with response:
                text = response.read().decode()
            connection.close()
            return response.status, text

        self.assertEqual(get("/health"), (200, "ok\n"))
        self.assertIn("<canvas", get("/")[1])
        self.assertEqual(get("/../service.toml")[0], 404)
        self.assertEqual(get("/metrics")[0], 401)
        status, text = get("/metrics", Authorization="Bearer " + TOKEN)
        self.assertEqual(status, 200)
        self.assertIn("# TYPE lumulus_frames_total counter", text)
        self.assertEqual(get("/", Host="evil.example")[0], 403)
        upgrade = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13",
                   "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ=="}
        self.assertEqual(get("/frames", Origin="http://evil.example", **upgrade)[0], 403)
        with connect(self.server.http) as connection:
            connection.sendall(b"GET / HTTP/1.1\r\n" + b"X: " + b"y" * 100000)
            self.assertTrue(closed(connection))


class Binding(unittest.TestCase):
    def test_refuses_the_world_without_a_token(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "scenes"))
            path = os.path.join(folder, "service.toml")
            with open(path, "w") as file:
                file.write('[listen]\ntcp = "0.0.0.0:0"\n')
            result = subprocess.run([LUMULUS, "serve", "--config", path], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr.count("\n"), 1)
        self.assertIn("there is no token", result.stderr)


if __name__ == "__main__":
    unittest.main()
