"""Frames over the socket: what they hold, that `render` makes the same, channels, streams, deadlines, idleness."""

import io
import os
import re
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import numpy
from PIL import Image

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from flat_layers import read_exr
from server import LUMULUS, SCENE, Server, ServiceTest
from lumulus_client import ServiceError

ALL = ["color", "cloud", "transmittance", "depth", "front"]
LARGE_SCENE = '[[cloud]]\nprocedural = "cumulus"\nresolution = 480\n'  # takes seconds to make
LAYERS = {"color": ["R", "G", "B", "A"], "cloud": ["cloud.R", "cloud.G", "cloud.B", "cloud.A"],
          "transmittance": ["transmittance.R", "transmittance.G", "transmittance.B"], "depth": ["depth.Z"],
          "front": ["depth.front"]}


def run_render(scene, overrides):
    """Layers of what `render` writes, by name, as arrays."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture.exr")
        settings = [argument for override in overrides for argument in ("--set", override)]
        subprocess.run([LUMULUS, "render", scene, "-o", path, "--quiet", *settings], check=True)
        width, height, layers = read_exr(path)[:3]
        return {name: numpy.array(values, "f").reshape(height, width) for name, values in layers.items()}


class Equality(ServiceTest):
    """Every frame is what `render` writes with the overrides that the reply states."""

    def check(self, frame, overrides=()):
        layers = run_render(os.path.join(self.server.folder, "scenes", "small.toml"),
                            [*overrides, *frame.info["repeat"]])
        self.assertTrue(frame.verify())
        for part in frame.info["views"][0]["products"]:
            expected = numpy.stack([layers[name] for name in LAYERS[part["name"]]], axis=2)
            if part["type"] == "half":
                with numpy.errstate(over="ignore"):
                    expected = expected.astype(numpy.float16)
            numpy.testing.assert_array_equal(frame.values(part["name"]), expected, part["name"])

    def test_the_whole_ring(self):
        with self.server.client() as client:
            frame = client.frame(products=ALL)
            self.assertEqual(frame.info["generations"], 4)
            self.check(frame)
            self.check(client.frame(products=ALL, encoding="float"))

    def test_while_the_ring_fills(self):
        with self.server.client() as client:
            client.load_scene("small.toml", private=True, set=["photon_map.generations=7"])
            for photons in (1, 15000, 23000):
                frame = client.frame(products=ALL, budget={"photons": photons})
                self.assertGreaterEqual(frame.info["photons"], photons)
                self.check(frame)

    def test_after_the_sun_moved(self):
        with self.server.client() as client:
            client.load_scene("small.toml", private=True)
            client.frame()
            sun = {"azimuth": -100, "elevation": 10}
            frame = client.frame(products=ALL, sun=sun)
            self.assertEqual(frame.info["current_generations"], 4)
            self.assertEqual(frame.info["first_generation"], 4)
            self.check(frame)

    def test_in_a_stream(self):
        with self.server.client() as client:
            client.load_scene("small.toml", private=True)
            stream = client.start_stream(max_rate=1000)
            for _ in range(6):
                self.check(client.next_frame(stream))

    def test_other_cameras_and_sizes(self):
        with self.server.client() as client:
            frame = client.frame(camera={"position": [300, 50, 20], "target": [0, 100, 0], "vertical_fov": 60},
                                 width=40, height=31)
            self.check(frame, ["camera.position=[300,50,20]", "camera.target=[0,100,0]", "camera.vertical_fov=60",
                               "image.width=40", "image.height=31"])

    def test_an_exr_is_the_layers(self):
        with self.server.client() as client:
            frame = client.frame(products=ALL, encoding="exr")
            with tempfile.NamedTemporaryFile(suffix=".exr") as file:
                file.write(frame.file())
                file.flush()
                width, height, layers = read_exr(file.name)[:3]
            expected = run_render(os.path.join(self.server.folder, "scenes", "small.toml"), frame.info["repeat"])
            self.assertEqual(set(layers), set(expected))
            for name, values in layers.items():
                numpy.testing.assert_array_equal(numpy.array(values, "f").reshape(height, width), expected[name])


class Behaviour(ServiceTest):
    def test_views_share_one_moment(self):
        with self.server.client() as client:
            whole = client.frame(width=64, height=48)
            tiles = client.frame(views=[{"width": 64, "height": 48, "tile": tile}
                                        for tile in ([0, 0, 33, 48], [33, 0, 31, 48])])
            joined = numpy.concatenate([tiles.values(view=0), tiles.values(view=1)], axis=1)
            numpy.testing.assert_array_equal(joined, whole.values())

    def test_a_cut_shows_nothing_of_before(self):
        far = {"position": [0, 100, 5000], "target": [0, 100, 6000]}
        with self.server.client() as client:
            for _ in range(2):
                self.assertGreater(client.frame(products=["cloud"]).values("cloud")[..., 3].max(), 0.1)
                self.assertEqual(client.frame(products=["cloud"], camera=far).values("cloud")[..., 3].max(), 0.0)

    def test_alpha_goes_with_its_colours(self):
        asked = {"products": ["color", "cloud"], "encoding": "float"}
        with self.server.client() as client:
            name = client.welcome["scene"]
            client.load_scene(name, private=True)
            frame = client.frame(**asked)
            cloud = frame.values("cloud")
            self.assertEqual(set(frame.values("color")[..., 3].ravel()), {1.0})
            self.assertEqual((cloud.shape[2], cloud[0, 0].tolist()), (4, [0.0] * 4))
            client.load_scene(name, private=True, set=["image.background=false"])
            frame = client.frame(**asked)
            numpy.testing.assert_array_equal(frame.values("color"), frame.values("cloud"))
            self.assertGreater(frame.values("color")[..., 3].max(), 0.1)
            picture = Image.open(io.BytesIO(client.frame(encoding="png").file()))
            self.assertEqual((picture.mode, picture.getpixel((0, 0))), ("RGBA", (0, 0, 0, 0)))
            self.assertEqual(Image.open(io.BytesIO(client.frame(encoding="jpeg").file())).mode, "RGB")

    def test_the_latest_wins(self):
        with self.server.client() as client:
            requests = [client.send("frame", {"width": 256, "height": 192, "time": number}) for number in range(30)]
            outcomes = []
            for request in requests:
                try:
                    outcomes.append(client.wait(request)[0]["time"])
                except ServiceError as error:
                    self.assertEqual(error.code, "superseded")
            self.assertEqual(outcomes[-1], 29)
            self.assertLess(len(outcomes), 30)

    def test_a_queue_keeps_all_and_refuses_too_many(self):
        with self.server.client() as client:
            requests = [client.send("frame", {"queue": True, "width": 256, "height": 192}) for _ in range(30)]
            codes = []
            for request in requests:
                try:
                    client.wait(request)
                    codes.append("frame")
                except ServiceError as error:
                    codes.append(error.code)
            self.assertGreaterEqual(codes.count("frame"), 8)
            self.assertEqual(set(codes), {"frame", "busy"})

    def test_channels_do_not_replace_each_other(self):
        with self.server.client() as client:
            requests = [client.send("frame", {"channel": channel}) for channel in range(6)]
            self.assertEqual([client.wait(request)[0]["channel"] for request in requests], list(range(6)))

    def test_deadlines_are_kept_by_doing_less(self):
        with self.server.client() as client:
            client.frame(width=1024, height=768)  # teaches the service what pixels cost
            relaxed = client.frame(width=1024, height=768, budget={"milliseconds": 60000}).info
            self.assertEqual((relaxed["reduction"], relaxed["budget_met"]), (1, True))
            hasty = client.frame(width=1024, height=768, budget={"milliseconds": 0.4 * relaxed["milliseconds"]["draw"]})
            self.assertGreater(hasty.info["reduction"], 1)
            self.assertEqual(hasty.values().shape, (768, 1024, 4))
            none = client.frame(width=256, height=256, budget={"milliseconds": 0}).info
            self.assertEqual((none["reduction"], none["budget_met"]), (8, False))

    def test_an_id_under_way_is_not_taken_again(self):
        with self.server.client() as client:
            request = client.send("frame", {"width": 512, "height": 384})
            client.send("ping", request=request)  # answered at once, with the same id: pings are never under way
            self.assertEqual(client.receive()[0], 0x8000 + 10)
            client.send("frame", {"width": 8, "height": 8, "channel": 1}, request=request)
            kind, _, info, _ = client.receive()
            self.assertEqual((kind, info["code"]), (0x8000, "bad_request"))
            self.assertEqual(client.wait(request)[0]["views"][0]["width"], 512)
            self.assertEqual(client.wait(client.send("frame", {"width": 8, "height": 8}, request=request))[0]["channel"], 0)

    def test_cancel(self):
        with self.server.client() as client:
            client.load_scene("small.toml", private=True, set=["photon_map.generations=40",
                                                               "photon_map.photons=8000000"])
            request = client.send("frame")
            time.sleep(0.2)
            client.cancel(request)
            with self.assertRaises(ServiceError) as caught:
                client.wait(request)
            self.assertEqual(caught.exception.code, "cancelled")

    def test_light_ages_in_without_freezing(self):
        with self.server.client() as client:
            client.load_scene("small.toml", private=True)
            client.frame()
            client.change(sun={"azimuth": 10, "elevation": 80}, extinction=0.04, wind=[5, 0, 0])
            frame = client.frame(budget={"photons": 0})
            self.assertLess(frame.info["current_generations"], 4)
            self.assertEqual(frame.info["generations"], 4)
            moved = client.frame(time=20)
            self.assertEqual(moved.info["current_generations"], 4)
            self.assertNotEqual(moved.info["hash"], client.frame(time=0).info["hash"])

    def test_a_change_may_name_the_cloud(self):
        with self.server.client() as client:
            client.load_scene("small.toml", private=True)
            before = client.frame().info["hash"]
            client.change(cloud=0, extinction=0.04)
            self.assertNotEqual(client.frame().info["hash"], before)
            client.change(extinction=0.03)
            for cloud in (1, "nobody"):
                with self.assertRaises(ServiceError) as caught:
                    client.change(cloud=cloud, extinction=0.05)
                self.assertEqual((caught.exception.code, caught.exception.where), ("not_found", "cloud"))
            self.assertEqual(client.frame().info["repeat"][-1].split("=")[0], "photon_map.photons")

    def test_a_scene_loaded_again_tells_the_light_of_now(self):
        with self.server.client() as client:
            loaded = client.load_scene("small.toml", private=True)
            self.assertAlmostEqual(loaded["extinction"], 0.03)
            client.change(sun={"azimuth": 90, "elevation": 0, "irradiance": [1, 2, 3]}, extinction=0.04)
            again = client.load_scene("small.toml", private=True)  # before or after the change is made
            self.assertAlmostEqual(again["extinction"], 0.04)
            self.assertEqual(again["sun"]["irradiance"], [1, 2, 3])
            for told, wanted in zip(again["sun"]["direction_to"], (1, 0, 0)):
                self.assertAlmostEqual(told, wanted)
            client.frame(sun={"azimuth": 180, "elevation": 0}, extinction=0.05)
            again = client.load_scene("small.toml", private=True)
            self.assertAlmostEqual(again["extinction"], 0.05)
            self.assertAlmostEqual(again["sun"]["direction_to"][2], 1)
            state = client.statistics()["scene"]
            self.assertAlmostEqual(state["extinction"], 0.05)
            self.assertAlmostEqual(state["sun"]["direction_to"][2], 1)

    def test_pass_names_are_documented(self):
        with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "protocol.md")) as file:
            documented = set(re.findall(r"`([a-z ]+)`", file.read()))
        with self.server.client() as client:
            passes = set(client.frame(width=32, height=24).info["milliseconds"]["passes"])
        self.assertTrue(passes)
        self.assertEqual(passes - documented, set())

    def test_scenes_of_others_are_left_alone(self):
        with self.server.client() as one, self.server.client() as other:
            before = one.frame().info["hash"]
            other.load_scene(toml=SCENE.replace("0.03", "0.001"))
            self.assertNotEqual(other.frame().info["hash"], before)
            self.assertEqual(one.frame().info["hash"], before)

    def test_refines_and_then_idles(self):
        with self.server.client() as client:
            client.load_scene("small.toml", private=True)
            deadline = time.monotonic() + 30
            while client.statistics()["scene"]["current_generations"] < 4:
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.1)
            stream = client.start_stream(when="change")
            while not client.next_frame(stream).info["bias"]:  # which paths measure where a picture rests
                self.assertLess(time.monotonic(), deadline)
            time.sleep(0.5)
            before = self.server.cpu_seconds()
            time.sleep(3)
            self.assertLess(self.server.cpu_seconds() - before, 0.1)
            client.start_stream(stream, when="change", width=32, height=32)
            self.assertEqual(client.next_frame(stream).info["views"][0]["width"], 32)

    def test_composite_is_seen_through_the_fog(self):
        color, depth = numpy.ones((30, 40, 3), "f"), numpy.full((30, 40), 100.0, "f")
        fog = 'cloud = []\n[[fog.media]]\nkind = "homogeneous"\nabsorption = 0.01\nscattering = 0.0\n'
        with self.server.client() as client:
            client.load_scene(toml=fog)
            frame = client.composite(color.tobytes(), depth.tobytes(), 40, 30, encoding="float")
            self.assertTrue(frame.verify())
            numpy.testing.assert_allclose(frame.values()[..., :3], numpy.exp(-1.0), rtol=0.01)

    def test_unix_socket_with_its_permissions(self):
        server = Server(LUMULUS, listen='unix = "frames.sock"\nunix_mode = "0600"')
        try:
            path = os.path.join(server.folder, "frames.sock")
            self.assertEqual(os.stat(path).st_mode & 0o777, 0o600)
            server.tcp = "unix:" + path
            with server.client() as client:
                self.assertTrue(client.frame().verify())
        finally:
            self.assertEqual(server.stop(), 0)
        self.assertFalse(os.path.exists(path))

    def test_fetch(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, magic in (("a.exr", b"\x76\x2f\x31\x01"), ("a.png", b"\x89PNG"), ("a.jpg", b"\xff\xd8")):
                path = os.path.join(folder, name)
                subprocess.run([LUMULUS, "fetch", "--address", self.server.tcp, "-o", path,
                                "--width", "50", "--height", "40", "--sun", "20", "30"], check=True)
                with open(path, "rb") as file:
                    self.assertTrue(file.read(8).startswith(magic))
            with socket.socket() as taken:
                taken.bind(("127.0.0.1", 0))
                result = subprocess.run([LUMULUS, "fetch", "-o", path, "--address",
                                         f"127.0.0.1:{taken.getsockname()[1]}"], capture_output=True, text=True)
            self.assertEqual(result.returncode, 1)
            self.assertEqual(result.stderr.count("\n"), 1)

    def test_fetch_names_the_file_of_the_user(self):
        with tempfile.TemporaryDirectory() as folder:
            scene, vdb = os.path.join(folder, "mine.toml"), os.path.join(folder, "mine.vdb")
            for path, text in ((scene, "[image]\nwidht = 3\n"), (vdb, "no volume")):
                with open(path, "w") as file:
                    file.write(text)

            def refused(*words):
                result = subprocess.run([LUMULUS, "fetch", "--address", self.server.tcp, "-o",
                                         os.path.join(folder, "a.png"), *words], capture_output=True, text=True)
                self.assertEqual((result.returncode, result.stderr.count("\n")), (2, 1), result.stderr)
                self.assertNotIn("inline", result.stderr)
                return result.stderr

            self.assertIn(f'unknown key "widht" ({scene}:2, image.widht): did you mean "width"?',
                          refused("--scene", scene))
            self.assertIn("(missing.toml)", refused("--scene", "missing.toml"))
            self.assertIn("missing.vdb", refused("--vdb", os.path.join(folder, "missing.vdb")))
            self.assertIn("given twice", refused("--stats", os.path.join(folder, "./a.png")))
            self.assertEqual(sorted(os.listdir(folder)), ["mine.toml", "mine.vdb"])


class Ending(unittest.TestCase):
    def test_finishes_what_it_promised(self):
        server = Server(LUMULUS)
        with server.client() as client:
            stream = client.start_stream(max_rate=5)
            client.next_frame(stream)
            request = client.send("frame", {"width": 512, "height": 384})
            time.sleep(0.1)
            started = time.monotonic()
            server.process.terminate()
            self.assertTrue(client.wait(request)[1])
            with self.assertRaises(ServiceError) as caught:
                while True:
                    client.next_frame(stream)
            self.assertEqual(caught.exception.code, "shutting_down")
        self.assertEqual(server.stop(), 0)
        self.assertLess(time.monotonic() - started, 15)

    def check_shut_down(self, server, client, request):
        """SIGTERM: the request fails as it should, and the server ends soon although it is in the middle of it."""
        server.process.terminate()
        with self.assertRaises(ServiceError) as caught:
            client.wait(request)
        self.assertEqual(caught.exception.code, "shutting_down")
        self.assertEqual(server.stop(10), 0)
        self.assertEqual([event for event in server.log if event.get("level") == "error"], [])

    def test_while_the_default_scene_loads(self):
        server = Server(LUMULUS, scene=LARGE_SCENE, wait=False)
        server.event("scene_loading")
        self.assertEqual(server.stop(10), 0)
        self.assertEqual(server.log[-1]["event"], "stopped")

    def test_gives_up_a_scene(self):
        server = Server(LUMULUS)
        with server.client() as client:
            request = client.send("load_scene", payload=LARGE_SCENE.encode())
            server.event("scene_loading")
            self.check_shut_down(server, client, request)

    def test_fails_what_takes_too_long(self):
        # many short steps and little memory, so that a busy machine can end it too
        server = Server(LUMULUS, scene=SCENE + "[draw]\ntolerance = 0\n", limits="shutdown_seconds = 0.2")
        with server.client() as client:
            client.frame(width=16, height=16)
            view = {"width": 640, "height": 400, "camera": {"position": [0, 100, 150], "target": [0, 100, 0]}}
            request = client.send("frame", {"views": [view] * 16})
            time.sleep(0.5)
            self.check_shut_down(server, client, request)

    def test_fails_a_picture_in_fog(self):
        fog = 'cloud = []\n[fog]\nfilter = "gather"\n[[fog.media]]\nkind = "homogeneous"\nvisibility = 300\n'
        server = Server(LUMULUS, limits="shutdown_seconds = 0.2")
        with server.client() as client:
            client.load_scene(toml=fog)
            width, height = 400, 300
            picture = numpy.ones(width * height * 3, "f").tobytes() + numpy.full(width * height, 500, "f").tobytes()
            request = client.send("composite", {"width": width, "height": height}, picture)
            time.sleep(0.5)
            self.check_shut_down(server, client, request)


if __name__ == "__main__":
    unittest.main()
