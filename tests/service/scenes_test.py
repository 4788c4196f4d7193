"""What clients are told of scenes: which there are, how they were before somebody changed them, who else sees them, and how
far a load is."""

import time
import unittest

from server import ServiceTest
from lumulus_client import ServiceError

TWO_CLOUDS = """
[sun]
direction_to = [0.0, 1.0, 0.0]
[[cloud]]
name = "west"
procedural = "sphere"
resolution = 16
extinction = 0.03
phase = { model = "henyey-greenstein", g = 0.5 }
[[cloud]]
procedural = "sphere"
resolution = 16
transform = [[1, 0, 0, 3000], [0, 1, 0, 0], [0, 0, 1, 0]]
extinction = 0.01
phase = { model = "rayleigh" }
[preparation]
samples = 200
[photon_map]
photons = 4000
generations = 2
bands = 2
"""
LARGE_SCENE = '[[cloud]]\nprocedural = "cumulus"\nresolution = 96\n'


class Scenes(ServiceTest):
    def test_the_list(self):
        self.server.write("scenes/another.toml", TWO_CLOUDS)
        self.server.write("scenes/readme.txt", "no scene")
        with self.server.client() as client:
            self.assertEqual(client.scenes(), ["another.toml", "small.toml"])
            for name in client.scenes():
                self.assertEqual(client.load_scene(name)["name"], name)
            with self.assertRaises(ServiceError) as caught:
                client.ask("list_scenes", {"folder": "/"})
            self.assertEqual((caught.exception.code, caught.exception.where), ("bad_request", "folder"))

    def test_the_original_stays_as_the_file_says(self):
        with self.server.client() as client:
            original = client.load_scene(toml=TWO_CLOUDS)["original"]
            self.assertEqual(original["sun"]["direction_to"], [0.0, 1.0, 0.0])
            self.assertEqual(original["clouds"], [{"name": "west", "extinction": 0.03, "g": 0.5},
                                                  {"name": "1", "extinction": 0.01}])
            client.change(sun={"direction_to": [1, 0, 0]}, extinction=0.5)
            repeat = client.frame(width=16, height=16, budget={"photons": 0}).info["repeat"]
            self.assertIn("cloud.1.extinction=0.5", repeat)
            self.assertIn("sun.direction_to=[1,0,0]", repeat)
            self.assertEqual(client.load_scene(toml=TWO_CLOUDS)["original"], original)

    def test_who_shares_the_light(self):
        with self.server.client() as one, self.server.client() as two, self.server.client() as three:
            for client, own in ((one, False), (two, False), (three, True)):
                client.load_scene("small.toml", private=own)
            counted = [client.statistics()["scene"]["clients"] for client in (one, two, three)]
            self.assertEqual(counted, [2, 2, 1])

    def test_how_far_a_load_is(self):
        with self.server.client() as client:
            self.assertNotIn("loading", client.statistics())
            request = client.send("load_scene", payload=LARGE_SCENE.encode())
            steps, deadline = set(), time.monotonic() + 120
            while not any(message[1] == request for message in client.early):
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.01)
                loading = client.statistics().get("loading")
                if loading:
                    steps.add(loading["step"])
                    self.assertGreaterEqual(loading["seconds"], 0)
            self.assertIn("preparing the cloud", steps)
            client.wait(request)
            self.assertNotIn("loading", client.statistics())


if __name__ == "__main__":
    unittest.main()
