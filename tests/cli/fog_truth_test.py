"""The study fog_truth at a size that takes seconds: fog_truth_test.py LUMULUS [unittest arguments]."""

import math
import re
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

RUN = Path(__file__).resolve().parents[2] / "scripts/study/run"
LUMULUS = sys.argv[1]


class FogTruth(unittest.TestCase):
    def test_tables_and_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run([sys.executable, RUN, "fog_truth", folder, "--lumulus", LUMULUS, "--spp", "4", "--width", "32",
                                     "--filters", "scatter"], capture_output=True, text=True, timeout=280)
            self.assertEqual(result.returncode, 0, result.stderr)
            rows = re.findall(r"^\| (\d) \| `scatter` \| ([\d.]+) \| (.+?) % ", result.stdout, re.MULTILINE)
            self.assertEqual([row[0] for row in rows], ["1", "2", "4", "8"] * 2)
            for depth, error, bias in rows:
                # a filter that does nothing has an error of 1 in the scattered part
                self.assertLess(float(error), 0.8, depth)
                self.assertTrue(math.isfinite(float(bias)))
            png = (Path(folder) / "fog-truth.png").read_bytes()
            self.assertEqual(struct.unpack(">4sII", png[12:24]), (b"IHDR", 5 * 32, 4 * 18))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
