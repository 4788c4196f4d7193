"""Sequences of frames and animated scenes: frames_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments]."""

import hashlib
import json
import os
import random
import resource
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from cli_test import CliTest  # noqa: E402

SMALL = """
image = { width = 32, height = 18 }
photon_map = { photons = 20000, generations = 5 }
preparation = { samples = 500 }
[[cloud]]
resolution = 24
"""
SECOND = """
[[cloud]]
resolution = 24
seed = 2
transform = [[1, 0, 0, 900], [0, 1, 0, 100], [0, 0, 1, -9000]]
"""
CONSTANT = "sky = { model = \"constant\" }\n"
FIELD = """
sky = { model = "constant" }
image = { width = 48, height = 27 }
camera = { position = [0, 300, 4000], target = [0, 900, 0] }
photon_map = { photons = 20000, generations = 5 }
preparation = { samples = 500 }
[[field]]
area = [3000, 0, 3000]
variants = 2
resolution = 24
"""
MOVING_CLOUDS = """[animate]
cloud.0.transform = [[0, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]], [10, [[1, 0, 0, 100], [0, 1, 0, 0], [0, 0, 1, 0]]]]
cloud.1.transform = [[0, [[1, 0, 0, 700], [0, 1, 0, 0], [0, 0, 1, 0]]], [10, [[1, 0, 0, 500], [0, 1, 0, 50], [0, 0, 1, 0]]]]
"""
MOVING_CAMERA = "[animate]\ncamera.position = [[0, [0, 300, 2600]], [10, [500, 700, 2400]]]\n"
MOVING_SUN = "[animate]\n\"sun.elevation\" = [[0, 5.0], [10, 40.0]]\n"


class Frames(CliTest):
    def hashes(self, pattern="*.exr"):
        return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(self.out.glob(pattern))}

    def frames(self, scene, frames, *more, code=0, **options):
        result = self.run_lumulus("render", scene, "--frames", frames, "-o", self.out / "f_####.exr", "--quiet", *more, **options)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def test_each_frame_is_that_of_its_own_process(self):
        """What one process keeps from frame to frame changes no bit: photons, the clouds, the device; where clouds move, what
        was prepared of them; where some are others, that of the others."""
        self.volumes(0, 5, 10)
        files = SMALL.replace("resolution = 24", "vdb = \"v_####.vdb\"")
        wind = "wind = [[0, 0, 0, 0], [2000, 900, 0, 300]]\n"
        for name, text in (("a field in a wind that grows with height", FIELD + wind + MOVING_SUN),
                           ("files beside a cloud that stays", CONSTANT + files + SECOND),
                           ("camera", CONSTANT + SMALL + MOVING_CAMERA), ("sun", SMALL + MOVING_SUN),
                           ("sun on several clouds", CONSTANT + SMALL + SECOND + MOVING_SUN),
                           ("camera before several clouds", CONSTANT + SMALL + SECOND + MOVING_CAMERA),
                           ("fog", CONSTANT + SMALL + "[[fog.media]]\nscattering = 0.0001\nbottom = 0\ntop = 900\n"
                            "[animate]\n\"fog.media.0.scattering\" = [[0, 0.0001], [10, 0.0004]]\n"),
                           ("cloud", CONSTANT + SMALL + "[animate]\n\"cloud.0.extinction\" = [[0, 0.05], [10, 0.1]]\n")):
            with self.subTest(moves=name):
                scene = self.scene(text)
                self.frames(scene, "0-10:5")
                together = self.hashes()
                self.assertEqual(list(together), ["f_0000.exr", "f_0005.exr", "f_0010.exr"])
                self.assertEqual(len(set(together.values())), 3, "they differ")
                for frame in ("10", "0", "5"):
                    self.frames(scene, frame)
                self.assertEqual(self.hashes(), together)

    def test_the_frame_is_the_scene_with_its_values(self):
        self.frames(self.scene(CONSTANT + SMALL + """
[animate]
"sun.elevation" = [[0, 10.0], [4, 30.0]]
"cloud.0.seed" = [[0, 1], [4, 3]]
"cloud.0.phase.model" = [[0, "hg"], [2, "rayleigh"]]
"sky.radiance" = { keys = [[0, [0.1, 0.2, 0.4]], [2, [1, 1, 1]], [3, 0.5]], interpolation = "step" }
"""), "2")
        animated = self.hashes()
        self.frames(self.scene(CONSTANT + SMALL), "2", "--set", "sun.elevation=20", "--set", "cloud.0.seed=2", "--set",
                    "cloud.0.phase.model=rayleigh", "--set", "sky.radiance=[1, 1, 1]")
        self.assertEqual(self.hashes(), animated)

    def test_set_stands_above_the_animation(self):
        scene = self.scene(CONSTANT + SMALL + MOVING_SUN)
        self.frames(scene, "0-10:10", "--set", "sun.elevation=20")
        self.assertEqual(len(set(self.hashes().values())), 1)

    def test_without_frames_the_scene_is_at_frame_0(self):
        scene = self.scene(CONSTANT + SMALL + MOVING_SUN)
        self.frames(scene, "0")
        self.assertEqual(self.run_lumulus("render", scene, "-o", self.out / "alone.exr", "--quiet").returncode, 0)
        hashes = self.hashes()
        self.assertEqual(hashes["alone.exr"], hashes["f_0000.exr"])

    def test_camera_path(self):
        (self.folder / "path.csv").write_text("frame,x,y,z,target_x,target_y,target_z\n0,0,300,2600,0,300,0\n10,500,700,2400,0,400,0\n")
        self.frames(self.scene(CONSTANT + SMALL + "[animate]\ncamera = \"path.csv\"\n"), "0-10:5")
        middle = self.hashes()["f_0005.exr"]
        self.frames(self.scene(CONSTANT + SMALL + "[camera]\nposition = [250, 500, 2500]\ntarget = [0, 350, 0]\n"), "5")
        self.assertEqual(self.hashes()["f_0005.exr"], middle)

    def test_killed_and_resumed(self):
        """SIGKILL at any time, then --skip-existing: the same bits; a file that was cut short is made again."""
        scene = self.scene(CONSTANT + SMALL.replace("width = 32, height = 18", "width = 160, height = 90") + MOVING_SUN)
        self.frames(scene, "1-8")
        whole = self.hashes()
        for path in self.out.iterdir():
            path.unlink()
        chance = random.Random(3)
        for _ in range(3):
            self.kill(chance.uniform(0.3, 1.0), "render", scene, "--frames", "1-8", "-o", self.out / "f_####.exr",
                      "--skip-existing")
        left = sorted(self.out.glob("f_*.exr"))
        if left:
            os.truncate(left[-1], 700)
        self.frames(scene, "1-8", "--skip-existing")
        self.assertEqual(self.hashes("f_*.exr"), whole)
        before = {path.name: path.stat().st_mtime_ns for path in self.out.glob("f_*.exr")}
        self.frames(scene, "1-8", "--skip-existing")
        self.assertEqual({path.name: path.stat().st_mtime_ns for path in self.out.glob("f_*.exr")}, before)

    def test_frames_that_fail(self):
        """The others are there, and the exit code is 1."""
        scene = self.scene(CONSTANT + SMALL + MOVING_SUN)
        (self.out / "f_0002.exr").mkdir()
        result = self.frames(scene, "1-3", code=1)
        lines = result.stderr.splitlines()
        self.assertIn("frame 2: ", lines[0])
        self.assertEqual(lines[-1].split(" (")[0], "lumulus: error: 1 of 3 frames failed")
        self.assertEqual([path.name for path in sorted(self.out.glob("*.exr")) if path.is_file()], ["f_0001.exr", "f_0003.exr"])

    def test_a_disk_that_is_full(self):
        scene = self.scene(CONSTANT + SMALL + MOVING_SUN)
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))  # noqa: E731
        result = self.frames(scene, "1-2", code=1, preexec_fn=limit)
        self.assertIn("2 of 2 frames failed", result.stderr)
        self.assertEqual(list(self.out.iterdir()), [])

    def volumes(self, *numbers):
        """Small clouds, each of another shape, as files of a sequence."""
        for number in numbers:
            path = self.folder / f"v_{number:04}.vdb"
            result = self.run_lumulus("cloud", "cumulus", "--resolution", 16, "--seed", number, "-o", path, "--quiet")
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_cloud_of_files(self):
        """Each frame shows the file of its number, and beyond the ends what `extend` says."""
        self.volumes(7, 8, 9)
        head = CONSTANT + SMALL.replace("[[cloud]]\nresolution = 24\n", "")
        alone = {}
        for number in (7, 8, 9):
            self.frames(self.scene(head + f"[[cloud]]\nvdb = \"v_{number:04}.vdb\"\n"), "0")
            alone[number] = self.hashes()["f_0000.exr"]
        cloud = "[[cloud]]\nvdb = \"v_####.vdb\"\nframes = [7, 9]\n"
        for extend, numbers in (("hold", {6: 7, 8: 8, 11: 9}), ("repeat", {10: 7, 11: 8}), ("ping-pong", {10: 8, 11: 7})):
            for frame, number in numbers.items():
                with self.subTest(extend=extend, frame=frame):
                    self.frames(self.scene(head + cloud + f"extend = \"{extend}\"\n"), frame)
                    self.assertEqual(self.hashes()[f"f_{frame:04}.exr"], alone[number])
        self.frames(self.scene(head + cloud + "extend = \"clip\"\n"), "5")
        from flat_layers import read_exr
        self.assertEqual(set(read_exr(self.out / "f_0005.exr")[2]["cloud.R"]), {0.0})

    def test_a_file_may_have_the_name_of_a_sequence(self):
        self.volumes(7)
        (self.folder / "v_0007.vdb").rename(self.folder / "take#2.vdb")
        self.frames(self.scene(CONSTANT + SMALL.replace("resolution = 24", "vdb = \"take#2.vdb\"")), "0-1")
        self.assertEqual(len(set(self.hashes().values())), 1)

    def test_files_that_are_missing(self):
        self.volumes(7, 9)
        head = CONSTANT + SMALL.replace("[[cloud]]\nresolution = 24\n", "") + "[[cloud]]\nvdb = \"v_%04d.vdb\"\n"
        self.rejected("render", self.scene(head), "--frames", "7-9", "-o", self.out / "f_####.exr", says="frame 8: ")
        self.rejected("render", self.scene(head), "-o", self.out / "a.exr", says="frame 0: ")
        self.rejected("render", self.scene(head + "frames = [9, 7]\n"), "-o", self.out / "a.exr", says="rise")
        result = self.frames(self.scene(head + "missing = \"hold\"\n"), "7-9")
        self.assertIn("v_0008.vdb does not exist: ", result.stderr)
        hashes = self.hashes()
        self.assertEqual(hashes["f_0007.exr"], hashes["f_0008.exr"])
        self.assertNotEqual(hashes["f_0007.exr"], hashes["f_0009.exr"])

    def test_wind_carries_fields(self):
        """A field after ten seconds lies where one that was moved by hand does."""
        field = FIELD + "wind = [20, 0, -5]\n"
        self.frames(self.scene(field), "0-240:240")
        hashes = self.hashes()
        self.assertNotEqual(hashes["f_0000.exr"], hashes["f_0240.exr"])
        self.frames(self.scene(field + "[animate]\nfps = 12\n"), "120")
        self.assertEqual(self.hashes()["f_0120.exr"], hashes["f_0240.exr"])

    def test_statistics(self):
        self.frames(self.scene(CONSTANT + SMALL + MOVING_CAMERA), "3-4", "--stats", self.folder / "s.json")
        frames = json.loads((self.folder / "s.json").read_text())["frames"]
        self.assertEqual([each["frame"] for each in frames], [3, 4])
        self.assertEqual(frames[1]["statistics"]["photons"], 20000)

    def test_what_is_kept_is_told(self):
        """Clouds that move are prepared once. What becomes another is prepared anew."""
        self.frames(self.scene(CONSTANT + SMALL + SECOND + MOVING_CLOUDS), "0-5", "--stats", self.folder / "s.json",
                    "--set", "preparation.level_of_detail=false")
        frames = [each["statistics"] for each in json.loads((self.folder / "s.json").read_text())["frames"]]
        self.assertGreater(sum(frames[0]["preparation"].values()), 0.0)
        for frame in frames[1:]:
            self.assertEqual(frame["assets"], frames[0]["assets"])
            self.assertEqual(frame["collectors"], frames[0]["collectors"])
            self.assertLess(frame["gpu_bytes"], 1.01 * frames[0]["gpu_bytes"], "memory stays flat")
            self.assertEqual(sum(frame["preparation"].values()), 0.0)
        self.frames(self.scene(CONSTANT + SMALL + MOVING_SUN), "0-1", "--stats", self.folder / "s.json")
        frames = [each["statistics"] for each in json.loads((self.folder / "s.json").read_text())["frames"]]
        self.assertEqual(frames[1]["assets"], frames[0]["assets"])
        self.assertEqual(sum(frames[1]["preparation"].values()), 0.0)
        other = "[animate]\n\"cloud.0.seed\" = [[0, 1], [1, 2]]\n"
        self.frames(self.scene(CONSTANT + SMALL + other), "0-1", "--stats", self.folder / "s.json")
        frames = [each["statistics"] for each in json.loads((self.folder / "s.json").read_text())["frames"]]
        self.assertGreater(sum(frames[1]["preparation"].values()), 0.0)

    def test_the_reference_at_a_frame(self):
        """The picture of the scene with the values of that frame."""
        text = CONSTANT + SMALL + ("[animate]\n\"sun.elevation\" = [[0, 10.0], [4, 30.0]]\n"
                                   "\"cloud.0.extinction\" = [[0, 0.02], [4, 0.06]]\n")
        words = ["reference", self.scene(text), "--spp", 1, "--quiet"]
        for more in (["-o", self.out / "t_####.exr", "--frame", 3], ["-o", self.out / "zero.exr"],
                     ["-o", self.out / "set.exr", "--set", "sun.elevation=25", "--set", "cloud.0.extinction=0.05"]):
            done = self.run_lumulus(*words, *more)
            self.assertEqual(done.returncode, 0, done.stderr)
        hashes = self.hashes()
        self.assertEqual(hashes["t_0003.exr"], hashes["set.exr"])
        self.assertNotEqual(hashes["zero.exr"], hashes["set.exr"])
        done = self.run_lumulus(*words, "-o", self.out / "t_0003.exr", "--frame", 2, "--resume")
        self.assertEqual(done.returncode, 2)
        self.assertIn("was made from another scene", done.stderr)
        self.assertEqual(self.hashes(), hashes)
        for path in self.out.iterdir():
            path.unlink()
        for frame in ("-1", "x", "1.5", "1-3", "1e12", "nan", ""):
            self.rejected(*words, "-o", self.out / "a.exr", f"--frame={frame}", says="--frame")
        files = self.scene(CONSTANT + SMALL.replace("resolution = 24", "vdb = \"v_####.vdb\""))
        self.rejected("reference", files, "--spp", 1, "-o", self.out / "a.exr", "--frame", 8, says="frame 8: ")

    def test_questions_at_a_frame(self):
        """A ball that the wind has carried out of the way."""
        scene = self.scene(CONSTANT + SMALL.replace("resolution = 24", "procedural = \"sphere\"") +
                           "[animate]\n\"cloud.0.transform\" = [[0, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]], "
                           "[9, [[1, 0, 0, 900], [0, 1, 0, 0], [0, 0, 1, 0]]]]\n")
        (self.folder / "s.csv").write_text("x0,y0,z0,x1,y1,z1\n0,-500,0,0,500,0\n900,-500,0,900,500,0\n")
        for frame, thick in ((0, [True, False]), (9, [False, True]), (4, [False, False])):
            done = self.run_lumulus("query", scene, "--segments", self.folder / "s.csv", "--json", "--frame", frame, "--quiet")
            self.assertEqual(done.returncode, 0, done.stderr)
            through = [min(each["transmittance"]) for each in json.loads(done.stdout)["passages"]]
            self.assertEqual([each < 0.01 for each in through], thick, frame)
        done = [self.run_lumulus("sky", self.scene(SMALL + MOVING_SUN), "--json", "--frame", frame) for frame in (0, 10)]
        self.assertNotEqual(done[0].stdout, done[1].stdout)

    def test_names(self):
        scene = self.scene(CONSTANT + SMALL)
        for name, files in (("a.%04d.exr", ["a.0007.exr"]), ("b##.png", ["b07.png"]), ("c%d.png", ["c7.png"])):
            result = self.run_lumulus("render", scene, "--frames", "7", "-o", self.out / name, "--quiet")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue((self.out / files[0]).exists())

    def test_bad_usage(self):
        scene = self.scene(CONSTANT + SMALL)
        good = ["-o", self.out / "f_####.exr"]
        for frames in ("x", "3-1", "1-3:0", "1-3:", "-1", "1-", "1-3-5", "0-5000000", "1-99999999999"):
            self.rejected("render", scene, *good, f"--frames={frames}", says="--frames")
        self.rejected("render", scene, "--frames", "1-2", "-o", self.out / "a.exr", says="####")
        self.rejected("render", scene, "--frames", "1-2", says="nothing is to be written")
        self.rejected("render", scene, "--frames", "1-2", *good, *good, says="twice")
        self.rejected("render", scene, "--frames", "1-2", *good, "--seconds", 2, says="--seconds")
        self.rejected("render", scene, "--frames", "1-2", *good, "--map-out", self.folder / "a.map", says="photon maps")
        self.rejected("render", scene, "-o", self.out / "a.exr", "--skip-existing", says="--skip-existing")

    def test_bad_animations(self):
        for text, says in (("\"sun.hight\" = [[0, 1]]", "sun.hight"), ("\"sun.elevation\" = 3", "keys"),
                           ("\"sun.elevation\" = []", "keys"), ("\"sun.elevation\" = [[0, 1], [0, 2]]", "rise"),
                           ("\"sun.elevation\" = [[0, 1], [5, [1, 2]]]", "nothing"), ("\"sun.elevation\" = [[0, 1], [5, 91]]", "frame 5"),
                           ("\"sun.elevation\" = [[0, \"high\"]]", "frame 0"), ("\"sun.elevation\" = [0, 1]", "frame and a value"),
                           ("\"sun.elevation\" = { keys = [[0, 1]], interpolation = \"wild\" }", "linear, smooth"),
                           ("\"sun.elevation\" = { keys = [[0, 1]], unit = \"hour\" }", "unit"),
                           ("\"sun.elevation\" = [[0, nan]]", "finite"), ("fps = 0", "fps"), ("camera = \"no.csv\"", "no.csv"),
                           ("\"cloud.7.extinction\" = [[0, 1]]", "cloud.1")):
            with self.subTest(text=text):
                scene = self.scene(CONSTANT + SMALL + "[animate]\n" + text + "\n")
                line = self.rejected("render", scene, "--frames", "0-5", "-o", self.out / "f_####.exr", says=says)
                self.assertIn("scene.toml", line) if "no.csv" not in text else None
        self.rejected("render", self.scene("animate = 3\n" + SMALL), "-o", self.out / "a.exr", says="animate must be a table")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
