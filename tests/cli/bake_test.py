"""Light as grids: bake_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments]."""

import json
import math
import resource
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import pyopenvdb as openvdb

sys.path.insert(0, str(Path(__file__).parent))
from cli_test import LUMULUS, CliTest  # noqa: E402

SCENE = """
photon_map = { photons = 400000, generations = 2 }
preparation = { samples = 500 }
sky = { model = "constant", radiance = [2.0, 1.0, 0.5] }
sun = { direction_to = [1, 0, 0], irradiance = [3.0, 2.0, 1.0] }
[[cloud]]
procedural = "sphere"
resolution = 18
extinction = 1e-3
"""
NAMES = ["fluence", "flux_red", "flux_green", "flux_blue", "sun"] + [f"sh{i}" for i in range(9)]


class Bake(CliTest):
    def bake(self, scene, *more):
        path = self.out / "light.vdb"
        result = self.run_lumulus("bake", scene, "-o", path, "--quiet", *more)
        self.assertEqual((result.returncode, result.stderr.count("error")), (0, 0), result.stderr)
        return path

    def test_grids_and_conventions(self):
        """Little is scattered in this cloud (optical thickness 0.2): fluence is 4 pi L and the sun, flux the sun's."""
        path = self.bake(self.scene(SCENE), "--voxel", 40, "--nvdb")
        conventions = json.loads(path.with_suffix(".json").read_text())
        self.assertEqual((conventions["format"], conventions["version"], conventions["file"]),
                         ("lumulus light", 1, "light.vdb"))
        self.assertEqual(conventions["direction_to_sun"], [1.0, 0.0, 0.0])
        self.assertEqual(list(conventions["grids"]), NAMES)
        grids = {grid.name: grid for grid in openvdb.readAll(str(path))[0]}
        self.assertEqual(sorted(grids), sorted(NAMES))
        for name, grid in grids.items():
            self.assertEqual(grid["unit"], conventions["grids"][name]["unit"])
            self.assertEqual(grid.transform.voxelSize(), (40.0, 40.0, 40.0))
            self.assertEqual(grid.activeVoxelCount(), conventions["frame"]["voxels"])
        # the ball has a radius of 100 m about (0, 100, 0); few photons meet its rim
        middle = [item.min for item in grids["sun"].iterOnValues()
                  if math.dist([40 * i for i in item.min], (0, 100, 0)) < 70]
        value = {name: [sum(grid.getConstAccessor().getValue(place)[c] for place in middle) / len(middle)
                        for c in range(3)] for name, grid in grids.items()}
        for c, (sky, sun) in enumerate(zip((2.0, 1.0, 0.5), (3.0, 2.0, 1.0))):
            self.assertAlmostEqual(value["sun"][c] / sun, 0.9, delta=0.1)  # between 1 and exp(-0.2)
            self.assertAlmostEqual(value["fluence"][c] / (4 * math.pi * sky + sun), 1, delta=0.1)
            flux = value["flux_" + ("red", "green", "blue")[c]]
            self.assertAlmostEqual(flux[0] / -sun, 1, delta=0.5)
        info = self.run_lumulus("info", path.with_suffix(".nvdb"), "--json")
        self.assertEqual(sorted(grid["name"] for grid in json.loads(info.stdout)["grids"]), sorted(NAMES))

    def test_same_bytes(self):
        scene = self.scene(SCENE)
        path = self.bake(scene, "--nvdb", "--voxel", 20)
        files = [path, path.with_suffix(".nvdb"), path.with_suffix(".json")]
        before = [file.read_bytes() for file in files]
        self.bake(scene, "--nvdb", "--voxel", 20, "--threads", 1)
        self.assertEqual([file.read_bytes() for file in files], before)
        self.bake(scene, "--voxel", 20, "--seed", 2)
        self.assertNotEqual(path.read_bytes(), before[0])


class Refusals(CliTest):
    def test_bad_input(self):
        scene, out = self.scene(SCENE), self.out / "light.vdb"
        for more, says in ((["--voxel", "0"], "0 m is no edge"), (["--voxel", "nan"], "is no edge"),
                           # before photons are traced, which would take hours
                           (["--voxel", "0.01", "--set", "photon_map.photons=4000000000", "--set",
                             "photon_map.generations=1"], "--voxel): give larger ones"),
                           (["--voxel", "wide"], "--voxel"),
                           (["--voxel", "1e300"], "larger than the clouds"),
                           (["--set", "cloud.0.albedo=0"], "no light is scattered in a cloud"),
                           (["--set", "sky.radiance=0", "--set", "sun.irradiance=0"], "no light is scattered"),
                           (["--set", "cloud.0.albedoo=1"], "unknown key"), (["--device", "none such"], "device")):
            with self.subTest(more=more):
                result = self.run_lumulus("bake", scene, "-o", out, "--quiet", *more)
                self.assertIn(says, self.one_line(result, 2 if says != "device" else result.returncode))
                self.assertEqual(list(self.out.iterdir()), [])
        self.rejected("bake", scene, "-o", self.out / "light.exr", says="cannot write a file of this kind")
        self.rejected("bake", self.folder / "missing.toml", "-o", out)
        self.rejected("bake", scene, "-o", self.folder / "missing" / "light.vdb")

    def test_stops_and_leaves_nothing(self):
        process = subprocess.Popen([LUMULUS, "bake", self.scene(SCENE), "-o", str(self.out / "light.vdb"), "--quiet",
                                    "--set", "photon_map.photons=4000000000", "--set",
                                    "photon_map.generations=1"], stderr=subprocess.PIPE, text=True)
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        self.assertIn("interrupted", process.communicate(timeout=30)[1])
        self.assertEqual((process.returncode, list(self.out.iterdir())), (1, []))

    def test_full_disk(self):
        def small():
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
        result = self.run_lumulus("bake", self.scene(SCENE), "-o", self.out / "light.vdb", "--quiet", preexec_fn=small)
        self.one_line(result, 1)
        self.assertEqual(list(self.out.iterdir()), [])


class Example(CliTest):
    def test_a_march_through_the_grids_is_the_picture(self):
        script = Path(__file__).parents[2] / "src/python/examples/light_from_vdb.py"
        result = subprocess.run([sys.executable, str(script), LUMULUS, str(self.folder), "100000"], capture_output=True,
                                text=True, timeout=200)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("mean of the cloud's pixels", result.stdout)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
