"""Streams that ask for moments: which frame is for which moment, and the simulation time that comes back."""

import time
import unittest

from server import SCENE, Server, ServiceTest

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


class Preemption(unittest.TestCase):
    def test_pictures_do_not_wait_for_a_generation_of_their_scene(self):
        """A generation takes seconds; frames with a budget and streams come between its rounds."""
        photons, generations = 20_000_000, 5
        server = Server(scene=SCENE.replace("photons = 40000", f"photons = {photons}").replace(
            "generations = 4", f"generations = {generations}"))
        self.addCleanup(server.stop)
        with server.client() as client, server.client() as watcher:
            wishes = {"width": 48, "height": 36, "encoding": "half"}
            begin = time.monotonic()
            traced = client.frame(**wishes, budget={"photons": photons // generations}).info["generations"]
            each = time.monotonic() - begin
            stream = client.start_stream(**wishes, every=50, budget={"milliseconds": 50})
            begin, came, longest, lone = time.monotonic(), [], 0.0, 0.0
            while time.monotonic() - begin < 60 and traced < generations - 1:
                came.append(time.monotonic())
                client.next_frame(stream)
                longest = max(longest, time.monotonic() - came[-1])
                asked = time.monotonic()
                watcher.frame(**wishes, budget={"milliseconds": 20})
                lone = max(lone, time.monotonic() - asked)
                traced = watcher.statistics()["scene"]["generations"]
        print(f"a generation {each:.2f} s; longest wait in the stream {1e3 * longest:.0f} ms, for a lone frame {1e3 * lone:.0f} ms")
        self.assertGreaterEqual(traced, generations - 1, "streams do not keep the photons from being traced")
        self.assertLess(max(longest, lone), 0.5 * each)
        self.assertGreater(len(came), 10)


if __name__ == "__main__":
    unittest.main()
