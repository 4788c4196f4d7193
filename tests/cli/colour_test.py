"""Pictures of few photons have no colour that no light has: colour_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments]."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from cli_test import CliTest  # noqa: E402
from flat_layers import read_exr  # noqa: E402

SKY, SUN = (0.12, 0.22, 0.42), (5.0, 4.8, 4.4)
HEAD = f"""
[image]
width = 64
height = 36
[sky]
radiance = {list(SKY)}
[sun]
irradiance = {list(SUN)}
"""
DECK = """
azimuth = 310.0
elevation = 12.0
[camera]
position = [100.0, 380.0, 800.0]
target = [0.0, 60.0, 0.0]
vertical_fov = 50.0
[[cloud]]
procedural = "stratus"
resolution = 96
phase = { model = "droplet", droplet_diameter = 10.0 }
"""
CUMULUS = """
azimuth = 62.0
elevation = 18.0
[[cloud]]
procedural = "cumulus"
resolution = 64
"""
SECOND = """
[[cloud]]
procedural = "cumulus"
resolution = 48
seed = 2
transform = [[0.6, 0.0, 0.0, 600.0], [0.0, 0.6, 0.0, 60.0], [0.0, 0.0, 0.6, 150.0]]
phase = { model = "droplet" }
"""
# of the ratio of red to blue: noise below zero, which is cut off, may take some light of one colour away
LEAST, MOST = 0.75, 1.02


class Colour(CliTest):
    def ratios(self, path, seed):
        """Of red to blue in the clouds' own light, where they hide a tenth or more."""
        result = self.run_lumulus("render", path, "-o", self.out / "p.exr", "--quality", "draft", "--quiet", "--seed", seed)
        self.assertEqual(result.returncode, 0, result.stderr)
        layers = read_exr(self.out / "p.exr")[2]
        shown = [i for i, t in enumerate(layers["transmittance.R"]) if t < 0.9]
        self.assertGreater(len(shown), 300)
        return [layers["cloud.R"][i] / max(layers["cloud.B"][i], 1e-12) for i in shown]

    def test_light_is_between_sun_and_sky(self):
        """Droplets that absorb nothing leave colours as they are: each pixel's lies between those of the lights."""
        for name, clouds in (("deck", DECK), ("cumulus", CUMULUS), ("two", CUMULUS + SECOND)):
            for seed in (1, 2, 3):
                with self.subTest(scene=name, seed=seed):
                    found = self.ratios(self.scene(HEAD + clouds), seed)
                    self.assertGreater(min(found), LEAST * SKY[0] / SKY[2])
                    self.assertLess(max(found), MOST * SUN[0] / SUN[2])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
