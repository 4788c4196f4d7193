"""Time to a relMSE of 0.003 in large pictures. `render`, as a whole process with its shaders in Mesa's cache and without,
against the path tracer's samples without its loading. Errors are the mean product of a picture's errors against two
references of few samples, divided by the picture's squares (study large_score); between `interactive`, four times its
photons and `final` time is interpolated along straight lines of logarithms. `--target-error 0.003` is there for what it
takes until the program says so itself.

    scripts/study/run large_pictures cumulus-side-lit cirrus --spp 24 --folder build/large
"""

import math
import tempfile

import numpy

from study.lumulus import Lumulus, add_common_options
from study.pictures import read_exr
from study.program import Failure, size_sets
from study.studies.large_score import tracer_error
from study.tables import Table, write_figures

GOAL = 0.003
WAYS = {"interactive": ["--quality", "interactive"],
        "more": ["--quality", "interactive", "--set", "photon_map.photons=8e6"],
        "final": ["--quality", "final"],
        "target": ["--target-error", str(GOAL)]}


def optical_depth(lumulus, scene, shown):
    """Mean over the pixels in which `shown` has a cloud: from a cloud so thin that no depth is cut off."""
    thinner = 0.01
    path = lumulus.path(scene, "thin")
    lumulus.render(scene, path, [f"cloud.0.density_scale={thinner}", "photon_map.photons=1000"])
    cloud = read_exr(shown)["transmittance.R"] < 0.999
    transmittance = numpy.clip(read_exr(path)["transmittance.R"][cloud], 1e-30, 1.0)
    return float(numpy.mean(-numpy.log(transmittance)) / thinner)


def sample_seconds(lumulus, scene, spp):
    """References of two seeds, and the time of one sample: the difference of many and of one."""
    pictures, seconds = [], []
    for seed, samples in ((101, spp), (102, spp), (103, 1)):
        pictures.append(lumulus.path(scene, "truth", seed))
        seconds.append(lumulus.new_reference(scene, pictures[-1], spp=samples, seed=seed).seconds)
    return pictures[:2], (seconds[0] + seconds[1] - 2 * seconds[2]) / (2 * (spp - 1))


def rendered(lumulus, scene, name):
    """Path, seconds with shaders in the cache, seconds without."""
    path = lumulus.path(scene, name)
    with tempfile.TemporaryDirectory() as cache:
        cold, warm = (lumulus.render(scene, path, words=WAYS[name], environment={"MESA_SHADER_CACHE_DIR": cache})
                      ["process_seconds"] for _ in range(2))
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
    found = {"scene": scene, "sample_seconds": sample}
    points = []
    for name in WAYS:
        path, warm, cold = rendered(lumulus, scene, name)
        compared = lumulus.compare(path, *truths, denominator=path)
        relmse, deviation = compared["relmse"], compared["standard_error"]["relmse"]
        found[name] = {"relmse": relmse, "deviation": deviation, "seconds": warm, "cold_seconds": cold}
        if name != "target":
            # what the references cannot tell from 0 may be as much as its deviation
            points.append((max(relmse, deviation), warm, cold))
    found["optical_depth"] = optical_depth(lumulus, scene, path)
    found["tracer_seconds"] = spp * tracer_error(compared) / GOAL * sample
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


def add_options(parser):
    add_common_options(parser, width=1280)
    parser.add_argument("scenes", nargs="*", help="default: all")
    parser.add_argument("--spp", type=int, default=24, help="samples of each reference (default %(default)s)")


def main(options):
    if options.spp < 2:
        raise Failure("--spp has to be 2 at least")
    lumulus = Lumulus.of(options, size_sets(options.width))
    table = Table(["scene", "optical depth", "interactive: relMSE, s (cold)", "the same, 8 M photons", "final",
                   f"--target-error {GOAL}", f"{GOAL} after", "path tracer (a sample)", "ratio (cold)"])
    for scene in lumulus.scenes(options.scenes):
        found = measure(lumulus, scene, options.spp)
        table.add(found, texts_of(found))
    write_figures(options, table.figures)
