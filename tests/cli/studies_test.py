"""What the studies of scripts/study share, and what two programs' pictures are judged by: studies_test.py LUMULUS
[unittest arguments]."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from study import pictures  # noqa: E402
from study.layers import layer  # noqa: E402
from study.program import Failure, finished, succeeded  # noqa: E402
from study.studies.same_pictures.difference import difference  # noqa: E402

LUMULUS = Path(sys.argv[1]).resolve()
RUN = ROOT / "scripts/study/run"


def study(*words):
    return subprocess.run([sys.executable, RUN, *map(str, words)], capture_output=True, text=True, timeout=280)


class Entry(unittest.TestCase):
    def test_help_lists_every_study_in_a_line(self):
        lines = study("--help").stdout.splitlines()
        names = {path.stem for path in (ROOT / "scripts/study/studies").iterdir() if not path.name.startswith("__")}
        listed = {line.split()[0] for line in lines if line.startswith("  ")}
        self.assertEqual(listed, names)
        for name in names:
            done = study(name, "--help")
            self.assertEqual((done.returncode, done.stderr), (0, ""), name)

    def test_unknown_names_and_bad_input_are_one_line(self):
        for words in (["no_such"], ["scores", "--lumulus", "no/such", "--scenes", "cirrus"],
                      ["scores", "--scenes", "no-such"], ["large_score", "a", "b", "c", "--lumulus", LUMULUS]):
            done = study(*words)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)


class Programs(unittest.TestCase):
    def test_what_a_process_says_and_uses(self):
        done = finished("sh", "-c", "echo said; echo complained >&2; exit 3")
        self.assertEqual((done.code, done.output, done.complaint), (3, "said\n", "complained\n"))
        self.assertGreater(done.rss_bytes, 0)

    def test_failures_are_lines(self):
        for words, limit, says in ((("sh", "-c", "echo why >&2; exit 1"), None, "why"), (("false",), None, "code 1"),
                                   (("no/such",), None, "no/such"), (("sleep", "60"), 0.2, "not done after 0.2 s")):
            with self.assertRaisesRegex(Failure, says):
                succeeded(*words, limit=limit)


class Pictures(unittest.TestCase):
    def test_layers_come_back_with_their_names_and_bits(self):
        numbers = numpy.random.default_rng(3)
        layers = {name: numbers.normal(size=(5, 7)).astype("f4") for name in ("B", "G", "R", "A", "cloud.R", "depth.front")}
        layers["R"][0, :3] = [numpy.nan, -0.0, numpy.inf]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a.exr"
            pictures.write_exr(path, layers)
            self.assertEqual(difference(layers, pictures.read_exr(path)), "")
            path.write_bytes(path.read_bytes()[:-20])
            with self.assertRaises(Failure):
                pictures.read_exr(path)

    def test_differences_are_found(self):
        layers = {"R": numpy.array([[0.0, 1.0], [2.0, numpy.nan]], "f4")}
        self.assertEqual(difference(layers, {"R": layers["R"].copy()}), "")
        for change, says in (((0, 0, -0.0), r"R: 1 of 4 values, largest 0 at"), ((1, 0, 2.5), r"largest 0.5 at \(0, 1\)"),
                             ((1, 1, 3.0), r"1 not finite")):
            changed = layers["R"].copy()
            changed[change[0], change[1]] = change[2]
            self.assertRegex(difference(layers, {"R": changed}), says)
        self.assertIn("became", difference(layers, {"G": layers["R"]}))
        self.assertIn("became", difference(layers, {"R": layers["R"].astype("f2")}))
        self.assertIn("became", difference(layers, {"R": layers["R"][:1]}))


class SamePictures(unittest.TestCase):
    """A program against itself, and against one that moves the sun by a hundredth of a degree."""

    CASES = "^composite, scatter|^cumulus, march|^service: PNG"

    def test_a_program_equals_itself(self):
        done = study("same_pictures", LUMULUS, LUMULUS, "--case", self.CASES)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("3 of 3 cases are equal", done.stdout)

    def test_another_picture_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            other = Path(folder) / "lumulus"
            other.write_text(f'#!/bin/sh\ncase $1 in render) exec {LUMULUS} "$@" --set sun.azimuth=70.01;; '
                             f'*) exec {LUMULUS} "$@";; esac\n')
            other.chmod(0o755)
            done = study("same_pictures", LUMULUS, other, "--case", self.CASES)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stdout, r"\| cumulus, march \| 13 \| 160×90 \| \*\*differs\*\* R: \d+ of 14400 values")
        self.assertIn("2 of 3 cases are equal", done.stdout)


class Layers(unittest.TestCase):
    def test_doubling_agrees_with_van_de_hulst(self):
        """1980: g 0.75, optical thickness 2, albedo 0.9, light from above."""
        found = layer(2.0, 0.75, 0.9)
        self.assertAlmostEqual(found["reflected"], 0.09739, delta=5e-5)
        self.assertAlmostEqual(found["transmitted"], 0.525625 + 0.1353353, delta=5e-5)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
