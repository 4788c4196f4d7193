"""Streams that ask for moments: which frame is for which moment, and the simulation time that comes back."""

import re
import time
import unittest
import urllib.request

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
        """A generation takes long; frames with a budget and streams come between its rounds."""
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
            begin, waits = time.monotonic(), []
            while time.monotonic() - begin < 60 and traced < generations - 1:
                asked = time.monotonic()
                client.next_frame(stream)
                came = time.monotonic()
                watcher.frame(**wishes, budget={"milliseconds": 20})
                waits += [came - asked, time.monotonic() - came]
                traced = watcher.statistics()["scene"]["generations"]
        waits.sort()
        usual = waits[int(0.9 * len(waits))]
        print(f"a generation {each:.2f} s; waits meanwhile: {1e3 * usual:.0f} ms (p90), {1e3 * waits[-1]:.0f} ms (most)")
        self.assertGreaterEqual(traced, generations - 1, "streams do not keep the photons from being traced")
        self.assertLess(usual, 0.5 * each)
        self.assertGreater(len(waits), 20)


class Newcomers(unittest.TestCase):
    def test_streams_do_not_wait_for_light_that_nobody_sees(self):
        """The default scene gets its photons while nobody streams, and not beside the stream of another scene."""
        server = Server(scene=SCENE.replace("generations = 4", "generations = 4000"))
        self.addCleanup(server.stop)
        with server.client() as client:
            client.load_scene(toml=SCENE.replace("generations = 4", "generations = 1").replace("24", "20"))
            wishes = {"width": 32, "height": 24, "every": 50, "budget": {"milliseconds": 50}}
            stream = client.start_stream(**wishes)
            client.next_frame(stream)

            def streamed():
                for i in range(20):
                    client.start_stream(stream, time=i, **wishes)
                    client.next_frame(stream)

            beside = self.rate(server, streamed)
            client.stop_stream(stream)
            alone = self.rate(server, lambda: time.sleep(1))
        print(f"generations a second: {beside:.1f} beside a stream, {alone:.1f} alone")
        self.assertGreater(alone, 5)
        self.assertLess(beside, 0.2 * alone, "but for moments in which the stream has what it asked for")

    def rate(self, server, work):
        """Generations a second while something is done."""
        before, begin = self.generations(server), time.monotonic()
        work()
        return (self.generations(server) - before) / (time.monotonic() - begin)

    def generations(self, server):
        with urllib.request.urlopen(f"http://{server.http}/metrics") as reply:
            return float(re.search(r"^lumulus_generations_total (\S+)$", reply.read().decode(), re.MULTILINE)[1])


if __name__ == "__main__":
    unittest.main()
