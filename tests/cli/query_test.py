"""`lumulus query` on good and bad input: query_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments]."""

import csv
import io
import json
import math
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from cli_test import CliTest  # noqa: E402
from flat_layers import read_exr  # noqa: E402

# a ball of radius 100 m about (0, 100, 0)
SCENE = """
[[cloud]]
procedural = "sphere"
resolution = 32
extinction = 0.02
[sun]
azimuth = 0.0
elevation = 90.0
[[fog.media]]
scattering = [1e-4, 2e-4, 3e-4]
"""


class Query(CliTest):
    def setUp(self):
        super().setUp()
        self.path = self.scene(SCENE)

    def table(self, text):
        path = self.folder / "table.csv"
        path.write_text(text)
        return path

    def ask(self, *arguments, **options):
        result = self.run_lumulus("query", self.path, "--quiet", *arguments, **options)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout

    def rows(self, text):
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(io.StringIO(text))]

    def test_segments(self):
        table = self.table("x0,y0,z0,x1,y1,z1\n-500,100,0,500,100,0\n0,100,0,500,100,0\n7,8,9,7,8,9\n"
                           "1e7,0,1e7,1e7,1000,1e7\n")
        through, half, nothing, far = self.rows(self.ask("--segments", table))
        for channel, fog in (("r", 1e-4), ("g", 2e-4), ("b", 3e-4)):
            depth, share = f"optical_depth_{channel}", f"transmittance_{channel}"
            self.assertAlmostEqual(half[depth], 0.5 * through[depth], delta=1e-3 * through[depth])
            self.assertAlmostEqual(through[share], math.exp(-through[depth]), delta=1e-6)
            self.assertEqual((nothing[depth], nothing[share]), (0, 1))
            self.assertAlmostEqual(far[depth], 1000 * fog, delta=1e-6)
        self.assertAlmostEqual(through["optical_depth_b"] - through["optical_depth_r"], 0.2, delta=1e-5)
        self.assertGreater(through["optical_depth_r"], 1)

    def test_json_says_the_same(self):
        table = self.table("-500,100,0,500,100,0\n7,8,9,7,8,9\n")
        rows = self.rows(self.ask("--segments", table))
        passages = json.loads(self.ask("--segments", table, "--json"))["passages"]
        for row, passage in zip(rows, passages, strict=True):
            self.assertEqual(list(row.values()), passage["transmittance"] + passage["optical_depth"])
        self.ask("--segments", table, "--json", "-o", self.out / "a.json")
        self.assertEqual(json.loads((self.out / "a.json").read_text())["passages"], passages)

    def test_sun(self):
        scene = self.scene(SCENE + "[ground]\nheight = -10.0\n")
        table = self.table("x,y,z\n0,-5,0\n0,300,0\n0,-20,0\n")
        below, above, buried = self.rows(self.ask("--sun", table))
        self.assertLess(below["transmittance_r"], 0.5 * above["transmittance_r"])
        self.assertEqual(buried["transmittance_r"], 0)
        self.assertEqual(json.loads(self.ask("--sun", table, "--json"))["passages"][2]["optical_depth"], [None] * 3)
        self.assertEqual(scene, self.path)

    def test_standard_input(self):
        result = self.ask("--segments", "-", input="7,8,9,7,8,9\n")
        self.assertEqual(len(self.rows(result)), 1)

    def test_ground_shadow(self):
        self.ask("--ground-shadow", "-300,-300,300,300", "--size", "30x20", "--height", "-50", "-o", self.out / "a.exr")
        width, height, layers, attributes = read_exr(self.out / "a.exr")
        self.assertEqual((width, height, set(layers)), (30, 20, {"R", "G", "B"}))
        self.assertLess(layers["R"][10 * 30 + 15], 0.5 * layers["R"][0])
        self.assertIn("at -50 m", attributes["rectangle"])

    def test_ambient(self):
        scene = '[sun]\nazimuth = 90.0\nelevation = 30.0\nirradiance = 2.0\n[sky]\nradiance = [1.0, 2.0, 3.0]\n'
        open_sky = self.scene('cloud = []\n' + scene)
        table = self.table("x,y,z\n0,10,0\n0,100,0\n")
        rows = self.rows(self.ask("--ambient", table))
        for row in rows:
            self.assertEqual([row[f"sun_{c}"] for c in "rgb"], [2, 2, 2])
            for channel, radiance in (("r", 1), ("g", 2), ("b", 3)):
                self.assertAlmostEqual(row[f"sh0_{channel}"], radiance * math.sqrt(4 * math.pi), delta=1e-4)
                for i in range(1, 9):
                    self.assertAlmostEqual(row[f"sh{i}_{channel}"], 0, delta=0.02)
        points = json.loads(self.ask("--ambient", table, "--json"))["points"]
        self.assertEqual([points[0]["sh"][i][0] for i in range(9)], [rows[0][f"sh{i}_r"] for i in range(9)])
        # above a black ground the lower half is dark; in a cloud there is light, and less sun
        self.scene(scene + '[ground]\nalbedo = 0.0\n[[cloud]]\nprocedural = "sphere"\nresolution = 16\n'
                   'extinction = 0.02\n[photon_map]\nphotons = 20000\ngenerations = 2\n[preparation]\nsamples = 500\n')
        aside, inside = self.rows(self.ask("--ambient", self.table("2000,10,0\n0,100,0\n")))
        self.assertAlmostEqual(aside["sh1_r"], 1.5 * aside["sh0_r"] / math.sqrt(3), delta=0.05)
        self.assertLess(inside["sun_r"], 0.5 * aside["sun_r"])
        self.assertGreater(inside["sh0_r"], 0.3 * aside["sh0_r"])
        self.assertEqual(open_sky, self.path)
        self.rejected("query", self.path, "--ambient", self.table("0,1,0\n0,-1,0\n"), says="row 2")

    def test_ambient_under_an_atmosphere(self):
        """The sun of a point is that of `lumulus sky` at a camera there, through the air."""
        scene = '[sun]\nelevation = 12.0\n[sky]\nmodel = "atmosphere"\n[camera]\nposition = [0.0, 500.0, 0.0]\n'
        self.scene("cloud = []\n" + scene)
        row, higher = self.rows(self.ask("--ambient", self.table("0,500,0\n0,60000,0\n")))
        result = self.run_lumulus("sky", self.path, "--json")
        irradiance = json.loads(result.stdout)["sun"]["irradiance"]
        for channel, expected in zip("rgb", irradiance):
            self.assertAlmostEqual(row[f"sun_{channel}"], expected, delta=0.01 * expected)
            self.assertGreater(higher[f"sun_{channel}"], 1.1 * expected)

    def test_bad_tables(self):
        for text, says in (("1,2,3,4,5\n", "table.csv:1): each row has the numbers x0,y0,z0,x1,y1,z1"),
                           ("x0,y0,z0,x1,y1,z1\n1,2,3,4,5,six\n", 'z1 = "six" is no number'),
                           ("1,2,3,4,5,nan\n", "table.csv:1"), ("1,2,3,4,5,2e9\n", "±1e9")):
            self.rejected("query", self.path, "--segments", self.table(text), "-o", self.out / "a.csv", says=says)
        self.rejected("query", self.path, "--segments", self.folder / "none.csv", says="none.csv")
        self.rejected("query", self.path, "--segments", self.folder, says="cannot read the file")

    def test_bad_usage(self):
        table = self.table("7,8,9,7,8,9\n")
        self.rejected("query", self.path, says="exactly one subject")
        self.rejected("query", self.path, "--segments", table, "--sun", table, says="exactly one subject")
        self.rejected("query", "-", "--segments", "-", says="standard input")
        shadow = ["query", self.path, "--ground-shadow"]
        self.rejected(*shadow, "0,0,1,1", says="-o shadow.exr")
        self.rejected(*shadow, "0,0,1,1", "-o", self.out / "a.png", says=".exr")
        self.rejected(*shadow, "0,0,0,1", "-o", self.out / "a.exr", says="is no rectangle")
        self.rejected(*shadow, "0,0,nan,1", "-o", self.out / "a.exr", says="±1e9")
        for size in ("0x5", "5", "5x", "axb", "20000x5", "5x5x5"):
            self.rejected(*shadow, "0,0,1,1", "--size", size, "-o", self.out / "a.exr", says="--size")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
