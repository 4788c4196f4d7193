#!/usr/bin/python3
"""relMSE of large pictures against two noisy references with different seeds: the mean product of the errors against
both, which has no noise of theirs in it, divided by the square of the first picture, which has less noise than theirs.
What the path tracer's own pictures have, by half their difference, stands beside it. Needs Debian's python3-numpy.

    scripts/large_score.py a.exr b.exr picture.exr...
"""

import argparse
import struct
import zlib

from measuring import Failure, read_exr, run

try:
    import numpy
except ImportError as missing:
    raise SystemExit(f"large_score.py: {missing}: as root, run apt-get install python3-numpy")


def layers_of(path):
    try:
        layers = read_exr(path)[2]
        return {name: numpy.array(layers[name]) for name in ("R", "G", "B", "transmittance.R")}
    except KeyError as missing:
        raise Failure(f"{path} has no layer or attribute {missing}")
    except (OSError, ValueError, IndexError, struct.error, zlib.error) as error:
        raise Failure(f"{path} is not a whole EXR file of lumulus: {error}")


def squares_of(layers, cloud):
    return {c: layers[c][cloud] ** 2 + 0.01 * numpy.mean(layers[c][cloud] ** 2) for c in "RGB"}


def score(picture, first, second, cloud, squares):
    """relMSE of a picture's layers in the pixels `cloud` against two references, and its standard error."""
    # channels are one sample: their errors go together
    errors = numpy.mean([(picture[c] - first[c])[cloud] * (picture[c] - second[c])[cloud] / squares[c] for c in "RGB"],
                        axis=0)
    return errors.mean(), errors.std() / numpy.sqrt(errors.size)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("references", nargs=2)
    parser.add_argument("pictures", nargs="+")
    options = parser.parse_args()
    first, second = (layers_of(path) for path in options.references)
    pictures = {path: layers_of(path) for path in options.pictures}
    scale = next(iter(pictures.values()))
    for path, layers in [*zip(options.references, (first, second)), *pictures.items()]:
        if layers["R"].size != scale["R"].size:
            raise Failure(f"{path} has another size than {options.pictures[0]}")
    cloud = scale["transmittance.R"] < 0.999
    squares = squares_of(scale, cloud)
    tracer = numpy.mean([0.5 * (first[c][cloud] - second[c][cloud]) ** 2 / squares[c] for c in "RGB"])
    print(f"path tracer: {tracer:.4f}")
    for path, picture in pictures.items():
        relmse, deviation = score(picture, first, second, cloud, squares)
        print(f"{path}: relMSE {relmse:.5f} ± {deviation:.5f}")


if __name__ == "__main__":
    run(main)
