"""Loads of scenes: what ends them, and in which order they come."""

import os
import subprocess
import time
import unittest

from server import LUMULUS, ServiceTest
from lumulus_client import ServiceError

SMALL = '[[cloud]]\nprocedural = "sphere"\nresolution = 16\n[photon_map]\nphotons = 4000\ngenerations = 2\nbands = 2\n'
# a scene is read before it waits for its turn, and again when its load begins
NOT_BEGUN = ("waiting", "reading the scene")


def large(seed):
    return f'[[cloud]]\nprocedural = "cumulus"\nresolution = 448\nseed = {seed}\n'


class Loads(ServiceTest):
    def begin(self, client, toml):
        """Asks for a scene, and waits until it is being loaded. Returns the request."""
        request = client.send("load_scene", payload=toml.encode())
        self.wait_until(lambda: self.step(client) not in (None, *NOT_BEGUN))
        return request

    def step(self, client):
        return client.statistics().get("loading", {}).get("step")

    def wait_until(self, happens):
        deadline = time.monotonic() + 60
        while not happens():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)

    def test_small_ones_pass_large_ones(self):
        with self.server.client() as one, self.server.client() as two, self.server.client() as three:
            request = self.begin(one, large(1))
            waits = two.send("load_scene", payload=large(2).encode())
            three.load_scene(toml=SMALL)
            # the first large one is under way still, and the second one waits for it
            self.assertNotIn(self.step(one), (None, "waiting"))
            self.assertEqual(self.step(two), "waiting")
            self.assertFalse(any(message[1] in (request, waits) for message in one.early + two.early))

    def test_a_client_that_leaves_ends_its_load(self):
        two = self.server.client()
        with self.server.client() as one:
            self.begin(one, large(3))
            request = two.send("load_scene", payload=large(4).encode())
            self.assertIn(self.step(two), NOT_BEGUN)
            self.assertNotIn(self.step(one), (None, *NOT_BEGUN))
        # large ones come one at a time: this one begins because the other one has ended
        self.wait_until(lambda: self.step(two) not in NOT_BEGUN)
        self.assertFalse(any(message[1] == request for message in two.early))
        two.close()

    def test_loads_of_a_client_come_in_their_order(self):
        with self.server.client() as client:
            widths = [40, 24, 16]
            requests = [client.send("load_scene", payload=f"[image]\nwidth = {width}\nheight = 8\n{SMALL}".encode())
                        for width in widths]
            self.assertEqual([client.wait(request)[0]["width"] for request in requests], widths)
            self.assertEqual(client.frame().info["views"][0]["width"], widths[-1])

    def test_two_clients_load_one_scene_once(self):
        self.server.write("scenes/once.toml", SMALL.replace("16", "64"))
        with self.server.client() as one, self.server.client() as two:
            requests = [client.send("load_scene", {"name": "once.toml"}) for client in (one, two)]
            for client, request in zip((one, two), requests):
                client.wait(request)
            self.assertEqual(one.statistics()["scene"]["clients"], 2)
        self.wait_until(lambda: self.loaded("once.toml") > 0)
        with self.server.client() as client:
            client.ping()  # what was logged before has been read by now, or nearly
        self.assertEqual(self.loaded("once.toml"), 1)

    def loaded(self, scene):
        return sum(event["event"] == "scene_loaded" and event["scene"] == scene for event in self.server.log)


class Limit(ServiceTest):
    options = {"limits": "load_seconds = 6.0"}

    def test_reading_is_cut_off(self):
        first = os.path.join(self.server.folder, "scenes", "0.vdb")
        subprocess.run([LUMULUS, "cloud", "slab", "--resolution", "384", "-o", first, "--quiet"], check=True)
        clouds = 200  # files of their own: more than any machine reads in the time
        for i in range(1, clouds):
            os.link(first, os.path.join(self.server.folder, "scenes", f"{i}.vdb"))
        toml = "".join(f'[[cloud]]\nvdb = "{i}.vdb"\n' for i in range(clouds))
        with self.server.client() as client:
            request = client.send("load_scene", payload=toml.encode())
            steps = set()
            while not any(message[1] == request for message in client.early):
                steps.add(client.statistics().get("loading", {}).get("step"))
                time.sleep(0.05)
            with self.assertRaises(ServiceError) as caught:
                client.wait(request)
            self.assertEqual(caught.exception.code, "too_large", str(caught.exception))
            self.assertIn("takes longer", str(caught.exception))
            self.assertNotIn("preparing the cloud", steps)
            self.assertEqual(client.frame(width=16, height=16).info["views"][0]["width"], 16)


if __name__ == "__main__":
    unittest.main()
