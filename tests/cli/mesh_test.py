"""Meshes: mesh_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments]."""

import json
import subprocess
import sys
import unittest
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).parent))
from cli_test import SMALL, CliTest  # noqa: E402
from flat_layers import read_exr  # noqa: E402

MESHES = Path(__file__).parents[2] / "scripts" / "meshes.py"
SCENE = """
camera = {{ position = [0, 100, {away}], target = [0, 100, 0], vertical_fov = 30 }}
sky = {{ model = "constant", radiance = {sky} }}
sun = {{ azimuth = 120, elevation = {elevation}, irradiance = {sun}, angular_diameter = 2.0 }}
"""
BALL = """
[[mesh]]
gltf = "{name}.glb"
position = [{x}, 100, 0]
scale = {scale}
"""
FOG = """
[[fog.media]]
scattering = [0.0019, 0.0019, 0.0019]
absorption = [0.0001, 0.0001, 0.0001]
g = 0.6
top = 400
bottom = 0
"""
THIN = """
[[cloud]]
procedural = "sphere"
resolution = 32
extinction = 2e-3
transform = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]
"""
CLOUD = """
[[cloud]]
procedural = "sphere"
resolution = 24
extinction = 2e-3
transform = [[0.5, 0, 0, -100], [0, 0.5, 0, 500], [0, 0, 0.5, -500]]
"""


class MeshTest(CliTest):
    def ball(self, name, **material):
        options = [f"--{key}={value}" for key, value in material.items()]
        subprocess.run([MESHES, "ball", "-o", self.folder / f"{name}.glb", *options], check=True)

    def layers(self, command, text, *options, name="a.exr"):
        result = self.run_lumulus(command, self.scene(text), *SMALL, "-o", self.out / name, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return {layer: numpy.asarray(values) for layer, values in read_exr(self.out / name)[2].items()}


class Pictures(MeshTest):
    def test_a_white_ball_in_a_white_furnace(self):
        """Of no light but a sky of 1 a white ball shows 1 everywhere, whatever its facets."""
        for metallic in (0, 1):
            self.ball("white", colour="1,1,1", metallic=metallic, roughness=0.6)
            text = SCENE.format(away=8, sky=[1, 1, 1], sun=[0, 0, 0], elevation=40)
            text += BALL.format(name="white", x=0, scale=1)
            seen = self.layers("render", text)
            self.assertGreater(numpy.count_nonzero(seen["mesh.id"] == 1), 60)
            for channel in "RGB":
                mean = float(numpy.mean(seen[channel][seen["mesh.id"] == 1]))
                self.assertLess(abs(mean - 1), 0.012, f"metallic {metallic}")
                self.assertLess(numpy.max(numpy.abs(seen[channel] - 1)), 0.15)

    def test_layers_of_a_ball(self):
        self.ball("grey")
        text = SCENE.format(away=10, sky=[0.2, 0.3, 0.4], sun=[3, 3, 3], elevation=40)
        text += BALL.format(name="grey", x=0, scale=1) + BALL.format(name="grey", x=2.4, scale=0.5)
        seen = {name: layer.reshape(24, 32) for name, layer in self.layers("render", text).items()}
        self.assertEqual(seen["mesh.id"][12, 16], 1)
        self.assertEqual(set(numpy.unique(seen["mesh.id"])), {0, 1, 2})
        self.assertLess(abs(seen["depth.Z"][12, 16] - 9), 0.03)
        self.assertLess(abs(seen["depth.front"][12, 16] - 9), 0.03)
        self.assertEqual(seen["cloud.A"][12, 16], 1)
        self.assertEqual(seen["transmittance.R"][12, 16], 0)
        self.assertEqual(seen["cloud.A"][1, 1], 0)
        self.assertLess(abs(seen["G"][1, 1] - 0.3), 1e-6)

    def test_render_agrees_with_the_reference(self):
        """Metal, plastic and matte below a cloud."""
        self.ball("metal", metallic=1, roughness=0.4, colour="0.9,0.8,0.6")
        self.ball("plastic", roughness=0.4, colour="0.6,0.1,0.1")
        self.ball("matte")
        text = SCENE.format(away=14, sky=[0.11, 0.20, 0.38], sun=[5.0, 4.6, 3.9], elevation=40) + CLOUD
        for name, x in (("metal", -2.4), ("plastic", 0), ("matte", 2.4)):
            text += BALL.format(name=name, x=x, scale=1)
        size = ["--set", "image.width=64", "--set", "image.height=28"]
        drawn = self.layers("render", text, *size, "--set", "photon_map.photons=200000")
        truth = self.layers("reference", text, *size, "--spp", "1024", name="b.exr")
        within = drawn["mesh.id"] > 0
        self.assertGreater(numpy.count_nonzero(within), 120)
        for channel in "RGB":
            a, b = drawn[channel][within], truth[channel][within]
            noise = truth["variance." + channel][within]
            self.assertLess(abs(numpy.sum(a) / numpy.sum(b) - 1), 0.02, channel)
            self.assertLess(numpy.mean(((a - b) ** 2 - noise) / (b**2 + 1e-4)), 1e-2, channel)
        depth = drawn["depth.Z"] - truth["depth.Z"]
        self.assertLess(float(numpy.median(numpy.abs(depth[within]))), 0.05)

    def agrees(self, text, photons, samples, bias, error):
        """Whether pictures of render and reference agree; those of render."""
        size = ["--set", "image.width=64", "--set", "image.height=36"]
        drawn = self.layers("render", text, *size, "--set", f"photon_map.photons={photons}")
        truths = [
            self.layers("reference", text, *size, "--spp", samples, "--set", f"photon_map.seed={seed}", name="b.exr")
            for seed in (1, 2)
        ]
        for channel in "RGB":
            a, b, c = (layers[channel] for layers in (drawn, *truths))
            mean = (b + c) / 2
            self.assertLess(abs(numpy.sum(a) / numpy.sum(mean) - 1), bias, channel)
            self.assertLess(numpy.mean((a - b) * (a - c) / (mean**2 + 1e-4)), error, channel)
        return drawn

    def test_a_tower_throws_its_shadow_on_the_ground(self):
        subprocess.run([MESHES, "tower", "-o", self.folder / "tower.glb"], check=True)
        text = SCENE.format(away=260, sky=[0.11, 0.20, 0.38], sun=[5.0, 4.6, 3.9], elevation=35)
        text = text.replace("[0, 100, 260], target = [0, 100, 0]", "[60, 90, 200], target = [0, 20, 0]")
        text += "ground = { height = 0, albedo = [0.3, 0.3, 0.3] }\n"
        text += BALL.format(name="tower", x=0, scale=1).replace("100", "0")
        drawn = self.agrees(text, 1000, "256", 0.003, 3e-3)
        shaded = drawn["G"][drawn["mesh.id"] == 0]
        self.assertLess(numpy.min(shaded), 0.5 * numpy.median(shaded))

    def test_a_ball_throws_its_shadow_into_fog(self):
        self.ball("grey", radius=40)
        text = SCENE.format(away=300, sky=[0.05, 0.05, 0.05], sun=[5.0, 4.6, 3.9], elevation=60)
        text = text.replace("[0, 100, 300], target = [0, 100, 0]", "[0, 60, 300], target = [0, 60, 0]")
        text = text.replace("azimuth = 120", "azimuth = 90").replace("fov = 30", "fov = 40")
        text += "ground = { height = 0, albedo = [0.3, 0.3, 0.3] }\n" + FOG.replace("400", "120")
        text += BALL.format(name="grey", x=60, scale=1).replace("100", "180")
        self.agrees(text, 1000, "512", 0.012, 1e-3)

    def test_a_ball_throws_its_shadow_on_a_thin_cloud(self):
        """Most of the middle of a cloud that scatters light about once lies in the shadow of a black ball out of view."""
        self.ball("black", radius=40, colour="0,0,0", metallic=1)
        text = SCENE.format(away=250, sky=[0, 0, 0], sun=[5, 5, 5], elevation=60).replace("azimuth = 120", "azimuth = 90")
        text = text.replace("[0, 100, 250], target = [0, 100, 0]", "[0, 110, 250], target = [0, 110, 0]") + THIN
        shade = BALL.format(name="black", x=120, scale=2).replace("100, 0]", "308, 0]")
        seen = {
            "lit": self.layers("render", text),
            "shaded": self.layers("render", text + shade),
            "truth": self.layers("reference", text + shade, "--spp", "4096", name="b.exr"),
        }
        inside = {name: layers["G"].reshape(24, 32)[4:20, 13:19].sum() for name, layers in seen.items()}
        self.assertLess(inside["shaded"], 0.7 * inside["lit"])
        self.assertLess(abs(inside["shaded"] - inside["truth"]), 0.05 * inside["lit"])

    def test_a_tower_in_fog_with_a_lamp(self):
        subprocess.run([MESHES, "tower", "-o", self.folder / "tower.glb"], check=True)
        text = SCENE.format(away=260, sky=[0, 0, 0], sun=[0, 0, 0], elevation=35)
        text = text.replace("[0, 100, 260], target = [0, 100, 0]", "[150, 60, 260], target = [0, 55, 0]")
        text += "ground = { height = 0, albedo = [0.3, 0.3, 0.3] }\n" + FOG
        text += BALL.format(name="tower", x=0, scale=1).replace("100", "0")
        text += "[[lamp]]\npower = [20000, 18000, 14000]\nposition = [40, 60, 60]\nradius = 0.5\n"
        self.agrees(text, 400000, "512", 0.02, 1e-2)

    def test_a_mesh_ends_the_clouds_behind_it(self):
        """A large ball in front of a cloud shows the same as without the cloud, but for the cloud's light; one behind it
        is hidden."""
        self.ball("black", colour="0,0,0", metallic=1)
        text = SCENE.format(away=900, sky=[1, 1, 1], sun=[0, 0, 0], elevation=40).replace("fov = 30", "fov = 4") + CLOUD
        text = text.replace("-100], [0, 0.5, 0, 500], [0, 0, 0.5, -500]", "0], [0, 0.5, 0, 100], [0, 0, 0.5, 0]")
        text = text.replace("2e-3", "0.1")
        before, behind = (BALL.format(name="black", x=0, scale=10).replace("100, 0]", f"100, {z}]") for z in (600, -600))
        middle = 12 * 32 + 16
        self.assertLess(self.layers("render", text + before)["G"][middle], 1e-3)
        hidden = self.layers("render", text + behind)
        self.assertGreater(hidden["G"][middle], 0.1)
        self.assertEqual(hidden["mesh.id"][middle], 1)

    def test_scenes_without_meshes_have_no_pass_of_them(self):
        self.ball("grey")
        text = SCENE.format(away=10, sky=[0.2, 0.3, 0.4], sun=[3, 3, 3], elevation=40)
        for more, expected in (("cloud = []\n", False), (BALL.format(name="grey", x=0, scale=1), True)):
            scene = more + text if "cloud" in more else text + more
            stats = self.folder / "stats.json"
            seen = self.layers("render", scene, "--stats", stats)
            passes = [entry["name"] for entry in json.loads(stats.read_text())["passes"]]
            self.assertEqual("mesh rays" in passes, expected)
            self.assertEqual("mesh.id" in seen, expected)


class Refusals(MeshTest):
    def refused(self, text, message, *options, command="render"):
        result = self.run_lumulus(command, self.scene(text), *SMALL, "-o", self.out / "a.exr", *options)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1)
        self.assertIn(message, result.stderr)
        self.assertEqual(list(self.out.iterdir()), [])

    def test_bad_meshes(self):
        text = SCENE.format(away=10, sky=[1, 1, 1], sun=[1, 1, 1], elevation=40)
        self.ball("grey")
        ball = BALL.format(name="grey", x=0, scale=1)
        self.refused(text + "[[mesh]]\nyaw = 3\n", "the mesh has no file")
        self.refused(text + BALL.format(name="other", x=0, scale=1), "other.glb does not exist")
        self.refused(text + ball + 'name = "a b"\n', "cannot be the name of a mesh")
        self.refused(text + ball, "billboards are not drawn among meshes", "--set", "draw.mode=billboards")
        (self.folder / "grey.glb").write_bytes(b"glTF and nothing else")
        self.refused(text + ball, "it is no glTF 2.0")
        self.refused(text + ball, "it is no glTF 2.0", "--spp", "1", command="reference")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
