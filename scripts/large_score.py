#!/usr/bin/python3
"""relMSE of large pictures against two noisy references with different seeds: the mean product of the errors against
both, which has no noise of theirs in it, divided by the square of the first picture, which has less noise than theirs.
What the path tracer's own pictures have, by half their difference, stands beside it. Needs Debian's python3-numpy.

    scripts/large_score.py a.exr b.exr picture.exr...
"""

import argparse
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "cli"))
from exr_reader import read_exr  # noqa: E402


def layers_of(path):
    layers = read_exr(path)[2]
    return {name: numpy.array(layers[name]) for name in ("R", "G", "B", "transmittance.R")}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("references", nargs=2)
    parser.add_argument("pictures", nargs="+")
    options = parser.parse_args()
    first, second = (layers_of(path) for path in options.references)
    pictures = {path: layers_of(path) for path in options.pictures}
    scale = next(iter(pictures.values()))
    cloud = scale["transmittance.R"] < 0.999
    squares = {c: scale[c][cloud] ** 2 + 0.01 * numpy.mean(scale[c][cloud] ** 2) for c in "RGB"}
    tracer = numpy.mean([0.5 * (first[c][cloud] - second[c][cloud]) ** 2 / squares[c] for c in "RGB"])
    print(f"path tracer: {tracer:.4f}")
    for path, picture in pictures.items():
        # channels are one sample: their errors go together
        errors = numpy.mean([(picture[c] - first[c])[cloud] * (picture[c] - second[c])[cloud] / squares[c]
                             for c in "RGB"], axis=0)
        print(f"{path}: relMSE {errors.mean():.5f} ± {errors.std() / numpy.sqrt(errors.size):.5f}")


if __name__ == "__main__":
    main()
