"""What the scripts that measure lumulus share: running it, its scenes, tables in Markdown and JSON."""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "cli"))
from exr_reader import read_exr  # noqa: E402, F401

# All that ship but the furnace, in which nothing is to be seen.
SCENES = ["cumulus", "cumulus-side-lit", "cumulus-back-lit", "cumulus-front-lit", "cumulus-low-sun", "disney-cloud",
          "cirrus", "stratus", "smoke"]


class Failure(Exception):
    """A program that did not do its work: one line."""


def started(words):
    """The program with these words, its output and its complaints to be read."""
    try:
        return subprocess.Popen([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    except OSError as error:
        raise Failure(f"{words[0]}: {error.strerror}; run scripts/build.sh first") from None


def output_of(*words):
    process = started(words)
    said, complaint = process.communicate()
    if process.returncode != 0:
        raise Failure((complaint.strip().splitlines() or [f"{words[0]} failed"])[-1])
    return said


def with_sets(sets):
    """Overrides as words of the command line."""
    return [word for one in sets for word in ("--set", one)]


def size_sets(width):
    """Pictures are 16:9."""
    return [f"image.width={width}", f"image.height={width * 9 // 16}"]


def parser_of(description, width=None):
    """Options that all have in common; `width` is that of pictures, where there is one."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lumulus", default=ROOT / "build/release/lumulus", type=pathlib.Path, help="the executable")
    parser.add_argument("--folder", type=pathlib.Path, help="for pictures, which stay there (default: gone afterwards)")
    parser.add_argument("--json", type=pathlib.Path, help="write the figures to this file too")
    parser.add_argument("--vdb", type=pathlib.Path, help="wdas_cloud_sixteenth.vdb, without which disney-cloud is left out")
    parser.add_argument("--set", action="append", default=[], help="override section.key=value; may repeat")
    if width:
        parser.add_argument("--width", type=int, default=width, help="of pictures, 16:9 (default %(default)s)")
    return parser


class Lumulus:
    """The executable, and a folder for its pictures."""

    def __init__(self, options):
        self.program, self.vdb = options.lumulus, options.vdb
        self._temporary = None if options.folder else tempfile.TemporaryDirectory()
        self.folder = options.folder or pathlib.Path(self._temporary.name)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.sets = list(options.set)

    def scenes(self, wanted=None):
        """Those that are wanted, or all that there is data for."""
        for scene in wanted or []:
            if not (ROOT / f"configs/scenes/{scene}.toml").exists():
                raise Failure(f"no scene {scene} in configs/scenes")
        return [scene for scene in wanted or SCENES if scene != "disney-cloud" or self.vdb]

    def _scene_words(self, scene, sets):
        more = [f"cloud.0.vdb={self.vdb.resolve()}"] if scene == "disney-cloud" else []
        return [ROOT / "configs/scenes" / f"{scene}.toml", *with_sets([*self.sets, *more, *sets])]

    def path(self, *words, suffix=".exr"):
        return self.folder / ("-".join(map(str, words)) + suffix)

    def render(self, scene, output, sets=(), words=()):
        """Statistics of the picture, with the largest resident memory of the process as "rss_bytes"."""
        command = [self.program, "render", *self._scene_words(scene, sets), "-o", output, "--quiet", "--stats", "-", *words]
        process = started(command)
        said = process.stdout.read()
        complaint = process.stderr.read()
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise Failure((complaint.strip().splitlines() or ["lumulus failed"])[-1])
        return {**json.loads(said), "rss_bytes": used.ru_maxrss * 1024}

    def reference(self, scene, output, sets=(), spp=64, seed=101):
        """By the faster majorant. A picture that is there already is gone on with up to these samples, or, without its
        sums, kept."""
        sums = output.with_name(output.name + ".sums")
        if sums.exists() or not output.exists():
            output_of(self.program, "reference", *self._scene_words(scene, sets), "-o", output, "--spp", spp,
                      "--majorant", "local", "--seed", seed, "--resume", "--quiet")
        return output

    def compare(self, picture, *truths, words=()):
        return json.loads(output_of(self.program, "compare", picture, *truths, "--json", *words))


def scene_values(scene):
    return tomllib.loads((ROOT / "configs/scenes" / f"{scene}.toml").read_text())


def markdown(titles, rows):
    lines = ["| " + " | ".join(titles) + " |", "|---" * len(titles) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


class Table:
    """Prints its rows as Markdown as they come, and keeps the figures for a file."""

    def __init__(self, titles):
        self.figures = []
        print(markdown(titles, []), flush=True)

    def add(self, figures, texts):
        self.figures.append(figures)
        print("| " + " | ".join(texts) + " |", flush=True)


def finish(options, figures):
    if options.json:
        options.json.write_text(json.dumps(figures, indent=1) + "\n")


def run(main):
    """main(), with failures as one line and exit code 2."""
    try:
        main()
    except Failure as failure:
        print(f"{pathlib.Path(sys.argv[0]).name}: {failure}", file=sys.stderr)
        sys.exit(2)
