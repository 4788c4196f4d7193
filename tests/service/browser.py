"""Headless Chromium at the page of a server, for tests."""

import tempfile
import time
import urllib.parse

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By


class Browser:
    """A window at the page of `server`; what it downloads lies in the folder `downloads`."""

    def __init__(self, width=900, height=600, touch=False):
        self.profile = tempfile.TemporaryDirectory()
        self.downloads = tempfile.TemporaryDirectory()
        options = webdriver.ChromeOptions()
        # --no-sandbox: tests run as root in containers too
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                         f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}"):
            options.add_argument(argument)
        options.add_experimental_option("prefs", {
            "download.default_directory": self.downloads.name,
            "profile.default_content_setting_values.automatic_downloads": 1})
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        # the window of a headless browser has a frame, and is never narrower than 500 pixels
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": touch})
        if touch:
            self.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})

    def close(self):
        self.driver.quit()
        self.profile.cleanup()
        self.downloads.cleanup()

    def open(self, server, fragment="", wait=True):
        """The page anew, until it shows a picture."""
        self.driver.get("about:blank")
        self.driver.get(f"http://{server.http}/{fragment}")
        if wait:
            self.wait(lambda: self.frames() > 0)

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, condition, seconds=60):
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline:
                raise AssertionError(f"not in {seconds} s: {self.notices()} {self.driver.get_log('browser')}")
            time.sleep(0.05)

    def element(self, name):
        return self.driver.find_element(By.ID, name)

    def text(self, name):
        return self.element(name).text

    def value(self, name):
        return float(self.run("return document.getElementById(arguments[0]).value", name))

    def click(self, selector):
        self.driver.find_element(By.CSS_SELECTOR, selector).click()

    def frames(self):
        return int(self.run("return document.body.dataset.frames ?? 0"))

    def notices(self):
        """Topic and text of what stands over the picture."""
        return dict(self.run("""return [...document.querySelectorAll("#notices li")].map(
            (item) => [item.dataset.topic, item.querySelector("span").textContent])"""))

    def figures(self):
        return dict(self.run("""return [...document.querySelectorAll("#figures div")].map(
            (pair) => [pair.children[0].textContent, pair.children[1].textContent])"""))

    def link(self):
        """Fields of the address behind #."""
        return dict(urllib.parse.parse_qsl(self.run("return location.hash")[1:], keep_blank_values=True))

    def picture(self):
        return self.run("return document.getElementById('picture').toDataURL()")

    def set(self, name, value):
        """Moves a slider, or chooses from a list, and lets go."""
        self.run("""const control = document.getElementById(arguments[0]);
            control.value = arguments[1];
            control.dispatchEvent(new Event("input"));
            control.dispatchEvent(new Event("change"));""", name, value)

    def errors(self):
        return [entry for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]
