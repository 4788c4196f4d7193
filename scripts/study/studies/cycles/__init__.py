"""Error against time of Blender's Cycles beside lumulus's. Renders a scene with Cycles at growing samples (the same density,
camera, sun and sky), measures it like `lumulus bench`, and makes its plot with the points of all three: error.svg,
error.csv, cycles.csv. Prints how far means of blocks are from the reference's, which tells whether both render the same
scene. Needs Blender (Debian package `blender`, 3.4) and the whole build.

    scripts/study/run cycles configs/scenes/cumulus-side-lit.toml --reference truth.exr -o build/cycles
"""

import json
import math
import pathlib
import re
import shutil
import statistics

import numpy

from study.lumulus import Lumulus
from study.pictures import read_exr, rgb
from study.program import ROOT, Failure, succeeded, with_sets

COLUMNS = ["seconds", "seconds_without_warmup", "photons_or_spp", "relMSE", "RMSE", "FLIP", "bias", "relative_bias"]
LUMINANCE = (0.2126, 0.7152, 0.0722)  # of linear Rec. 709
BLOCKS = 8  # across the picture


def cycles_run(options, picture, samples, seed):
    """Renders one picture: seconds of the whole process, and of the rendering alone."""
    script = pathlib.Path(__file__).with_name("blender_scene.py")
    done = succeeded("blender", "-b", "--factory-startup", "--python-exit-code", 1, "-P", script, "--", options.output,
                     picture, samples, seed, options.step_rate)
    found = re.search(r"^cycles seconds (\S+)$", done.output, re.MULTILINE)
    if not found:
        raise Failure("Blender did not render: " + " / ".join(done.output.strip().splitlines()[-2:]))
    return done.seconds, float(found[1])


def measure(lumulus, options, picture, exposure):
    """The last five of the COLUMNS."""
    found = lumulus.compare(picture, options.reference, words=["--exposure", exposure])
    return [found["relmse"] - (found["reference_noise"] or 0.0), found["rmse"], found["flip"], found["bias"],
            found["relative_bias"]]


def csv_row(warm, runs):
    """A row of error.csv from the values of each seed, in the order of COLUMNS."""
    words = ["Cycles", f"{warm:.6g}", str(len(runs))]
    for values in zip(*runs):
        words += [f"{statistics.mean(values):.6g}", f"{statistics.stdev(values) if len(runs) > 1 else 0.0:.3g}"]
    return ",".join(words)


def block_means(path, cloud):
    """Mean luminance of each block whose pixels show the cloud to a half at least; NaN for the others."""
    light = rgb(read_exr(path)) @ LUMINANCE
    height, width = cloud.shape
    edge = max(1, width // BLOCKS)
    rows, columns = height // edge, width // edge

    def sums(values):
        return values[:rows * edge, :columns * edge].reshape(rows, edge, columns, edge).sum(axis=(1, 3))

    count = sums(cloud.astype(float))
    return numpy.where(count >= edge * edge / 2, sums(light * cloud) / numpy.maximum(count, 1.0), numpy.nan)


def compare_blocks(pictures, reference):
    """Text: deviations of Cycles' mean picture from the reference over blocks, in percent of the reference."""
    cloud = read_exr(reference)["transmittance.G"] < 0.999
    truth = block_means(reference, cloud)
    each = numpy.array([block_means(picture, cloud) for picture in pictures])
    seen = numpy.isfinite(truth)
    off = 100.0 * (each.mean(axis=0) / truth - 1.0)[seen]
    text = (f"means of {off.size} blocks against the reference: {off.mean():+.2f} % on average, "
            f"rms {math.sqrt((off**2).mean()):.2f} %, largest {off[numpy.abs(off).argmax()]:+.2f} %")
    if len(pictures) < 2:
        return text
    noise = (100.0 * each.std(axis=0, ddof=1) / math.sqrt(len(pictures)) / truth)[seen]
    return text + f"; noise of Cycles in them: {math.sqrt((noise**2).mean()):.2f} %"


def add_options(parser):
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--reference", type=pathlib.Path, required=True, help="by `lumulus reference`, of the scene's size")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="folder")
    parser.add_argument("--samples", nargs="+", type=int, default=[1, 4, 16, 64], help="of each pixel, growing")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--step-rate", type=float, default=1.0, help="of Cycles' march, in voxels; 0.25 to check means")
    parser.add_argument("--set", action="append", default=[], help="override section.key=value; may repeat")
    parser.add_argument("--seconds", default="0.3,1,3", help="budgets of `lumulus bench`; empty: leave it out")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release", help="folder of the executables")


def main(options):
    if not shutil.which("blender"):
        raise Failure("there is no Blender: as root, run apt-get install --no-install-recommends blender")
    options.output.mkdir(parents=True, exist_ok=True)
    lumulus = Lumulus(options.build / "lumulus", options.output)
    succeeded(options.build / "tests/export_scene", options.scene, options.output, *options.set)
    exposure = json.loads((options.output / "scene.json").read_text())["exposure"]
    lines = [",".join(["method", "budget", "seeds"] + [f"{name},{name}_spread" for name in COLUMNS])]
    for samples in options.samples:
        runs, pictures = [], []
        for seed in range(1, options.seeds + 1):
            pictures.append(lumulus.path("cycles", samples, seed))
            whole, warm = cycles_run(options, pictures[-1], samples, seed)
            runs.append([whole, warm, samples] + measure(lumulus, options, pictures[-1], exposure))
        lines.append(csv_row(statistics.mean(run[1] for run in runs), runs))
        print(f"Cycles, {samples} samples: {statistics.mean(run[0] for run in runs):.2f} s, relMSE "
              f"{statistics.mean(run[3] for run in runs):.3g}", flush=True)
    print(compare_blocks(pictures, options.reference))
    table = options.output / "cycles.csv"
    table.write_text("\n".join(lines) + "\n")
    if options.seconds:
        print(lumulus.succeeded("bench", options.scene, "--reference", options.reference, "-o", options.output,
                                "--seconds", options.seconds, "--seeds", options.seeds, "--quiet", "--cycles", table,
                                *with_sets(options.set)).output, end="")
