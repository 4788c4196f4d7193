"""What the path tracer's samples are worth. The relative variance of one over the cloud's pixels, the user milliseconds of
one sample of every pixel, and their product, to which the time to an error is proportional. Several executables take turns.
The squares that variances are divided by are those of a picture of four times the samples by the last executable, with
another seed: of the same samples they would favour it.

    scripts/study/run reference_work old/lumulus build/release/lumulus --scenes stratus cumulus-side-lit --spp 40
"""

import pathlib

import numpy

from study.lumulus import Lumulus, add_common_options
from study.pictures import read_exr
from study.program import size_sets
from study.tables import Table, write_figures


def layers_of(lumulus, scene, spp, seed):
    """The layers of a new picture, and the user seconds it took."""
    path = lumulus.path(scene, seed)
    seconds = lumulus.new_reference(scene, path, spp=spp, seed=seed).user_seconds
    return read_exr(path), seconds


def rendered(lumulus, scene, spp):
    """The layers of a picture, and the user seconds of a sample without those of loading."""
    _, loading = layers_of(lumulus, scene, 1, 11)
    layers, seconds = layers_of(lumulus, scene, spp, 11)
    return layers, (seconds - loading) / (spp - 1)


def relative_variances(layers, truth, spp):
    """Of one sample, over the cloud's pixels [3, pixels]."""
    cloud = truth["transmittance.R"] < 0.999
    return numpy.array([spp * layers[f"variance.{c}"][cloud] /
                        (truth[c][cloud] ** 2 + 0.01 * numpy.mean(truth[c][cloud]) ** 2) for c in "RGB"])


def add_options(parser):
    add_common_options(parser, width=160)
    parser.add_argument("programs", nargs="+", type=pathlib.Path, help="executables, in place of --lumulus")
    parser.add_argument("--scenes", nargs="+")
    parser.add_argument("--spp", type=int, default=40, help="at least 2")


def main(options):
    programs = [Lumulus(program, options.folder, [*options.set, *size_sets(options.width)], options.vdb)
                for program in options.programs]
    table = Table(["scene", "executable", "variance of a sample", "largest of a pixel", "user ms", "product"])
    for scene in programs[0].scenes(options.scenes):
        found = [rendered(lumulus, scene, options.spp) for lumulus in programs]
        truth, _ = layers_of(programs[-1], scene, 4 * options.spp, 12)
        for program, (layers, seconds) in zip(options.programs, found):
            relative = relative_variances(layers, truth, options.spp)
            variance, largest = float(relative.mean()), float(relative.max())
            table.add({"scene": scene, "executable": str(program), "variance": variance, "largest": largest,
                       "user_seconds": seconds},
                      [scene, program.name, f"{variance:.4g}", f"{largest:.3g}", f"{1e3 * seconds:.1f}",
                       f"{variance * seconds:.3g}"])
    write_figures(options, table.figures)
