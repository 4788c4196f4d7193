#!/usr/bin/env python3
"""What error stays however many photons there are, over shipped scenes: two Markdown tables for docs/error-time.md, from
whose last columns, the largest over the scenes, src/progressive/bias.cpp has its figures.

Bands: relMSE of pictures with 1 to 6 bands against one with 8 from the same photons, so that there is no noise in it.
The rest: pictures with photons until their noise is low (`render --target-error`) against two independent references,
less the noise. Run it in the root of the repository after scripts/demo.sh.
"""

import argparse
import json
import pathlib
import subprocess

SCENES = ["cumulus-side-lit", "cumulus-back-lit", "cumulus-front-lit", "cumulus-low-sun"]
VARIANTS = {"march": [], "no cut": ["photon_map.forward_cut=0"], "billboards": ["draw.mode=billboards"]}


def run(*words):
    done = subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True)
    return done.stdout


def with_sets(sets):
    return [word for one in sets for word in ("--set", one)]


def table(title, scenes, rows):
    """Prints rows of (name, error by scene) as they come."""
    print(f"| {title} | " + " | ".join(scenes) + " | largest |")
    print("|---" * (len(scenes) + 2) + "|")
    for name, errors in rows:
        print(f"| {name} | " + " | ".join(f"{value:.5f}" for value in errors) + f" | {max(errors):.5f} |", flush=True)
    print()


class Study:
    def __init__(self, options):
        self.options = options
        self.size = with_sets([f"image.width={options.width}", f"image.height={options.width * 9 // 16}"])

    def path(self, *words):
        return self.options.folder / ("-".join(map(str, words)) + ".exr")

    def render(self, scene, output, *more):
        return json.loads(run(self.options.lumulus, "render", f"configs/scenes/{scene}.toml", "-o", output, "--quiet",
                              "--stats", "-", *self.size, *more))

    def relmse(self, picture, *truths):
        return json.loads(run(self.options.lumulus, "compare", picture, *truths, "--json"))["relmse"]

    def bands(self):
        for scene in self.options.scenes:
            self.render(scene, self.path(scene, 8), *with_sets(["photon_map.bands=8"]))
        for bands in range(1, 7):
            errors = []
            for scene in self.options.scenes:
                self.render(scene, self.path(scene, bands), *with_sets([f"photon_map.bands={bands}"]))
                errors.append(self.relmse(self.path(scene, bands), self.path(scene, 8)))
            yield bands, errors

    def rest(self):
        truths = {scene: [self.path(scene, "truth", seed) for seed in (101, 102)] for scene in self.options.scenes}
        for scene, paths in truths.items():
            for seed, path in zip((101, 102), paths):
                run(self.options.lumulus, "reference", f"configs/scenes/{scene}.toml", "-o", path, "--spp",
                    self.options.spp, "--majorant", "local", "--seed", seed, "--quiet", *self.size)
        for name, sets in VARIANTS.items():
            errors = []
            for scene, paths in truths.items():
                picture = self.path(scene, "picture")
                stats = self.render(scene, picture, "--target-error", self.options.noise, *with_sets(sets))
                errors.append(self.relmse(picture, *paths) - stats["progressive"]["noise"])
            yield name, errors


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lumulus", default="build/release/lumulus")
    parser.add_argument("--folder", type=pathlib.Path, default="build/bias", help="for pictures and references")
    parser.add_argument("--scenes", nargs="+", default=SCENES)
    parser.add_argument("--spp", type=int, default=512, help="of each reference")
    parser.add_argument("--noise", type=float, default=5e-4, help="relMSE of the photons' noise to stop at")
    parser.add_argument("--width", type=int, default=160, help="of the pictures, which are 16:9")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    study = Study(options)
    table("bands", options.scenes, study.bands())
    table("many photons", options.scenes, study.rest())


if __name__ == "__main__":
    main()
