"""The documented balancer, configs/haproxy.cfg: of two servers one is killed, and frames go on with the same hashes."""

import os
import re
import subprocess
import tempfile
import time
import unittest
import urllib.request

from server import Server
from tls_test import free_ports
from lumulus_client import Client

HERE = os.path.dirname(os.path.abspath(__file__))
CONFIG = os.path.join(HERE, "..", "..", "configs", "haproxy.cfg")


class Balanced(unittest.TestCase):
    def setUp(self):
        self.servers = [Server(), Server()]
        self.folder = tempfile.TemporaryDirectory()
        self.frames, self.pages = free_ports(2)
        with open(CONFIG) as file:
            text = file.read()
        ports = [address.rsplit(":", 1)[1] for server in self.servers for address in (server.tcp, server.http)]
        ports = dict(zip(("7788", "7789", "7798", "7799", "7800", "7801"), [*ports, str(self.frames), str(self.pages)]))
        text, count = re.subn(r"\b(?:" + "|".join(ports) + r")\b", lambda match: ports[match.group(0)], text)
        self.assertEqual(count, 8)
        path = os.path.join(self.folder.name, "haproxy.cfg")
        with open(path, "w") as file:
            file.write(text)
        self.haproxy = subprocess.Popen(["/usr/sbin/haproxy", "-db", "-f", path], stderr=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL)

    def tearDown(self):
        self.haproxy.terminate()
        self.haproxy.wait(10)
        self.folder.cleanup()

    def frame(self, deadline):
        """The hash of a frame of the whole ring, by a connection of its own; None where there is none now."""
        try:
            with Client(f"127.0.0.1:{self.frames}", timeout=20) as client:
                return client.frame(width=64, height=48).info["hash"]
        except OSError:
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.1)
            return None

    def test_one_is_killed_and_frames_go_on(self):
        deadline = time.monotonic() + 60
        while (first := self.frame(deadline)) is None:
            pass
        for server in self.servers:  # both are in use, and draw the same
            with server.client() as client:
                self.assertEqual(client.frame(width=64, height=48).info["hash"], first)
        with urllib.request.urlopen(f"http://127.0.0.1:{self.pages}/health", timeout=10) as answer:
            self.assertEqual(answer.read(), b"ok\n")
        clients = [Client(f"127.0.0.1:{self.frames}", timeout=20) for _ in range(4)]
        counts = [len([e for e in server.log if e["event"] == "connected"]) for server in self.servers]
        self.assertTrue(all(count > 1 for count in counts), counts)
        self.servers[0].kill()
        alive = 0
        for client in clients:  # those of the other server go on; the others learn that theirs is gone
            try:
                self.assertEqual(client.frame(width=64, height=48).info["hash"], first)
                alive += 1
            except OSError:
                pass
            client.close()
        self.assertGreaterEqual(alive, 1)
        self.assertLess(alive, 4)
        deadline, after = time.monotonic() + 30, []
        while len(after) < 5:
            found = self.frame(deadline)
            after += [found] if found else []
        self.assertEqual(set(after), {first})
        self.assertEqual(self.servers[1].stop(), 0)


if __name__ == "__main__":
    unittest.main()
