#!/usr/bin/python3
"""Time to a relMSE of .003 in large pictures: `render`, as a whole process with its shaders in Mesa's cache and without,
against the path tracer's samples without its loading. Errors are the mean product of a picture's errors against two
references of few samples (scripts/large_score.py); between `interactive` and `final` time is interpolated along the
straight line of logarithms. Needs Debian's python3-numpy.

    scripts/large_pictures.py cumulus-side-lit cirrus --spp 24 --folder build/large
"""

import math
import os
import tempfile
import time

from large_score import layers_of, score, squares_of
from measuring import ROOT, Failure, Lumulus, Table, finish, parser_of, run, size_sets

import numpy

GOAL = 0.003
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


def rendered(lumulus, scene, quality):
    """Path, seconds with shaders in the cache, seconds without."""
    path = lumulus.path(scene, quality)
    with tempfile.TemporaryDirectory() as cache:
        os.environ[MESA_CACHE] = cache
        try:
            cold, warm = (timed(lambda: lumulus.render(scene, path, words=["--quality", quality]))[0] for _ in range(2))
        finally:
            del os.environ[MESA_CACHE]
    return path, warm, cold


def time_to_goal(first, second):
    """Seconds at GOAL from two points (relMSE, seconds); where the first is there already, its seconds."""
    (error, seconds), (less, more) = first, second
    if error <= GOAL:
        return seconds
    if less > GOAL:
        return math.inf
    share = math.log(error / GOAL) / math.log(error / less)
    return seconds * (more / seconds) ** share


def measure(lumulus, scene, spp):
    truths, sample = sample_seconds(lumulus, scene, spp)
    references = [layers_of(path) for path in truths]
    found = {"scene": scene, "sample_seconds": sample}
    points = {}
    for quality in ("interactive", "final"):
        path, warm, cold = rendered(lumulus, scene, quality)
        layers = layers_of(path)
        cloud = layers["transmittance.R"] < 0.999
        squares = squares_of(layers, cloud)
        relmse, deviation = score(layers, *references, cloud, squares)
        # what the references cannot tell from 0 may be as much as its deviation
        points[quality] = (max(relmse, deviation), warm, cold)
        found[quality] = {"relmse": relmse, "deviation": deviation, "seconds": warm, "cold_seconds": cold}
    # by the squares of `final`, the best picture there is
    tracer = numpy.mean([0.5 * (references[0][c][cloud] - references[1][c][cloud]) ** 2 / squares[c] for c in "RGB"])
    found["optical_depth"] = optical_depth(lumulus, scene, cloud)
    found["tracer_seconds"] = float(spp * tracer / GOAL * sample)
    for name, column in (("goal_seconds", 1), ("goal_cold_seconds", 2)):
        found[name] = time_to_goal(*((points[q][0], points[q][column]) for q in ("interactive", "final")))
    return found


def texts_of(found):
    def error(quality):
        one = found[quality]
        return f"{one['relmse']:.4f} ± {one['deviation']:.4f}, {one['seconds']:.1f} s ({one['cold_seconds']:.1f})"

    sign = "≤ " if found["interactive"]["relmse"] <= GOAL else ""
    return [found["scene"], f"{found['optical_depth']:.1f}", error("interactive"), error("final"),
            f"{sign}{found['goal_seconds']:.1f} s", f"{found['tracer_seconds']:,.0f} s ({found['sample_seconds']:.2f})",
            f"{found['tracer_seconds'] / found['goal_seconds']:,.0f}",
            f"{found['tracer_seconds'] / found['goal_cold_seconds']:,.0f}"]


def main():
    parser = parser_of(__doc__, width=1280)
    parser.add_argument("scenes", nargs="*", help="default: all")
    parser.add_argument("--spp", type=int, default=24, help="samples of each reference (default %(default)s)")
    options = parser.parse_args()
    if options.spp < 2:
        raise Failure("--spp has to be 2 at least")
    lumulus = Lumulus(options)
    lumulus.sets += size_sets(options.width)
    for scene in options.scenes:
        if not (ROOT / f"configs/scenes/{scene}.toml").exists():
            raise Failure(f"no scene {scene} in configs/scenes")
    table = Table(["scene", "optical depth", "interactive: relMSE, s (cold)", "final", "3e-3", "path tracer (a sample)",
                   "ratio", "cold"])
    for scene in lumulus.scenes(options.scenes):
        found = measure(lumulus, scene, options.spp)
        table.add(found, texts_of(found))
    finish(options, table.figures)


if __name__ == "__main__":
    run(main)
