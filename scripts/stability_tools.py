"""Runs lumulus for the stability report and reads what it writes."""

import json
import math
import pathlib
import subprocess
import sys
from dataclasses import dataclass

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "cli"))
from exr_reader import read_exr  # noqa: E402

# The scene of which the cases are variations: a ball of radius 100 m, optical thickness 4, before sun and sky.
SCENE = """
[image]
width = 48
height = 32
[[cloud]]
procedural = "sphere"
resolution = 32
extinction = 0.02
[photon_map]
photons = 60000
generations = 4
"""


class Failure(Exception):
    """A case did not come to its end: the reason in one line."""


@dataclass
class Outcome:
    """What a case found: in words, its deviation in standard errors (None where nothing is random), whether it holds."""
    text: str
    deviation: float | None
    holds: bool


@dataclass
class Picture:
    path: pathlib.Path
    width: int
    height: int
    layers: dict
    statistics: dict


class Lumulus:
    def __init__(self, binary, folder, fixtures, seconds):
        self.binary, self.folder, self.fixtures, self.seconds = binary, pathlib.Path(folder), fixtures, seconds
        self.pictures = 0
        self.scene = self.folder / "scene.toml"
        self.scene.write_text(SCENE)

    def run(self, *arguments):
        """The finished process; a case that hangs is killed (SIGTERM asks, and might not be heard)."""
        try:
            return subprocess.run([self.binary, *map(str, arguments)], capture_output=True, text=True,
                                  timeout=self.seconds)
        except subprocess.TimeoutExpired:
            raise Failure(f"not done after {self.seconds} s")

    def output(self, *arguments):
        done = self.run(*arguments)
        if done.returncode != 0:
            raise Failure(f"exit code {done.returncode}: {done.stderr.strip()[-160:]}")
        return done.stdout

    def slab(self, **values):
        return json.loads(self.output("slab", "--json", *(x for k, v in values.items() for x in (f"--{k}", v))))

    def new_path(self):
        self.pictures += 1
        return self.folder / f"{self.pictures}.exr"

    @staticmethod
    def overrides(sets):
        return [word for one in sets for word in ("--set", one)]

    def render(self, *sets, seed=1):
        """A picture. Fails where a value is not finite, a photon is unaccounted for or lost, or a sum saturated."""
        path = self.new_path()
        text = self.output("render", self.scene, "-o", path, "--stats", "-", "--quiet", "--seed", seed,
                           *self.overrides(sets))
        statistics = json.loads(text)
        width, height, layers, _ = read_exr(path)
        for name, values in layers.items():
            if not all(map(math.isfinite, values)):
                raise Failure(f"layer {name} is not finite")
        ends = {name: statistics[name] for name in ("lost", "saturated")}
        if any(ends.values()):
            raise Failure(", ".join(f"{count} {name}" for name, count in ends.items()))
        if statistics["absorbed"] + statistics["escaped"] != statistics["photons"]:
            raise Failure("photons absorbed and escaped are not the photons emitted")
        return Picture(path, width, height, layers, statistics)

    def reference(self, *sets, spp):
        path = self.new_path()
        self.output("reference", self.scene, "-o", path, "--spp", spp, "--majorant", "local", "--quiet", "--seed", 2,
                    *self.overrides(sets))
        return path

    def compare(self, picture, truth):
        return json.loads(self.output("compare", picture, truth, "--json"))


def mean_and_error(values):
    mean = sum(values) / len(values)
    variance = sum((v - mean) ** 2 for v in values) / (len(values) - 1)
    return mean, math.sqrt(variance / len(values))
