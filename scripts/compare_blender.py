"""Renders a scene with Blender's Cycles at growing samples, measures it like `lumulus bench`, and makes its plot with the
points of all three: error.svg, error.csv, cycles.csv. Prints how far means of blocks are from the reference's, which
tells whether both render the same scene. Start it by scripts/compare-blender.sh, after scripts/build.sh."""

import argparse
import json
import math
import pathlib
import re
import statistics
import time

from measuring import ROOT, Failure, output_of, read_exr, run, with_sets

COLUMNS = ["seconds", "seconds_without_warmup", "photons_or_spp", "relMSE", "RMSE", "FLIP", "bias", "relative_bias"]


def cycles_run(options, picture, samples, seed):
    """Renders one picture: seconds of the whole process, and of the rendering alone."""
    start = time.monotonic()
    said = output_of("blender", "-b", "--factory-startup", "--python-exit-code", 1, "-P", ROOT / "scripts" / "cycles_scene.py", "--",
                     options.output, picture, samples, seed, options.step_rate)
    found = re.search(r"^cycles seconds (\S+)$", said, re.MULTILINE)
    if not found:
        raise Failure("Blender did not render: " + " / ".join(said.strip().splitlines()[-2:]))
    return time.monotonic() - start, float(found[1])


def measure(options, picture, exposure):
    found = json.loads(output_of(options.lumulus, "compare", picture, options.reference, "--json", "--exposure", exposure))
    return [found["relmse"] - (found["reference_noise"] or 0.0), found["rmse"], found["flip"], found["bias"],
            found["relative_bias"]]


def csv_row(warm, runs):
    """A row of error.csv from the values of each seed, in the order of COLUMNS."""
    words = ["Cycles", f"{warm:.6g}", str(len(runs))]
    for values in zip(*runs):
        words += [f"{statistics.mean(values):.6g}", f"{statistics.stdev(values) if len(runs) > 1 else 0.0:.3g}"]
    return ",".join(words)


def block_means(path, across, weights):
    """Means of luminance over blocks of pixels with cloud (weights), and how many pixels they have."""
    width, height, layers, _ = read_exr(path)
    edge = max(1, width // across)
    sums = {}
    for i, weight in enumerate(weights):
        if weight:
            block = (i // width // edge, i % width // edge)
            light = sum(share * layers[name][i] for share, name in ((.2126, "R"), (.7152, "G"), (.0722, "B")))
            total, count = sums.get(block, (0.0, 0))
            sums[block] = (total + light, count + 1)
    return {block: (total / count, count) for block, (total, count) in sums.items() if count >= edge * edge / 2}


def compare_blocks(pictures, reference, across=8):
    """Text: deviations of Cycles' mean picture from the reference over blocks, in percent of the reference."""
    _, _, layers, _ = read_exr(reference)
    weights = [t < 0.999 for t in layers["transmittance.G"]]
    truth = block_means(reference, across, weights)
    each = [block_means(picture, across, weights) for picture in pictures]
    off, noise = [], []
    for block, (mean, _) in truth.items():
        values = [means[block][0] for means in each]
        off.append(100.0 * (statistics.mean(values) / mean - 1.0))
        if len(values) > 1:
            noise.append(100.0 * statistics.stdev(values) / math.sqrt(len(values)) / mean)
    text = (f"means of {len(off)} blocks against the reference: {statistics.mean(off):+.2f} % on average, "
            f"rms {math.sqrt(statistics.mean(o * o for o in off)):.2f} %, largest {max(off, key=abs):+.2f} %")
    return text + (f"; noise of Cycles in them: {math.sqrt(statistics.mean(n * n for n in noise)):.2f} %" if noise else "")


def parse():
    parser = argparse.ArgumentParser(prog="compare-blender.sh", description=__doc__)
    parser.add_argument("scene")
    parser.add_argument("--reference", required=True, help="by `lumulus reference`, of the scene's size")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="folder")
    parser.add_argument("--samples", default="1,4,16,64", help="of each pixel, growing")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--step-rate", type=float, default=1.0, help="of Cycles' march, in voxels; .25 to check means")
    parser.add_argument("--set", action="append", default=[], help="override section.key=value; may repeat")
    parser.add_argument("--seconds", default="0.3,1,3", help="budgets of `lumulus bench`; empty: leave it out")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release")
    options = parser.parse_args()
    options.lumulus = options.build / "lumulus"
    return options


def main():
    options = parse()
    output_of(options.build / "tests" / "export_scene", options.scene, options.output, *options.set)
    exposure = json.loads((options.output / "scene.json").read_text())["exposure"]
    lines = [",".join(["method", "budget", "seeds"] + [f"{name},{name}_spread" for name in COLUMNS])]
    for samples in map(int, options.samples.split(",")):
        runs, pictures = [], []
        for seed in range(1, options.seeds + 1):
            pictures.append(options.output / f"cycles-{samples}-{seed}.exr")
            whole, warm = cycles_run(options, pictures[-1], samples, seed)
            runs.append([whole, warm, samples] + measure(options, pictures[-1], exposure))
        lines.append(csv_row(statistics.mean(run[1] for run in runs), runs))
        print(f"Cycles, {samples} samples: {statistics.mean(run[0] for run in runs):.2f} s, relMSE "
              f"{statistics.mean(run[3] for run in runs):.3g}", flush=True)
    print(compare_blocks(pictures, options.reference))
    table = options.output / "cycles.csv"
    table.write_text("\n".join(lines) + "\n")
    if options.seconds:
        print(output_of(options.lumulus, "bench", options.scene, "--reference", options.reference, "-o", options.output,
                        "--seconds", options.seconds, "--seeds", options.seeds, "--quiet", "--cycles", table,
                        *with_sets(options.set)), end="")


if __name__ == "__main__":
    run(main)
