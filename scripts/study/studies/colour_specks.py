"""Whether pictures of few photons have specks of a colour that their surroundings do not have. A row a scene, over many
seeds, each pixel's ratio of red to blue in the cloud's own light, where it hides a tenth or more: how far it is from the
median of the 9 by 9 pixels around it, how many pixels are farther from it than the given factor, and how far it is from its
median over all seeds, as a factor and in standard deviations: those of the pixels around it over all seeds.
"""

import numpy
from numpy.lib.stride_tricks import sliding_window_view

from study.lumulus import Lumulus, add_common_options, scene_file
from study.pictures import read_exr
from study.program import size_sets
from study.tables import Table, write_figures

REACH = 4  # pixels to each side
LEAST = 1e-12

CUMULUS = """[[cloud]]
procedural = "cumulus"
resolution = 64
"""
COLOURS = """[sun]
elevation = 20.0
irradiance = [5.0, 2.5, 0.7]
[sky]
radiance = [0.03, 0.15, 0.9]
[[cloud]]
procedural = "cumulus"
resolution = 64
albedo = [1.0, 0.98, 0.93]
"""
MANY = "".join(f"""[[cloud]]
procedural = "cumulus"
resolution = 48
seed = {seed}
transform = [[0.6, 0.0, 0.0, {x}], [0.0, 0.6, 0.0, {y}], [0.0, 0.0, 0.6, {z}]]
extinction = {extinction}
albedo = {albedo}
phase = {{ model = "{model}" }}
""" for seed, x, y, z, extinction, albedo, model in ((1, -400, 0, 0, 0.08, "1.0", "hg"),
                                                     (2, 250, 60, 150, 0.05, "[1.0, 0.97, 0.9]", "droplet"),
                                                     (3, 150, 100, -350, 0.02, "[0.9, 0.97, 1.0]", "mie")))
SUNSET = """[camera]
position = [0.0, 2.0, 1700.0]
target = [0.0, 820.0, 0.0]
[sun]
azimuth = 75.0
elevation = 2.0
[sky]
model = "atmosphere"
[[cloud]]
procedural = "cumulus"
resolution = 64
transform = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 600.0], [0.0, 0.0, 1.0, 0.0]]
"""
DROPLETS = "phase = { model = \"mie\", effective_radius = 10.0 }\n"
DECK = """[camera]
position = [100.0, 380.0, 800.0]
target = [0.0, 60.0, 0.0]
vertical_fov = 50.0
[sun]
azimuth = 310.0
elevation = 12.0
[[cloud]]
procedural = "stratus"
resolution = 128
phase = { model = "droplet", droplet_diameter = 10.0 }
"""
# Beside the shipped ones.
SCENES = {"deck": DECK, "droplets": CUMULUS + DROPLETS, "colours": COLOURS, "colours-droplets": COLOURS + DROPLETS,
          "many": "[sun]\nelevation = 25.0\nirradiance = [5.0, 4.0, 2.8]\n" + MANY, "sunset": SUNSET,
          "sunset-droplets": SUNSET + DROPLETS}


def logarithms(layers):
    """Of the ratio of red to blue of each pixel that shows the cloud, NaN elsewhere. A channel without light is endlessly
    far from the others."""
    red, blue = (numpy.maximum(layers[f"cloud.{c}"].astype(float), LEAST) for c in "RB")
    return numpy.where(layers["transmittance.R"] < 0.9, numpy.log(red / blue), numpy.nan)


def around(values):
    """The values of 9 by 9 pixels around each, those of all pictures together: [height, width, values]."""
    height, width = values.shape[-2:]
    padded = numpy.pad(values.reshape(-1, height, width), ((0, 0), (REACH, REACH), (REACH, REACH)), constant_values=numpy.nan)
    windows = sliding_window_view(padded, (2 * REACH + 1, 2 * REACH + 1), axis=(1, 2))
    return numpy.moveaxis(windows, 0, 2).reshape(height, width, -1)


def from_surroundings(picture):
    """Distances from the median of the pixels around, of the pixels that show the cloud."""
    shown = numpy.isfinite(picture)
    return numpy.abs(picture[shown] - numpy.nanmedian(around(picture)[shown], axis=-1))


def from_all_seeds(pictures):
    """Distances from each pixel's median over all pictures, and the same in standard deviations of the pixels around it, the
    root mean square of theirs."""
    shown = numpy.isfinite(pictures[0])
    away = numpy.abs(pictures - numpy.median(pictures, axis=0))
    deviation = 1.4826 * numpy.median(away, axis=0)  # of a normal distribution; no speck explains itself
    spread = numpy.sqrt(numpy.nanmean(numpy.square(around(deviation)[shown]), axis=-1))
    return away[:, shown], away[:, shown] / spread


def add_options(parser):
    add_common_options(parser, width=160)
    parser.add_argument("--scenes", nargs="+", default=["cumulus-side-lit", "stratus", *SCENES])
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--quality", default="draft")
    parser.add_argument("--factor", type=float, default=1.5)


def pictures_of(lumulus, scene, options):
    """The logarithms of all seeds, [seeds, height, width]."""
    if scene in SCENES:
        name, scene = scene, lumulus.path(scene, suffix=".toml")
        scene.write_text(SCENES[name])
    found = []
    for seed in range(1, options.seeds + 1):
        path = lumulus.path(scene_file(scene).stem, "speck", seed)
        if not path.exists():
            lumulus.render(scene, path, [f"photon_map.seed={seed}"], ["--quality", options.quality])
        found.append(logarithms(read_exr(path)))
    return numpy.stack(found)


def main(options):
    lumulus = Lumulus.of(options, size_sets(options.width))
    table = Table(["scene", "seeds", "pixels", "worst factor", "pixels beyond", "pictures with some",
                   "worst factor from all seeds", "in standard deviations", "beyond six of them"])
    for scene in options.scenes:
        pictures = pictures_of(lumulus, scene, options)
        near = [numpy.exp(from_surroundings(picture)) for picture in pictures]
        many = [int((one > options.factor).sum()) for one in near]
        away, deviations = from_all_seeds(pictures)
        figures = {"scene": scene, "seeds": options.seeds, "pixels": sum(map(len, near)),
                   "worst": max(float(one.max(initial=1.0)) for one in near), "beyond": sum(many),
                   "pictures": sum(n > 0 for n in many), "worst_from_all": float(numpy.exp(away.max(initial=0.0))),
                   "worst_deviation": float(deviations.max(initial=0.0)), "beyond_six": int((deviations > 6.0).sum())}
        table.add(figures, [scene, str(options.seeds), str(figures["pixels"]), f"{figures['worst']:.2f}", str(sum(many)),
                            str(figures["pictures"]), f"{figures['worst_from_all']:.2f}",
                            f"{figures['worst_deviation']:.1f}", str(figures["beyond_six"])])
    write_figures(options, table.figures)
