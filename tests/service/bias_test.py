"""The error of pictures at rest, measured by paths while nothing changes: bias_test.py [unittest arguments]."""

import json
import math
import pathlib
import subprocess
import tempfile
import time
import unittest

from server import LUMULUS, SCENE, Server

SIZE = {"width": 64, "height": 48}
PATIENCE = 90  # seconds; the paths take three of a thread of low priority


class Bias(unittest.TestCase):
    def rested(self, client, **wishes):
        """What frames of this view say once their error is known."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            info = client.frame(**SIZE, **wishes).info
            if info["bias"]:
                return info
            time.sleep(0.5)
        self.fail("nothing was said of the error")

    def test_is_that_which_render_measures(self):
        server = Server()
        self.addCleanup(server.stop)
        with server.client() as client:
            self.assertIsNone(client.frame(**SIZE).info["bias"])
            info = self.rested(client)
            found = info["bias"]
            self.assertGreater(found["sigma"], 0.0)
            self.assertLess(found["sigma"], 0.1)
            with tempfile.TemporaryDirectory() as folder:
                scene, stats = pathlib.Path(folder, "scene.toml"), pathlib.Path(folder, "stats.json")
                scene.write_text(SCENE)
                sets = [f"--set={text}" for text in [*info["repeat"], *(f"image.{k}={v}" for k, v in SIZE.items())]]
                subprocess.run([LUMULUS, "render", scene, "-o", pathlib.Path(folder, "x.exr"), *sets, "--quiet",
                                "--error-paths=400000", "--no-correct", f"--stats={stats}"], check=True)
                measured = json.loads(stats.read_text())["error"]
            sigma = math.hypot(found["sigma"], measured["bias_sigma"])
            self.assertLess(abs(found["value"] - measured["bias"]), 4 * sigma)

            # another light has other errors, and so has another view
            moved = client.frame(**SIZE, camera={"position": [0, 0, 2000], "target": [0, 0, 0]}).info
            self.assertIsNone(moved["bias"])
            self.assertIsNone(client.frame(**SIZE, sun={"azimuth": 10, "elevation": 20}).info["bias"])

    def test_a_stream_at_rest_is_told(self):
        server = Server()
        self.addCleanup(server.stop)
        with server.client() as client:
            stream = client.start_stream(**SIZE)
            end = time.monotonic() + PATIENCE
            while not client.next_frame(stream).info["bias"]:
                self.assertLess(time.monotonic(), end)


if __name__ == "__main__":
    unittest.main()
