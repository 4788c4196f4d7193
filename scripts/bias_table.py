#!/usr/bin/env python3
"""What error stays however many photons there are: relMSE by bands, forward cut and way to draw, over shipped scenes.

Each scene is rendered with photons until their noise is below a target (`render --target-error`), compared with two
independent references, and what is left of the noise is subtracted. Prints a Markdown table for docs/error-time.md; its
last column, the largest over the scenes, is what src/progressive/bias.cpp holds.
Run it in the root of the repository after scripts/demo.sh.
"""

import argparse
import json
import pathlib
import subprocess

SCENES = ["cumulus-side-lit", "cumulus-back-lit", "cumulus-front-lit", "cumulus-low-sun"]
# name, overrides
VARIANTS = [(f"{bands} bands", [f"photon_map.bands={bands}"]) for bands in range(1, 9)] + [
    ("5 bands, no cut", ["photon_map.forward_cut=0"]),
    ("5 bands, billboards", ["draw.mode=billboards"]),
]


def run(*words):
    done = subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True)
    return done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lumulus", default="build/release/lumulus")
    parser.add_argument("--folder", type=pathlib.Path, default="build/bias", help="for pictures and references")
    parser.add_argument("--scenes", nargs="+", default=SCENES)
    parser.add_argument("--variants", nargs="+", type=int, default=range(len(VARIANTS)), help="numbers of the rows")
    parser.add_argument("--spp", type=int, default=512, help="of each reference")
    parser.add_argument("--noise", type=float, default=5e-4, help="relMSE of the photons' noise to stop at")
    parser.add_argument("--width", type=int, default=160, help="of the pictures, which are 16:9")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    size = ["--set", f"image.width={options.width}", "--set", f"image.height={options.width * 9 // 16}"]

    print("| march, cut 12° unless said | " + " | ".join(options.scenes) + " | largest |")
    print("|---" * (len(options.scenes) + 2) + "|")
    truths = {}
    for scene in options.scenes:
        truths[scene] = [options.folder / f"{scene}-{seed}.exr" for seed in (101, 102)]
        for seed, truth in zip((101, 102), truths[scene]):
            run(options.lumulus, "reference", f"configs/scenes/{scene}.toml", "-o", truth, "--spp", options.spp,
                "--majorant", "local", "--seed", seed, "--quiet", *size)
    for number in options.variants:
        name, sets = VARIANTS[number]
        left = []
        for scene in options.scenes:
            picture = options.folder / f"{scene}.exr"
            stats = json.loads(run(options.lumulus, "render", f"configs/scenes/{scene}.toml", "-o", picture, "--quiet",
                                   "--target-error", options.noise, "--stats", "-", *size,
                                   *(word for one in sets for word in ("--set", one))))
            error = json.loads(run(options.lumulus, "compare", picture, *truths[scene], "--json"))["relmse"]
            left.append(error - stats["progressive"]["noise"])
        print(f"| {name} | " + " | ".join(f"{value:.4f}" for value in left) + f" | {max(left):.4f} |", flush=True)


if __name__ == "__main__":
    main()
