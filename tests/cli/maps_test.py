"""Photon maps in files: maps_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments]."""

import hashlib
import random
import struct
import sys
import unittest
import zlib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from cli_test import CliTest  # noqa: E402

ONE = """
image = { width = 32, height = 18 }
photon_map = { photons = 28000, generations = 14 }
preparation = { samples = 500 }
sky = { model = "constant" }
[[cloud]]
resolution = 24
"""
FIELD = ONE.replace("sky = { model = \"constant\" }\n", "") + """
[[cloud]]
resolution = 24
seed = 2
transform = [[1, 0, 0, 900], [0, 1, 0, 100], [0, 0, 1, -500]]
phase = { g = 0.7 }
[ground]
height = -50
"""
HAZE = ONE + """
[[fog.media]]
visibility = 8000
bottom = 0
top = 2000
"""


class Maps(CliTest):
    def lumulus(self, *arguments):
        result = self.run_lumulus(*arguments, "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def picture(self, scene, *more):
        """SHA-256 of a picture's file."""
        path = self.folder / "picture.exr"
        self.lumulus("render", scene, "-o", path, *more)
        return hashlib.sha256(path.read_bytes()).hexdigest()

    def part(self, scene, first, last, *more):
        path = self.folder / f"{first}-{last}.map"
        self.lumulus("render", scene, "--generations", f"{first}-{last}", "--map-out", path, *more)
        return path

    def merged(self, *maps):
        path = self.folder / "merged.map"
        self.lumulus("merge", *maps, "-o", path)
        return path

    def test_parts_in_any_order_are_the_whole(self):
        """One SHA-256, for 1, 2, 4 and 7 parts, by maps that are merged, merged in groups, or given as they are."""
        chance = random.Random(1)
        for name, text in (("one", ONE), ("field", FIELD), ("haze", HAZE)):
            scene = self.scene(text)
            whole = self.picture(scene)
            for parts in (1, 2, 4, 7) if name == "one" else (3,):
                with self.subTest(scene=name, parts=parts):
                    edges = [14 * i // parts for i in range(parts + 1)]
                    maps = [self.part(scene, a, b - 1) for a, b in zip(edges, edges[1:])]
                    chance.shuffle(maps)
                    self.assertEqual(self.picture(scene, "--map-in", *maps), whole)
                    self.assertEqual(self.picture(scene, "--map-in", self.merged(*maps)), whole)
                    if parts > 2:
                        group = self.folder / "group.map"
                        self.lumulus("merge", *maps[1:], "-o", group)
                        self.assertEqual(self.picture(scene, "--map-in", self.merged(group, maps[0])), whole)

    def test_parts_by_their_number(self):
        scene = self.scene(ONE)
        for number, first, last in ((1, 0, 3), (2, 4, 8), (3, 9, 13)):  # of 14 generations
            part = self.folder / "part.map"
            self.lumulus("render", scene, "--generations", f"{number}/3", "--map-out", part)
            self.assertEqual(part.read_bytes(), self.part(scene, first, last).read_bytes())
        for wrong in ("0/3", "4/3", "1/15", "1/0"):
            self.rejected("render", scene, "--generations", wrong, "--map-out", self.out / "a.map",
                          says=f"there is no part {wrong.replace('/', ' of ')} of the scene's 14 generations")
        for wrong in ("1/", "/3", "1/2/3", "1-2/3", "a/b"):
            self.rejected("render", scene, "--generations", wrong, "--map-out", self.out / "a.map",
                          says="is no range of generations")

    def test_a_map_goes_on(self):
        """What is missing at the end is traced: the resume of a long picture, also in place."""
        scene = self.scene(ONE)
        whole = self.picture(scene)
        part = self.part(scene, 0, 4)
        self.assertEqual(self.picture(scene, "--map-in", part, "--map-out", part), whole)
        self.assertEqual(self.picture(scene, "--map-in", part), whole)

    def test_one_map_many_views(self):
        scene = self.scene(ONE)
        part = self.part(scene, 0, 13)
        view = ["--set", "camera.position=[900, 300, 1500]", "--set", "image.width=24", "--set", "draw.tolerance=0.1"]
        self.assertEqual(self.picture(scene, "--map-in", part, *view), self.picture(scene, *view))

    def test_killed_parts_leave_nothing(self):
        scene = self.scene(ONE)
        path = self.folder / "killed.map"
        self.kill(1.5, "render", scene, "--generations", "0-6", "--map-out", path, "--set", "photon_map.photons=400000000")
        self.assertFalse(path.exists())

    def test_what_does_not_belong_together_is_refused(self):
        scene = self.scene(ONE)
        parts = [self.part(scene, 0, 3), self.part(scene, 4, 9), self.part(scene, 10, 13)]
        overlapping = self.part(scene, 3, 5)
        out = self.out / "a.map"
        self.rejected("merge", parts[0], overlapping, "-o", out, says="generation 3 is in a map before this one too")
        self.rejected("merge", parts[0], parts[1], parts[0], "-o", out, says="generation 0")
        render = ["render", scene, "-o", self.out / "a.exr", "--quiet", "--map-in"]
        self.rejected(*render, parts[0], parts[2], says="0-3, 10-13: 4-9 are missing")
        self.rejected(*render, parts[1], parts[2], says="0-3 are missing")
        result = self.run_lumulus("merge", parts[0], parts[2], "-o", self.folder / "gap.map")
        self.assertEqual((result.returncode, result.stderr.count("\n")), (0, 1))
        self.assertIn("0-3, 10-13", result.stderr)
        self.rejected(*render, self.folder / "gap.map", says="4-9 are missing")
        self.rejected(*render, *parts, "--generations", "0-9", says="leave out what is beyond")
        for change in ("photon_map.seed=2", "cloud.0.albedo=0.9", "cloud.0.extinction=0.081", "cloud.0.seed=3",
                       "cloud.0.phase.g=0.8", "sun.elevation=36", "sky.radiance=1", "photon_map.photons=28014",
                       "photon_map.bands=3", "photon_map.forward_cut=14", "ground.albedo=0.3",
                       "cloud.0.transform=[[1.01,0,0,0],[0,1,0,0],[0,0,1,0]]"):
            with self.subTest(change=change):
                more = [] if "ground" not in change else ["--set", "ground.height=-50"]
                self.rejected(*render, parts[0], "--set", change, *more, says="another scene, light, seed or version")

    def test_files_that_are_no_maps_are_refused(self):
        scene = self.scene(ONE)
        part = self.part(scene, 0, 3)
        good, bad = part.read_bytes(), self.folder / "bad.map"
        # claims many counts that a few bytes hold, with the right checksum
        head = good[:192 + 16]  # with one range of generations
        packed = zlib.compress(bytes(8))
        claims = head + struct.pack("<QQ", 1 << 31, len(packed)) + packed
        claims += hashlib.sha256(claims).hexdigest().encode()
        changed = bytearray(good)
        changed[len(good) // 2] ^= 1
        for content, says in ((b"", "no photon map"), (b"lumulus map 2\n" + good[14:], "another version"), (good[:15], "cut short"),
                              (good[:100], "cut short"), (good[:-1], "cut short"), (good[: len(good) // 2], "cut short"),
                              (good + b"x", "more bytes"), (bytes(changed), "checksum"), (good[:80] + b"\xff" * 300 + good[380:], "damaged"),
                              (b"PK\x03\x04" + good, "no photon map"), (claims, "damaged")):
            with self.subTest(says=says):
                bad.write_bytes(content)
                self.rejected("merge", part, bad, "-o", self.out / "a.map", says=says)
                self.rejected("render", scene, "-o", self.out / "a.exr", "--map-in", bad, says=says)
        self.rejected("merge", self.folder / "no.map", "-o", self.out / "a.map", says="no.map")
        self.rejected("merge", self.folder, "-o", self.out / "a.map", says="cannot read the photon map")

    def test_bad_usage(self):
        scene = self.scene(ONE)
        for text in ("5-3", "a-b", "0-14", "-1", "1-", "", "0-9-12"):
            with self.subTest(generations=text):
                self.rejected("render", scene, "--map-out", self.out / "a.map", f"--generations={text}", says="--generations")
        self.rejected("render", scene, says="nothing is to be written")
        self.rejected("render", scene, "--map-out", self.out / "a.map", "--seconds", 1, says="--seconds")
        self.rejected("render", scene, "--map-out", self.out / "no/a.map", says="no/a.map")
        self.rejected("render", scene, "--map-out", self.out / "a.exr", "-o", self.out / "a.exr", says="a.exr")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
