"""Environment maps: environment_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments].

Files are read by OpenImageIO, which knows nothing of the program.
"""

import json
import math
import resource
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import numpy
import OpenImageIO as oiio

sys.path.insert(0, str(Path(__file__).parent))
from cli_test import LUMULUS, CliTest  # noqa: E402

CLOUDLESS = "cloud = []\n"
CONSTANT = """
sky = { model = "constant", radiance = [2.0, 1.0, 0.5] }
sun = { direction_to = [0.6, 0.8, 0], irradiance = [3.0, 2.0, 1.0], angular_diameter = 2.0 }
camera = { position = [10, 20, 30] }
"""
AIR = """
sky = { model = "atmosphere" }
sun = { azimuth = 120, elevation = 40, angular_diameter = 2.0 }
ground = { albedo = 0.3 }
"""
CLOUD = CONSTANT + """
photon_map = { photons = 4000, generations = 2 }
preparation = { samples = 500 }
[[cloud]]
procedural = "sphere"
resolution = 18
extinction = 4e-3
"""


def levels_of(path):
    """Pixels of all mip levels, [rows, columns, 3], and the specification of the first."""
    file = oiio.ImageInput.open(str(path))
    assert file, oiio.geterror()
    found, spec = [], file.spec()
    while file.seek_subimage(0, len(found)):
        found.append(file.read_image("float"))
    return found, spec


def solid_angles(height):
    edges = numpy.sin(math.pi * (0.5 - numpy.arange(height + 1) / height))
    return (edges[:-1] - edges[1:]) * math.pi / height


def directions(width, height):
    """Of the middles of a panorama's pixels, as docs/environment.md has them."""
    longitude = 2 * math.pi * ((numpy.arange(width) + 0.5) / width - 0.5)
    latitude = math.pi * (0.5 - (numpy.arange(height) + 0.5) / height)
    return numpy.stack([numpy.outer(numpy.cos(latitude), numpy.cos(longitude)),
                        numpy.outer(numpy.sin(latitude), numpy.ones(width)),
                        numpy.outer(numpy.cos(latitude), numpy.sin(longitude))], -1)


def basis(direction):
    x, y, z = direction
    return [0.28209479, 0.48860251 * y, 0.48860251 * z, 0.48860251 * x, 1.09254843 * x * y, 1.09254843 * y * z,
            0.31539157 * (3 * z * z - 1), 1.09254843 * x * z, 0.54627422 * (x * x - y * y)]


class EnvironmentTest(CliTest):
    def made(self, scene, *more, name="env.exr"):
        path = self.out / name
        result = self.run_lumulus("environment", scene, "-o", path, "--quiet", *more)
        self.assertEqual((result.returncode, result.stderr.count("error")), (0, 0), result.stderr)
        return path, json.loads(path.with_suffix(".json").read_text())

    def sky(self, scene, *more):
        return json.loads(self.run_lumulus("sky", scene, "--json", *more).stdout)


class Maps(EnvironmentTest):
    def test_white_sky_in_all_files(self):
        path, told = self.made(self.scene(CLOUDLESS + CONSTANT), "--size", 32, "--levels", 4, "--by-level", "--by-face")
        faces = ["px", "nx", "py", "ny", "pz", "nz"]
        names = {"env.exr", "env.json", "env_latlong.exr", "env_brdf.exr", *(f"env_m{i}.exr" for i in range(4)),
                 *(f"env_m{i}_{face}.exr" for i in range(4) for face in faces)}
        self.assertEqual({file.name for file in self.out.iterdir()}, names)
        levels, spec = levels_of(path)
        self.assertEqual((spec.width, spec.height, len(levels)), (32, 192, 8))
        self.assertEqual(spec.getattribute("textureformat"), "CubeFace Environment")
        for i, level in enumerate(levels):
            self.assertEqual(level.shape, (max(1, 192 >> i), max(1, 32 >> i), 3))
        for file in sorted(names - {"env.json", "env_brdf.exr"}):
            for level in levels_of(self.out / file)[0]:
                for channel, radiance in enumerate((2.0, 1.0, 0.5)):
                    self.assertLess(abs(level[..., channel] / radiance - 1).max(), 1e-5, file)
        self.assertEqual([(level["roughness"], level["size"]) for level in told["levels"]],
                         [(i / 3, 32 >> i) for i in range(4)])
        self.assertEqual(levels_of(self.out / "env_m2.exr")[0][0].shape, (16, 32, 3))
        self.assertEqual(told["levels"][2]["faces"]["ny"], "env_m2_ny.exr")

    def test_conventions(self):
        path, told = self.made(self.scene(CLOUDLESS + CONSTANT), "--size", 64)
        self.assertEqual((told["format"], told["version"], told["point"]), ("lumulus environment", 1, [10, 20, 30]))
        self.assertEqual([level["roughness"] for level in told["levels"]], [0, 0.5, 1])  # 64, 32, 16 pixels
        self.assertFalse(told["discs_in_map"])
        for c, radiance in enumerate((2.0, 1.0, 0.5)):
            self.assertAlmostEqual(told["harmonics"]["radiance"][0][c] / radiance, math.sqrt(4 * math.pi), places=5)
            self.assertAlmostEqual(told["harmonics"]["irradiance"][0][c] * 0.28209479 / radiance, math.pi, places=5)
            for other in told["harmonics"]["radiance"][1:]:
                self.assertLess(abs(other[c]), 5e-4 * radiance)  # middles of pixels stand for their means
        sun, = told["lights"]
        self.assertEqual((sun["name"], sun["angular_radius"], sun["irradiance"]), ("sun", 1.0, [3.0, 2.0, 1.0]))
        numpy.testing.assert_allclose(sun["direction_to"], [0.6, 0.8, 0.0], atol=1e-12)
        spec = levels_of(path)[1]
        self.assertEqual(spec.getattribute("environment.roughness"), "0 0.5 1")
        self.assertEqual(spec.getattribute("environment.sun.irradiance"), "3 2 1")
        self.assertEqual(spec.getattribute("environment.point"), "10 20 30")
        coefficients = [[float(n) for n in part.split()]
                        for part in spec.getattribute("environment.irradiance_sh").split(", ")]
        numpy.testing.assert_allclose(coefficients, told["harmonics"]["irradiance"], atol=1e-7)
        table = levels_of(self.out / "env_brdf.exr")[0][0]
        self.assertEqual(table.shape[:2], (64, 64))
        energy = table[..., 0] + table[..., 1]
        self.assertLess(abs(energy[0, 4:] - 1).max(), 0.01)
        self.assertTrue((energy < 1.005).all() and energy[-1, -1] < 0.6)

    def test_clear_sky(self):
        """The sun is a light and not in the map; with --with-sun it is there, with just its irradiance."""
        scene = self.scene(CLOUDLESS + AIR)
        path, told = self.made(scene, "--size", 64, "--levels", 2)
        sky = self.sky(scene)
        sun, = told["lights"]
        self.assertEqual(sun["irradiance"], sky["sun"]["irradiance"])
        self.assertAlmostEqual(sun["illuminance"] / sky["sun"]["illuminance"], 1)
        irradiance = told["harmonics"]["irradiance"]
        map_without = levels_of(self.out / "env_latlong.exr")[0][0].astype(float)
        _, told = self.made(scene, "--size", 64, "--levels", 2, "--with-sun")
        self.assertTrue(told["discs_in_map"])
        disc = levels_of(self.out / "env_latlong.exr")[0][0] - map_without
        weight = solid_angles(128)[:, None, None]
        numpy.testing.assert_allclose((disc * weight).sum((0, 1)), sun["irradiance"], rtol=0.02)
        y, x = numpy.unravel_index(disc[..., 1].argmax(), disc.shape[:2])
        there = directions(256, 128)[y, x]
        self.assertGreater(numpy.dot(there, sun["direction_to"]), math.cos(math.radians(2)))
        # light on level ground: by the map, by the harmonics, and what `lumulus sky` says
        rows = numpy.sin(math.pi * (0.5 - (numpy.arange(128) + 0.5) / 128))[:, None, None]
        level = (map_without * weight * numpy.maximum(rows, 0)).sum((0, 1))
        lux = 683 * numpy.dot(level, [0.2126, 0.7152, 0.0722])
        self.assertAlmostEqual(lux / sky["sky"]["illuminance"], 1, delta=0.02)
        # harmonics against sums over all pixels, for planes all around
        by_harmonics, by_sum = [], []
        for i in range(60):
            y = 1 - (2 * i + 1) / 60
            angle = 2 * math.pi * i / 1.618034
            normal = [math.sqrt(1 - y * y) * math.cos(angle), y, math.sqrt(1 - y * y) * math.sin(angle)]
            by_harmonics.append(numpy.dot(basis(normal), irradiance))
            cosines = numpy.maximum(directions(256, 128) @ normal, 0)[..., None]
            by_sum.append((map_without * weight * cosines).sum((0, 1)))
        self.assertLess(numpy.linalg.norm(numpy.subtract(by_harmonics, by_sum)) / numpy.linalg.norm(by_sum), 0.008)

    def test_moon(self):
        """As the sun: a light, and its disc only where it is asked for."""
        scene = self.scene(CLOUDLESS + 'sky = { model = "atmosphere" }\nsun = { elevation = -30 }\n'
                           "moon = { shines = true, azimuth = 40, elevation = 45 }\n")
        _, told = self.made(scene, "--size", 32, "--levels", 1)
        moon, = told["lights"]
        self.assertEqual((moon["name"], moon["irradiance"]), ("moon", self.sky(scene)["moon"]["irradiance"]))
        without = levels_of(self.out / "env_latlong.exr")[0][0].astype(float)
        self.made(scene, "--size", 32, "--levels", 1, "--with-sun")
        disc = levels_of(self.out / "env_latlong.exr")[0][0] - without
        numpy.testing.assert_allclose((disc * solid_angles(64)[:, None, None]).sum((0, 1)), moon["irradiance"],
                                      rtol=0.02)

    def test_a_cloud_before_the_sun(self):
        """What reaches the point is dimmed by the clouds as `lumulus query` says, and the sky has the cloud in it."""
        scene = self.scene(CLOUD)
        _, told = self.made(scene, "--size", 16, "--at=-160,20,0", "--seed", 3)
        sun, = told["lights"]
        (self.folder / "points.csv").write_text("x,y,z\n-160,20,0\n")
        asked = self.run_lumulus("query", scene, "--sun", self.folder / "points.csv", "--json", "--quiet")
        transmittance = json.loads(asked.stdout)["passages"][0]["transmittance"]
        self.assertLess(transmittance[0], 0.9)
        numpy.testing.assert_allclose(sun["transmittance"], transmittance, rtol=1e-3)
        numpy.testing.assert_allclose(sun["irradiance"], numpy.multiply(transmittance, [3, 2, 1]), rtol=1e-3)
        self.assertEqual(sun["irradiance_in_air"], [3, 2, 1])
        pixels = levels_of(self.out / "env_latlong.exr")[0][0]
        self.assertGreater(abs(pixels[..., 0] / 2 - 1).max(), 0.02)
        self.assertLess(abs(pixels[-1, :, 0] / 2 - 1).max(), 1e-4)  # no cloud is straight below

    def test_same_bytes(self):
        scene = self.scene(CLOUD)
        more = ("--size", 16, "--at", "0,100,300", "--by-face")
        self.made(scene, *more)
        before = {file.name: file.read_bytes() for file in self.out.iterdir()}
        self.made(scene, *more, "--threads", 1)
        self.assertEqual({file.name: file.read_bytes() for file in self.out.iterdir()}, before)
        self.made(scene, *more, "--seed", 2)
        self.assertNotEqual((self.out / "env.exr").read_bytes(), before["env.exr"])

    def test_a_map_of_a_map(self):
        """The panorama as the sky of another scene, rotated by a quarter, is the same panorama."""
        self.made(self.scene(CLOUDLESS + AIR), "--size", 32, "--levels", 1)
        before = levels_of(self.out / "env_latlong.exr")[0][0]
        scene = self.scene(CLOUDLESS + f'sky = {{ model = "map", map = "{self.out / "env_latlong.exr"}", map_rotation = 90 }}\n')
        self.made(scene, "--size", 32, "--levels", 1, name="again.exr")
        again = levels_of(self.out / "again_latlong.exr")[0][0]
        self.assertLess(numpy.abs(again - before).mean(), 0.02 * before.mean())

    def test_roughness_and_seconds(self):
        _, told = self.made(self.scene(CLOUD), "--size", 16, "--roughness", "0,0.134,1", "--seconds", 3)
        self.assertEqual([level["roughness"] for level in told["levels"]], [0, 0.134, 1])


class Refusals(EnvironmentTest):
    def test_bad_input(self):
        scene, out = self.scene(CLOUDLESS + AIR), self.out / "env.exr"
        for more, says in ((["--levels", "0"], "0 levels"), (["--levels", "-1"], "levels"),
                           (["--levels", "10"], "10 levels do not fit into faces of 256"),
                           (["--levels", "many"], "--levels"), (["--size", "100"], "100 pixels"),
                           (["--size", "4096"], "4096 pixels"), (["--size", "0"], "0 pixels"),
                           (["--roughness", "0,2"], "2 is no roughness"),
                           (["--roughness", "0.5,0.1"], "0.1 is no roughness behind 0.5"),
                           (["--roughness", "nan"], "no roughness"),
                           (["--roughness", "0,1", "--levels", "2"], "given twice"),
                           (["--method", "thesis", "--levels", "3"], "eleven levels"),
                           (["--method", "thesis", "--size", "256"], "11 levels do not fit"),
                           (["--method", "best"], "--method"),
                           (["--at", "0,-5,0"], "y = -5 is below the ground at 0 m (--at)"),
                           (["--at", "0,nan,0"], "--at"), (["--at", "1,2"], "--at"),
                           (["--seconds", "0"], "0 is no limit"), (["--set", "sky.modell=1"], "unknown key"),
                           (["--set", "camera.position=[0,-1,0]"], "camera.position"),
                           (["--device", "none such"], "device")):
            with self.subTest(more=more):
                result = self.run_lumulus("environment", scene, "-o", out, "--quiet", *more)
                self.assertIn(says, self.one_line(result, 2 if says != "device" else result.returncode))
                self.assertEqual(list(self.out.iterdir()), [])
        self.rejected("environment", scene, says="--output")
        self.rejected("environment", scene, "-o", self.out / "env.png", says="cannot write a file of this kind")
        self.rejected("environment", self.folder / "missing.toml", "-o", out)
        self.rejected("environment", scene, "-o", self.folder / "missing" / "env.exr")
        (self.folder / "env.json").mkdir()
        self.rejected("environment", scene, "-o", self.folder / "env.exr", says="env.json")

    def test_stops_and_leaves_nothing(self):
        process = subprocess.Popen([LUMULUS, "environment", self.scene(CLOUD), "-o", str(self.out / "env.exr"),
                                    "--quiet", "--set", "photon_map.photons=4000000000", "--set",
                                    "photon_map.generations=1"], stderr=subprocess.PIPE, text=True)
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        self.assertIn("interrupted", process.communicate(timeout=30)[1])
        self.assertEqual((process.returncode, list(self.out.iterdir())), (1, []))

    def test_stops_while_filtering(self):
        process = subprocess.Popen([LUMULUS, "environment", self.scene(CLOUDLESS + CONSTANT), "-o", str(self.out / "env.exr"),
                                    "--size", "1024", "--by-level", "--by-face"], stderr=subprocess.PIPE, text=True)
        for line in process.stderr:
            if "filtering" in line:
                break
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        self.assertIn("interrupted", process.communicate(timeout=30)[1])
        self.assertEqual((process.returncode, list(self.out.iterdir())), (1, []))

    def test_full_disk(self):
        def small():
            resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
        result = self.run_lumulus("environment", self.scene(CLOUDLESS + AIR), "-o", self.out / "env.exr", "--quiet", "--size", 32,
                                  preexec_fn=small)
        self.one_line(result, 1)
        self.assertEqual(list(self.out.iterdir()), [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
