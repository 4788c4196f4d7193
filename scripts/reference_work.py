#!/usr/bin/python3
"""What the path tracer's samples are worth: the relative variance of one over the cloud's pixels, the user milliseconds of
one sample of every pixel, and their product, to which the time to an error is proportional. Several executables take turns.
The squares that variances are divided by are those of a picture of four times the samples by the last executable, with
another seed: of the same samples they would favour it. Needs Debian's python3-numpy.

    scripts/reference_work.py old/lumulus build/release/lumulus --scenes stratus cumulus-side-lit --spp 40
"""

import pathlib
import resource

from measuring import Lumulus, Table, finish, parser_of, read_exr, run, size_sets

try:
    import numpy
except ImportError as missing:
    raise SystemExit(f"reference_work.py: {missing}: as root, run apt-get install python3-numpy")


def user_seconds():
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def layers_of(options, program, scene, spp, seed):
    """The layers of a new picture, and the user seconds it took."""
    options.lumulus = program
    lumulus = Lumulus(options)
    lumulus.sets += size_sets(options.width)
    path = lumulus.path(scene, seed)
    for old in (path, path.with_name(path.name + ".sums")):
        old.unlink(missing_ok=True)
    before = user_seconds()
    lumulus.reference(scene, path, spp=spp, seed=seed)
    seconds = user_seconds() - before
    return {name: numpy.array(values) for name, values in read_exr(path)[2].items()}, seconds


def rendered(options, program, scene):
    """The layers of a picture, and the user seconds of a sample without those of loading."""
    _, loading = layers_of(options, program, scene, 1, 11)
    layers, seconds = layers_of(options, program, scene, options.spp, 11)
    return layers, (seconds - loading) / (options.spp - 1)


def main():
    parser = parser_of(__doc__, width=160)
    parser.add_argument("programs", nargs="+", type=pathlib.Path, help="executables, in place of --lumulus")
    parser.add_argument("--scenes", nargs="+")
    parser.add_argument("--spp", type=int, default=40, help="at least 2")
    options = parser.parse_args()
    table = Table(["scene", "executable", "variance of a sample", "largest of a pixel", "user ms", "product"])
    for scene in Lumulus(options).scenes(options.scenes):
        found = [rendered(options, program, scene) for program in options.programs]
        truth, _ = layers_of(options, options.programs[-1], scene, 4 * options.spp, 12)
        cloud = truth["transmittance.R"] < 0.999
        for program, (layers, seconds) in zip(options.programs, found):
            relative = [options.spp * layers[f"variance.{c}"][cloud] /
                        (truth[c][cloud] ** 2 + 0.01 * numpy.mean(truth[c][cloud]) ** 2) for c in "RGB"]
            variance, largest = float(numpy.mean(relative)), float(numpy.max(relative))
            table.add({"scene": scene, "executable": str(program), "variance": variance, "largest": largest,
                       "user_seconds": seconds},
                      [scene, program.name, f"{variance:.4g}", f"{largest:.3g}", f"{1e3 * seconds:.1f}",
                       f"{variance * seconds:.3g}"])
    finish(options, table.figures)


if __name__ == "__main__":
    run(main)
