"""The page in headless Chromium: it loads, a frame appears, dragging changes it, the server's death is survived."""

import os
import tempfile
import time
import unittest

from selenium import webdriver
from selenium.webdriver import ActionChains
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By

from server import LUMULUS, Server


def browser(profile, width, height):
    options = webdriver.ChromeOptions()
    # --no-sandbox: tests run as root in containers too
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     f"--user-data-dir={profile}", f"--window-size={width},{height}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


class Page(unittest.TestCase):
    def setUp(self):
        self.server = Server(LUMULUS)
        self.profile = tempfile.TemporaryDirectory()
        self.driver = browser(self.profile.name, 900, 600)
        self.addCleanup(self.profile.cleanup)
        self.addCleanup(lambda: self.assertEqual(self.server.stop(), 0))
        self.addCleanup(self.driver.quit)
        self.driver.get(f"http://{self.server.http}/")

    def wait(self, condition, seconds=60):
        deadline = time.monotonic() + seconds
        while not condition():
            self.assertLess(time.monotonic(), deadline, self.driver.get_log("browser"))
            time.sleep(0.1)

    def frames(self):
        return int(self.driver.execute_script("return document.body.dataset.frames ?? 0"))

    def picture(self):
        return self.driver.execute_script("return document.getElementById('picture').toDataURL()")

    def settled(self):
        """The picture once no more come."""
        before = -1
        while before != self.frames():
            before = self.frames()
            time.sleep(1.5)
        return self.picture()

    def slide(self, name, value):
        self.driver.execute_script("""const slider = document.getElementById(arguments[0]);
            slider.value = arguments[1];
            slider.dispatchEvent(new Event("input"));
            slider.dispatchEvent(new Event("change"));""", name, value)

    def test_the_cloud_is_there_and_follows(self):
        self.wait(lambda: self.frames() > 0)
        first = self.settled()
        self.assertEqual(self.driver.find_element(By.ID, "message").text, "")
        figures = self.driver.find_element(By.ID, "figures").text
        self.assertRegex(figures, r"M photons, noise \d+\.\d %, \d+ ms")
        bright = self.driver.execute_script("""const c = document.getElementById("picture");
            const d = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
            const at = (x, y) => d[4 * (Math.floor(y * c.height) * c.width + Math.floor(x * c.width))];
            return [at(0.5, 0.5), at(0.02, 0.02)];""")
        self.assertGreater(bright[0], bright[1] + 10, "the cloud is brighter than the sky beside it")

        canvas = self.driver.find_element(By.ID, "picture")
        ActionChains(self.driver).move_to_element_with_offset(canvas, -200, 0).click_and_hold().move_by_offset(
            150, 40).release().perform()
        self.wait(lambda: self.settled() != first)
        for name, value in (("elevation", 80), ("exposure", 1.5), ("extinction", -2.5), ("g", 0.3)):
            before = self.settled()
            self.slide(name, value)
            self.wait(lambda: self.settled() != before)
        errors = [entry for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"
                  and "favicon" not in entry["message"]]
        self.assertEqual(errors, [])

    def test_the_servers_death_and_return(self):
        self.wait(lambda: self.frames() > 0)
        ports = tuple(int(address.rsplit(":", 1)[1]) for address in (self.server.tcp, self.server.http))
        self.server.owns = False
        self.server.kill()
        self.wait(lambda: self.driver.find_element(By.ID, "status").text == "reconnecting")
        before = self.frames()
        self.server = Server(LUMULUS, folder=self.server.folder, ports=ports)
        self.server.owns = True
        self.wait(lambda: self.frames() > before)
        self.assertFalse(self.driver.find_element(By.ID, "status").is_displayed())


class Phone(unittest.TestCase):
    def test_fits_a_small_screen(self):
        server = Server(LUMULUS)
        self.addCleanup(lambda: self.assertEqual(server.stop(), 0))
        with tempfile.TemporaryDirectory() as profile:
            driver = browser(profile, 390, 844)
            self.addCleanup(driver.quit)
            driver.get(f"http://{server.http}/")
            deadline = time.monotonic() + 60
            while driver.execute_script("return document.body.dataset.frames ?? 0") == 0:
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.1)
            width, inner = driver.execute_script("return [document.documentElement.scrollWidth, innerWidth]")
            self.assertLessEqual(width, inner)
            self.assertFalse(driver.execute_script("return document.getElementById('panel').open"))


if __name__ == "__main__":
    unittest.main()
