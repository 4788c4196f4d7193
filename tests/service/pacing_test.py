"""Streams that ask for moments: which frame is for which moment, and the simulation time that comes back."""

import time
import unittest

from server import ServiceTest

EVERY, PHASE = 100.0, 50.0  # milliseconds


class Pacing(ServiceTest):
    def test_a_stream_keeps_its_rhythm(self):
        wishes = {"width": 32, "height": 24, "every": EVERY, "phase": PHASE, "budget": {"milliseconds": EVERY}}
        with self.server.client() as client:
            begin = time.monotonic()
            stream = client.start_stream(time=7.0, **wishes)
            numbers = []
            for _ in range(6):
                info = client.next_frame(stream).info
                came = 1e3 * (time.monotonic() - begin)
                self.assertGreaterEqual(came, PHASE + info["number"] * EVERY, "no frame comes before its moment")
                self.assertEqual(info["time"], 7.0)
                self.assertLess(info["milliseconds"]["total"], 60e3)
                numbers.append(info["number"])
            self.assertEqual(numbers, sorted(set(numbers)))
            self.assertLess(numbers[-1], 600, "six frames of a small scene take no minute")
            client.start_stream(stream, time=8.5, **wishes)
            while (info := client.next_frame(stream).info)["time"] == 7.0:
                numbers.append(info["number"])
            self.assertEqual(info["time"], 8.5)
            self.assertGreater(info["number"], numbers[-1], "new wishes leave the rhythm alone")
            self.assertTrue(client.stop_stream(stream))


if __name__ == "__main__":
    unittest.main()
