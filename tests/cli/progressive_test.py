"""`render --seconds` and `--target-error`: progressive_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments]."""

import json
import sys
import time
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
EACH = 1000  # photons of a generation, by SMALL


class Progressive(CliTest):
    def progressive(self, *more, quiet=True):
        """A picture, its statistics, what was said, and the seconds that the process took."""
        begin = time.monotonic()
        small = SMALL if quiet else SMALL[1:]
        result = self.run_lumulus("render", self.scene(SCENE), "-o", self.out / "a.exr", "--stats", "-", *small, *more)
        self.assertEqual(result.returncode, 0, result.stderr)
        return read_exr(self.out / "a.exr")[2], json.loads(result.stdout), result.stderr, time.monotonic() - begin

    def test_stops_at_the_target_error_and_says_so(self):
        _, stats, said, _ = self.progressive("--target-error", "0.2", quiet=False)
        reached = stats["progressive"]
        self.assertEqual(reached["stop"], "target-error")
        self.assertLessEqual(reached["noise"], 0.2)
        self.assertGreater(reached["noise"], 0.0)
        self.assertNotIn("bias_estimate", reached)
        self.assertEqual(reached["photons"], EACH * reached["generations"])
        self.assertEqual(stats["photons"], reached["photons"])
        self.assertRegex(said.splitlines()[-1],
                         rf"^lumulus: stopped by target-error after .* {reached['photons']} photons .* --error measures its bias$")

    def test_same_bits_as_a_picture_that_knows_its_photons(self):
        layers, stats, said, _ = self.progressive("--target-error", "0.01")
        self.assertEqual(stats["progressive"]["stop"], "target-error")
        known, _ = self.rendered(self.scene(SCENE), "--set", f"photon_map.photons={stats['photons']}", "--set",
                                 f"photon_map.generations={stats['generations']}")
        self.assertEqual(layers, known)

    def test_stops_in_time(self):
        _, stats, said, took = self.progressive("--seconds", "5", quiet=False)
        self.assertEqual(stats["progressive"]["stop"], "seconds")
        self.assertGreater(stats["generations"], 2)
        self.assertLess(took, 8.0)  # other work on the machine may delay it
        self.assertGreater(took, 3.0)
        self.assertIn("stopped by seconds", said)

    def test_too_little_time_draws_one_generation_and_says_so(self):
        _, stats, said, _ = self.progressive("--seconds", "0.001")
        self.assertEqual((stats["progressive"]["stop"], stats["generations"]), ("seconds", 1))
        self.assertIsNone(stats["progressive"]["noise"])
        self.assertRegex(said, r"^lumulus: warning: 0\.001 s were too short .*\n$")

    def test_a_very_thick_cloud_has_a_picture_in_time(self):
        """Density in wrong units: not one generation of the scene's photons would end."""
        for scale in ("1e3", "1e6"):
            with self.subTest(scale=scale):
                layers, stats, said, took = self.progressive("--seconds", "2", "--set", f"cloud.0.density_scale={scale}",
                                                             "--set", "photon_map.photons=1000000")
                self.assertEqual(stats["progressive"]["stop"], "seconds")
                self.assertLess(stats["seconds"]["total"], 2 * 2 + 3)
                self.assertGreater(max(layers["cloud.G"]), 0.0)
                self.assertIn("warning", said)

    def test_whatever_comes_first(self):
        _, stats, _, _ = self.progressive("--target-error", "0.5", "--seconds", "100")
        self.assertEqual(stats["progressive"]["stop"], "target-error")
        _, stats, _, _ = self.progressive("--target-error", "1e-9", "--seconds", "1")
        self.assertEqual(stats["progressive"]["stop"], "seconds")

    def test_nothing_to_trace(self):
        result = self.run_lumulus("render", self.scene("cloud = []"), "-o", self.out / "a.png", "--stats", "-", *SMALL,
                                  "--target-error", "1e-6", "--seconds", "50")
        self.assertEqual(json.loads(result.stdout)["progressive"]["stop"], "photons")

    def test_bad_values(self):
        for option in ("--seconds", "--target-error"):
            for value in ("0", "-1", "nan", "inf", "1e999", "soon", ""):
                with self.subTest(option=option, value=value):
                    self.rejected_scene(self.scene(SCENE), option, value, says=option)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
