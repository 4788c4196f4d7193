"""The Python client's examples, as a person runs them: what they save is what they promise."""

import os
import subprocess
import sys
import tempfile
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from flat_layers import read_exr
from server import ServiceTest

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "service", "client", "python", "examples")
SMALL = ("--width", "64", "--height", "36")


def layers_of(path):
    width, height, layers = read_exr(path)[:3]
    return {name: numpy.array(values, "f").reshape(height, width) for name, values in layers.items()}


class Examples(ServiceTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = os.path.join(folder.name, "made", "here")

    def run_example(self, name, *arguments):
        """Its lines; it runs in another folder than its own."""
        result = subprocess.run([sys.executable, "-B", os.path.abspath(os.path.join(EXAMPLES, name)), *arguments,
                                 "--address", self.server.tcp], capture_output=True, text=True, timeout=200, cwd="/")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout.splitlines()

    def saved(self):
        contents = []
        for name in sorted(os.listdir(self.folder)):
            with open(os.path.join(self.folder, name), "rb") as file:
                contents.append(file.read())
        return contents

    def test_orbit(self):
        self.assertEqual(len(self.run_example("orbit.py", self.folder, "--frames", "4", *SMALL)), 4)
        pictures = self.saved()
        self.assertEqual(len(set(pictures)), 4)
        self.assertTrue(all(picture.startswith(b"\xff\xd8") for picture in pictures))

    def test_sun_sweep(self):
        lines = self.run_example("sun_sweep.py", self.folder, "--frames", "5", *SMALL)
        self.assertTrue(all("generations see this sun" in line for line in lines))
        self.assertEqual(len(set(self.saved())), 5)

    def test_save_sequence(self):
        self.run_example("save_sequence.py", self.folder, "--frames", "3", "--wind", "40", "0", "0", *SMALL)
        alphas = [layers_of(os.path.join(self.folder, name))["cloud.A"] for name in sorted(os.listdir(self.folder))]
        self.assertEqual(len(alphas), 3)
        # the middle of what covers the sky drifts one way
        columns = [(alpha.sum(0) * numpy.arange(alpha.shape[1])).sum() / alpha.sum() for alpha in alphas]
        steps = numpy.diff(columns)
        self.assertGreater(abs(steps).min(), 0.5)
        self.assertGreater(steps[0] * steps[1], 0.0)

    def test_composite_depth(self):
        def picture(visibility):
            path = os.path.join(self.folder, f"ground{visibility}.exr")
            self.run_example("composite_depth.py", path, "--visibility", str(visibility), *SMALL)
            return layers_of(path)["R"]

        clear, thick = picture(1e7), picture(300)
        # the chequers of the ground are 0.2 and 0.8; far away fog takes their contrast, nearby it leaves some
        self.assertGreater(numpy.ptp(clear[25]), 0.5)
        self.assertGreater(numpy.ptp(thick[-1]), 0.2)
        self.assertLess(numpy.ptp(thick[19]), 0.1 * numpy.ptp(clear[19]))

    def test_composite_depth_knows_its_files(self):
        result = subprocess.run([sys.executable, "-B", os.path.join(EXAMPLES, "composite_depth.py"), "ground.tif"],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn(".png", result.stderr)


if __name__ == "__main__":
    unittest.main()
