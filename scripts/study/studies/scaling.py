"""Time and memory against the number of voxels, of collectors and of photons. Three Markdown tables.

    scripts/study/run scaling --json build/scaling.json
"""

from study.lumulus import Lumulus, add_common_options
from study.program import size_sets
from study.tables import Table, write_figures

SCENE = "cumulus-side-lit"
PARTS = ["load", "prepare", "trace", "draw", "total"]  # of a run's seconds
TITLES = [f"{part} s" for part in PARTS] + ["collectors", "GPU MiB", "process MiB"]


def figures_of(stats):
    return {**{name: stats["seconds"][name] for name in PARTS},
            **{name: stats[name] for name in ("photons", "collectors", "gpu_bytes", "rss_bytes", "events")}}


def study(lumulus, title, values, sets_of, text=str):
    """One table: a picture for each of the values, the second of two for the first one, which compiles shaders."""
    print()
    table = Table([title] + TITLES)
    for value in values:
        stats = lumulus.render(SCENE, lumulus.path("picture"), sets_of(value))
        if value == values[0]:
            stats = lumulus.render(SCENE, lumulus.path("picture"), sets_of(value))
        found = figures_of(stats)
        table.add({title: value, **found},
                  [text(value)] + [f"{found[name]:.2f}" for name in PARTS] +
                  [str(found["collectors"])] + [f"{found[name] / 2**20:.0f}" for name in ("gpu_bytes", "rss_bytes")])
    return table.figures


def add_options(parser):
    add_common_options(parser, width=1280)
    parser.add_argument("--resolutions", nargs="*", type=int, default=[64, 128, 256, 512])
    parser.add_argument("--collectors", nargs="*", type=int, default=[1000, 10000, 30000, 100000])
    parser.add_argument("--photons", nargs="*", type=float, default=[1e5, 1e6, 1e7, 1e8])


def main(options):
    lumulus = Lumulus.of(options, size_sets(options.width))
    figures = {}
    if options.resolutions:
        figures["voxels"] = study(lumulus, "voxels along the longest side", options.resolutions,
                                  lambda n: [f"cloud.0.resolution={n}"])
    if options.collectors:
        # samples make leaves; an optically thin cloud is not split further
        figures["collectors"] = study(lumulus, "collectors at most", options.collectors,
                                      lambda n: [f"preparation.samples={n}", f"preparation.max_leaves={n}",
                                                 "preparation.density_threshold=0.01"])
    if options.photons:
        figures["photons"] = study(lumulus, "photons", [int(n) for n in options.photons],
                                   lambda n: [f"photon_map.photons={n}",
                                              f"photon_map.generations={max(1, n // 200000)}"], "{:.0e}".format)
    write_figures(options, figures)
