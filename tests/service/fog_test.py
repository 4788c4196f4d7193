"""Changes of fog while a scene is served: fog_test.py [unittest arguments]."""

import os
import time
import unittest

import numpy

from server import LUMULUS, Server, ServiceTest
from lumulus_client import ERROR, ServiceError

REST = """
[image]
width = 64
height = 36
[sun]
azimuth = 70
elevation = 35
[camera]
position = [0, 60, 1500]
target = [0, 200, 0]
[[cloud]]
procedural = "sphere"
resolution = 20
extinction = 0.03
transform = [[1, 0, 0, 0], [0, 1, 0, 250], [0, 0, 1, 0]]
[preparation]
samples = 300
max_leaves = 300
[photon_map]
photons = 20000
generations = 4
bands = 3
"""
MEDIA = """
[[fog.media]]
kind = "exponential"
visibility = 8000
falloff = 0.002
g = 0.8
[[fog.media]]
visibility = 2000
top = 50
aerosol = "urban"
"""
CONSTANT = """
[sky]
model = "constant"
radiance = 2.0
[ground]
height = 0
""" + MEDIA + REST
AIR = """
[sky]
model = "atmosphere"
aerosol_depth = 0
""" + MEDIA + REST
GENERATIONS = 4


class FogTest(ServiceTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.server.write("scenes/constant.toml", CONSTANT)
        cls.server.write("scenes/air.toml", AIR)

    def client(self, scene="constant.toml"):
        client = self.server.client()
        self.addCleanup(client.close)
        self.loaded = client.load_scene(scene)
        return client

    def picture(self, client, **wishes):
        frame = client.frame(encoding="float", **wishes)
        return frame.values("color")[..., :3], frame.info

    def assertShines(self, client, what):
        values, _ = self.picture(client, budget={"photons": 0})
        self.assertTrue(numpy.isfinite(values).all(), what)
        self.assertGreater(values.min(), 0.0, what)
        return values.mean()

    def loaded_anew(self, scene, info):
        """The picture of a scene that was loaded as a frame's `repeat` says."""
        with self.server.client() as anew:
            anew.load_scene(scene, private=True, set=info["repeat"])
            return self.picture(anew)[1]["hash"]

    def refused(self, client, code, where, text, **change):
        with self.assertRaises(ServiceError) as caught:
            client.change(**change)
        error = caught.exception
        self.assertEqual((error.code, error.where), (code, where), error)
        self.assertIn(text, str(error))


class Fog(FogTest):
    def test_in_the_end_it_is_the_scene_loaded_with_these_media(self):
        for scene in ("constant.toml", "air.toml"):
            with self.subTest(scene):
                client, bystander = self.client(scene), self.client(scene)
                before, others = self.picture(client)[1]["hash"], self.picture(bystander)[1]["hash"]
                client.change(media=[{"medium": 0, "visibility": 1500, "albedo": 0.9, "top": 900},
                                     {"medium": 1, "top": 120, "aerosol": "maritime"}])
                client.change(media=[{"medium": 0, "g": 0.7, "falloff": 0.004}])
                _, info = self.picture(client)  # waits for all generations
                self.assertEqual(info["current_generations"], GENERATIONS)
                self.assertNotEqual(info["hash"], before)
                self.assertEqual([line for line in info["repeat"] if line.startswith("fog.")],
                                 ["fog.media.0.albedo=0.9", "fog.media.0.falloff=0.004", "fog.media.0.g=0.7",
                                  "fog.media.0.top=900", "fog.media.0.visibility=1500",
                                  'fog.media.1.aerosol="maritime"', "fog.media.1.top=120"])
                self.assertEqual(self.loaded_anew(scene, info), info["hash"])
                self.assertEqual(self.picture(bystander)[1]["hash"], others, "others do not see it")
                client.close(), bystander.close()

    def test_what_the_scene_has_comes_back(self):
        client = self.client("air.toml")
        self.picture(client)
        original = self.loaded["original"]["media"]
        self.assertEqual([(one["kind"], one["g"]) for one in original], [("exponential", 0.8), ("homogeneous", 0.689)])
        self.assertAlmostEqual(original[0]["visibility"], 8000, delta=1e-6)
        self.assertAlmostEqual(original[1]["visibility"], 2000, delta=1e-6)
        self.assertEqual((original[1]["bottom"], original[1]["top"], original[0]["falloff"]), (0, 50, 0.002))
        self.assertEqual(self.loaded["media"], original)
        client.change(media=[{"medium": 1, "visibility": 60, "top": 400}])
        self.picture(client, budget={"photons": 0})  # whose state the statistics tell
        state = client.statistics()["scene"]
        self.assertTrue(state["own"])
        self.assertEqual((round(state["media"][1]["visibility"], 6), state["media"][1]["top"]), (60, 400))
        client.change(media=[{"medium": 1, "original": True}])
        _, info = self.picture(client)
        self.assertEqual([line for line in info["repeat"] if line.startswith("fog.")], [])
        self.assertEqual(self.loaded_anew("air.toml", info), info["hash"])
        again = client.load_scene("air.toml")
        self.assertEqual(again["media"], original)
        self.assertFalse(client.statistics()["scene"]["own"])

    def test_clouds_and_the_sun_change_in_other_fog(self):
        client = self.client("air.toml")
        client.change(media=[{"medium": 0, "visibility": 3000}])
        client.change(sun={"azimuth": 200, "elevation": 20})
        _, info = self.picture(client)
        self.assertEqual(self.loaded_anew("air.toml", info), info["hash"])
        client.change(clouds=[{"add": "other", "like": 0, "move": [300, 0, 0]}])
        client.change(media=[{"medium": 1, "visibility": 500}])
        _, info = self.picture(client)
        self.assertEqual([line for line in info["repeat"] if line.startswith("fog.")],
                         ["fog.media.0.visibility=3000", "fog.media.1.visibility=500"])
        self.assertEqual(client.load_scene("air.toml")["media"], self.loaded["original"]["media"])

    def test_the_sun_never_goes_out(self):
        """A slider from clear to thickest and back: light at every step, and the same again at the end."""
        for scene, steps in (("constant.toml", (50e3, 5e3, 500, 50, 5, 0.5, 50, 5e3, 50e3)), ("air.toml", (50e3, 300, 5, 50e3))):
            with self.subTest(scene):
                client = self.client(scene)
                first = None
                for visibility in steps:
                    client.change(media=[{"medium": 0, "visibility": visibility}])
                    mean = self.assertShines(client, f"{scene}, {visibility} m")
                    if first is None:
                        first = self.picture(client)
                    self.assertGreater(mean, 1e-3 * first[0].mean(), f"{scene}, {visibility} m")
                values, info = self.picture(client)
                self.assertEqual(self.loaded_anew(scene, info), info["hash"])
                # other photons: the noise of so few
                self.assertAlmostEqual(values.mean(), first[0].mean(), delta=0.01 * first[0].mean())
                client.close()

    def test_faults(self):
        client = self.client()
        client.load_scene("constant.toml", set=["ground.height=-50"])
        before = self.picture(client)[1]["hash"]
        zero = {"medium": 0}
        for where, text, edit in (
                ("media[0].visibility", "visibility must be above 0", {"visibility": -5}),
                ("media[0].visibility", "visibility must be a number", {"visibility": "far"}),
                ("media[0].visibility", "must be a number, three numbers or a name", {"visibility": True}),
                ("media[0].g", "g must be above -1, below 1, got 1", {"g": 1}),
                ("media[0].albedo", "albedo must lie in 0…1, got 1.5", {"albedo": [0.5, 0.5, 1.5]}),
                ("media[0].aerosol", "\"urban\"", {"aerosol": "smog"}),
                ("media[0].visiblity", "is not known here", {"visiblity": 5}),
                ("media[0].kind", "cannot change", {"kind": "box"}),
                ("media[0].center", "center", {"center": [0, 0, 0]}),
                ("media[0].bottom", "is not below its top", {"bottom": 50, "top": 40}),
                ("media[0].top", "fog in the light of a sun, a sky or a lamp needs a top", {"falloff": 0}),
                ("media[0]", "changes nothing", {})):
            with self.subTest(edit):
                self.refused(client, "bad_request", where, text, media=[{**zero, **edit}])
        self.refused(client, "bad_request", "media[0].scattering", "exclude each other",
                     media=[{**zero, "visibility": 5, "scattering": 0.1}])
        self.refused(client, "not_found", "media[1].medium", "there is no medium 2: the fog of the scene has 2",
                     media=[{**zero, "g": 0.1}, {"medium": 2, "g": 0.1}])
        self.refused(client, "bad_request", "media[0].medium", "is missing", media=[{"g": 0.1}])
        self.refused(client, "bad_request", "media[1].medium", "is in the list twice", media=[zero | {"g": 0.1}] * 2)
        self.refused(client, "bad_request", "media", "lists no change", media=[])
        self.refused(client, "bad_request", "media", "by themselves", media=[{**zero, "g": 0.1}], extinction=0.1)
        self.refused(client, "bad_request", "media", "no level fog would be left",
                     media=[{**zero, "top": -100, "bottom": -200}, {"medium": 1, "top": -100, "bottom": -200}])
        self.assertEqual(self.picture(client)[1]["hash"], before)
        self.assertFalse(client.statistics()["scene"]["own"])
        client.load_scene("small.toml")
        self.refused(client, "bad_request", "media", "the scene was made without fog", media=[{**zero, "g": 0.1}])

    def test_fog_by_the_filter_alone(self):
        """A ball of fog has no light of sun and sky, and cannot get it by another shape."""
        ball = CONSTANT.replace(MEDIA, '[[fog.media]]\nkind = "sphere"\ncenter = [0, 200, 0]\nradius = 500\nvisibility = 3000\n')
        self.server.write("scenes/ball.toml", ball)
        client = self.client("ball.toml")
        before = self.picture(client)[1]["hash"]
        client.change(media=[{"medium": 0, "radius": 800, "visibility": 900}])
        _, info = self.picture(client)
        self.assertNotEqual(info["hash"], before)
        self.assertEqual(self.loaded_anew("ball.toml", info), info["hash"])


class Slider(FogTest):
    def test_rapid_changes_do_not_queue_up(self):
        client = self.client("air.toml")
        self.picture(client)
        requests = [client.send("change", {"media": [{"medium": 0, "visibility": 1000 + 100 * i}]}) for i in range(60)]
        made = 0
        for request in requests[:-1]:
            try:
                client.wait(request)
                made += 1
            except ServiceError as error:
                self.assertEqual(error.code, "superseded")
        self.assertEqual(client.wait(requests[-1])[0], {})
        self.assertLess(made, 20)
        _, info = self.picture(client, budget={"photons": 0})
        self.assertIn("fog.media.0.visibility=6900", info["repeat"])
        # changes of other things than those that wait are not lost
        requests = [client.send("change", {"media": [one]}) for one in
                    ({"medium": 0, "visibility": 500}, {"medium": 1, "top": 60}, {"medium": 0, "g": 0.5}, {"medium": 1, "top": "high"})]
        for request in requests[:-1]:
            self.assertEqual(client.wait(request)[0], {})
        with self.assertRaises(ServiceError):
            client.wait(requests[-1])
        _, info = self.picture(client, budget={"photons": 0})
        self.assertEqual([line for line in info["repeat"] if line.startswith("fog.")],
                         ["fog.media.0.g=0.5", "fog.media.0.visibility=500", "fog.media.1.top=60"])

    def test_another_scene_ends_what_waits(self):
        client = self.client("air.toml")
        request = client.send("change", {"media": [{"medium": 0, "visibility": 70}]})
        reply = client.load_scene("constant.toml")
        self.assertEqual(reply["media"], reply["original"]["media"])
        try:  # it may have been made just before
            client.wait(request)
        except ServiceError as error:
            self.assertEqual(error.code, "superseded")
        _, info = self.picture(client)
        self.assertEqual([line for line in info["repeat"] if line.startswith("fog.")], [])

    def intervals(self, client, stream, seconds, before):
        """Between the frames of a stream; before() is called at each."""
        result, last, end = [], None, time.monotonic() + seconds
        while last is None or last < end:
            client.next_frame(stream)
            now = time.monotonic()
            before(now)
            if last is not None:
                result.append(now - last)
            last = now
        return numpy.array(result)

    def test_frames_go_on(self):
        """Intervals of streams while the visibility changes ten times a second, and without."""
        seconds = float(os.environ.get("FOG_SECONDS", "2"))
        for scene in os.environ.get("FOG_SCENES", "air.toml").split():
            for width, height in ((160, 90), (320, 180)):
                client = self.client(scene)
                client.change(media=[{"medium": 0, "visibility": 9000}])  # light of its own
                self.picture(client, width=width, height=height)
                stream = client.start_stream(width=width, height=height, max_rate=30, budget={"milliseconds": 33})
                alone = self.intervals(client, stream, seconds, lambda now: None)
                sent, began = [], time.monotonic()

                def slide(now):
                    if now - began >= 0.1 * len(sent):
                        metres = 10 ** (3.3 + 0.7 * numpy.sin(3.0 * (now - began)))
                        sent.append(client.send("change", {"media": [{"medium": 0, "visibility": metres}]}))

                sliding = self.intervals(client, stream, seconds, slide)
                client.stop_stream(stream)
                made = 0
                for request in sent:
                    try:
                        client.wait(request)
                        made += 1
                    except ServiceError as error:
                        self.assertEqual(error.code, "superseded")
                for name, list_ in (("without", alone), (f"{len(sent)} changes, {made} made", sliding)):
                    print(f"{scene} {width}x{height} {name}: {len(list_)} intervals, median {1e3 * numpy.median(list_):.0f} ms, "
                          f"99 % {1e3 * numpy.quantile(list_, 0.99):.0f} ms, longest {1e3 * max(list_):.0f} ms")
                shown = [event["shown_milliseconds"] for event in self.server.log if event["event"] == "fog_shown"]
                print(f"  the render thread took {numpy.median(shown):.0f} ms (median), {max(shown):.0f} ms at most to show it")
                self.assertGreater(made, 0)
                self.assertLess(numpy.median(sliding), max(2.0, 5 * numpy.median(alone)))  # also on a busy machine
                self.assertLess(max(sliding), max(6.0, 10 * max(alone)))
                client.close()


class Shared(unittest.TestCase):
    def test_all_see_shared_fog(self):
        server = Server(LUMULUS, scene=CONSTANT, security="shared_light = true")
        self.addCleanup(server.stop)
        with server.client() as one, server.client() as other:
            one.load_scene("small.toml")
            loaded = other.load_scene("small.toml")
            one.change(media=[{"medium": 0, "visibility": 700}])
            info = other.frame(budget={"photons": 0}).info
            self.assertIn("fog.media.0.visibility=700", info["repeat"])
            again = other.load_scene("small.toml")
            self.assertAlmostEqual(again["media"][0]["visibility"], 700, delta=1e-6)
            self.assertEqual(again["original"], loaded["original"])


if __name__ == "__main__":
    unittest.main()
