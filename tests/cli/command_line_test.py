"""The command line: what is blamed and advised, help in all its forms, threads, readers that go away:
command_line_test.py LUMULUS [unittest arguments]."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

LUMULUS = Path(sys.argv[1]).resolve()
SMALL = ["--quiet", "--quality", "draft", "--set", "image.width=16", "--set", "image.height=9", "--set",
         "photon_map.photons=1000", "--set", "photon_map.generations=1", "--set", "preparation.samples=500"]
SPHERE = '[[cloud]]\nprocedural = "sphere"\nresolution = 16\n'

# pthread_create that fails once THREADS_LEFT threads were started, as under ulimit -u; the first ones are asked for so early
# that the C library knows no environment yet
NO_THREADS = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) {
    static int left = THREADS_LEFT;
    if (left == 0) return EAGAIN;
    --left;
    int (*create)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*) = dlsym(RTLD_NEXT, "pthread_create");
    return create(thread, attributes, run, argument);
}
"""


class CommandLine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "s.toml").write_text(SPHERE)

    def run_lumulus(self, *words, **options):
        return subprocess.run([LUMULUS, *map(str, words)], capture_output=True, text=True, timeout=120, cwd=self.folder,
                              **options)

    def line(self, code, *words, **options):
        """The one line of an error with this exit code."""
        result = self.run_lumulus(*words, **options)
        self.assertEqual((result.returncode, result.stderr.count("\n")), (code, 1), result.stderr)
        self.assertRegex(result.stderr, r"^lumulus: error: \S")
        return result.stderr

    def succeeds(self, *words, **options):
        result = self.run_lumulus(*words, **options)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout


class Words(CommandLine):
    def test_blame_and_advice(self):
        self.assertIn('unknown command "rendr" (command line): did you mean render?', self.line(2, "rendr", "s.toml"))
        line = self.line(2, "render", "--qualty", "draft", "s.toml", "-o", "a.png")
        self.assertIn('unknown option "--qualty" (lumulus render): did you mean --quality?', line)
        self.assertNotIn("s.toml", self.line(2, "render", "--nonsense", "2", "s.toml", "-o", "a.png"))
        self.assertIn("t.toml", self.line(2, "render", "s.toml", "t.toml", "-o", "a.png"))

    def test_advice_for_keys_works(self):
        line = self.line(2, "render", "s.toml", "-o", "a.png", "--set", "extinction=1")
        advised = re.search(r"did you mean ([a-z0-9_.]+)\?", line)[1]
        self.assertEqual(advised, "cloud.0.extinction")
        self.succeeds("render", "s.toml", *SMALL, "-o", "a.png", "--set", f"{advised}=0.01")


class Help(CommandLine):
    def test_help_is_that_of_the_option(self):
        self.assertEqual(self.succeeds("help"), self.succeeds("--help"))
        for command in ("render", "fetch", "help"):
            self.assertEqual(self.succeeds("help", command), self.succeeds(command, "--help"))
        self.assertIn("did you mean render?", self.line(2, "help", "rendr"))

    def test_every_option_stands_in_its_page(self):
        self.succeeds("help", "--files", "made")
        commands = re.findall(r"^  (\w+) ", self.succeeds("help").split("Subcommands:")[1], re.MULTILINE)
        pages = sorted(path.name for path in (self.folder / "made/man/man1").iterdir())
        self.assertEqual(pages, sorted(["lumulus.1", *(f"lumulus-{command}.1" for command in commands)]))
        for command in commands:
            page = (self.folder / f"made/man/man1/lumulus-{command}.1").read_text().replace("\\-", "-")
            options = re.findall(r"^  (?:-\w,)?(--[a-z0-9-]+)", self.succeeds("help", command), re.MULTILINE)
            self.assertIn("--threads", options)
            for option in options:
                self.assertIn(f"\\fB{option}\\fR", page, command)
            self.assertIn(f"lumulus {command}", page.split(".SH EXAMPLE")[1])

    def completed(self, *words):
        """What bash offers for the last word."""
        script = 'source made/bash-completion/completions/lumulus; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); ' \
                 '_lumulus; printf "%s\\n" "${COMPREPLY[@]}"'
        result = subprocess.run(["bash", "-c", script, "bash", "lumulus", *words], capture_output=True, text=True,
                                cwd=self.folder)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout.split()

    def test_completion(self):
        self.succeeds("help", "--files", "made")
        self.assertEqual(self.completed("ren"), ["render"])
        self.assertEqual(self.completed("render", "--qua"), ["--quality"])
        self.assertEqual(self.completed("render", "--quality", ""), ["draft", "interactive", "final"])
        self.assertEqual(self.completed("render", "--quality", "f"), ["final"])
        self.assertEqual(self.completed("render", "s"), ["s.toml"])
        self.assertEqual(self.completed("render", "s.toml", "-o", "s"), ["s.toml"])
        self.assertEqual(self.completed("help", "comp"), ["compare", "composite"])
        self.assertEqual(self.completed("--threads", "2", "ren"), ["render"])
        self.assertIn("--threads", self.completed("--th"))


class Pipes(CommandLine):
    def test_a_reader_that_has_gone_is_no_error(self):
        self.succeeds("cloud", "sphere", "-o", "a.vdb", "--resolution", "16", "--quiet")
        for words in (("--help",), ("help", "render"), ("--version",), ("info", "a.vdb"), ("info", "a.vdb", "--json"),
                      ("info", "--scene-format"),
                      ("slab", "--tau", "1", "--g", "0", "--albedo", "0", "--mu0", "1", "--photons", "10", "--reference"),
                      ("render", "s.toml", *SMALL, "-o", "b.png", "--stats", "-")):
            with self.subTest(words=words):
                reading, writing = os.pipe()
                os.close(reading)
                result = subprocess.run([LUMULUS, *words], stdout=writing, stderr=subprocess.PIPE, text=True,
                                        cwd=self.folder)
                os.close(writing)
                self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertTrue((self.folder / "b.png").exists())

    def test_outputs_that_are_pipes(self):
        render = ["render", "s.toml", *SMALL, "-o", "b.png", "--stats", "/dev/stdout"]
        self.assertEqual(json.loads(self.succeeds(*render))["photons"], 1000)


class Threads(CommandLine):
    def limited(self, threads):
        if b"__asan_init" in LUMULUS.read_bytes():
            self.skipTest("the sanitizer's runtime must be the first library")
        source, library = self.folder / "no_threads.c", self.folder / f"only_{threads}.so"
        source.write_text(NO_THREADS)
        subprocess.run(["cc", "-shared", "-fPIC", f"-DTHREADS_LEFT={threads}", source, "-o", library, "-ldl"], check=True)
        return {"env": dict(os.environ, LD_PRELOAD=str(library))}

    def test_none_at_all(self):
        (self.folder / "service.toml").write_text("")
        for words in (("info", "--devices"), ("render", "s.toml", "-o", "a.png"), ("serve", "--config", "service.toml")):
            self.assertIn("ulimit -u", self.line(1, *words, **self.limited(0)))
        self.assertFalse((self.folder / "a.png").exists())

    def test_too_few(self):
        # 4 + 4 + 3: those that libraries start before main() are tried first and started then
        line = self.line(1, "render", "s.toml", *SMALL, "--threads", "64", "-o", "a.png", **self.limited(11))
        self.assertRegex(line, r"start \d+ of the \d+ threads that it needs \(.*\): raise the limit, or give --threads 1")

    def test_one_thread_of_the_host_starts_no_other(self):
        for words in (("--threads", "1", "cloud", "sphere", "-o", "a.vdb", "--resolution", "24", "--quiet"),
                      ("info", "a.vdb", "--json", "--threads", "1")):
            self.succeeds(*words, **self.limited(8))
        self.assertEqual(json.loads(self.succeeds("info", "a.vdb", "--json"))["grids"][0]["name"], "density")

    def test_pictures_are_the_same(self):
        files = []
        for threads in (1, 2, 3):
            self.succeeds("render", "s.toml", *SMALL, "--threads", threads, "-o", "a.exr")
            files.append((self.folder / "a.exr").read_bytes())
        self.assertEqual(files[0], files[1])
        self.assertEqual(files[0], files[2])

    def test_bad_numbers(self):
        for number in ("0", "-1", "x", "1.5", "100000"):
            self.assertIn("--threads", self.line(2, "render", "s.toml", "-o", "a.png", "--threads", number))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
