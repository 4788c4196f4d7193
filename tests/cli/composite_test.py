"""`lumulus composite` by its files: composite_test.py LUMULUS [unittest arguments]."""

import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from flat_layers import read_exr, write_exr  # noqa: E402

LUMULUS = Path(sys.argv[1]).resolve()
WIDTH, HEIGHT = 6, 4
COUNT = WIDTH * HEIGHT
ABSORBING = "[[fog.media]]\nabsorption = [0.01, 0.02, 0.03]\n"
LIGHT = {"R": [1.0 + i for i in range(COUNT)], "G": [2.0] * COUNT, "B": [0.5] * COUNT}


class Composite(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = Path(self._folder.name)
        self.color, self.depth, self.out = (self.folder / name for name in ("color.exr", "depth.exr", "out.exr"))

    def tearDown(self):
        self._folder.cleanup()

    def composite(self, scene, *arguments, color=None, depth=None):
        write_exr(self.color, WIDTH, HEIGHT, color or {**LIGHT, "Z": [50.0] * COUNT})
        if depth:
            write_exr(self.depth, *depth)
            arguments = ("--depth", self.depth, *arguments)
        path = self.folder / "scene.toml"
        path.write_text("cloud = []\n[camera]\nposition = [0, 0, 5]\n" + scene)
        return subprocess.run([LUMULUS, "composite", "--color", self.color, "--scene", path, "-o", self.out,
                               *map(str, arguments)], capture_output=True, text=True, timeout=120)

    def layers(self, *arguments, **files):
        done = self.composite(*arguments, **files)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return read_exr(self.out)[2]

    def assert_refused(self, done, text):
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(text, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertFalse(self.out.exists())

    def test_pure_absorption_is_exact(self):
        layers = self.layers(ABSORBING)
        for name, coefficient in (("R", 0.01), ("G", 0.02), ("B", 0.03)):
            for found, clear in zip(layers[name], LIGHT[name]):
                self.assertAlmostEqual(found / (clear * math.exp(-50 * coefficient)), 1.0, places=5)

    def test_without_media_the_picture_stays(self):
        layers = self.layers("", "--stats", self.folder / "stats.json")
        self.assertEqual({name: layers[name] for name in LIGHT}, LIGHT)
        self.assertIn('"passes": []', (self.folder / "stats.json").read_text())

    def test_depth_in_its_own_file_under_either_name(self):
        for name in ("Z", "depth.Z"):
            layers = self.layers(ABSORBING, color=LIGHT, depth=(WIDTH, HEIGHT, {name: [100.0] * COUNT}))
            self.assertAlmostEqual(layers["G"][7] / (2.0 * math.exp(-2.0)), 1.0, places=5)

    def test_z_buffer(self):
        near, far, metres = 0.5, 300.0, 80.0
        z = (1 / near - 1 / metres) / (1 / near - 1 / far)
        scene = f'[fog]\ndepth = "zbuffer"\nnear = {near}\nfar = {far}\n' + ABSORBING
        # one pixel in the middle sees along the axis; this picture has none, so the camera has almost no angle
        layers = self.layers(scene, "--set", "camera.vertical_fov=0.01", color={**LIGHT, "Z": [z] * COUNT})
        self.assertAlmostEqual(layers["G"][9] / (2.0 * math.exp(-1.6)), 1.0, places=3)

    def test_all_filters_keep_a_uniform_picture(self):
        for fog_filter in ("scatter", "naive", "gather"):
            flat = {name: [3.0] * COUNT for name in "RGB"}
            layers = self.layers("[[fog.media]]\nscattering = 0.02\n", "--set", f"fog.filter={fog_filter}",
                                 color={**flat, "Z": [50.0] * COUNT})
            for value in layers["G"]:
                self.assertAlmostEqual(value, 3.0, places=3)

    def test_what_is_no_number_does_not_spread(self):
        light = {**LIGHT, "R": [math.nan, math.inf, *LIGHT["R"][2:]]}
        depth = [math.nan, math.inf, -1.0] + [50.0] * (COUNT - 3)
        done = self.composite("[[fog.media]]\nscattering = 0.02\n", color={**light, "Z": depth})
        self.assertEqual(done.returncode, 0)
        self.assertIn("2 values of", done.stderr)
        self.assertIn("2 depths of", done.stderr)
        for values in read_exr(self.out)[2].values():
            self.assertTrue(all(map(math.isfinite, values)))

    def test_missing_layers_are_named(self):
        self.assert_refused(self.composite(ABSORBING, color=LIGHT), "no layer Z or depth.Z (it has B, G, R)")
        self.assert_refused(self.composite(ABSORBING, color={"Y": [1.0] * COUNT}), "no layer R (it has Y)")

    def test_sizes_must_agree(self):
        done = self.composite(ABSORBING, color=LIGHT, depth=(2, 2, {"Z": [1.0] * 4}))
        self.assert_refused(done, "the depth has 2 × 2 pixels, the picture 6 × 4")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
