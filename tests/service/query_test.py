"""Questions without a picture: transmittance along segments, towards the sun and on the ground, of the light and the clouds
of now."""

import math
import struct
import threading
import time
import unittest

from server import ServiceTest
from lumulus_client import ServiceError


def doubles(*numbers):
    return struct.pack(f"<{len(numbers)}d", *numbers)


def floats(data):
    return struct.unpack(f"<{len(data) // 4}f", data)


# through the middle of the small scene's ball, radius 100 m about (0, 100, 0)
THROUGH, TO_MIDDLE = (-500, 100, 0, 500, 100, 0), (-500, 100, 0, 0, 100, 0)


class Queries(ServiceTest):
    def segments(self, client, *rows):
        """(transmittance, optical depth) of each row, red."""
        info, data = client.query("segments", doubles(*(number for row in rows for number in row)))
        self.assertEqual((info["width"], info["channels"]), (len(rows), 6))
        values = floats(data)
        return [(values[i], values[i + 3]) for i in range(0, len(values), 6)]

    def test_segments(self):
        with self.server.client() as client:
            through, middle, nothing = self.segments(client, THROUGH, TO_MIDDLE, (1e7, 0, 0, 1e7, 0, 0))
        self.assertAlmostEqual(through[1], 2 * middle[1], delta=1e-3 * through[1])
        self.assertAlmostEqual(through[0], math.exp(-through[1]), delta=1e-6)
        self.assertGreater(through[1], 3)
        self.assertEqual(nothing, (1, 0))

    def test_they_see_the_extinction_and_the_sun_of_now(self):
        with self.server.client() as client, self.server.client() as other:
            before = self.segments(client, THROUGH)[0][1]
            client.change(extinction=0.06, sun={"direction_to": [1, 0, 0]})
            self.assertAlmostEqual(self.segments(client, THROUGH)[0][1], 2 * before, delta=1e-3 * before)
            self.assertAlmostEqual(self.segments(other, THROUGH)[0][1], before, delta=1e-6)
            west, east = (floats(client.query("sun", doubles(x, 100, 0))[1])[0] for x in (-300, 300))
            self.assertLess(west, 0.01)
            self.assertEqual(east, 1)

    def test_ground_shadow(self):
        with self.server.client() as client:
            client.change(sun={"direction_to": [0, 1, 0]})
            info, data = client.query("ground_shadow", rectangle=[-300, -200, 300, 200], y=-5, width=6, height=4)
        self.assertEqual((info["product"], info["width"], info["height"], info["channels"]), ("ground_shadow", 6, 4, 3))
        red = floats(data)[::3]
        dark = {i for i, share in enumerate(red) if share < 1}
        self.assertEqual(dark, {6 * row + column for row in (1, 2) for column in (2, 3)})

    def test_ambient_light(self):
        """Far from all clouds that is the sky's: L √4π in the first coefficient and nothing in the others, and the sun's
        irradiance as the scene has it. Beside the ball there is light from its side."""
        with self.server.client() as client:
            sun = client.load_scene("small.toml")["original"]["sun"]["irradiance"]
            client.frame()
            rows = doubles(1e6, 1e6, 1e6, 0, 100, 150)
            info, data = client.query("ambient", rows)
            client.load_scene(toml="cloud = []\n[sky]\nradiance = [0.1, 0.2, 0.3]\n")
            empty = floats(client.query("ambient", doubles(0, 0, 0))[1])
        self.assertEqual((info["product"], info["width"], info["height"], info["channels"]), ("ambient", 2, 1, 30))
        far, near = floats(data)[:30], floats(data)[30:]
        for channel in range(3):
            self.assertAlmostEqual(far[channel], sun[channel], delta=1e-5 * sun[channel])
            self.assertAlmostEqual(empty[3 + channel], 0.1 * (channel + 1) * math.sqrt(4 * math.pi), delta=1e-3)
        for values in (far, empty):
            self.assertLess(max(abs(value) for value in values[6:]), 5e-3 * values[3])
        self.assertNotAlmostEqual(near[9], 0, delta=0.02 * near[3])  # z: the ball is north of the point

    def test_refusals(self):
        with self.server.client() as client:
            for product, rows, fields, code, where in (
                    ("segments", b"", {}, "bad_request", ""), ("segments", bytes(40), {}, "bad_request", ""),
                    ("sun", doubles(1, 2, 3, math.nan, 5, 6), {}, "bad_request", "row 1"),
                    ("sun", doubles(1, 2, 2e9), {}, "bad_request", "row 0"),
                    ("sun", bytes(24 * 262145), {}, "too_large", ""), ("ambient", bytes(24 * 65), {}, "too_large", ""),
                    ("moon", b"", {}, "bad_request", "products"),
                    ("ground_shadow", b"", {}, "bad_request", "rectangle"),
                    ("ground_shadow", b"", {"rectangle": [0, 0, 0, 1]}, "bad_request", "rectangle"),
                    ("ground_shadow", b"", {"rectangle": [0, 0, 1, 1], "width": 0}, "bad_request", "width"),
                    ("ground_shadow", b"", {"rectangle": [0, 0, 1, 1], "width": 4096, "height": 4096}, "too_large", "width"),
                    ("segments", bytes(48), {"y": 0}, "bad_request", "y")):
                with self.subTest(product=product, fields=fields), self.assertRaises(ServiceError) as caught:
                    client.query(product, rows, **fields)
                self.assertEqual((caught.exception.code, caught.exception.where), (code, where))

    def test_many_are_cancelled_or_wait_or_are_refused(self):
        rows = doubles(*THROUGH) * 200000
        with self.server.client() as client:
            ids = [client.send("query", {"products": ["segments"]}, rows) for _ in range(12)]
            client.send("cancel", {"request": ids[0]})
            answers = {}
            while len(answers) < 12:
                kind, request, info, _ = client.receive()
                if request in ids:
                    answers[request] = info.get("code", "answered")
        self.assertIn(answers[ids[0]], ("cancelled", "answered"))
        self.assertLessEqual(set(answers.values()), {"answered", "busy", "cancelled"})
        self.assertIn("answered", answers.values())

    def test_frames_go_on_beside_them(self):
        with self.server.client() as client, self.server.client() as asking:
            client.frame(width=64, height=48)
            done = threading.Event()

            def ask():
                while not done.is_set():
                    self.segments(asking, *([THROUGH] * 50000))

            thread = threading.Thread(target=ask)
            thread.start()
            try:
                start = time.monotonic()
                for _ in range(10):
                    client.frame(width=64, height=48)
                self.assertLess(time.monotonic() - start, 20)
            finally:
                done.set()
                thread.join()


TWO_CLOUDS = """
[[cloud]]
name = "west"
procedural = "sphere"
resolution = 16
extinction = 0.03
[[cloud]]
name = "east"
procedural = "sphere"
resolution = 16
transform = [[1, 0, 0, 1000], [0, 1, 0, 0], [0, 0, 1, 0]]
extinction = 0.03
[preparation]
samples = 200
[photon_map]
photons = 8000
generations = 2
bands = 2
"""


class Moving(ServiceTest):
    def depth(self, client, x):
        """Optical depth from below to above at x."""
        return floats(client.query("segments", doubles(x, -500, 0, x, 500, 0))[1])[3]

    def test_a_cloud_moves_above_a_ground(self):
        """Its shadow on the ground is made anew on all threads, while others are drawn on one."""
        ground = "[sky]\nmodel = \"constant\"\n[ground]\nheight = -2000\n"
        with self.server.client() as client, self.server.client() as other:
            for one in (client, other):
                one.load_scene(toml=ground + TWO_CLOUDS)
            for step in range(3):
                client.change(cloud="west", move=[100 * step, 0, 0])
                frame = client.frame(width=32, height=24, products=["transmittance"], encoding="float")
                self.assertEqual(len(frame.values("transmittance")), 24)

    def test_a_cloud_moves_by_name(self):
        with self.server.client() as client, self.server.client() as other:
            for one in (client, other):
                one.load_scene(toml=TWO_CLOUDS)
            whole = self.depth(client, 0)
            self.assertGreater(whole, 3)
            generations = client.frame(width=32, height=24).info["current_generations"]
            self.assertEqual(generations, 2)
            client.change(cloud="west", move=[500, 0, 0])
            self.assertEqual(self.depth(client, 0), 0)
            self.assertAlmostEqual(self.depth(client, 500), whole, delta=1e-3 * whole)
            self.assertAlmostEqual(self.depth(client, 1000), whole, delta=1e-3 * whole)
            self.assertAlmostEqual(self.depth(other, 0), whole, delta=1e-6)
            # a picture from above shows it at its new place; the photons of before give way
            camera = {"position": [500, 3000, 0], "target": [500, 0, 0], "vertical_fov": 3}
            frame = client.frame(width=32, height=24, camera=camera, products=["transmittance"], encoding="float",
                                 budget={"photons": 1})
            self.assertLess(frame.values("transmittance")[12, 16, 0], 0.2)
            client.change(cloud="west", extinction=1e-9)
            self.assertLess(self.depth(client, 500), 1e-4)
            client.change(cloud="west", move=[0, 0, 0], extinction=0.03)
            self.assertAlmostEqual(self.depth(client, 0), whole, delta=1e-3 * whole)

    def test_refusals(self):
        with self.server.client() as client:
            for fields, code in (({"move": [1, 2, 3]}, "bad_request"), ({"move": [1, 2, 3], "cloud": "no"}, "not_found"),
                                 ({"move": [1, 2], "cloud": 0}, "bad_request")):
                with self.assertRaises(ServiceError) as caught:
                    client.change(**fields)
                self.assertEqual(caught.exception.code, code)


if __name__ == "__main__":
    unittest.main()
