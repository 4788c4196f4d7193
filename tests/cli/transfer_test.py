"""Frames that go on with the light of those before: transfer_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments]."""

import hashlib
import json
import random
import sys
import unittest
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).parent))
from cli_test import CliTest  # noqa: E402
from flat_layers import read_exr  # noqa: E402

SCENE = """
sky = {{ model = "constant" }}
image = {{ width = 48, height = 27 }}
photon_map = {{ photons = {photons}, generations = 2, transfer = {transfer} }}
preparation = {{ samples = 500 }}
camera = {{ position = [0, 300, 2600], target = [0, 300, 0] }}
"""
CLOUD = """
[[cloud]]
vdb = "v_####.vdb"
"""
FPS = "[animate]\nfps = 1.0\n"


class TransferTest(CliTest):
    def volumes(self, frames, *more, resolution=16):
        done = self.run_lumulus("cloud", "cumulus", "--resolution", resolution, "-o", self.folder / "v_####.vdb", "--frames", frames,
                                "--fps", 1, "--quiet", *more)
        self.assertEqual(done.returncode, 0, done.stderr)

    def voxel(self):
        """Edge of the voxels of the files [m]."""
        info = json.loads(self.run_lumulus("info", self.folder / "v_0000.vdb", "--json").stdout)
        return next(grid for grid in info["grids"] if grid["name"] == "density")["voxel_size"][0]

    def text(self, more, transfer="true", photons=4000):
        return self.scene(SCENE.format(transfer=transfer, photons=photons) + more)

    def frames(self, scene, frames, *more, code=0, name="f_####.exr"):
        done = self.run_lumulus("render", scene, "--frames", frames, "-o", self.out / name, "--quiet", *more)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def hashes(self):
        return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(self.out.glob("*.exr"))}

    def clear(self):
        for path in self.out.iterdir():
            path.unlink()

    def picture(self, name):
        layers = read_exr(self.out / name)[2]
        return numpy.stack([numpy.array(layers[f"cloud.{channel}"], dtype=float) for channel in "RGB"])

    def difference(self, a, b):
        """Of two pictures, root mean square over that of the second."""
        return float(numpy.sqrt(numpy.mean((self.picture(a) - self.picture(b)) ** 2) / numpy.mean(self.picture(b) ** 2)))


class Resume(TransferTest):
    def test_killed_and_resumed(self):
        """A frame depends on those before it: SIGKILL at any time, and the same bits as in one go. Also where the kept
        light is gone, cut short or of another scene, and where a frame in the middle is missing."""
        self.volumes("0-5", "--wind", "10,0,0", "--swirl", 4)
        scene = self.text(FPS + CLOUD)
        self.frames(scene, "0-5")
        whole = self.hashes()
        self.assertEqual(len(set(whole.values())), 6)
        self.assertTrue((self.out / "f_0000.map").exists())
        self.clear()
        chance = random.Random(5)
        for _ in range(3):
            self.kill(chance.uniform(0.3, 1.2), "render", scene, "--frames", "0-5", "-o", self.out / "f_####.exr",
                      "--skip-existing")
        self.frames(scene, "0-5", "--skip-existing")
        self.assertEqual(self.hashes(), whole)
        kept = (self.out / "f_0000.map").read_bytes()
        for name, content in (("gone", None), ("cut short", kept[:-10]), ("whole", kept)):
            with self.subTest(map=name):
                (self.out / "f_0003.exr").unlink()
                (self.out / "f_0005.exr").unlink()
                (self.out / "f_0000.map").unlink() if content is None else (self.out / "f_0000.map").write_bytes(content)
                done = self.frames(scene, "0-5", "--skip-existing")
                self.assertEqual("traced again" in done.stderr, name == "cut short", done.stderr)
                self.assertEqual(self.hashes(), whole)
        self.frames(self.text(FPS + CLOUD + "extinction = 0.05\n"), "0-7", "--skip-existing", code=2)  # no file 6
        self.volumes("6-7", "--wind", "10,0,0", "--swirl", 4)
        done = self.frames(self.text(FPS + CLOUD + "extinction = 0.05\n"), "0-6", "--skip-existing")
        self.assertIn("another sequence", done.stderr)

    def test_a_range_goes_on_from_its_kept_light(self):
        self.volumes("0-5", "--swirl", 4)
        scene = self.text(FPS + CLOUD)
        self.frames(scene, "0-5")
        whole = self.hashes()
        self.clear()
        self.frames(scene, "0-2")
        began = (self.out / "f_0000.map").stat().st_mtime_ns
        done = self.frames(scene, "0-5", "--skip-existing")
        self.assertNotIn("traced again", done.stderr)
        self.assertEqual(self.hashes(), whole)
        self.assertNotEqual((self.out / "f_0000.map").stat().st_mtime_ns, began)


class Light(TransferTest):
    def test_a_still_cloud_collects_photons(self):
        """Eight frames have the light of eight: an error of a map with eight times the photons."""
        cloud = "[[cloud]]\nresolution = 24\n"
        self.frames(self.text(cloud), "0-8")
        self.frames(self.text(cloud, "false"), "8", name="anew_####.exr")
        self.frames(self.text(cloud, "false", 800000), "8", name="truth_####.exr")
        anew, carried = (self.difference(name, "truth_0008.exr") for name in ("anew_0008.exr", "f_0008.exr"))
        self.assertEqual(self.hashes()["f_0000.exr"] == self.hashes()["f_0008.exr"], False)
        self.assertLess(carried, 0.55 * anew, "√(1/8) = 0.35, and the bias of the cells of few photons")

    def test_a_shifted_cloud_gives_the_shifted_picture(self):
        """A cloud that the wind carries by whole voxels, before a camera that goes along: the picture of one that stands
        still, with velocities of the file, with those of the scene, and with a transform that moves."""
        self.volumes("0-5", resolution=24)
        voxel = self.voxel()
        self.frames(self.text(FPS + CLOUD), "0-5", name="still_####.exr")
        way = 5 * voxel
        camera = (f'"camera.position" = [[0, [0, 300, 2600]], [5, [{way}, 300, 2600]]]\n'
                  f'"camera.target" = [[0, [0, 300, 0]], [5, [{way}, 300, 0]]]\n')
        self.volumes("0-5", "--wind", f"{voxel},0,0", resolution=24)
        self.frames(self.text(FPS + camera + CLOUD), "0-5", name="moved_####.exr")
        transform = ('"cloud.0.transform" = [[0, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]], '
                     f'[5, [[1, 0, 0, {way}], [0, 1, 0, 0], [0, 0, 1, 0]]]]\n')
        self.frames(self.text(FPS + camera + transform + "[[cloud]]\nvdb = \"v_0000.vdb\"\n"), "0-5", name="whole_####.exr")
        for name in ("moved", "whole"):
            for frame in (1, 5):
                self.assertLess(self.difference(f"{name}_000{frame}.exr", f"still_000{frame}.exr"), 1e-3, (name, frame))
        self.frames(self.text(FPS + camera + CLOUD, "false"), "5", name="anew_####.exr")
        self.assertGreater(self.difference("anew_0005.exr", "still_0005.exr"), 0.03, "by its noise")

    def test_lights_and_grounds_go_along(self):
        """Several clouds above ground in an atmosphere, and a sun that sets: as bright as what is traced anew."""
        text = (SCENE.replace("sky = {{ model = \"constant\" }}\n", "") + FPS + "\"sun.elevation\" = [[0, 12], [4, 10]]\n"
                "[[cloud]]\nresolution = 16\n[[cloud]]\nresolution = 16\nseed = 2\ntransform = [[1, 0, 0, 700], [0, 1, 0, 200], [0, 0, 1, 0]]\n")
        for transfer in ("true", "false"):
            self.frames(self.scene(text.format(transfer=transfer, photons=20000)), "0-4", name=f"{transfer}_####.exr")
        mean = [self.picture(f"{name}_0004.exr").mean() for name in ("true", "false")]
        self.assertLess(abs(mean[0] / mean[1] - 1.0), 0.08, "a sun that sets is behind by a frame or two")
        self.assertLess(self.difference("true_0004.exr", "false_0004.exr"), 0.3)


class Files(TransferTest):
    def test_a_file_that_is_damaged(self):
        """That frame fails, those behind it begin anew."""
        self.volumes("0-3", "--swirl", 4)
        path = self.folder / "v_0001.vdb"
        path.write_bytes(path.read_bytes()[:3000])
        done = self.frames(self.text(FPS + CLOUD), "0-3", code=1)
        self.assertIn("frame 1: ", done.stderr)
        self.assertEqual(done.stderr.splitlines()[-1].split(" (")[0], "lumulus: error: 1 of 4 frames failed")
        self.assertEqual(list(self.hashes()), ["f_0000.exr", "f_0002.exr", "f_0003.exr"])

    def test_velocities_that_are_none(self):
        """No numbers, and a grid that lies elsewhere: a line with the frame's number, and exit code 1; the others are there.
        A single picture that needs them ends with exit code 2. What needs no velocities does not look at them."""
        cloud = f"[[cloud]]\nvdb = \"{self.fixtures}/moving-#.vdb\"\nextinction = 0.5\n"
        scene = lambda more, transfer: self.scene(  # noqa: E731
            SCENE.format(transfer=transfer, photons=2000).replace("2600", "60").replace("300", "0") + FPS + cloud + more)
        done = self.frames(scene("", "true"), "0-3", code=1)
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), 3, lines)
        self.assertRegex(lines[0], "frame 1: .*no number.*moving-1.vdb")
        self.assertRegex(lines[1], "frame 3: .*outside of the cloud.*moving-3.vdb")
        self.assertEqual(list(self.hashes()), ["f_0000.exr", "f_0002.exr"])
        self.clear()
        between = scene("frames = [0, 3]\noffset = 0.5\n", "false")
        self.rejected("render", between, "-o", self.out / "a.exr", says="no number")
        self.frames(scene("", "false"), "0-3")

    def test_moments_between_files(self):
        """Half a frame behind file 1 lies what both files have become till then; the nearest file where that is asked."""
        self.volumes("0-0", resolution=24)
        way = 2 * self.voxel()
        self.volumes("0-2", "--wind", f"{way},0,0", resolution=24)
        half = CLOUD + "frames = [0, 2]\nspeed = 0.5\n"
        self.frames(self.text(FPS + half, "false"), "3", name="between_####.exr")
        self.frames(self.text(FPS + half + "between = \"nearest\"\n", "false"), "3", name="nearest_####.exr")
        self.frames(self.text(FPS + CLOUD + "frames = [0, 2]\n", "false"), "2", name="two_####.exr")
        self.assertEqual(self.hashes()["nearest_0003.exr"], self.hashes()["two_0002.exr"])
        camera = SCENE.replace("[0, 300, 2600]", f"[{way / 2}, 300, 2600]").replace("target = [0,", f"target = [{way / 2},")
        self.frames(self.scene(camera.format(transfer="false", photons=4000) + FPS + half), "3", name="along_####.exr")
        self.frames(self.text(FPS + CLOUD + "frames = [0, 2]\n", "false"), "1", name="one_####.exr")
        alpha = [read_exr(self.out / name)[2]["cloud.A"] for name in ("along_0003.exr", "one_0001.exr")]
        self.assertLess(numpy.abs(numpy.array(alpha[0]) - numpy.array(alpha[1])).max(), 1e-3, "the same cloud, half a file on")
        (self.folder / "v_0002.vdb").unlink()
        one = self.hashes()["one_0001.exr"]
        self.clear()
        self.rejected("render", self.text(FPS + half, "false"), "--frames", "3", "-o", self.out / "a_####.exr", says="frame 2: ")
        self.frames(self.text(FPS + half + "missing = \"hold\"\n", "false"), "3", name="held_####.exr")
        self.assertEqual(self.hashes()["held_0003.exr"], one)

    def test_bad_usage(self):
        cloud = "[[cloud]]\nresolution = 16\n"
        scene = self.text(FPS + "\"photon_map.transfer\" = [[0, false], [1, true]]\n" + cloud, "false")
        self.rejected("render", scene, "--frames", "0-2", "-o", self.out / "a_####.exr", says="photon_map.transfer")
        self.rejected("render", self.text(cloud), "--frames", "0-2", "-o", self.out / "a_####.exr", "--set",
                      "photon_map.transfer_frames=99", says="transfer_frames")
        good = ["-o", self.out / "c_##.vdb", "--quiet"]
        for words, says in ((["--wind", "1,2"], "--wind"), (["--wind", "1,2,x", "--frames", "0-1"], "--wind"),
                            (["--swirl", 4], "--frames"), (["--frames", "3-1"], "--frames"), (["--frames", "0-1", "--swirl", -1], "--swirl"),
                            (["--frames", "0-1", "--fps", 0], "--fps"), (["--frames", "0-1", "--fps", "nan"], "--fps"),
                            (["--frames", "0-1", "--wind", "nan,0,0"], "--wind"), (["--frames", "0-1", "--wind", "0,1e9,0"], "--wind"),
                            (["--frames", "0-1", "--swirl", "nan"], "--swirl"),
                            (["--frames", "0-99999", "--swirl", 1000], "million voxels at frame 99999"),
                            (["--frames", "0-999999:1000", "--fps", 0.01, "--wind", "9,0,0"], "km away at frame 999000")):
            self.rejected("cloud", "cumulus", "--resolution", 16, *good, *words, says=says)
        self.rejected("cloud", "cumulus", "--resolution", 16, "-o", self.out / "c.vdb", "--frames", "0-1", says="####")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
