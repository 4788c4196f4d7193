#!/usr/bin/python3
"""Time to a relMSE of .003 in large pictures: `render`, as a whole process with its shaders in Mesa's cache and without,
against the path tracer's samples without its loading. Errors are the mean product of a picture's errors against two
references of few samples (scripts/large_score.py); between `interactive`, four times its photons and `final` time is
interpolated along straight lines of logarithms. `--target-error .003` is there for what it takes until the program says
so itself. Needs Debian's python3-numpy.

    scripts/large_pictures.py cumulus-side-lit cirrus --spp 24 --folder build/large
"""

import math
import os
import tempfile
import time

from large_score import layers_of, score, squares_of
from measuring import Failure, Lumulus, Table, finish, parser_of, run, size_sets

import numpy

GOAL = 0.003
WAYS = {"interactive": ["--quality", "interactive"],
        "more": ["--quality", "interactive", "--set", "photon_map.photons=8e6"],
        "final": ["--quality", "final"],
        "target": ["--target-error", str(GOAL)]}
MESA_CACHE = "MESA_SHADER_CACHE_DIR"


def timed(work):
    start = time.monotonic()
    done = work()
    return time.monotonic() - start, done


def optical_depth(lumulus, scene, cloud):
    """Mean over the pixels in which the cloud is seen: from a cloud so thin that no depth is cut off."""
    thinner = 0.01
    path = lumulus.path(scene, "thin")
    lumulus.render(scene, path, [f"cloud.0.density_scale={thinner}", "photon_map.photons=1000"])
    transmittance = numpy.clip(layers_of(path)["transmittance.R"][cloud], 1e-30, 1.0)
    return float(numpy.mean(-numpy.log(transmittance)) / thinner)


def sample_seconds(lumulus, scene, spp):
    """References of two seeds, and the time of one sample: the difference of many and of one."""
    pictures, seconds = [], []
    for seed, samples in ((101, spp), (102, spp), (103, 1)):
        path = lumulus.path(scene, "truth", seed)
        for old in (path, path.with_name(path.name + ".sums")):
            old.unlink(missing_ok=True)
        seconds.append(timed(lambda: lumulus.reference(scene, path, spp=samples, seed=seed))[0])
        pictures.append(path)
    return pictures[:2], (seconds[0] + seconds[1] - 2 * seconds[2]) / (2 * (spp - 1))


def rendered(lumulus, scene, name):
    """Path, seconds with shaders in the cache, seconds without."""
    path = lumulus.path(scene, name)
    with tempfile.TemporaryDirectory() as cache:
        os.environ[MESA_CACHE] = cache
        try:
            cold, warm = (timed(lambda: lumulus.render(scene, path, words=WAYS[name]))[0] for _ in range(2))
        finally:
            del os.environ[MESA_CACHE]
    return path, warm, cold


def time_to_goal(points):
    """Seconds at GOAL from (relMSE, seconds) in the order of their seconds; of the first where it is there already."""
    error, seconds = points[0]
    if error <= GOAL:
        return seconds
    for less, more in points[1:]:
        if less <= GOAL:
            return seconds * (more / seconds) ** (math.log(error / GOAL) / math.log(error / less))
        error, seconds = less, more
    return math.inf


def measure(lumulus, scene, spp):
    truths, sample = sample_seconds(lumulus, scene, spp)
    references = [layers_of(path) for path in truths]
    found = {"scene": scene, "sample_seconds": sample}
    points = []
    for name in WAYS:
        path, warm, cold = rendered(lumulus, scene, name)
        layers = layers_of(path)
        cloud = layers["transmittance.R"] < 0.999
        squares = squares_of(layers, cloud)
        relmse, deviation = score(layers, *references, cloud, squares)
        found[name] = {"relmse": relmse, "deviation": deviation, "seconds": warm, "cold_seconds": cold}
        if name != "target":
            # what the references cannot tell from 0 may be as much as its deviation
            points.append((max(relmse, deviation), warm, cold))
    tracer = numpy.mean([0.5 * (references[0][c][cloud] - references[1][c][cloud]) ** 2 / squares[c] for c in "RGB"])
    found["optical_depth"] = optical_depth(lumulus, scene, cloud)
    found["tracer_seconds"] = float(spp * tracer / GOAL * sample)
    found["goal_seconds"] = time_to_goal([(error, warm) for error, warm, _ in points])
    found["goal_cold_seconds"] = time_to_goal([(error, cold) for error, _, cold in points])
    return found


def texts_of(found):
    def error(name):
        one = found[name]
        return f"{one['relmse']:.4f} ± {one['deviation']:.4f}, {one['seconds']:.1f} s ({one['cold_seconds']:.1f})"

    tracer = f"{found['tracer_seconds']:,.0f} s ({found['sample_seconds']:.2f})"
    start = [found["scene"], f"{found['optical_depth']:.1f}", *(error(name) for name in WAYS)]
    if math.isinf(found["goal_seconds"]):
        return [*start, "not reached, or too few samples", tracer, ""]
    sign = "≤ " if found["goal_seconds"] == found["interactive"]["seconds"] else ""
    ratios = [found["tracer_seconds"] / found[name] for name in ("goal_seconds", "goal_cold_seconds")]
    return [*start, f"{sign}{found['goal_seconds']:.1f} s", tracer, "{:,.0f} ({:,.0f})".format(*ratios)]


def main():
    parser = parser_of(__doc__, width=1280)
    parser.add_argument("scenes", nargs="*", help="default: all")
    parser.add_argument("--spp", type=int, default=24, help="samples of each reference (default %(default)s)")
    options = parser.parse_args()
    if options.spp < 2:
        raise Failure("--spp has to be 2 at least")
    lumulus = Lumulus(options)
    lumulus.sets += size_sets(options.width)
    scenes = lumulus.scenes(options.scenes)
    table = Table(["scene", "optical depth", "interactive: relMSE, s (cold)", "the same, 8 M photons", "final",
                   "--target-error .003", "3e-3 after", "path tracer (a sample)", "ratio (cold)"])
    for scene in scenes:
        found = measure(lumulus, scene, options.spp)
        table.add(found, texts_of(found))
    finish(options, table.figures)


if __name__ == "__main__":
    run(main)
