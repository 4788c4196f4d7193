"""Files of clouds as people have them: input_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments]."""

import gzip
import json
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from cli_test import LUMULUS, SMALL, CliTest  # noqa: E402
from flat_layers import read_exr  # noqa: E402


class Input(CliTest):
    def picture(self, scene, *more, command="render", **options):
        """Layers and attributes of a small picture, and what stderr says."""
        path = self.out / "a.exr"
        small = SMALL if command == "render" else SMALL[:5]
        result = self.run_lumulus(command, scene, "-o", path, *small, *more, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        _, _, layers, attributes = read_exr(path)
        return layers, attributes, result.stderr

    def test_grid_by_name(self):
        fire = self.fixtures / "fire.vdb"
        layers, attributes, said = self.picture(self.vdb_scene(fire), "--stats", self.out / "s.json")
        self.assertRegex(said, r'^lumulus: warning: .*grid "Smoke" is taken')
        self.assertEqual(said.count("\n"), 1)
        self.assertEqual(attributes["grid"], "Smoke")
        self.assertEqual(json.loads((self.out / "s.json").read_text())["clouds"][0]["grid"], "Smoke")
        asked, _, said = self.picture(self.vdb_scene(fire, 'grid = "smoke"'))
        self.assertEqual(said, "")
        self.assertEqual(layers["R"], asked["R"])
        heat, attributes, _ = self.picture(self.vdb_scene(fire, 'grid = "HEAT"'))
        self.assertEqual(attributes["grid"], "heat")
        self.assertNotEqual(layers["R"], heat["R"])
        taken = [grid["taken"] for grid in json.loads(self.run_lumulus("info", "--json", fire).stdout)["grids"]]
        self.assertEqual(taken, [False, False, True])

    def test_the_line_of_a_cloud(self):
        scene = self.vdb_scene(self.fixtures / "ball.vdb")
        result = self.run_lumulus("render", scene, "-o", self.out / "a.exr", *SMALL[1:])
        # 13 voxels of 1.2345678 m, extinction 0.5 / m
        self.assertRegex(result.stderr, r'(?m)^lumulus: cloud 0: grid "density" of \S*ball.vdb, optical thickness at '
                                        r'most 8.02, [0-9.]+ on average$')
        told = result.stderr.index("lumulus: cloud 0")
        self.assertLess(told, result.stderr.index("photons: "), "before the work")

    def test_optical_thickness_in_statistics(self):
        stats = self.out / "s.json"
        self.picture(self.vdb_scene(self.fixtures / "ball.vdb"), "--stats", stats)
        thickness = json.loads(stats.read_text())["clouds"][0]["optical_thickness"]
        self.assertAlmostEqual(thickness["largest"], 0.5 * 13 * 1.2345678, places=5)
        grid, = json.loads(self.run_lumulus("info", "--json", self.fixtures / "ball.vdb").stdout)["grids"]
        self.assertAlmostEqual(sum(grid["optical_thickness"]["mean"]) / 3 * 0.5, thickness["mean"], places=6)

    def test_thin_clouds_are_warned_of(self):
        scene = self.vdb_scene(self.fixtures / "thin.vdb")
        for command, more in (("render", ()), ("reference", ("--spp", 1))):
            with self.subTest(command=command):
                _, attributes, said = self.picture(scene, *more, command=command)
                self.assertRegex(said, r"^lumulus: warning: .*optical thickness.*cloud\.0\.density_scale")
                self.assertEqual(attributes["grid"], "density")

    def test_thick_clouds_that_scatter_backwards_are_warned_of(self):
        scene = self.vdb_scene(self.fixtures / "ball.vdb", "density_scale = 4\nphase.g = -0.8")  # optical thickness 32
        self.assertRegex(self.picture(scene)[2], r"^lumulus: warning: cloud\.0 scatters backwards \(phase\.g -0\.8\)")
        for calm in ("cloud.0.phase.g=-0.4", "cloud.0.extinction=0.2", "sun.irradiance=0"):
            self.assertNotIn("backwards", self.picture(scene, "--set", calm)[2], calm)

    def test_negatives(self):
        _, _, said = self.picture(self.vdb_scene(self.fixtures / "small-negative.vdb"))
        self.assertRegex(said, r"^lumulus: warning: .* 1 negative voxel, the smallest -1e-07")
        (self.out / "a.exr").unlink()
        for name in ("negative", "nan", "infinite"):
            with self.subTest(name=name):
                line = self.rejected_scene(self.vdb_scene(self.fixtures / f"{name}.vdb"))
                self.assertIn("cloud.0.clamp = true", line)
                _, _, said = self.picture(self.vdb_scene(self.fixtures / f"{name}.vdb"), "--set", "cloud.0.clamp=true")
                self.assertRegex(said, r"^lumulus: warning: .*set to 0")
                (self.out / "a.exr").unlink()

    def test_a_cloud_in_place_of_the_scene(self):
        self.rejected("render", self.folder / "missing.vdb", "-o", self.out / "b.exr", says="missing.vdb")
        (self.folder / "empty.vdb").write_bytes(b"")
        self.rejected("render", self.folder / "empty.vdb", "-o", self.out / "b.exr", says="empty.vdb")
        ball = self.fixtures / "ball.vdb"
        by_scene, _, _ = self.picture(self.scene(f'[[cloud]]\nvdb = "{ball}"\n'))
        by_file, attributes, _ = self.picture(ball)
        self.assertEqual(by_scene, by_file)
        self.assertEqual(attributes["scene"], str(ball))
        loud = self.run_lumulus("render", ball, "-o", self.out / "a.exr", *SMALL[1:])
        self.assertRegex(loud.stderr.splitlines()[-1], "ball.vdb is an OpenVDB file")
        changed, _, _ = self.picture(ball, "--set", "cloud.0.extinction=2")
        self.assertNotEqual(changed["cloud.A"], by_file["cloud.A"])
        self.picture(ball, "--spp", 1, command="reference")

    def test_standard_input(self):
        (self.folder / "ball.vdb").write_bytes((self.fixtures / "ball.vdb").read_bytes())
        text = '[[cloud]]\nvdb = "ball.vdb"\nextinction = 0.5\n'  # beside where the program runs
        by_file, _, _ = self.picture(self.scene(text))
        by_input, attributes, _ = self.picture("-", input=text)
        self.assertEqual(by_file, by_input)
        self.assertEqual(attributes["scene"], "standard input")
        (self.out / "a.exr").unlink()
        result = self.run_lumulus("render", "-", "-o", self.out / "a.exr", input="[imag]\n")
        self.assertIn("(standard input:1, imag)", self.one_line(result, 2))
        with open(self.folder / "ball.vdb", "rb") as cloud:
            result = subprocess.run([LUMULUS, "render", "-", "-o", self.out / "a.exr"], stdin=cloud, text=True,
                                    stderr=subprocess.PIPE, timeout=60)
        self.assertIn("an OpenVDB file, not a scene", self.one_line(result, 2))

    def test_files_of_other_kinds(self):
        ball = (self.fixtures / "ball.vdb").read_bytes()
        for data, says in ((gzip.compress(ball), "gunzip"), (b"version https://git-lfs.github.com/spec/v1\n", "git lfs"),
                           (b"<!DOCTYPE html>", "a web page")):
            packed = self.folder / "packed.vdb"
            packed.write_bytes(data)
            (self.folder / "packed").write_bytes(data)
            with self.subTest(says=says):
                self.rejected_scene(self.vdb_scene("packed.vdb"), says=says)
                self.rejected("info", packed, says=says)
                self.rejected("render", packed, "-o", self.out / "a.exr", says=says)
                self.rejected("render", self.folder / "packed", "-o", self.out / "a.exr", says=says)

    def test_info_of_a_place(self):
        grid, = json.loads(self.run_lumulus("info", "--json", self.fixtures / "far.vdb").stdout)["grids"]
        edge = 1.2345678
        self.assertEqual(len(grid["transform"]), 4)
        for row, shift in enumerate((1e7, 1e7, -1e7)):
            self.assertEqual(grid["transform"][row], [edge if row == column else 0 for column in range(3)] + [shift])
            self.assertAlmostEqual(grid["world_minimum"][row], shift - 6.5 * edge, places=6)
            self.assertAlmostEqual(grid["world_maximum"][row], shift + 6.5 * edge, places=6)
        self.assertFalse(grid["mirrored"] or grid["rotated"])
        text = self.run_lumulus("info", self.fixtures / "far.vdb").stdout
        self.assertIn("metres    from 9999991.98 9999991.98 -10000008", text)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
