"""How near are pictures of several clouds to the path tracer? A row a scene: two clouds that overlap, one in the other's
shadow, a field that covers three tenths of the sky from the ground and from 3 km under a high, a low and a very low sun, and
clouds above the ground.

Two references judge a picture, so that their own noise is not in its relMSE. They are taken up where they are: with --folder,
run the study again with more samples to have less noise.
"""

from study.lumulus import Lumulus, add_common_options
from study.program import size_sets
from study.tables import Table, write_figures

# elevation, and irradiance before a constant sky
SUNS = {60: "", 20: "irradiance = [5.0, 4.3, 3.3]\n", 5: "irradiance = [3.2, 2.1, 1.0]\n"}

CLOUD = """[[cloud]]
procedural = "cumulus"
resolution = {resolution}
seed = {seed}
extinction = {extinction}
transform = [[{scale}, 0.0, 0.0, {x}], [0.0, {scale}, 0.0, {y}], [0.0, 0.0, {scale}, {z}]]
"""

FIELD = """[preparation]
samples = 2500
[[field]]
kind = "cumulus"
cover = 0.3
base = 1000.0
area = [8000.0, 0.0, 8000.0]
smallest = 300.0
largest = 1500.0
seed = 3
resolution = 48
"""

FROM_GROUND = """[camera]
position = [0.0, 2.0, 5000.0]
target = [0.0, 1300.0, 0.0]
vertical_fov = 50.0
"""

FROM_ABOVE = """[camera]
position = [0.0, 3000.0, 6000.0]
target = [0.0, 1200.0, 1000.0]
vertical_fov = 50.0
"""


def cloud(seed, x, y, z, scale=1.0, extinction=0.06, resolution=64):
    return CLOUD.format(seed=seed, x=x, y=y, z=z, scale=scale, extinction=extinction, resolution=resolution)


def scene(sky, camera, azimuth, elevation, irradiance, rest):
    model = "radiance = [0.09, 0.17, 0.34]" if sky == "constant" else 'model = "atmosphere"'
    sun = irradiance if sky == "constant" else ""
    return f"[sky]\n{model}\n[sun]\nazimuth = {azimuth}\nelevation = {elevation}\n{sun}{camera}{rest}"


NEAR = "[camera]\nvertical_fov = 36.0\n"
BESIDE = (75.0, 22.0, "irradiance = [5.0, 4.6, 3.9]\n")
GROUND = "[ground]\nalbedo = 0.3\nheight = -400.0\n"


def scenes(sky):
    """The text of each scene file, by its name, before a constant sky or in the atmosphere."""
    below = "" if sky == "constant" else GROUND  # the ground of the planet lies at 0 otherwise, in the clouds
    overlap = cloud(1, 0.0, 0.0, 0.0) + cloud(5, 300.0, 60.0, 80.0, 0.8)
    found = {"two that overlap": scene(sky, NEAR, *BESIDE, below + overlap),
             "one in the shadow of the other": scene(sky, NEAR, *BESIDE, below + cloud(1, -250.0, -120.0, 0.0, 0.8) +
                                                     cloud(5, 700.0, 300.0, 60.0, 0.8))}
    for elevation, irradiance in SUNS.items():
        sun = (60.0, float(elevation), irradiance)
        found[f"field from the ground, sun at {elevation}"] = scene(sky, FROM_GROUND, *sun, FIELD)
        found[f"field from 3 km, sun at {elevation}"] = scene(sky, FROM_ABOVE, *sun, FIELD)
    found["two that overlap, above the ground"] = scene(sky, NEAR, *BESIDE, GROUND + overlap)
    return found


def add_options(parser):
    add_common_options(parser, width=160)
    parser.add_argument("--sky", choices=["constant", "atmosphere"], default="constant")
    parser.add_argument("--scenes", nargs="+", help="those whose name has one of these words (default: all)")
    parser.add_argument("--quality", default="final")
    parser.add_argument("--photons", type=int, help="in the place of those of the quality")
    parser.add_argument("--spp", type=int, default=256, help="of each of the two references")
    parser.add_argument("--references-only", action="store_true", help="make no pictures")


def wanted(options):
    """Name and text of the scenes that the command line asks for."""
    return {name: text for name, text in scenes(options.sky).items()
            if not options.scenes or any(word in name for word in options.scenes)}


def main(options):
    lumulus = Lumulus.of(options, size_sets(options.width))
    table = Table(["scene", "relMSE", "bias", "seconds"])
    for name, text in wanted(options).items():
        words = [options.sky, *name.replace(",", "").split()]
        file, picture = lumulus.path(*words, suffix=".toml"), lumulus.path(*words, options.quality)
        file.write_text(text)
        truths = [lumulus.reference(file, lumulus.path(*words, seed), spp=options.spp, seed=seed) for seed in (101, 102)]
        if options.references_only:
            continue
        sets = [f"photon_map.photons={options.photons}"] if options.photons else []
        seconds = lumulus.render(file, picture, sets, ["--quality", options.quality])["seconds"]["total"]
        # divided by the picture's squares, which have less noise than those of references of few samples
        found = lumulus.compare(picture, *truths, denominator=picture)
        error = {key: value or 0.0 for key, value in found["standard_error"].items()}  # none where there is one sample
        table.add({"scene": name, **found, "seconds": seconds},
                  [name, f"{found['relmse']:.5f} ± {error['relmse']:.5f}",
                   f"{100 * found['relative_bias']:+.2f} ± {100 * error['relative_bias']:.2f} %", f"{seconds:.1f}"])
    write_figures(options, table.figures)
