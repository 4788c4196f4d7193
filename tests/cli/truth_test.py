"""The commands that say how wrong a picture is, on good and bad input: truth_test.py LUMULUS MAKE_VDB_FIXTURES
[unittest arguments]."""

import csv
import json
import math
import os
import re
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from cli_test import LUMULUS, SMALL, CliTest  # noqa: E402
from flat_layers import read_exr, write_exr  # noqa: E402

SCENE = """
[image]
width = 32
height = 24
[[cloud]]
procedural = "sphere"
resolution = 16
extinction = 0.02
"""


class Reference(CliTest):
    def setUp(self):
        super().setUp()
        self.path = self.scene(SCENE)
        self.picture, self.sums = self.out / "a.exr", self.out / "a.exr.sums"

    def reference(self, *more, output=None, **options):
        result = self.run_lumulus("reference", self.path, "-o", output or self.picture, "--quiet", *more, **options)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return read_exr(output or self.picture)

    def interrupted(self, *more):
        """Ctrl-C after some samples; the number of them."""
        for pause in (0.5, 2.0, 8.0, 30.0):  # a machine may be busy
            process = subprocess.Popen([LUMULUS, "reference", self.path, "-o", self.picture, "--spp", "1000000000", *more],
                                       stderr=subprocess.PIPE, text=True)
            self.addCleanup(process.stderr.close)
            process.stderr.readline()
            time.sleep(pause)
            process.send_signal(signal.SIGINT)
            last = process.stderr.read().splitlines()[-1]
            found = re.fullmatch(r"lumulus: warning: interrupted: the picture has (\d+) samples per pixel", last)
            self.assertEqual(process.wait(timeout=60), 0 if found else 1, last)
            if found:
                return int(found[1])
            self.assertIn("nothing was written", last)
            self.assertEqual(list(self.out.iterdir()), [])
        self.fail("no sample in 30 s")

    def test_layers_and_attributes(self):
        width, height, layers, attributes = self.reference("--spp", 4, "--seed", 7, "--majorant", "local")
        self.assertEqual((width, height), (32, 24))
        colours = {f"{name}{c}" for name in ("", "cloud.", "transmittance.", "variance.") for c in "RGB"}
        self.assertEqual(set(layers), colours | {"A", "cloud.A", "depth.Z", "depth.front"})
        for name, values in layers.items():
            self.assertTrue(all(map(math.isfinite, values)), name)
        for key, value in {"seed": "7", "samples": "4", "majorant": "local", "device": "CPU", "lost": "0"}.items():
            self.assertEqual(attributes[key], value)
        middle = 12 * 32 + 16
        self.assertLess(layers["depth.front"][middle], layers["depth.Z"][middle])
        self.assertEqual(layers["depth.front"][0], 1e10)

    def test_goes_on_with_the_same_bits(self):
        """After Ctrl-C, on one processor, and after another limit of time: as if nothing had happened."""
        for majorant in ("global", "local"):
            with self.subTest(majorant=majorant):
                more = ["--majorant", majorant]
                done = self.interrupted(*more)
                self.assertEqual(read_exr(self.picture)[3]["samples"], str(done))
                self.reference("--resume", "--seconds", 0.05, *more)
                wanted = int(read_exr(self.picture)[3]["samples"]) + 3
                self.assertGreater(wanted, done + 3)
                resumed = self.reference("--resume", "--spp", wanted, *more,
                                         preexec_fn=lambda: os.sched_setaffinity(0, {min(os.sched_getaffinity(0))}))
                whole = self.reference("--spp", wanted, *more, output=self.folder / "whole.exr")
                self.assertEqual(resumed[3]["samples"], str(wanted))
                self.assertEqual(resumed[2], whole[2])
                for path in (self.picture, self.sums):
                    path.unlink()

    def test_resume_begins_where_nothing_is(self):
        first = self.reference("--resume", "--spp", 2)
        self.assertEqual(first[2], self.reference("--resume", "--spp", 2)[2], "nothing is left to do")
        self.assertEqual(first[2], self.reference("--spp", 2)[2])

    def test_goes_on_from_its_own_picture_only(self):
        self.reference("--spp", 2)
        before = {path.name: path.read_bytes() for path in self.out.iterdir()}
        for change in (["--seed", "2"], ["--majorant", "local"], ["--set", "cloud.0.albedo=0.9"],
                       ["--set", "cloud.0.extinction=0.021"], ["--set", "cloud.0.resolution=17"],
                       ["--set", "cloud.0.phase.g=0.8"], ["--set", "sun.azimuth=71"], ["--set", "sky.radiance=1"],
                       ["--set", "camera.vertical_fov=41"], ["--set", "image.width=31"]):
            result = self.run_lumulus("reference", self.path, "-o", self.picture, "--resume", "--spp", 3, "--quiet", *change)
            self.assertIn("another scene, seed or majorant", self.one_line(result, 2), change)
        self.assertEqual(before, {path.name: path.read_bytes() for path in self.out.iterdir()})
        for sums, says in ((None, "exact sums of the picture are missing"), (before["a.exr.sums"][:5000], "damaged"), (b"", "damaged")):
            self.sums.unlink(missing_ok=True)
            if sums is not None:
                self.sums.write_bytes(sums)
            result = self.run_lumulus("reference", self.path, "-o", self.picture, "--resume", "--spp", 3, "--quiet")
            self.assertIn(says, self.one_line(result, 2))
            self.assertEqual(self.picture.read_bytes(), before["a.exr"])

    def test_fog_and_surfaces(self):
        """An emissive floor under fog that absorbs."""
        self.path = self.scene("""
cloud = []
image = { width = 8, height = 6 }
camera = { position = [0, 10, 0], target = [0, 0, 0], up = [0, 0, -1] }
[sun]
irradiance = 0
[[surface]]
albedo = 0
emission = [1, 2, 3]
[[fog.media]]
absorption = 0.05
bottom = 0
top = 100
""")
        image = self.reference("--spp", 256)[2]
        for channel, emission in zip("RGB", (1, 2, 3)):
            mean, error = image[channel][27], math.sqrt(image[f"variance.{channel}"][27])
            self.assertAlmostEqual(mean, emission * math.exp(-0.5), delta=4.0 * error + 0.05)
        self.assertEqual(set(image["cloud.A"]), {1.0})
        self.assertEqual(set(image["transmittance.R"]), {0.0})
        self.assertTrue(all(10.0 <= depth < 12.0 for depth in image["depth.Z"]))
        result = self.run_lumulus("reference", self.path, "-o", self.picture, "--resume", "--spp", 300, "--quiet",
                                  "--set", "surface.0.emission=1")
        self.assertIn("another scene", self.one_line(result, 2))

    def test_endless_fog_in_the_light_of_the_sky_is_refused(self):
        path = self.scene("[[fog.media]]\nvisibility = 100\ntop = 50\n[sky]\nmodel = \"constant\"\n")
        for command, *more in (("render",), ("reference", "--spp", 1)):
            self.rejected(command, path, "-o", self.out / "a.exr", *more,
                          says="(fog.media.0.bottom): give a height in metres, or [ground] height")

    def test_render_refuses_surfaces(self):
        path = self.scene("[[surface]]\n")
        self.rejected("render", path, "-o", self.picture, says="surfaces are for the reference alone")

    def test_seconds(self):
        start = time.monotonic()
        attributes = self.reference("--seconds", 0.3)[3]
        self.assertGreater(time.monotonic() - start, 0.3)
        self.assertGreaterEqual(int(attributes["samples"]), 1)

    def test_bad_usage(self):
        for more, says in (((), "either --spp or --seconds"), (("--spp", 2, "--seconds", 1), "either"),
                           (("--spp", 0), "--spp"), (("--spp", "1.5"), "--spp"), (("--spp", "9" * 20), "--spp"),
                           (("--seconds", 0), "--seconds"), (("--seconds", "nan"), "--seconds"),
                           (("--seconds", "inf"), "--seconds"), (("--spp", 1, "--majorant", "best"), "--majorant"),
                           (("--spp", 1, "--set", "cloud.0.phase.g=1"), "cloud.0.phase.g")):
            with self.subTest(more=more):
                self.rejected("reference", self.path, "-o", self.picture, *more, says=says)
        self.rejected("reference", self.path, "-o", self.out / "a.png", "--spp", 1, says=".exr")
        self.rejected("reference", self.folder / "no.toml", "-o", self.picture, "--spp", 1, says="no.toml")
        self.rejected("reference", self.path, "-o", self.folder / "no/a.exr", "--spp", 1, says="no/a.exr")

    def test_a_place_for_the_sums_is_sought_first(self):
        self.sums.mkdir()
        result = self.run_lumulus("reference", self.path, "-o", self.picture, "--spp", 1000000000)
        self.assertIn("a.exr.sums", self.one_line(result, 2))
        self.assertFalse(self.picture.exists())


class AgainstTheReference(CliTest):
    """What render and the path tracer, which share no light code, have in common."""

    def bias(self, path, photons, samples, *sets):
        """Of a picture with so many photons against a reference: the relative bias and its standard error."""
        words = ["--quiet", *(word for one in sets for word in ("--set", one))]
        for command, name, more in (("reference", "r.exr", ["--spp", samples, "--majorant", "local"]),
                                    ("render", "p.exr", ["--set", f"photon_map.photons={photons}"])):
            result = self.run_lumulus(command, path, "-o", self.out / name, *words, *more)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
        found = json.loads(self.run_lumulus("compare", self.out / "p.exr", self.out / "r.exr", "--json").stdout)
        return found["relative_bias"], found["standard_error"]["relative_bias"]

    def test_backscattering(self):
        """The sun's light goes to and fro along its axis: sun and sky within 3 % of the reference, thin and thick."""
        path = self.scene("sky = { model = \"constant\" }\n" + SCENE +
                          "phase = { model = \"henyey-greenstein\", g = -0.95 }\n")
        for g, extinction in ((-0.6, 0.03), (-0.8, 0.02), (-0.95, 0.004), (-0.95, 0.02), (-0.99, 0.001), (-0.99, 0.02)):
            with self.subTest(g=g, extinction=extinction):
                bias, error = self.bias(path, 1000000, 500, f"cloud.0.phase.g={g}", f"cloud.0.extinction={extinction}")
                self.assertLess(error, 0.012, "else this test says little")
                self.assertLess(abs(bias), 0.03 + 2.0 * error)

    def test_backscattering_under_a_bright_horizon(self):
        """A backward peak sends a bright horizon back as sharp as it is: level and from above, within 3 % of the reference. The
        sky is that of a clear evening, without a sun of its own."""
        sky = self.folder / "sky.exr"
        clear = self.scene("""
cloud = []
image = { width = 256, height = 128 }
camera = { projection = "panorama", position = [0, 0, 0], target = [0, 0, -1] }
sun = { azimuth = 20, elevation = -1 }
sky = { model = "atmosphere" }
""")
        result = self.run_lumulus("render", clear, "-o", sky, "--quiet")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        path = self.scene(f"sky = {{ model = \"map\", map = \"{sky}\", map_sun = false }}\nsun = {{ irradiance = 0 }}\n" + SCENE +
                          "phase = { model = \"henyey-greenstein\", g = -0.95 }\n")
        for g, camera in ((-0.95, "[0, 0, 9000]"), (-0.99, "[0, 0, 9000]"), (-0.99, "[0, 4000, 5000]")):
            with self.subTest(g=g, camera=camera):
                bias, error = self.bias(path, 1000000, 96, f"cloud.0.phase.g={g}", f"camera.position={camera}",
                                        "camera.target=[0, 0, 0]", "camera.vertical_fov=8")
                self.assertLess(error, 0.015, "else this test says little")
                self.assertLess(abs(bias), 0.03 + 2.0 * error)

    def test_flat_voxels(self):
        """Layers of voxels of 50:2:50 m from their side: a ball of a few pixels and a lopsided cumulus, within 1 %."""
        path = self.scene(SCENE.replace("resolution = 16", "resolution = 24") +
                          "transform = [[1.2, 0, 0, 0], [0, 0.048, 0, 0], [0, 0, 1.2, 0]]\n")
        bias, error = self.bias(path, 3000000, 500, "image.width=96", "image.height=10", "camera.vertical_fov=5",
                                "cloud.0.extinction=0.08")
        self.assertLess(error, 0.006, "else this test says little")
        self.assertLess(abs(bias), 0.01 + 2.0 * error)
        cumulus = self.scene("""
image = { width = 96, height = 14 }
camera = { position = [0, 240, 7500], target = [0, 60, 0], vertical_fov = 3.5 }
sun = { azimuth = 75, elevation = 30 }
sky = { model = "constant" }
[[cloud]]
resolution = 64
extinction = 0.04
transform = [[3.2, 0, 0, 0], [0, 0.128, 0, 20], [0, 0, 3.2, 0]]
""")
        bias, error = self.bias(cumulus, 3000000, 700)
        self.assertLess(error, 0.006, "else this test says little")
        self.assertLess(abs(bias), 0.01 + 2.0 * error)

    def test_the_sun_in_a_panorama(self):
        """An HDRI holds the sun's irradiance, 5 W/m², at every size and place, by both."""
        path = self.scene("""
cloud = []
camera = { projection = "panorama", position = [0, 0, 0], target = [0, 0, -1] }
sky = { radiance = 0 }
sun = { irradiance = 5.0 }
""")
        for height, azimuth, elevation in ((128, 33.3, 30.0), (16, 180.0, 89.7), (4, 77.0, -12.0)):
            sets = [word for key, value in (("image.width", 2 * height), ("image.height", height), ("sun.azimuth", azimuth),
                                            ("sun.elevation", elevation)) for word in ("--set", f"{key}={value}")]
            for command, more in (("render", []), ("reference", ["--spp", 1])):
                with self.subTest(height=height, command=command):
                    result = self.run_lumulus(command, path, "-o", self.picture_path(), "--quiet", *sets, *more)
                    self.assertEqual((result.returncode, result.stderr), (0, ""))
                    radiance = read_exr(self.picture_path())[2]["G"]
                    rows = [math.sin(math.pi * (0.5 - row / height)) for row in range(height + 1)]
                    found = sum(value * math.pi / height * (rows[i // (2 * height)] - rows[i // (2 * height) + 1])
                                for i, value in enumerate(radiance))
                    self.assertAlmostEqual(found, 5.0, delta=0.01)

    def picture_path(self):
        return self.out / "panorama.exr"


class Compare(CliTest):
    def image(self, name, change=None, width=4, height=3):
        """A grey picture; `change` is done to its layers."""
        layers = {c: [1.0] * (width * height) for c in "RGB"}
        if change:
            change(layers)
        write_exr(self.folder / name, width, height, layers)
        return self.folder / name

    def compared(self, *arguments):
        result = self.run_lumulus("compare", *arguments, "--json")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return json.loads(result.stdout)

    def test_known_answers(self):
        def half_more(layers):
            layers.update({c: [1.5] * 12 for c in "RGB"})
        found = self.compared(self.image("a.exr", half_more), self.image("b.exr"), "--diff", self.out / "d.exr")
        for name, value in {"pixels": 12, "rmse": 0.5, "bias": 0.5, "relative_bias": 0.5, "relmse": 0.25 / 1.01,
                            "mape": 0.5 / 1.01}.items():
            self.assertAlmostEqual(found[name], value, 7, name)
        self.assertGreater(found["flip"], 0.0)
        self.assertIsNone(found["standard_error"]["rmse"])
        self.assertEqual(read_exr(self.out / "d.exr")[2]["G"], [0.5] * 12)
        self.assertEqual(self.compared(self.image("a.exr"), self.image("b.exr"))["flip"], 0.0)

    def test_another_denominator(self):
        """Errors of .5 relative to 2 in place of 1, where its own transmittance is below .999."""
        def double(layers):
            layers.update({c: [2.0] * 12 for c in "RGB"})
            layers.update({f"transmittance.{c}": [0.5] * 4 + [1.0] * 8 for c in "RGB"})
        changed = self.image("a.exr", lambda layers: layers.update({c: [1.5] * 12 for c in "RGB"}))
        found = self.compared(changed, self.image("b.exr"), "--denominator", self.image("d.exr", double))
        for name, value in {"pixels": 4, "rmse": 0.5, "relmse": 0.25 / 4.04, "mape": 0.5 / 2.02, "relative_bias": 0.5}.items():
            self.assertAlmostEqual(found[name], value, 7, name)
        self.rejected("compare", changed, "b.exr", "--denominator", "missing.exr", says="missing.exr")
        self.rejected("compare", changed, "b.exr", "--denominator", self.image("wide.exr", width=5), says="4×3 against 5×3")
        self.rejected("compare", changed, "b.exr", "--denominator", "", says="--denominator")

    def test_black(self):
        black = self.image("black.exr", lambda layers: layers.update({c: [0.0] * 12 for c in "RGB"}))
        self.assertEqual(self.compared(black, black)["relmse"], 0.0)
        self.assertIsNone(self.compared(self.image("a.exr"), black)["relmse"], "infinity has no JSON")
        self.assertNotIn("nan", self.run_lumulus("compare", self.image("a.exr"), black).stdout)

    def test_bad_numbers(self):
        good = self.image("good.exr")
        for name, layer, value, says in (("nan.exr", "G", math.nan, "layer G is not a finite number at x 2, y 1"),
                                         ("inf.exr", "R", math.inf, "layer R is not a finite number at x 2, y 1"),
                                         ("variance.exr", "variance.B", -1.0, "variance.B is below 0 at x 2, y 1"),
                                         ("disc.exr", "sun.disc", math.nan, "sun.disc is not a finite")):
            def change(layers):
                layers.setdefault(layer, [0.0] * 12)
                layers[layer][6] = value
            bad = self.image(name, change)
            for pair in ((bad, good), (good, bad), (good, good, bad)):
                self.assertIn(name, self.rejected("compare", *pair, "--diff", self.out / "d.png", says=says))

    def test_bad_pictures(self):
        good = self.image("good.exr")
        (self.folder / "folder.exr").mkdir()
        (self.folder / "junk.exr").write_text("junk")
        (self.folder / "cut.exr").write_bytes(good.read_bytes()[:-20])
        for name in ("missing.exr", "folder.exr", "junk.exr", "cut.exr"):
            self.rejected("compare", good, name, says=name)
            self.rejected("compare", name, good, says=name)
        self.rejected("compare", good, self.image("wide.exr", width=5), says="4×3 against 5×3")
        self.rejected("compare", good, good, self.image("high.exr", height=4), says="4×3 against 4×4")
        self.rejected("compare", self.image("nob.exr", lambda layers: layers.pop("B")), good, says="no layer B")
        clear = self.image("clear.exr", lambda layers: layers.update({f"transmittance.{c}": [1.0] * 12 for c in "RGB"}))
        self.rejected("compare", good, clear, says="no pixel of the reference shows the cloud")

    def test_bad_usage(self):
        good = self.image("good.exr")
        self.rejected("compare", good)
        self.rejected("compare", good, good, "--exposure", "nan", says="--exposure")
        self.rejected("compare", good, good, "--diff", self.out / "d.jpg", says=".jpg")
        self.rejected("compare", good, good, "--diff", self.folder / "no/d.png", says="no/d.png")


class Slab(CliTest):
    LAYER = {"tau": 2, "g": 0.75, "albedo": 0.9, "mu0": 1, "photons": 100000}

    def arguments(self, **changes):
        return [word for name, value in (self.LAYER | changes).items() for word in (f"--{name}", value)]

    def test_both_tracers(self):
        """van de Hulst 1980: the same layer by the photon walk and by the reference."""
        for more in ((), ("--reference",)):
            result = self.run_lumulus("slab", *self.arguments(), "--json", *more)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            found = json.loads(result.stdout)
            for name, value in {"reflected": 0.09739, "transmitted_diffuse": 0.525625,
                                "transmitted_direct": 0.1353353}.items():
                self.assertLessEqual(abs(found[name] - value), 4.5 * found["standard_error"][name] + 1e-7, name)
            self.assertAlmostEqual(sum(found[name] for name in found["standard_error"]), 1.0, 12)

    def test_bad_usage(self):
        for changes in ({"tau": -1}, {"tau": "nan"}, {"tau": "inf"}, {"g": 1}, {"g": -1}, {"g": "nan"}, {"albedo": 1.1},
                        {"albedo": -0.1}, {"mu0": 0}, {"mu0": 1.01}, {"photons": 0}, {"photons": -5},
                        {"photons": 2**41}):
            for more in ((), ("--reference",)):
                with self.subTest(changes=changes, more=more):
                    self.rejected("slab", *self.arguments(**changes), *more, says=next(iter(changes)))
        self.rejected("slab", "--tau", 1)
        self.rejected("slab", *self.arguments(), "--device", "no such", says="no such")
        self.rejected("slab", *self.arguments(), "--reference", "--device", "0")

    def test_interrupted(self):
        for more in ((), ("--reference",)):
            for pause in (0.5, 2.0, 8.0, 30.0):  # a busy machine may not have started the program yet
                process = subprocess.Popen([LUMULUS, "slab", *map(str, self.arguments(photons=2**40)), *more],
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                time.sleep(pause)
                process.send_signal(signal.SIGINT)
                out, error = process.communicate(timeout=60)
                if process.returncode != -signal.SIGINT:
                    break
            self.assertEqual((process.returncode, out), (1, ""))
            self.assertEqual(error, "lumulus: error: interrupted: nothing was written\n")


class Bench(CliTest):
    def setUp(self):
        super().setUp()
        self.path = self.scene(SCENE)
        self.truth = self.folder / "truth.exr"
        result = self.run_lumulus("reference", self.path, "-o", self.truth, "--spp", 4, "--quiet", "--seed", 9)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_writes_numbers_and_plots(self):
        folder = self.out / "new/folder"
        result = self.run_lumulus("bench", self.path, "--reference", self.truth, "-o", folder, "--seconds", "0.05",
                                  "--seeds", 2, *SMALL)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("time to reach", result.stdout)
        self.assertEqual({path.name for path in folder.iterdir()}, {"error.csv", "error.svg", "error.png"})
        with open(folder / "error.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["method"] for row in rows], ["render", "path tracer"])
        for row in rows:
            self.assertEqual(row["seeds"], "2")
            for name in ("seconds", "seconds_without_warmup", "photons_or_spp", "relMSE", "RMSE", "FLIP", "bias"):
                self.assertTrue(math.isfinite(float(row[name])) and math.isfinite(float(row[f"{name}_spread"])), name)
        self.assertTrue((folder / "error.png").read_bytes().startswith(b"\x89PNG\r\n\x1a\n"))
        self.assertTrue((folder / "error.svg").read_text().endswith("</svg>\n"))

    def test_bad_input(self):
        write_exr(self.folder / "small.exr", 4, 3, {c: [1.0] * 12 for c in "RGB"})
        write_exr(self.folder / "black.exr", 32, 24, {c: [0.0] * 768 for c in "RGB"})
        write_exr(self.folder / "nan.exr", 32, 24, {c: [math.nan] * 768 for c in "RGB"})
        for name, says in (("small.exr", "--set image.width=4 --set image.height=3"), ("black.exr", "black"),
                           ("nan.exr", "not a finite number"), ("missing.exr", "missing.exr")):
            self.rejected("bench", self.path, "--reference", self.folder / name, "-o", self.out / "b", says=says)
        for more, says in ((("--seconds", "0"), "--seconds"), (("--seconds", "1,nan"), "--seconds"),
                           (("--seconds", "-1"), "--seconds"), (("--seeds", "0"), "--seeds"),
                           (("--device", "no such"), "no such"), (("--set", "image.width=33"), "the scene 33×24")):
            self.rejected("bench", self.path, "--reference", self.truth, "-o", self.out / "b", *more, says=says)
        self.rejected("bench", self.path, "--reference", self.truth, "-o", self.path, says="cannot make the folder")
        self.rejected("bench", self.path, "--reference", self.truth)

    def test_a_full_disk(self):
        (self.out / "error.png").symlink_to("/dev/full")
        result = self.run_lumulus("bench", self.path, "--reference", self.truth, "-o", self.out, "--seconds", "0.01",
                                  "--seeds", 1, *SMALL)
        self.assertIn("error.png", self.one_line(result, 1))
        self.assertEqual({path.name for path in self.out.iterdir()}, {"error.csv", "error.svg", "error.png"})

    def test_interrupted(self):
        process = subprocess.Popen([LUMULUS, "bench", self.path, "--reference", self.truth, "-o", self.out / "b",
                                    "--seconds", "1000"], stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        process.stderr.readline()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.stderr.read().splitlines()[-1], "lumulus: error: interrupted: nothing was written")
        self.assertEqual(process.wait(timeout=60), 1)
        self.assertEqual(list((self.out / "b").iterdir()), [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
