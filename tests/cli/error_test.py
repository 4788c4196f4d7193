"""`render --error` and `--correct`: error_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments]."""

import json
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from cli_test import SMALL, CliTest  # noqa: E402
from flat_layers import read_exr  # noqa: E402

SCENE = """
[[cloud]]
procedural = "sphere"
resolution = 16
extinction = 0.02
"""
SKY = "sky = { model = \"constant\" }\n"
FOG = "[fog]\n[[fog.media]]\nkind = \"homogeneous\"\nscattering = 1e-4\nbottom = 0.0\ntop = 2000.0\n"


def counted(layers):
    """The pixels of cloud and fog."""
    return [i for i, t in enumerate(zip(*(layers[f"transmittance.{c}"] for c in "RGB"))) if min(t) < 0.999]


def mean(layers, pixels, prefix=""):
    return sum(layers[f"{prefix}{c}"][i] for c in "RGB" for i in pixels) / (3 * len(pixels))


class Error(CliTest):
    def measured(self, scene, *more, quiet=True):
        """Layers, header, the statistics' `error` and what was said of a picture whose error is measured."""
        path, stats = self.out / "a.exr", self.out / "a.json"
        result = self.run_lumulus("render", scene, "-o", path, "--stats", stats, *(SMALL if quiet else SMALL[1:]), *more)
        self.assertEqual(result.returncode, 0, result.stderr)
        _, _, layers, header = read_exr(path)
        return layers, header, json.loads(stats.read_text()).get("error"), result.stderr

    def test_keys_layers_and_header(self):
        layers, header, error, said = self.measured(self.scene(SKY + SCENE), "--error-paths", "20000", quiet=False)
        self.assertEqual(list(error), ["bias", "bias_sigma", "relmse", "relmse_sigma", "mean", "pixels", "paths", "lost",
                                       "seconds", "corrected", "blocks"])
        self.assertEqual(list(error["blocks"][0]), ["x", "y", "width", "height", "pixels", "bias", "bias_sigma"])
        pixels = counted(layers)
        self.assertEqual(error["pixels"], len(pixels))
        self.assertEqual(sum(block["pixels"] for block in error["blocks"]), len(pixels))
        self.assertTrue(all(block["height"] == 3 for block in error["blocks"]), "an eighth of 24")
        self.assertAlmostEqual(error["mean"], mean(layers, pixels), delta=1e-5 * error["mean"])
        self.assertGreaterEqual(error["paths"], 20000)
        self.assertFalse(error["corrected"])
        for key in ("bias", "bias_sigma", "relmse", "relmse_sigma", "paths"):
            self.assertAlmostEqual(float(header[f"error.{key}"]), error[key], delta=1e-5 * abs(error[key]))
        self.assertNotIn("error.corrected", header)
        # the mean of the layer is the bias in radiance
        self.assertAlmostEqual(sum(layers["error.bias"]) / len(pixels), error["bias"] * error["mean"],
                               delta=1e-4 * error["mean"])
        self.assertGreater(min(layers["error.sigma"][i] for i in pixels), 0.0)
        self.assertRegex(said.splitlines()[-1], r"^lumulus: measured by \d+ paths in .* bias .* relMSE .* \(one sigma\)$")

        own = self.run_lumulus("compare", self.out / "a.exr", "--self", "--json")
        self.assertEqual(json.loads(own.stdout), {key: json.loads(header[f"error.{key}"]) for key in (
            "bias", "bias_sigma", "paths", "relmse", "relmse_sigma")})
        self.assertIn("bias_sigma", self.run_lumulus("compare", self.out / "a.exr", "--self").stdout)

    def test_compare_self_needs_a_stated_error(self):
        self.measured(self.scene(SKY + SCENE))
        picture = self.out / "a.exr"
        for words, says in (([picture, "--self"], "--error"), ([picture, picture, "--self"], "--self"), ([picture], "--self")):
            self.assertIn(says, self.one_line(self.run_lumulus("compare", *words), 2))

    def test_the_picture_stays_and_the_measure_repeats(self):
        scene = self.scene(SKY + SCENE)
        plain, header, error, _ = self.measured(scene)
        self.assertIsNone(error)
        self.assertFalse([key for key in [*plain, *header] if key.startswith("error")])
        first, _, _, _ = self.measured(scene, "--error-paths", "2000")
        bytes_of_first = (self.out / "a.exr").read_bytes()
        self.assertEqual({name: first[name] for name in plain}, plain)
        self.measured(scene, "--error-paths", "2000")
        self.assertEqual((self.out / "a.exr").read_bytes(), bytes_of_first)
        self.measured(scene, "--error-paths", "2000", "--threads", "1")
        self.assertEqual((self.out / "a.exr").read_bytes(), bytes_of_first)

    def test_a_wrong_picture_is_found_and_corrected(self):
        """Where light goes a third of a voxel between two scattering events: six percent too bright."""
        scene = self.scene(SKY + SCENE.replace("0.02", "0.3") + 'phase = { model = "hg", g = 0.0 }\n')
        wrong = ["--set", "photon_map.photons=20000", "--error-paths", "150000"]
        before, _, error, _ = self.measured(scene, *wrong, "--no-correct")
        self.assertGreater(abs(error["bias"]), 4 * error["bias_sigma"])
        after, header, again, said = self.measured(scene, *wrong, "--correct", quiet=False)
        self.assertTrue(again["corrected"])
        self.assertEqual(again["before"]["bias"], error["bias"])
        self.assertEqual(again["before"]["relmse"], error["relmse"])
        self.assertLess(abs(again["bias"]), 5 * again["bias_sigma"])
        self.assertLess(again["relmse"], 0.5 * error["relmse"])
        self.assertIn("unbiased", header["error.corrected"])
        self.assertRegex(said.splitlines()[-2], r"^lumulus: corrected by \d+ paths \(\d+ a pixel\) in .*; before: bias")
        pixels = counted(before)
        gone = [mean(before, pixels, prefix) - mean(after, pixels, prefix) for prefix in ("", "cloud.")]
        self.assertAlmostEqual(gone[0], gone[1], delta=1e-5 * error["mean"])
        self.assertAlmostEqual(gone[0] / error["mean"], error["bias"], delta=6 * error["bias_sigma"])
        others = set(range(len(before["R"]))) - set(pixels)
        self.assertTrue(all(before["R"][i] == after["R"][i] for i in others))

    def test_wrong_pictures_are_corrected_unasked(self):
        """Where photons alone make a dense cloud too dark: not in drafts, not where told otherwise, not against a clock."""
        scene = self.scene(SKY + SCENE.replace("0.02", "1.0") + 'phase = { model = "hg", g = 0.0 }\nalbedo = 0.9\n')
        few = ["--set", "photon_map.photons=20000"]
        path, stats = self.out / "a.exr", self.out / "a.json"
        plain, _, _, said = self.measured(scene, *few, "--no-correct", quiet=False)
        self.assertRegex(said, "warning: cloud.0 is so dense")
        pixels = counted(plain)
        better, header, error, said = self.measured(scene, *few, quiet=False)
        self.assertIsNone(error)
        self.assertRegex(said, r"lumulus: corrected by \d+ paths")
        self.assertIn("unbiased", header["error.corrected"])
        self.assertLessEqual(json.loads(stats.read_text())["correction"]["pixels"], len(pixels))
        truth = self.out / "truth.exr"
        self.run_lumulus("reference", scene, "-o", truth, "--spp", "64", *SMALL[:1], "--set", "image.width=32", "--set",
                         "image.height=24")
        right = mean(read_exr(truth)[2], pixels)
        self.assertLess(mean(plain, pixels) / right, 0.95)
        self.assertAlmostEqual(mean(better, pixels) / right, 1.0, delta=0.02)
        first = path.read_bytes()
        self.measured(scene, *few, "--threads", "1")
        self.assertEqual(path.read_bytes(), first)
        for more in (["--quality", "draft"], ["--seconds", "1"]):
            _, header, _, _ = self.measured(scene, *few, *more)
            self.assertNotIn("error.corrected", header)
        frames = self.run_lumulus("render", scene, "-o", self.out / "f_##.exr", "--frames", "0-0", *few, *SMALL)
        self.assertEqual(frames.returncode, 0, frames.stderr)
        self.assertIn("unbiased", read_exr(self.out / "f_00.exr")[3]["error.corrected"])

    def test_fog_air_several_clouds_and_bricks(self):
        second = SCENE + "transform = [[1, 0, 0, 900], [0, 1, 0, 0], [0, 0, 1, -900]]\n"
        for name, text in (("fog", SKY + SCENE + FOG), ("air", SCENE), ("clouds", SKY + SCENE + second),
                           ("bricks", SKY + SCENE + "[preparation]\nstorage = \"sparse\"\n"),
                           ("background", SKY + SCENE + "[image]\nbackground = false\n")):
            with self.subTest(scene=name):
                _, _, error, _ = self.measured(self.scene(text), "--error-paths", "4000")
                self.assertLess(abs(error["bias"]), 0.15 + 4 * error["bias_sigma"], "few photons")
                self.assertEqual(error["lost"], 0)

    def test_time(self):
        for more in (["--error"], ["--error-seconds", "0.2"], ["--correct"]):
            with self.subTest(more=more):
                _, _, error, _ = self.measured(self.scene(SKY + SCENE), *more)
                self.assertGreater(error["paths"], 0)
                self.assertGreater(error["seconds"], 0.0)

    def test_a_sky_without_clouds_has_no_error(self):
        layers, _, error, said = self.measured(self.scene(SKY + "cloud = []\n"), "--error")
        self.assertIsNone(error)
        self.assertRegex(said, r"^lumulus: warning: no pixel shows a cloud or fog")
        self.assertNotIn("error.bias", layers)

    def test_bad_options(self):
        scene = self.scene(SKY + SCENE)
        for value in ("0", "-1", "nan", "inf", "soon", ""):
            self.rejected_scene(scene, "--error-seconds", value, says="--error-seconds")
        for value in ("0", "-1", "1e999", "many", ""):
            self.rejected_scene(scene, "--error-paths", value, says="--error-paths")
        self.rejected_scene(scene, "--error-paths", "10", "--error-seconds", "1", says="--error-paths")
        self.rejected("render", scene, "--error", "--map-out", self.out / "a.map", says="--error")
        self.rejected_scene(scene, "--correct", "--no-correct", says="--no-correct")

    def test_clouds_that_are_too_large_for_paths(self):
        large = SKY + SCENE.replace("16", "128") + "[preparation]\nstorage = \"sparse\"\nmemory_budget = 4\n"
        self.rejected_scene(self.scene(large), *SMALL, "--error", says="preparation.memory_budget")

    def test_interrupted(self):
        self.interrupt("error", "render", self.scene(SKY + SCENE), "-o", self.out / "a.exr", "--error-seconds", "1000",
                       *SMALL[1:])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
