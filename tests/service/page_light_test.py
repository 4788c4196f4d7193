"""The page in headless Chromium: whose light its viewer changes, on servers that share light and on those that do not."""

import math
import time
import unittest

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

from browser import Browser
from page_test import PageTest
from server import LUMULUS, SCENE, Server

NIGHTFALL = {"sun": {"azimuth": 10, "elevation": 3}}


# balls of fog take less time to draw than layers, which have light of sun and sky
FOGGY = SCENE + """
[[fog.media]]
kind = "sphere"
radius = 400
visibility = 8000
[[fog.media]]
kind = "sphere"
radius = 300
visibility = 8000
"""


def picture(client):
    return client.frame(width=32, height=24).info["hash"]


def waiting(browser):
    """Whether a notice says that there is no room for the viewer's light."""
    return "are in use" in browser.notices().get("light", "")


class OwnLight(PageTest):
    options = {"limits": "own_lights = 1"}

    def setUp(self):
        self.browser.open(self.server)

    def sun(self):
        return [round(self.browser.value(name)) for name in ("elevation", "azimuth")]

    def test_others_do_not_see_the_viewers_light(self):
        browser = self.browser
        self.assertFalse(browser.element("own").is_displayed())
        browser.wait(lambda: browser.figures()["light"] == "the scene’s")
        with self.server.client() as client:
            before = picture(client)
            browser.wait(lambda: browser.figures()["light"] == "the scene’s, one other here")
            shown = browser.picture()
            browser.click("[data-sun=dusk]")
            browser.wait(lambda: browser.figures()["light"] == "own")
            browser.wait(lambda: browser.picture() != shown)
            dusk = self.sun()
            self.assertEqual(dusk[0], 4)
            self.assertEqual(picture(client), before)
            # pages that are left give their light back, or there would be no room for that of the next
            for _ in range(3):
                browser.open(self.server, browser.run("return location.hash"))
                browser.wait(lambda: browser.figures()["light"] == "own")
                self.assertEqual((browser.notices(), self.sun()), ({}, dusk))
            browser.click("#reset")
            browser.wait(lambda: browser.figures()["light"] == "the scene’s, one other here")
            browser.wait(lambda: self.sun() == [35, 70] and "sun" not in browser.link())
            client.change(**NIGHTFALL)  # there is room for it again
            self.assertNotEqual(picture(client), before)
        self.assertEqual(browser.errors(), [])

    def test_a_light_without_room_waits(self):
        browser = self.browser
        with self.server.client() as client:
            client.change(**NIGHTFALL)
            picture(client)
            browser.click("[data-sun=dusk]")
            browser.wait(lambda: waiting(browser))
            browser.wait(lambda: self.sun() == [35, 70])  # the sliders show the light that the picture has
        browser.wait(lambda: browser.notices() == {} and self.sun()[0] == 4)
        browser.wait(lambda: browser.figures()["light"] == "own")

    def test_links_of_servers_that_share_light(self):
        browser = self.browser
        browser.open(self.server, "#own=1")
        browser.wait(lambda: list(browser.link()) == ["camera"])
        browser.wait(lambda: browser.figures()["light"] == "the scene’s")


class Fog(PageTest):
    """The slider of the visibility, in a scene whose fog it changes in place and in one that has none."""

    size = {"width": 400, "height": 480}

    def open(self, fragment=""):
        self.browser.open(self.server, fragment)
        if not self.browser.element("panel").is_displayed():  # the window is small
            self.browser.click("#fold")

    def setUp(self):
        self.server.write("scenes/foggy.toml", FOGGY)
        self.open("#scene=foggy.toml")

    def shown(self):
        return self.browser.run("return document.getElementById('fog').parentElement.querySelector('output').textContent")

    def test_fog_changes_in_place(self):
        browser = self.browser
        self.assertAlmostEqual(browser.value("fog"), math.log10(4000), delta=0.002)  # both media together
        self.assertEqual(self.shown(), "4.0 km")
        browser.wait(lambda: browser.figures()["light"] == "the scene’s")
        before = browser.picture()
        browser.run("window.loaded = 0; new MutationObserver(() => { if (!document.getElementById('loading').hidden) ++window.loaded; })"
                    ".observe(document.getElementById('loading'), {attributes: true})")
        browser.set("fog", 2.5)
        browser.wait(lambda: browser.figures()["light"] == "own")
        browser.wait(lambda: browser.picture() != before)
        self.assertEqual(self.shown(), "316 m")
        browser.run("document.getElementById('fog').focus()")
        ActionChains(browser.driver).send_keys(Keys.ARROW_LEFT * 10).perform()
        browser.wait(lambda: browser.link().get("fog") == "309")
        self.assertEqual(browser.run("return window.loaded"), 0, "no scene was loaded")
        # the link brings it back
        fragment = browser.run("return location.hash")
        self.open(fragment)
        browser.wait(lambda: browser.figures()["light"] == "own")
        self.assertAlmostEqual(browser.value("fog"), math.log10(309), delta=0.002)
        self.assertEqual((browser.link()["fog"], browser.notices()), ("309", {}))
        # which stays the same when the sliders follow the light of the picture
        browser.run("document.activeElement.blur()")
        time.sleep(4)  # followTime of the page
        self.assertAlmostEqual(browser.value("fog"), math.log10(309), delta=0.002)
        browser.click("#reset")
        browser.wait(lambda: browser.figures()["light"] == "the scene’s" and "fog" not in browser.link())
        browser.wait(lambda: self.shown() == "4.0 km")
        self.assertEqual(browser.errors(), [])

    def test_a_slider_that_is_dragged_shows_its_end(self):
        browser = self.browser
        for visibility in (4.6, 4.0, 3.0, 2.0, 1.7, 2.4):
            browser.run("""const control = document.getElementById("fog");
                control.value = arguments[0];
                control.dispatchEvent(new Event("input"));""", visibility)
            frames = browser.frames()
            browser.wait(lambda: browser.frames() > frames)
        with self.server.client() as client:
            state = client.load_scene("foggy.toml")["media"]
            self.assertAlmostEqual(state[0]["visibility"], 8000, delta=1e-6)
        browser.wait(lambda: browser.link().get("fog") == "251.2" and browser.notices() == {})
        # what is drawn, by what the sliders follow
        browser.wait(lambda: round(browser.run("return performance.now()")) > 0 and abs(browser.value("fog") - 2.4) < 0.002)

    def test_fog_comes_into_a_scene_without(self):
        browser = self.browser
        self.open()
        self.assertEqual((self.shown(), round(browser.value("fog"), 2)), ("clear", 5))
        browser.set("fog", 3)
        browser.wait(lambda: browser.link().get("fog") == "1000" and self.shown() == "1.0 km")
        browser.wait(lambda: browser.figures()["light"].startswith("the scene’s"))  # it is loaded with that
        before = browser.picture()
        browser.set("fog", 2)  # in place: the scene with that fog is this viewer's
        browser.wait(lambda: browser.link().get("fog") == "100" and browser.picture() != before)
        self.open(browser.run("return location.hash"))
        browser.wait(lambda: browser.link().get("fog") == "100" and self.shown() == "100 m")
        browser.click("#reset")
        browser.wait(lambda: self.shown() == "clear" and "fog" not in browser.link())
        self.assertEqual((browser.notices(), browser.errors()), ({}, []))


class HeavyLight(unittest.TestCase):
    def test_light_that_takes_too_long_is_given_up(self):
        server = Server(LUMULUS, limits="generation_seconds = 3")
        self.addCleanup(server.stop)
        browser = Browser()
        self.addCleanup(browser.close)
        browser.open(server)
        browser.run("location.hash = 'extinction=1000000&exposure=1'")
        browser.wait(lambda: browser.notices().get("light", "").startswith("The light of before is back: "))
        browser.wait(lambda: browser.link().get("exposure") == "1" and "extinction" not in browser.link())
        browser.wait(lambda: abs(browser.value("extinction") + 1.52) < 0.01)
        before = browser.frames()
        browser.click("[data-sun=noon]")  # the page goes on
        browser.wait(lambda: browser.frames() > before and browser.notices() == {})


class SharedLight(PageTest):
    options = {"security": "shared_light = true"}

    def setUp(self):
        self.browser.open(self.server)

    def test_others_share_the_light(self):
        browser = self.browser
        with self.server.client() as client:
            client.load_scene("small.toml")
            browser.wait(lambda: browser.figures()["light"] == "shared with one other")
            client.change(sun={"azimuth": -100, "elevation": 50})
            # sliders that nobody has touched for a while follow
            browser.wait(lambda: [round(browser.value(name)) for name in ("elevation", "azimuth")] == [50, -100])
        browser.wait(lambda: browser.figures()["light"] == "shared, nobody else here")
        browser.click("#own")
        browser.wait(lambda: browser.figures()["light"] == "own" and browser.link().get("own") == "1")
        browser.open(self.server, browser.run("return location.hash"))
        self.assertTrue(browser.element("own").is_selected())
        self.assertEqual(browser.figures()["light"], "own")

    def test_sliders_mean_the_chosen_cloud(self):
        browser = self.browser
        self.assertFalse(browser.element("which").is_displayed())
        browser.open(self.server, "#scene=two.toml")
        self.assertEqual(browser.run("return [...document.getElementById('cloud').options].map((o) => o.text)"),
                         ["all clouds", "west", "east"])
        with self.server.client() as client:
            client.load_scene("two.toml")

            def changed():
                repeat = client.frame(width=16, height=16, budget={"photons": 0}).info["repeat"]
                return {line for line in repeat if line.startswith("cloud.")}

            browser.set("cloud", "1")
            self.assertFalse(browser.element("g").is_enabled())  # a Rayleigh phase function has none
            self.assertAlmostEqual(browser.value("extinction"), -2.0, delta=0.02)
            browser.set("extinction", -3)
            browser.wait(lambda: changed() == {"cloud.1.extinction=0.001"})
            browser.set("cloud", "all")
            self.assertTrue(browser.element("g").is_enabled())
            browser.set("extinction", -1)
            browser.wait(lambda: changed() == {"cloud.0.extinction=0.1", "cloud.1.extinction=0.1"})
            browser.set("cloud", "0")
            browser.set("g", 0.2)
            browser.wait(lambda: browser.link().get("g.0") == "0.2")
            browser.click("#reset")
            browser.wait(lambda: "g.0" not in browser.link())
            browser.wait(lambda: changed() == set())


if __name__ == "__main__":
    unittest.main()
