"""How do time, memory and error grow with the number of clouds? Fields of cumuli from one in the foreground to the horizon, of
six variants that are rotated: a Markdown table, a row for each number of clouds.

Rows of clouds stand one behind the other, each as wide as the picture is there, so that all of them are seen. `photons` is
the same for all numbers. Noise is the relMSE of two pictures of other photons, halved; the difference that levels of detail
make is that of pictures with and without them, less the noise of both.
"""

import math

from study.lumulus import Lumulus, add_common_options
from study.program import size_sets
from study.tables import Table, write_figures

VARIANTS = 6
FIRST, SPACING = 2000.0, 1400.0  # metres: of the first row, and between rows and clouds
BASE = 600.0
WIDE = 0.55  # of a row, over its distance, on each side: the field of view of 16:9 at 36 degrees

HEAD = """[image]
width = 160
height = 90
[camera]
position = [0.0, 300.0, 0.0]
target = [0.0, 900.0, -2000.0]
vertical_fov = 36.0
[sky]
radiance = [0.11, 0.20, 0.38]
[sun]
azimuth = 75.0
elevation = 30.0
irradiance = [5.0, 4.6, 3.9]
"""


def places(count):
    """(x, z, yaw in degrees) of so many clouds, nearest row first."""
    found, row = [(0.0, -FIRST, 0.0)], 1
    while len(found) < count:
        away = FIRST + SPACING * row
        across = max(1, int(2.0 * WIDE * away / SPACING))
        for i in range(across):
            x = (i - 0.5 * (across - 1)) * SPACING
            x += 400.0 * math.sin(12.9 * (row * 31 + i))  # no rows to be seen
            found.append((x, -away + 400.0 * math.sin(78.2 * (row * 17 + i)), 77.0 * len(found) % 360.0))
        row += 1
    return found[:count]


def scene_of(lumulus, count, resolution):
    """The file of a scene with so many clouds: a table of places for each variant."""
    path = lumulus.path("clouds", count, suffix=".toml")
    found = places(count)
    text = HEAD
    for variant in range(min(VARIANTS, count)):
        table = lumulus.path("places", count, variant, suffix=".csv")
        table.write_text("x,y,z,yaw\n" + "".join(f"{x!r},{BASE},{z!r},{yaw!r}\n" for x, z, yaw in found[variant::VARIANTS]))
        text += (f'[[cloud]]\nname = "variant{variant}"\nprocedural = "cumulus"\nresolution = {resolution}\n'
                 f'seed = {variant + 1}\nextinction = 0.05\ninstances = "{table.name}"\n')
    path.write_text(text)
    return path


def add_options(parser):
    add_common_options(parser, width=320)
    parser.add_argument("--numbers", type=int, nargs="+", default=[1, 5, 20, 50, 100, 200], help="of clouds")
    parser.add_argument("--resolution", type=int, default=96, help="of each cloud")
    parser.add_argument("--photons", type=int, default=1000000)
    parser.add_argument("--compare", type=int, default=0,
                        help="up to so many clouds, compare with pictures without levels of detail")


def measured(lumulus, count, options):
    """The figures of one number of clouds."""
    scene = scene_of(lumulus, count, options.resolution)
    sets = [f"photon_map.photons={options.photons}"]
    picture, other = lumulus.path("picture", count), lumulus.path("other", count)
    stats = lumulus.render(scene, picture, sets)
    lumulus.render(scene, other, [*sets, "photon_map.seed=2"])
    noise = 0.5 * lumulus.compare(other, picture)["relmse"]
    difference = None
    if count <= options.compare:
        whole, seconds = lumulus.path("whole", count), lumulus.path("whole", count, 2)
        full = [*sets, "preparation.level_of_detail=false"]
        lumulus.render(scene, whole, [*full, "photon_map.seed=3"])
        lumulus.render(scene, seconds, [*full, "photon_map.seed=4"])
        own = 0.5 * lumulus.compare(seconds, whole)["relmse"]
        difference = lumulus.compare(picture, whole)["relmse"] - noise - own
    return {"clouds": count, "seconds": stats["seconds"], "gpu_bytes": stats["gpu_bytes"], "rss_bytes": stats["rss_bytes"],
            "collectors": stats["collectors"], "noise": noise, "difference": difference}


def main(options):
    lumulus = Lumulus.of(options, size_sets(options.width))
    table = Table(["clouds", "prepare s", "trace s", "draw s", "trace + draw, times one", "GPU MiB", "process MiB",
                   "collectors of assets", "noise, relMSE", "levels of detail, relMSE"])
    first = None
    for count in options.numbers:
        figures = measured(lumulus, count, options)
        seconds = figures["seconds"]
        work = seconds["trace"] + seconds["draw"]
        first = first or work
        difference = "" if figures["difference"] is None else f"{figures['difference']:.5f}"
        table.add(figures, [str(count), f"{seconds['prepare']:.1f}", f"{seconds['trace']:.1f}", f"{seconds['draw']:.1f}",
                            f"{work / first:.1f}", f"{figures['gpu_bytes'] / 2**20:.0f}",
                            f"{figures['rss_bytes'] / 2**20:.0f}", str(figures["collectors"]), f"{figures['noise']:.5f}",
                            difference])
    write_figures(options, table.figures)
