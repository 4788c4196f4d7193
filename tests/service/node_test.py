"""A client in another language, node_client.js, against the server: over TCP and over a WebSocket."""

import os
import subprocess
import unittest

from server import LUMULUS, ServiceTest

HERE = os.path.dirname(os.path.abspath(__file__))


class Node(ServiceTest):
    def check(self, how, address):
        path = os.path.join(self.server.folder, "ball.vdb")
        subprocess.run([LUMULUS, "cloud", "sphere", "-o", path, "--resolution", "24", "--quiet"], check=True)
        result = subprocess.run(["node", os.path.join(HERE, "node_client.js"), how, address, path], timeout=100,
                                capture_output=True, text=True, env={**os.environ, "NODE_PATH": "/usr/share/nodejs"})
        self.assertEqual((result.returncode, result.stdout), (0, "ok\n"), result.stderr)

    def test_over_tcp(self):
        self.check("tcp", self.server.tcp)

    def test_over_a_websocket(self):
        self.check("ws", self.server.http)


if __name__ == "__main__":
    unittest.main()
