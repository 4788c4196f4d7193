"""Nothing on the thread of the sockets takes more than 10 ms: io_thread_test.py [unittest arguments]."""

import os
import re
import unittest

from raw_websocket import WebSocket
from server import Server
from lumulus_client import HEADER, MAGIC, TYPES
from supervisor_test import get

BOUND = 10_000  # microseconds
MEGABYTE = 1 << 20
PINGS = 200_000


def head(kind, number, json_bytes=0):
    return HEADER.pack(MAGIC, 1, TYPES[kind], number, json_bytes, 0, 0)


class IoThread(unittest.TestCase):
    def setUp(self):
        self.server = Server(limits="requests_per_second = 1000000")
        self.addCleanup(self.server.stop)

    def tearDown(self):
        metrics = get(self.server, "/metrics")[1]
        found = {name: float(value) for name, value in re.findall(r"^lumulus_io_(\w+) (\S+)$", metrics, re.MULTILINE)}
        print(f"{self.id().rsplit('.', 1)[1]}: longest handler {found['longest_handler_microseconds'] / 1e3:.2f} ms")
        self.assertGreater(found["longest_handler_microseconds"], 0)
        self.assertLess(found["longest_handler_microseconds"], BOUND)
        self.assertEqual(found["slow_handlers_total"], 0)

    def test_an_upload(self):
        path = os.path.join(self.server.folder, "large.vdb")
        with open(path, "wb") as file:
            file.write(os.urandom(96 * MEGABYTE))
        with self.server.client() as client:
            digest = client.upload(path)
            self.assertEqual([one["hash"] for one in client.list_uploads()["uploads"]], [digest])
            self.assertTrue(client.delete_upload(digest))

    def test_messages_in_one_of_a_websocket(self):
        pings = b"".join(head("ping", number + 2) for number in range(PINGS))
        with WebSocket(self.server.http) as one, self.server.client() as other:
            one.send(head("hello", 1, 2) + b"{}")
            one.message()
            one.begin(len(pings))
            for begin in range(0, len(pings), MEGABYTE):
                one.socket.sendall(pings[begin:begin + MEGABYTE])
                other.ping()
                answers = self.answers(one, min(len(pings), begin + MEGABYTE) // HEADER.size - begin // HEADER.size)
                self.assertGreater(answers, 0)

    def answers(self, socket, most):
        count = 0
        while count < most:
            socket.frame()
            count += 1
        return count

    def test_large_frames_that_nobody_reads(self):
        """And clients that go with all of them waiting."""
        wishes = {"width": 1024, "height": 768, "encoding": "float", "budget": {"photons": 0}}
        for _ in range(3):
            crowd = [self.server.client() for _ in range(6)]
            for one in crowd:
                one.start_stream(max_rate=1000, **wishes)
            with self.server.client() as other:
                for _ in range(10):
                    self.assertTrue(other.frame(**wishes).verify())
            for one in crowd:
                one.close()

    def test_many_scenes_are_listed(self):
        for number in range(3000):
            self.server.write(f"scenes/{number}.toml", "")
        with self.server.client() as client:
            self.assertGreater(len(client.scenes()), 900)


if __name__ == "__main__":
    unittest.main(verbosity=2)
