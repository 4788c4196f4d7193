"""What the cases of the stability report share: a case, what it found, and lumulus with a plain scene."""

import math
import pathlib
from dataclasses import dataclass
from typing import Callable

import numpy

from study import lumulus
from study.pictures import read_exr
from study.program import Failure

# The scene of which the cases are variations: a ball of radius 100 m, optical thickness 4, before sun and sky.
SCENE = """
[image]
width = 48
height = 32
[sky]
model = "constant"
[[cloud]]
procedural = "sphere"
resolution = 32
extinction = 0.02
[photon_map]
photons = 60000
generations = 4
"""


@dataclass
class Case:
    """`run` takes a Lumulus and returns an Outcome, or raises Failure."""

    name: str
    expected: str
    run: Callable
    reason: str = ""  # why it does not hold, where that is known
    seconds: float = 0.0  # a time limit of its own


@dataclass
class Outcome:
    """What a case found: in words, its deviation in standard errors (None where nothing is random), whether it holds."""

    text: str
    deviation: float | None
    holds: bool


@dataclass
class Picture:
    path: pathlib.Path
    layers: dict
    statistics: dict


class Lumulus(lumulus.Lumulus):
    """`fixtures` is the executable make_vdb_fixtures."""

    def __init__(self, program, fixtures):
        super().__init__(program)
        self.fixtures, self.pictures = fixtures, 0
        self.scene = self.path("scene", suffix=".toml")
        self.scene.write_text(SCENE)

    def new_path(self):
        self.pictures += 1
        return self.path(self.pictures)

    def render(self, *sets, seed=1):
        """A picture. Fails where a value is not finite, a photon is unaccounted for or lost, or a sum saturated."""
        path = self.new_path()
        statistics = super().render(self.scene, path, sets, ["--seed", seed])
        layers = read_exr(path)
        for name, values in layers.items():
            if not numpy.isfinite(values).all():
                raise Failure(f"layer {name} is not finite")
        ends = {name: statistics[name] for name in ("lost", "saturated")}
        if any(ends.values()):
            raise Failure(", ".join(f"{count} {name}" for name, count in ends.items()))
        if statistics["absorbed"] + statistics["escaped"] != statistics["photons"]:
            raise Failure("photons absorbed and escaped are not the photons emitted")
        return Picture(path, layers, statistics)

    def reference(self, *sets, spp):
        """The path of the picture."""
        path = self.new_path()
        self.new_reference(self.scene, path, sets, spp, seed=2)
        return path


def mean_and_error(values):
    mean = sum(values) / len(values)
    variance = sum((v - mean) ** 2 for v in values) / (len(values) - 1)
    return mean, math.sqrt(variance / len(values))
