"""EXR files for tests, by the studies' reader and writer: layers as flat lists, which compare by ==, rows from the top."""

import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from study import pictures  # noqa: E402


def read_exr(path):
    """(width, height, {layer: [floats]}, {attribute: text})."""
    layers = pictures.read_exr(path)
    height, width = next(iter(layers.values())).shape
    return width, height, {name: values.ravel().tolist() for name, values in layers.items()}, pictures.read_attributes(path)


def write_exr(path, width, height, layers):
    """`layers`: name to width·height values."""
    pictures.write_exr(path, {name: numpy.reshape(values, (height, width)) for name, values in layers.items()})
