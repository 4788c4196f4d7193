"""Whether pictures of few photons have specks of a colour that their surroundings do not have. A row a scene, over many
seeds: the largest factor by which the ratio of red to blue of a pixel differs from the median of the 9 by 9 pixels around it,
and how many pixels differ by more than the given factor. Only the cloud's own light counts, where it hides a tenth or more.
"""

import numpy
from numpy.lib.stride_tricks import sliding_window_view

from study.lumulus import Lumulus, add_common_options
from study.pictures import read_exr
from study.program import size_sets
from study.tables import Table, write_figures

SCENES = ["cumulus-side-lit", "stratus"]
REACH = 4  # pixels to each side
LEAST = 1e-12


def factors(layers):
    """Of each pixel that shows the cloud, its ratio of red to blue over the median around it, or the inverse where that is
    larger. A channel without light differs by an endless factor."""
    red, blue = (numpy.maximum(layers[f"cloud.{c}"].astype(float), LEAST) for c in "RB")
    shown = layers["transmittance.R"] < 0.9
    ratio = numpy.where(shown, numpy.log(red / blue), numpy.nan)
    around = sliding_window_view(numpy.pad(ratio, REACH, constant_values=numpy.nan), (2 * REACH + 1, 2 * REACH + 1))
    middle = numpy.nanmedian(around[shown], axis=(1, 2))
    return numpy.exp(numpy.abs(ratio[shown] - middle))


def add_options(parser):
    add_common_options(parser, width=160)
    parser.add_argument("--scenes", nargs="+", default=SCENES)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--quality", default="draft")
    parser.add_argument("--factor", type=float, default=1.5)


def main(options):
    lumulus = Lumulus.of(options, size_sets(options.width))
    table = Table(["scene", "seeds", "pixels", "worst factor", "pixels beyond", "pictures with some"])
    for scene in options.scenes:
        worst, beyond, pictures, pixels = 1.0, 0, 0, 0
        for seed in range(1, options.seeds + 1):
            path = lumulus.path(scene, "speck")
            lumulus.render(scene, path, [f"photon_map.seed={seed}"], ["--quality", options.quality])
            found = factors(read_exr(path))
            pixels += len(found)
            worst = max(worst, float(found.max(initial=1.0)))
            many = int((found > options.factor).sum())
            beyond += many
            pictures += many > 0
        table.add({"scene": scene, "seeds": options.seeds, "pixels": pixels, "worst": worst, "beyond": beyond,
                   "pictures": pictures},
                  [scene, str(options.seeds), str(pixels), f"{worst:.2f}", str(beyond), str(pictures)])
    write_figures(options, table.figures)
