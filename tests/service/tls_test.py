"""The documented proxy, configs/nginx-tls.conf: the protocol and the page through TLS."""

import os
import ssl
import subprocess
import tempfile
import time
import unittest
import urllib.request

from server import Server, ServiceTest
from lumulus_client import Client

HERE = os.path.dirname(os.path.abspath(__file__))


def free_ports(count):
    import socket
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class TlsClient(Client):
    """What a client adds for TLS: its socket is wrapped before it says hello."""

    def __init__(self, address, context):
        self.context = context
        super().__init__(address, timeout=30)

    def ask(self, kind, fields=None, payload=b""):
        if kind == "hello":
            self.socket = self.context.wrap_socket(self.socket, server_hostname="localhost")
        return super().ask(kind, fields, payload)


class Tls(ServiceTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = tempfile.TemporaryDirectory()
        certificate, key = (os.path.join(cls.folder.name, name) for name in ("certificate.pem", "key.pem"))
        subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", key, "-out", certificate,
                        "-days", "2", "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost"],
                       check=True, capture_output=True)
        cls.frames, cls.page = free_ports(2)
        with open(os.path.join(HERE, "..", "..", "configs", "nginx-tls.conf")) as file:
            text = file.read()
        for old, new in (("/etc/lumulus/certificate.pem", certificate), ("/etc/lumulus/key.pem", key),
                         ("listen 7790", f"listen 127.0.0.1:{cls.frames}"), ("listen 7791", f"listen 127.0.0.1:{cls.page}"),
                         ("127.0.0.1:7788", cls.server.tcp), ("127.0.0.1:7789", cls.server.http)):
            assert old in text, old
            text = text.replace(old, new)
        path = os.path.join(cls.folder.name, "nginx.conf")
        with open(path, "w") as file:
            file.write(text)
        cls.nginx = subprocess.Popen(["/usr/sbin/nginx", "-p", cls.folder.name, "-c", path, "-g",
                                      f"daemon off; pid {cls.folder.name}/pid; error_log stderr;"],
                                     stderr=subprocess.DEVNULL)
        cls.context = ssl.create_default_context(cafile=certificate)

    @classmethod
    def tearDownClass(cls):
        cls.nginx.terminate()
        cls.nginx.wait(10)
        cls.folder.cleanup()
        super().tearDownClass()

    def connect(self):
        deadline = time.monotonic() + 20
        while True:
            try:
                return TlsClient(f"127.0.0.1:{self.frames}", self.context)
            except ConnectionRefusedError:
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.1)

    def test_frames(self):
        with self.connect() as client, self.server.client() as plain:
            self.assertEqual(client.frame().info["hash"], plain.frame().info["hash"])
            stream = client.start_stream(width=320, height=180)
            for _ in range(3):
                self.assertTrue(client.next_frame(stream).verify())

    def test_the_page(self):
        self.connect().close()
        with urllib.request.urlopen(f"https://localhost:{self.page}/health", context=self.context, timeout=20) as reply:
            self.assertEqual(reply.read(), b"ok\n")

    def test_without_tls_there_is_nothing(self):
        self.connect().close()
        with self.assertRaises((OSError, ConnectionError)):
            Client(f"127.0.0.1:{self.frames}", timeout=5)


if __name__ == "__main__":
    unittest.main()
