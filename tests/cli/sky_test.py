#!/usr/bin/python3
"""`lumulus sky`, exposure and time on the command line: sky_test.py LUMULUS MAKE_VDB_FIXTURES [unittest arguments]."""
import json
import os
import sys
import unittest

from PIL import Image

from cli_test import SMALL, CliTest


class Sky(CliTest):
    GOLDEN = ("--set", "time.utc=2003-10-17T19:30:30Z", "--set", "time.latitude=39.742476", "--set",
              "time.longitude=-105.1786")

    def sky(self, *arguments):
        done = self.run_lumulus("sky", *arguments, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_sun_of_a_time_and_place(self):
        told = self.sky(*self.GOLDEN)
        self.assertAlmostEqual(told["sun"]["azimuth"], 194.340, delta=0.01)  # Reda and Andreas 2004
        self.assertAlmostEqual(told["sun"]["elevation"], 39.872, delta=0.01)
        self.assertEqual(set(told), {"time", "position", "sun", "sky", "moon"})

    def test_light_of_an_atmosphere(self):
        told = self.sky("--set", "sky.model=atmosphere", "--set", "sun.elevation=30")
        self.assertAlmostEqual(told["sky"]["illuminance"], 11600, delta=600)
        self.assertAlmostEqual(told["sky"]["zenith_luminance"], 1395, delta=70)
        red, green, blue = told["sun"]["irradiance"]
        self.assertAlmostEqual(told["sun"]["illuminance"], 683 * (0.2126 * red + 0.7152 * green + 0.0722 * blue),
                               delta=1)
        self.assertGreater(red, blue)

    def test_text_has_a_line_a_value(self):
        done = self.run_lumulus("sky", self.scene("[sun]\nazimuth = 90\nelevation = 45\n"))
        self.assertEqual(done.returncode, 0)
        self.assertIn("sun.azimuth            90.000°\n", done.stdout)
        self.assertIn("sky.zenith_luminance", done.stdout)
        self.assertIn("moon.phase_angle", done.stdout)

    def test_bad_input(self):
        self.rejected("sky", "--set", "time.utc=1949-01-01T00:00:00Z", "--set", "time.latitude=0", "--set",
                      "time.longitude=0", says="1949")
        self.rejected("sky", "--set", "time.latitude=91", says="time.latitude")
        self.rejected("sky", "/nowhere.toml", says="/nowhere.toml")


class Exposure(CliTest):
    def shown(self, *arguments, **options):
        picture = self.out / "a.png"
        done = self.run_lumulus("render", self.scene(""), *SMALL, *arguments, "-o", picture, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        with Image.open(picture) as image:
            return list(image.convert("RGB").getdata())

    def test_auto_does_not_depend_on_the_unit(self):
        auto = ("--set", "image.exposure_mode=auto", "--set", "sky.model=constant")
        times = ("--set", "sun.irradiance=[50, 48, 44]", "--set", "sky.radiance=[1.2, 2.2, 4.2]")
        for one, other in zip(self.shown(*auto), self.shown(*auto, *times)):
            for a, b in zip(one, other):
                self.assertLessEqual(abs(a - b), 1)

    def test_tone_maps_differ(self):
        shown = {name: self.shown("--set", f"image.tone_map={name}")[0]
                 for name in ("filmic", "agx", "aces", "neutral", "linear")}
        self.assertEqual(len(set(shown.values())), len(shown))
        self.assertEqual(self.shown()[0], shown["filmic"])

    def test_a_faulty_configuration_of_open_color_io(self):
        done = self.run_lumulus("render", self.scene(""), *SMALL, "-o", self.out / "a.png",
                                env={**os.environ, "OCIO": "/nowhere.ocio"})
        self.assertIn("OCIO=/nowhere.ocio", self.one_line(done, 2))
        self.assertEqual(list(self.out.iterdir()), [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
