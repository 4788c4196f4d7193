"""The page in headless Chromium: files that it takes and gives, and the token that it asks for."""

import base64
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from browser import Browser
from flat_layers import read_exr
from page_test import PageTest
from server import LUMULUS, Server

DROP = """
const bytes = Uint8Array.from(atob(arguments[1]), (c) => c.charCodeAt(0));
const dataTransfer = new DataTransfer();
dataTransfer.items.add(new File([bytes], arguments[0]));
const drop = (name) => document.dispatchEvent(new DragEvent(name, {dataTransfer, bubbles: true, cancelable: true}));
drop("dragover");
const shown = !document.getElementById("drop").hidden;
drop("drop");
return shown && document.getElementById("drop").hidden;"""


class Files(PageTest):
    def setUp(self):
        self.browser.open(self.server)

    def drop(self, name, data):
        self.assertTrue(self.browser.run(DROP, name, base64.b64encode(data).decode()))

    def uploads(self):
        return os.listdir(os.path.join(self.server.folder, "uploads"))

    def test_a_dropped_cloud_is_shown(self):
        browser = self.browser
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ball.vdb")
            subprocess.run([LUMULUS, "cloud", "sphere", "--resolution", "16", "-o", path, "--quiet"], check=True)
            with open(path, "rb") as file:
                ball = file.read()
        self.drop("notes.txt", b"no cloud at all")
        browser.wait(lambda: browser.notices() == {"upload": "notes.txt is no OpenVDB file"})
        self.assertEqual(self.uploads(), [])
        self.drop("ball.vdb", ball)
        browser.wait(lambda: browser.link().get("file") == "ball.vdb")
        self.assertNotIn("upload", browser.notices())
        self.assertEqual(self.uploads(), [browser.link()["vdb"] + ".vdb"])
        chosen = "return document.getElementById('scene').selectedOptions[0].text"
        browser.wait(lambda: browser.run(chosen) == "ball.vdb")
        before = browser.frames()
        browser.wait(lambda: browser.frames() > before)
        link = browser.run("return location.hash")
        browser.open(self.server, link)  # it is there still
        self.assertEqual(browser.driver.title, "ball.vdb – Lumulus")
        self.drop("broken.vdb", ball[:len(ball) // 2])
        browser.wait(lambda: "scene" in browser.notices())
        self.assertEqual(browser.driver.title, "ball.vdb – Lumulus")

    def saved(self, name):
        path = os.path.join(self.browser.downloads.name, name)
        self.browser.wait(lambda: os.path.exists(path))
        with open(path, "rb") as file:
            return path, file.read()

    def test_pictures_are_saved(self):
        browser = self.browser
        size = browser.run("const c = document.getElementById('picture'); return [c.clientWidth, c.clientHeight]")
        browser.click("[data-save=png]")
        _, png = self.saved("small.png")
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual([int.from_bytes(png[at:at + 4], "big") for at in (16, 20)], size)
        browser.click("[data-save=exr]")
        path, _ = self.saved("small.exr")
        width, height, layers = read_exr(path)[:3]
        self.assertEqual([width, height], size)
        self.assertLessEqual({"R", "G", "B", "depth.Z", "transmittance.G"}, set(layers))
        self.assertEqual(browser.notices(), {})


class Token(unittest.TestCase):
    TOKEN = "a token of twenty-two."

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = os.path.join(folder.name, "token")
        with open(path, "w") as file:
            file.write(self.TOKEN + "\n")
        self.server = Server(LUMULUS, security=f'token_file = "{path}"')
        self.addCleanup(lambda: self.assertEqual(self.server.stop(), 0))
        self.browser = Browser()
        self.addCleanup(self.browser.close)

    def test_the_page_asks_for_it_and_keeps_it_out_of_links(self):
        browser = self.browser
        browser.open(self.server, wait=False)
        browser.wait(lambda: browser.element("ask").is_displayed())
        self.assertFalse(browser.element("refused").is_displayed())
        browser.element("token").send_keys("guessed wrongly\n")
        browser.wait(lambda: browser.element("refused").is_displayed())
        browser.element("token").clear()
        browser.element("token").send_keys(self.TOKEN + "\n")
        browser.wait(lambda: browser.frames() > 0)
        self.assertFalse(browser.element("ask").is_displayed())
        browser.wait(lambda: "camera" in browser.link())
        self.assertNotIn("token", browser.link())
        browser.run("sessionStorage.clear()")
        browser.open(self.server, f"#exposure=1&token={self.TOKEN.replace(' ', '+')}")
        self.assertEqual(browser.value("exposure"), 1)
        browser.wait(lambda: "camera" in browser.link())
        self.assertNotIn("token", browser.link())
        browser.driver.refresh()  # the tab keeps it
        browser.wait(lambda: browser.frames() > 0)


if __name__ == "__main__":
    unittest.main()
