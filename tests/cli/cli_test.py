"""The whole program on good and bad input: cli_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments].

Bad input ends with exit code 2 and one line on stderr that begins with `lumulus: error:`, and leaves no output.
"""

import json
import math
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

from PIL import Image

sys.path.insert(0, str(Path(__file__).parent))
from flat_layers import read_exr  # noqa: E402

LUMULUS, MAKE_FIXTURES = sys.argv[1], sys.argv[2]

# a picture that takes no time; every render of this file is of this kind
SMALL = ["--quiet", "--set", "image.width=32", "--set", "image.height=24", "--set", "photon_map.photons=2000",
         "--set", "photon_map.generations=2", "--set", "preparation.samples=500"]


class CliTest(unittest.TestCase):
    """A folder with the fixtures, and `out` for what the program writes."""

    @classmethod
    def setUpClass(cls):
        cls._fixtures = tempfile.TemporaryDirectory()
        cls.fixtures = Path(cls._fixtures.name)
        subprocess.run([MAKE_FIXTURES, str(cls.fixtures)], check=True)

    @classmethod
    def tearDownClass(cls):
        cls._fixtures.cleanup()

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = Path(self._folder.name)
        self.out = self.folder / "out"
        self.out.mkdir()

    def scene(self, text):
        path = self.folder / "scene.toml"
        path.write_text(text)
        return str(path)

    def vdb_scene(self, vdb, more=""):
        return self.scene(f'[[cloud]]\nvdb = "{vdb}"\nextinction = 0.5\n{more}')

    def run_lumulus(self, *arguments, **options):
        return subprocess.run([LUMULUS, *map(str, arguments)], capture_output=True, text=True, timeout=120,
                              cwd=self.folder, **options)

    def kill(self, seconds, *arguments):
        """Starts the program, and kills it after so many seconds: it has no time to tidy up."""
        process = subprocess.Popen([LUMULUS, *map(str, arguments), "--quiet"], cwd=self.folder)
        time.sleep(seconds)
        process.kill()
        process.wait(timeout=60)

    def one_line(self, result, code):
        """Checks the exit code and the shape of the error; returns the line."""
        self.assertEqual(result.returncode, code, result.stderr)
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertRegex(lines[0], r"^lumulus: error: \S")
        return lines[0]

    def rejected(self, *arguments, says=""):
        """Bad usage or bad input: exit code 2, one line, no file."""
        line = self.one_line(self.run_lumulus(*arguments), 2)
        self.assertIn(says, line)
        self.assertEqual(list(self.out.iterdir()), [], "nothing may be written")
        return line

    def rejected_scene(self, scene, *more, says=""):
        return self.rejected("render", scene, "-o", self.out / "a.exr", *more, says=says)

    def rendered(self, scene, *more):
        """Renders a small picture; returns its layers and the process's result."""
        path = self.out / "a.exr"
        result = self.run_lumulus("render", scene, "-o", path, *SMALL, *more)
        self.assertEqual(result.returncode, 0, result.stderr)
        width, height, layers, _ = read_exr(path)
        self.assertEqual((width, height), (32, 24))
        for name, values in layers.items():
            self.assertTrue(all(map(math.isfinite, values)), name)
        return layers, result

    def interrupt(self, step, *arguments):
        """Ctrl-C as soon as the progress of a step begins."""
        with self.subTest(step=step):
            process = subprocess.Popen([LUMULUS, *map(str, arguments)], stderr=subprocess.PIPE, text=True)
            self.addCleanup(process.stderr.close)
            watchdog = threading.Timer(120, process.kill)
            watchdog.start()
            self.addCleanup(watchdog.cancel)
            line = process.stderr.readline()
            while line and not line.startswith(f"{step}: 0/"):
                line = process.stderr.readline()
            self.assertNotEqual(line, "")
            process.send_signal(signal.SIGINT)
            lines = process.stderr.read().splitlines()
            self.assertEqual(process.wait(timeout=60), 1)
            self.assertEqual(lines[-1], "lumulus: error: interrupted: nothing was written")
            self.assertEqual(list(self.out.iterdir()), [])


class Usage(CliTest):
    def test_help_shows_an_example(self):
        for command in ("render", "cloud", "info", "composite", "serve", "fetch"):
            result = self.run_lumulus(command, "--help")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertIn(f"Example:\n  lumulus {command}", result.stdout)
        self.assertIn("render", self.run_lumulus("--help").stdout)

    def test_help_of_commands_that_are_not_there(self):
        for arguments in (["denoise", "--help"], ["simulate", "-h"], ["simulate", "--version"]):
            self.rejected(*arguments, says="unknown command")
        self.rejected("--nonsense", "--help", says="unknown option")
        self.assertIn("--scene-format", self.run_lumulus("info", "--help").stdout)

    def test_version(self):
        self.assertRegex(self.run_lumulus("--version").stdout, r"^lumulus \d+\.\d+\.\d+\n$")

    def test_bad_command_lines(self):
        scene = self.scene("")
        out = self.out / "a.exr"
        for arguments in ([], ["nonsense"], ["render"], ["render", scene], ["render", "-o", out],
                          ["render", scene, "-o"], ["render", scene, "-o", out, "--nonsense"],
                          ["render", scene, "-o", out, "--quality", "best"],
                          ["render", scene, "-o", out, "--seed", "-1"], ["render", scene, "-o", out, "--seed", "x"],
                          ["render", scene, scene, "-o", out], ["info"], ["info", "--devices", "a.vdb"], ["cloud"],
                          ["cloud", "cumulus"], ["cloud", "cumulus", "-o", self.out / "a.vdb", "--resolution", "x"]):
            with self.subTest(arguments=arguments):
                self.rejected(*arguments)

    def test_outputs_are_checked_first(self):
        scene = self.scene("this is not read")
        for name in ("a.jpg", "a", "a.exr.txt", ".exr"):
            self.rejected("render", scene, "-o", self.out / name, says="give a name that ends with .exr or .png")
        out = self.out / "a.exr"
        for again in (out, self.out / "../out/a.exr"):
            self.rejected("render", scene, "-o", out, "-o", again, says="given twice")
            self.rejected("render", scene, "-o", out, "--stats", again, says="given twice")
        self.rejected("render", scene, "-o", out, "--stats", "", says="--stats")
        self.rejected("render", scene, "-o", out, "--device", "", says="--device")

    def test_devices(self):
        result = self.run_lumulus("info", "--devices", "--json")
        devices = json.loads(result.stdout)["devices"]
        self.assertGreaterEqual(len(devices), 1)
        self.assertIn(devices[0]["name"], self.run_lumulus("info", "--devices").stdout)

    def test_standard_output_that_is_full(self):
        with open("/dev/full", "w") as full:
            result = subprocess.run([LUMULUS, "--version"], stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertRegex(self.one_line(result, 1), r": cannot write: .* \(standard output\): ")


class Scene(CliTest):
    def test_bad_scenes_name_key_and_line(self):
        for text, says in (
                ("\n[image]\nwidht = 3\n", "scene.toml:3, image.widht): did you mean \"width\"?"),
                ("[imag]\nwidth = 3\n", "did you mean \"image\"?"),
                ("[image]\nwidth = \"wide\"\n", "width must be a whole number, got a string"),
                ("[image]\nwidth = 0\n", "width must lie in 1…16384, got 0"),
                ("[image]\nwidth = nan\n", "scene.toml:2, image.width"),
                ("[sky]\nradiance = [1, inf, 1]\n", "scene.toml:2, sky.radiance"),
                ("[[cloud]]\nalbedo = 1.2\n", "albedo must lie in 0…1, got 1.2 ("),
                ("[[cloud]]\nalbedo = [1, 1, -0.1]\n", "scene.toml:2, cloud.0.albedo"),
                ("[[cloud]]\nphase = { g = 1 }\n", "g must be above -1, below 1, got 1"),
                ("[[cloud]]\nphase = { g = -1.0 }\n", "cloud.0.phase.g"),
                ("[[cloud]]\nextinction = -1\n", "scene.toml:2, cloud.0.extinction"),
                ("[[cloud]]\ntransform = [[1,0,0,0],[0,1,0,0],[0,0,0,0]]\n", "transform must be invertible"),
                ("[camera]\nposition = [1,2,3]\ntarget = [1,2,3]\n", "same point"),
                ("[image\n", "scene.toml:1"),
                ("[[cloud]]\n" * 257, "at most 256 clouds, this one has 257"),
                ("a = " + "[" * 100000, "scene.toml:1")):
            with self.subTest(text=text[:60]):
                self.rejected_scene(self.scene(text), says=says)

    def test_bad_overrides(self):
        scene = self.scene("")
        for override in ("cloud.0.albedo=2", "cloud.albedo=1", "image.width", "nonsense=1", "draw.mode=paint",
                         "photon_map.photons=0", "photon_map.generations=5000"):
            with self.subTest(override=override):
                self.rejected_scene(scene, "--set", override, says="--set")

    def test_bad_scene_files(self):
        self.rejected_scene(self.folder / "missing.toml", says="missing.toml")
        self.rejected_scene(self.folder, says="folder")
        (self.folder / "binary.toml").write_bytes(bytes(range(256)))
        self.rejected_scene(self.folder / "binary.toml", says="binary.toml:1")

    def test_line_breaks_in_names_stay_in_one_line(self):
        self.rejected_scene(self.folder / "a\nb.toml", says="a b.toml")

    def test_names_do_no_harm_to_a_terminal(self):
        self.rejected_scene(self.folder / "a\x1b[31mb\udcff.toml", says=r"a\x1B[31mb\xFF.toml")
        line = self.rejected_scene(self.scene("[image]\n" + "w" * 500000 + " = 1\n"), says='unknown key "ww')
        self.assertLess(len(line), 1000)

    def test_unknown_device(self):
        self.rejected_scene(self.scene(""), "--device", "no such device", says="no such device")
        self.rejected_scene(self.scene(""), "--device", "999")


class Volumes(CliTest):
    def test_missing_file_and_folder(self):
        self.rejected_scene(self.vdb_scene("missing.vdb"), says="scene.toml:2, cloud.0.vdb")
        self.rejected_scene(self.vdb_scene(self.fixtures), says="scene.toml:2, cloud.0.vdb")
        self.rejected("info", self.folder / "missing.vdb", says="missing.vdb")

    def test_damaged_files(self):
        whole = (self.fixtures / "ball.vdb").read_bytes()
        broken = self.folder / "broken.vdb"
        cuts = [0, 1, 4, 8, 20, 40, 80, 200, len(whole) // 2, len(whole) * 3 // 4, len(whole) - 16, len(whole) - 1]
        for data in [whole[:cut] for cut in cuts] + [b"not a volume\n" * 1000, bytes(4096)]:
            with self.subTest(size=len(data)):
                broken.write_bytes(data)
                self.rejected_scene(self.vdb_scene("broken.vdb"), says="broken.vdb")
                self.rejected("info", broken, says="broken.vdb")

    def test_grids_that_are_no_densities(self):
        self.rejected_scene(self.vdb_scene(self.fixtures / "ball.vdb", 'grid = "smoke"'), says="smoke")
        for name in ("level-set", "vectors", "nan", "infinite", "negative"):
            with self.subTest(name=name):
                self.rejected_scene(self.vdb_scene(self.fixtures / f"{name}.vdb"), says=f"{name}.vdb")

    def test_singular_transform(self):
        data = (self.fixtures / "ball.vdb").read_bytes()
        size = struct.pack("<d", 1.2345678)
        self.assertIn(size, data)
        (self.folder / "singular.vdb").write_bytes(data.replace(size, bytes(8)))
        self.rejected_scene(self.vdb_scene("singular.vdb"), says="singular.vdb")

    def test_info(self):
        grid, = json.loads(self.run_lumulus("info", self.fixtures / "ball.vdb", "--json").stdout)["grids"]
        self.assertEqual((grid["name"], grid["type"]), ("density", "float"))
        inside = [1 for x in range(-6, 7) for y in range(-6, 7) for z in range(-6, 7) if x * x + y * y + z * z <= 36]
        self.assertEqual(grid["active_voxels"], len(inside))
        self.assertIn("density", self.run_lumulus("info", self.fixtures / "ball.vdb").stdout)

    def test_info_of_a_grid_with_a_bad_name(self):
        data = (self.fixtures / "ball.vdb").read_bytes()
        (self.folder / "bad.vdb").write_bytes(data.replace(b"density", b"d\x1b[2Jt\xff"))
        self.assertIn(r"d\x1B[2Jt\xFF: float", self.run_lumulus("info", self.folder / "bad.vdb").stdout)

    def test_procedural(self):
        path = self.out / "a.vdb"
        files = []
        for seed in (1, 2, 2):
            result = self.run_lumulus("cloud", "cumulus", "-o", path, "--resolution", 24, "--seed", seed, "--quiet")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            files.append(path.read_bytes())
        self.assertNotEqual(files[0], files[1])
        self.assertEqual(files[1], files[2])
        self.assertIn("density", self.run_lumulus("info", path).stdout)
        loud = self.run_lumulus("cloud", "sphere", "-o", path, "--resolution", 24)
        self.assertRegex(loud.stderr, r"^making the cloud: 0/22 (.*\n)+writing: .* s\n$")
        path.unlink()
        self.rejected("cloud", "nonsense", "-o", path, says="nonsense")
        self.rejected("cloud", "sphere", "-o", self.out / "a.txt", says=".vdb")
        self.rejected("cloud", "sphere", "-o", self.out / "no/a.vdb", says="no/a.vdb")
        for resolution in (0, -5, 1000000):
            self.rejected("cloud", "sphere", "-o", path, "--resolution", resolution)


class Places(CliTest):
    """Where outputs cannot go."""

    def test_bad_places(self):
        scene = self.scene("")
        (self.folder / "file").write_text("")
        (self.folder / "folder.exr").mkdir()
        for place in (self.folder / "missing/a.exr", self.folder / "file/a.png", self.folder / "folder.exr",
                      "/proc/a.exr"):
            with self.subTest(place=place):
                self.rejected("render", scene, "-o", place, says=str(place))
                self.rejected("render", scene, "-o", self.out / "a.exr", "--stats", place, says=str(place))

    def test_names_of_one_file(self):
        """One output under two names, whether it is there or not."""
        scene = self.scene("")
        for names in (("a.png", "./a.png"), ("./out/b.png", self.out / "b.png")):
            arguments = [part for name in names for part in ("-o", name)]
            self.rejected("render", scene, *arguments, says="given twice")
        self.rejected("reference", scene, "--spp", 1, "-o", "./a.exr", "--stats", "a.exr.sums", says="given twice")

    def test_files_that_may_not_be_written(self):
        path = self.folder / "kept.png"
        path.write_text("old")
        path.chmod(0o444)
        self.rejected("render", self.scene("this is not read"), "-o", path, says="kept.png): allow it")
        self.assertEqual(path.read_text(), "old")

    def test_links_and_permissions(self):
        scene = self.scene("cloud = []")
        link, old = self.folder / "link.png", self.folder / "old.png"
        link.symlink_to("out/new.png")
        old.write_text("")
        old.chmod(0o640)
        result = self.run_lumulus("render", scene, *SMALL, "-o", link, "-o", old)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertTrue(link.is_symlink())
        self.assertEqual(link.read_bytes(), old.read_bytes())
        self.assertEqual(old.stat().st_mode & 0o777, 0o640)

    def test_devices_stay_devices(self):
        self.rejected("render", self.scene(""), "-o", "/dev/full", says="/dev/full")
        self.assertTrue(Path("/dev/full").is_char_device())

    def fails_full(self, *outputs, **options):
        arguments = [part for output in outputs for part in ("-o", output)]
        result = self.run_lumulus("render", self.scene("cloud = []"), *arguments, *SMALL, **options)
        return self.one_line(result, 1)

    def test_full_device(self):
        (self.out / "a.exr").symlink_to("/dev/full")
        self.assertIn("No space left", self.fails_full(self.out / "a.exr"))
        self.assertTrue(Path("/dev/full").is_char_device())

    def test_full_disk(self):
        """A limit of file sizes does what a full disk does, without the right to mount one."""
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (512, resource.RLIM_INFINITY))

        (self.out / "a.exr").write_text("old")
        self.fails_full(self.out / "a.exr", preexec_fn=limit)
        self.assertEqual((self.out / "a.exr").read_text(), "old")
        self.assertEqual([path.name for path in self.out.iterdir()], ["a.exr"])
        result = self.run_lumulus("cloud", "sphere", "-o", self.out / "a.vdb", "--resolution", "24", "--quiet",
                                  preexec_fn=limit)
        self.one_line(result, 1)
        self.assertEqual([path.name for path in self.out.iterdir()], ["a.exr"])


class Rendering(CliTest):
    def test_layers_attributes_and_statistics(self):
        scene = self.scene("[[cloud]]\nprocedural = \"sphere\"\nresolution = 24\n")
        exr, png, stats = self.out / "a.exr", self.out / "a.PNG", self.out / "stats.json"
        result = self.run_lumulus("render", scene, "-o", exr, "-o", png, "--stats", stats, "--seed", 7, *SMALL)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        _, _, layers, attributes = read_exr(exr)
        for name in ("R", "G", "B", "A", "cloud.R", "cloud.G", "cloud.B", "cloud.A", "depth.Z", "depth.front", "transmittance.R",
                     "transmittance.G", "transmittance.B"):
            self.assertIn(name, layers)
        self.assertEqual(attributes["scene"], scene)
        self.assertEqual(attributes["seed"], "7")
        self.assertTrue(attributes["software"].startswith("lumulus "))
        self.assertEqual(png.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        numbers = json.loads(stats.read_text())
        self.assertEqual(numbers["photons"], 2000)
        self.assertEqual(numbers["generations"], 2)
        self.assertEqual(numbers["absorbed"] + numbers["escaped"] + numbers["lost"], 2000)
        self.assertEqual(set(numbers["seconds"]), {"load", "prepare", "trace", "draw", "write", "total"})
        self.assertEqual(set(numbers["preparation"]), {"upload", "majorants", "sampling", "tree", "collectors"})
        self.assertLessEqual(sum(numbers["preparation"].values()), numbers["seconds"]["prepare"])
        self.assertEqual([asset["instances"] for asset in numbers["assets"]], [1])
        self.assertTrue(numbers["passes"])

    def test_statistics_on_standard_output(self):
        result = self.run_lumulus("render", self.scene("cloud = []"), "-o", self.out / "a.png", "--stats", "-", *SMALL)
        self.assertEqual(json.loads(result.stdout)["events"], 0)

    def test_same_seed_same_picture(self):
        scene = self.vdb_scene(self.fixtures / "ball.vdb")
        first, _ = self.rendered(scene, "--seed", "3")
        again, _ = self.rendered(scene, "--seed", "3")
        other, _ = self.rendered(scene, "--seed", "4")
        self.assertEqual(first, again)
        self.assertNotEqual(first["R"], other["R"])

    def test_same_seed_same_bytes(self):
        scene = self.vdb_scene(self.fixtures / "ball.vdb")
        for command in (("render", *SMALL), ("reference", *SMALL, "--spp", 1)):
            files = []
            for _ in range(2):
                path = self.folder / "same.exr"
                result = self.run_lumulus(command[0], scene, "-o", path, *command[1:])
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                files.append(path.read_bytes())
            self.assertEqual(files[0], files[1], command[0])

    def test_background_left_out(self):
        scene = self.vdb_scene(self.fixtures / "ball.vdb")
        with_sky, _ = self.rendered(scene)
        self.assertEqual(set(with_sky["A"]), {1.0})
        alone, _ = self.rendered(scene, "--set", "image.background=false", "-o", self.out / "a.png")
        for name in ("R", "G", "B", "A"):
            self.assertEqual(alone[name], with_sky[f"cloud.{name}"])
        picture = Image.open(self.out / "a.png")
        self.assertEqual(picture.mode, "RGBA")
        alphas = list(picture.getchannel("A").getdata())
        self.assertEqual(alphas, [math.floor(255 * alpha + 0.5) for alpha in alone["A"]])
        self.assertEqual((min(alphas), picture.getpixel((0, 0))), (0, (0, 0, 0, 0)))

    def test_no_cloud_is_sky(self):
        layers, _ = self.rendered(self.scene("cloud = []\n[sky]\nradiance = [0.5, 1, 2]\n"),
                                  "--set", "sun.irradiance=0")
        for name, radiance in (("R", 0.5), ("G", 1.0), ("B", 2.0)):
            self.assertTrue(all(abs(value - radiance) < 1e-5 for value in layers[name]), name)

    def test_zero_density_is_sky_and_a_warning(self):
        layers, result = self.rendered(self.vdb_scene(self.fixtures / "zeros.vdb"), "--set", "sky.radiance=1")
        self.assertRegex(result.stderr, r"^lumulus: warning: ")
        self.assertTrue(all(value == 0 for value in layers["cloud.A"]))

    def test_one_voxel(self):
        layers, _ = self.rendered(self.vdb_scene(self.fixtures / "one-voxel.vdb"))
        self.assertGreater(max(layers["cloud.A"]), 0.0)

    def test_far_from_the_origin(self):
        near, _ = self.rendered(self.vdb_scene(self.fixtures / "ball.vdb"))
        far, _ = self.rendered(self.vdb_scene(self.fixtures / "far.vdb"))
        for name in ("R", "G", "B", "cloud.A"):
            mean = sum(near[name]) / len(near[name])
            rms = math.sqrt(sum((a - b) ** 2 for a, b in zip(near[name], far[name])) / len(near[name]))
            self.assertLess(rms, 1e-3 * mean, name)

    def test_progress(self):
        result = self.run_lumulus("render", self.vdb_scene(self.fixtures / "ball.vdb"), "-o", self.out / "a.exr",
                                  *SMALL[1:])
        for step in ("loading the cloud: ", "preparing the cloud: ", "photons: 2/2 ", "drawing: 2/2 ", "writing: "):
            self.assertIn("\n" + step, "\n" + result.stderr)

    def test_interrupted(self):
        self.interrupt("making the cloud", "cloud", "cumulus", "-o", self.out / "a.vdb", "--resolution", 600)
        render = ["render", self.scene(""), "-o", self.out / "a.exr", "--set", "preparation.samples=500"]
        self.interrupt("making the cloud", *render, "--set", "cloud.0.resolution=600")
        small = [*render, "--set", "cloud.0.resolution=16", "--set", "photon_map.photons=100000"]
        self.interrupt("photons", *small, "--set", "photon_map.generations=4096")
        self.interrupt("drawing", *small, "--set", "image.width=4096", "--set", "image.height=4096")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
