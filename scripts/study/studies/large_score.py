"""relMSE of large pictures against two references of few samples. The mean product of the errors against both has none of
the references' noise in it; it is divided by the squares of the first picture, which has less noise than they have
(`lumulus compare --denominator`). What the path tracer's own pictures have stands beside it.

    scripts/study/run large_score a.exr b.exr picture.exr...
"""

import pathlib

from study.lumulus import Lumulus, add_program_option


def tracer_error(found):
    """relMSE of one reference by its noise, from a comparison with the mean of two as noisy."""
    return 2.0 * found["reference_noise"]


def add_options(parser):
    add_program_option(parser)
    parser.add_argument("references", nargs=2, type=pathlib.Path)
    parser.add_argument("pictures", nargs="+", type=pathlib.Path)


def main(options):
    lumulus = Lumulus(options.lumulus)
    for picture in options.pictures:
        found = lumulus.compare(picture, *options.references, denominator=options.pictures[0])
        if picture == options.pictures[0]:
            print(f"path tracer: {tracer_error(found):.4f}")
        print(f"{picture}: relMSE {found['relmse']:.5f} ± {found['standard_error']['relmse']:.5f}", flush=True)
