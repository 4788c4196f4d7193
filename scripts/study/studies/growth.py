"""Growth of time with pixels and with photons. A plot, and the slopes on doubly logarithmic paper (1: linear). Needs Debian's
python3-matplotlib.

    scripts/study/run growth -o docs/images/growth.svg --json build/growth.json
"""

import pathlib

import numpy

from study.lumulus import Lumulus, add_common_options
from study.program import Failure, size_sets
from study.tables import write_figures

SCENE = "cumulus-side-lit"


def slope(xs, ys):
    """Of the straight line of least squares through the logarithms."""
    return float(numpy.polyfit(numpy.log(xs), numpy.log(ys), 1)[0])


def measure(lumulus, name, sets):
    """Seconds of one part of the run and of all of it, the less of three: the first may compile shaders."""
    runs = [lumulus.render(SCENE, lumulus.path("picture"), sets)["seconds"] for _ in range(3)]
    return min(seconds[name] for seconds in runs), min(seconds["total"] for seconds in runs)


def with_pixels(lumulus, widths, mode):
    few = ["photon_map.photons=100000", "photon_map.generations=1", f"draw.mode={mode}"]
    return [(w * (w * 9 // 16), *measure(lumulus, "draw", size_sets(w) + few)) for w in widths]


def with_photons(lumulus, numbers):
    return [(n, *measure(lumulus, "trace", size_sets(64) + [f"photon_map.photons={n}", "photon_map.generations=10"]))
            for n in numbers]


def figures_of(name, points):
    """Of the part, and of the process as a whole."""
    xs, parts, wholes = zip(*points)
    return {title: {"points": list(zip(xs, ys)), "slope": slope(xs, ys), "last_slope": slope(xs[-2:], ys[-2:])}
            for title, ys in ((name, parts), (f"{name}, process", wholes))}


def plot(figures, path):
    try:
        import matplotlib
        matplotlib.use("svg")
        from matplotlib import pyplot
    except ImportError as missing:
        raise Failure(f"{missing}: as root, run apt-get install python3-matplotlib") from None
    matplotlib.rcParams.update({"svg.hashsalt": "lumulus", "font.size": 9})
    picture, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.6))
    for axes, names, title in ((left, ["march", "billboards"], "pixels"), (right, ["tracing"], "photons")):
        for name in (one for part in names for one in (part, f"{part}, process")):
            xs, ys = zip(*figures[name]["points"])
            axes.loglog(xs, ys, "o-", label=f"{name}: slope {figures[name]['slope']:.2f}")
        xs, ys = zip(*figures[names[0]]["points"])
        axes.loglog(xs, [ys[-1] * x / xs[-1] for x in xs], ":", color="grey", label="linear")
        axes.set_xlabel(title)
        axes.set_ylabel("seconds")
        axes.grid(True, which="both", alpha=0.3)
        axes.legend()
    picture.tight_layout()
    picture.savefig(path, metadata={"Date": None})


def add_options(parser):
    add_common_options(parser)
    parser.add_argument("--widths", nargs="+", type=int, default=[160, 320, 640, 1280, 2560])
    parser.add_argument("--photons", nargs="+", type=float, default=[1e5, 3e5, 1e6, 3e6, 1e7])
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)


def main(options):
    lumulus = Lumulus.of(options)
    figures = {}
    for mode in ("march", "billboards"):
        figures |= figures_of(mode, with_pixels(lumulus, options.widths, mode))
    figures |= figures_of("tracing", with_photons(lumulus, [int(n) for n in options.photons]))
    for name, found in figures.items():
        print(f"{name}: slope {found['slope']:.2f}, between the last two {found['last_slope']:.2f}: " +
              ", ".join(f"{x} in {y:.2f} s" for x, y in found["points"]), flush=True)
    plot(figures, options.output)
    write_figures(options, figures)
