"""The same seed gives the same bits, whatever the number of threads: threads_test.py LUMULUS [unittest arguments].

LP_NUM_THREADS is the number of lavapipe's threads; a picture is rendered in a process for each.
"""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from flat_layers import read_exr  # noqa: E402

LUMULUS = Path(sys.argv[1]).resolve()

SCENE = """
[image]
width = 48
height = 32

[preparation]
samples = 2000

[photon_map]
photons = 20000
generations = 3
forward_cut = 12.0

[[cloud]]
procedural = "cumulus"
resolution = 32
albedo = [1.0, 0.95, 0.8]
"""


class Threads(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = Path(self._folder.name)
        (self.folder / "scene.toml").write_text(SCENE)

    def rendered(self, threads, *more):
        """Layers of the picture, by a process of its own."""
        path = self.folder / "out.exr"
        environment = dict(os.environ, LP_NUM_THREADS=str(threads))
        result = subprocess.run([LUMULUS, "render", "scene.toml", "-o", str(path), "--quiet", *more],
                                capture_output=True, text=True, timeout=120, cwd=self.folder, env=environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        layers = read_exr(path)[2]
        path.unlink()
        return layers

    def test_pictures_are_the_same(self):
        for mode in ("march", "billboards"):
            with self.subTest(mode=mode):
                draw = ["--set", f"draw.mode={mode}"]
                one = self.rendered(1, *draw)
                self.assertGreater(max(one["cloud.G"]), 0.0)
                self.assertEqual(one, self.rendered(2, *draw))

    def test_seeds_differ(self):
        one = self.rendered(2)
        self.assertEqual(one, self.rendered(2))
        self.assertNotEqual(one["R"], self.rendered(2, "--seed", "7")["R"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
