"""`lumulus composite` by its files: composite_test.py LUMULUS [unittest arguments]."""

import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy
import OpenImageIO

sys.path.insert(0, str(Path(__file__).parent))
from flat_layers import pictures, read_exr, write_exr  # noqa: E402

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

    def written(self, path, parts):
        """An EXR file of several parts: (part's name, {channel: value}, data window x y width height, display window)."""
        specs = []
        for name, channels, data, display in parts:
            spec = OpenImageIO.ImageSpec(data[2], data[3], len(channels), OpenImageIO.FLOAT)
            spec.x, spec.y = data[:2]
            spec.full_x, spec.full_y, spec.full_width, spec.full_height = display
            spec.channelnames = tuple(channels)
            if len(parts) > 1:
                spec.attribute("oiio:subimagename", name)
            specs.append(spec)
        file = OpenImageIO.ImageOutput.create(str(path))
        self.assertTrue(file.open(str(path), tuple(specs)) if len(specs) > 1 else file.open(str(path), specs[0]))
        for i, (_, channels, data, _) in enumerate(parts):
            if i > 0:
                self.assertTrue(file.open(str(path), specs[i], "AppendSubimage"))
            pixels = numpy.empty((data[3], data[2], len(channels)), "f")
            for c, value in enumerate(channels.values()):
                pixels[..., c] = value
            self.assertTrue(file.write_image(pixels))
        file.close()

    def composed(self, scene, *arguments):
        """The spec and the layers of the file that comes out."""
        path = self.folder / "scene.toml"
        path.write_text("cloud = []\n[camera]\nposition = [0, 0, 5]\n" + scene)
        done = subprocess.run([LUMULUS, "composite", "--color", self.color, "--scene", path, "-o", self.out, *arguments],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        file = OpenImageIO.ImageInput.open(str(self.out))
        spec = file.spec()
        file.close()
        return spec, pictures.read_exr(self.out)

    def test_windows_stay_and_the_camera_is_that_of_the_display_window(self):
        """Planar depth through absorption: a pixel of a crop, or of an overscan, has the distance that it has in the whole
        picture."""
        scene = '[fog]\ndepth = "planar"\n[[fog.media]]\nabsorption = 0.01\n'
        display, whole = (0, 0, 16, 9), (-2, -3, 20, 15)
        light = {"R": 1.0, "G": 2.0, "B": 4.0, "A": 0.5, "Z": 50.0}
        self.written(self.color, [("", light, whole, display)])
        spec, complete = self.composed(scene)
        self.assertEqual((spec.x, spec.y, spec.width, spec.height), whole)
        self.assertEqual((spec.full_x, spec.full_y, spec.full_width, spec.full_height), display)
        self.assertEqual(set(spec.channelnames), set("RGBA"))
        half = math.tan(math.radians(20))
        for x, y in ((0, 0), (9, 4), (19, 14)):
            across, up = ((x - 2 + 0.5) / 16 * 2 - 1) * half * 16 / 9, (1 - (y - 3 + 0.5) / 9 * 2) * half
            expected = 2.0 * math.exp(-0.5 * math.sqrt(1 + across**2 + up**2))
            self.assertAlmostEqual(complete["G"][y, x] / expected, 1.0, places=5)
        for crop in ((5, 2, 8, 4), (-2, -3, 3, 3), (12, 5, 6, 7)):
            self.written(self.color, [("", light, crop, display)])
            spec, part = self.composed(scene)
            self.assertEqual((spec.x, spec.y, spec.width, spec.height), crop)
            inside = complete["R"][crop[1] + 3:crop[1] + 3 + crop[3], crop[0] + 2:crop[0] + 2 + crop[2]]
            self.assertLess(abs(part["R"] / inside - 1).max(), 1e-5)
            self.assertEqual(set(part["A"].ravel()), {0.5})

    def test_layers_and_parts(self):
        window = (0, 0, WIDTH, HEIGHT)
        layers = {"ViewLayer.Combined.R": 3.0, "ViewLayer.Combined.G": 2.0, "ViewLayer.Combined.B": 1.0,
                  "ViewLayer.Depth.Z": 100.0, "ViewLayer.Normal.X": 0.0, "ViewLayer.Normal.Y": 0.0,
                  "ViewLayer.Normal.Z": 1.0, "Light.Combined.R": 5.0, "Light.Combined.G": 5.0, "Light.Combined.B": 5.0}
        self.written(self.color, [("", layers, window, window)])
        _, found = self.composed(ABSORBING, "--layer", "ViewLayer.Combined")
        self.assertAlmostEqual(found["R"][1, 2] / (3.0 * math.exp(-1.0)), 1.0, places=5)
        self.assertEqual(set(found), set("RGB"))
        path = self.folder / "scene.toml"
        done = subprocess.run([LUMULUS, "composite", "--color", self.color, "--scene", path, "-o", self.folder / "no.exr"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("choose one by --layer: Light.Combined, ViewLayer.Combined", done.stderr)
        self.written(self.color, [("diffuse", {"diffuse.R": 9.0, "diffuse.G": 9.0, "diffuse.B": 9.0}, window, window),
                                  ("rgba", {"R": 3.0, "G": 2.0, "B": 1.0, "A": 1.0}, window, window),
                                  ("depth", {"Z": 100.0}, window, window)])
        _, found = self.composed(ABSORBING)
        self.assertAlmostEqual(found["R"][1, 2] / (3.0 * math.exp(-1.0)), 1.0, places=5)
        _, found = self.composed(ABSORBING, "--layer", "diffuse")
        self.assertAlmostEqual(found["R"][1, 2] / (9.0 * math.exp(-1.0)), 1.0, places=5)

    def test_sizes_must_agree(self):
        done = self.composite(ABSORBING, color=LIGHT, depth=(2, 2, {"Z": [1.0] * 4}))
        self.assert_refused(done, "the depth has 2 × 2 pixels, the picture 6 × 4")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
