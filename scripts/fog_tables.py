#!/usr/bin/python3
"""The tables of docs/fog.md: every filter of the fog against the exact one, by scripts/fog_scenes.py's pictures.

    scripts/fog_tables.py LUMULUS [--only filters|turn|sizes|time|picture]

Needs python3-numpy."""

import argparse
import json
import os
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import fog_scenes  # noqa: E402
from exr_reader import read_exr  # noqa: E402

SIZE = (192, 108)
NAIVE = ["fog.filter=naive"]
MASKED = ["fog.filter=masked"]
FILTERS = [
    ("naive", NAIVE),
    ("+ masking", MASKED + ["fog.depth_lookups=0", "fog.separation.strength=0"]),
    ("+ depth blur", MASKED + ["fog.separation.strength=0"]),
    ("+ separation", MASKED),
    ("scatter", ["fog.filter=scatter"]),
]


class Bench:
    """Runs `composite` in a folder of its own; pictures are asked for again and again, the exact ones only once."""

    def __init__(self, lumulus, folder):
        self.lumulus, self.folder, self.exact = lumulus, folder, {}

    def path(self, name):
        return os.path.join(self.folder, name)

    def composite(self, picture, scene, overrides):
        """RGB [height, width, 3] and the statistics."""
        with open(self.path("scene.toml"), "w") as file:
            file.write(scene)
        sets = [word for override in overrides for word in ("--set", override)]
        subprocess.run([self.lumulus, "composite", "--color", self.path(picture), "--scene", self.path("scene.toml"),
                        "-o", self.path("out.exr"), "--stats", self.path("stats.json"), *sets], check=True)
        with open(self.path("stats.json")) as file:
            return rgb(self.path("out.exr")), json.load(file)

    def gathered(self, picture, scene):
        key = (picture, scene)
        if key not in self.exact:
            self.exact[key] = self.composite(picture, scene, ["fog.filter=gather"])[0]
        return self.exact[key]


def rgb(path):
    width, height, layers = read_exr(path)[:3]
    return numpy.stack([numpy.array(layers[name]).reshape(height, width) for name in "RGB"], axis=-1)


def sharp_light(scattering, radiance, distance):
    """The light that stays in its pixel, in a medium that does not absorb."""
    return numpy.exp(-scattering * numpy.minimum(distance, fog_scenes.FOG_ENDS))[..., None] * radiance


def errors(image, exact, sharp):
    """Relative RMSE (of the mean), rms of log10 and share of the energy, of the scattered part."""
    a, b = image - sharp, exact - sharp
    floor = 1e-4 * b.mean()
    logs = numpy.log10(numpy.maximum(a, floor)) - numpy.log10(numpy.maximum(b, floor))
    return numpy.sqrt(((a - b) ** 2).mean()) / b.mean(), numpy.sqrt((logs ** 2).mean()), a.sum() / b.sum()


def filter_table(bench):
    pictures = {"night": fog_scenes.night(*SIZE), "step": fog_scenes.step(*SIZE)}
    for name, (radiance, distance) in pictures.items():
        fog_scenes.write(bench.path(name + ".exr"), radiance, distance)
        print(f"\n{name}\n\n| filter | " + " | ".join(f"σs {s}, g {g}" for s, g in fog_scenes.MEDIA) + " |")
        print("|---|" + "---|" * len(fog_scenes.MEDIA))
        for label, overrides in FILTERS:
            cells = []
            for scattering, g in fog_scenes.MEDIA:
                scene = fog_scenes.scene_text(fog_scenes.medium(scattering, g))
                sharp = sharp_light(scattering, radiance, distance)
                image = bench.composite(name + ".exr", scene, overrides)[0]
                cells.append("{:.3f} / {:.3f} / {:.3f}".format(*errors(image, bench.gathered(name + ".exr", scene), sharp)))
            print(f"| {label} | " + " | ".join(cells) + " |", flush=True)


def turn_table(bench, frames=5, degrees=0.1):
    """A slow turn: rms of the change of scattered light between frames that the exact filter does not show, in parts of
    the rms of its own change."""
    scattering, g = fog_scenes.MEDIA[2]
    scenes = [fog_scenes.scene_text(fog_scenes.medium(scattering, g), i * degrees) for i in range(frames)]
    pictures = [fog_scenes.night(*SIZE, i * degrees) for i in range(frames)]
    for i, picture in enumerate(pictures):
        fog_scenes.write(bench.path(f"turn{i}.exr"), *picture)
    sharp = [sharp_light(scattering, *picture) for picture in pictures]
    exact = [bench.gathered(f"turn{i}.exr", scene) for i, scene in enumerate(scenes)]
    change = numpy.diff(numpy.array(exact) - sharp, axis=0)
    print("\n| filter | change that the exact filter does not show |\n|---|---|")
    for label, overrides in FILTERS:
        images = [bench.composite(f"turn{i}.exr", scene, overrides)[0] for i, scene in enumerate(scenes)]
        excess = numpy.diff(numpy.array(images) - sharp, axis=0) - change
        print(f"| {label} | {numpy.sqrt((excess ** 2).mean() / (change ** 2).mean()):.3f} |", flush=True)


def reduced(radiance, distance, factor):
    """A picture of fewer pixels, as a renderer with many samples makes it: mean radiance, and the distance of the
    brightest sample."""
    height, width = distance.shape[0] // factor, distance.shape[1] // factor
    blocks = radiance.reshape(height, factor, width, factor, 3)
    samples = distance.reshape(height, factor, width, factor).swapaxes(1, 2).reshape(height, width, -1)
    brightest = blocks.sum(axis=-1).swapaxes(1, 2).reshape(height, width, -1).argmax(axis=-1)
    return blocks.mean(axis=(1, 3)), numpy.take_along_axis(samples, brightest[..., None], axis=-1)[..., 0]


def size_table(bench):
    """The same scene at three sizes, brought to the smallest: relMSE against the finest."""
    finest = fog_scenes.night(1280, 720)
    print("\n| medium | 320×180 | 640×360 |\n|---|---|---|")
    for scattering, g in fog_scenes.MEDIA:
        scene = fog_scenes.scene_text(fog_scenes.medium(scattering, g))
        images = []
        for factor in (1, 2, 4):
            fog_scenes.write(bench.path("size.exr"), *reduced(*finest, 4 // factor))
            image = bench.composite("size.exr", scene, [])[0]
            images.append(image.reshape(180, factor, 320, factor, 3).mean(axis=(1, 3)))
        truth = images[-1]
        cells = [((i - truth) ** 2 / (truth ** 2 + 0.01 * truth.mean() ** 2)).mean() for i in images[:-1]]
        print(f"| σs {scattering}, g {g} | " + " | ".join(f"{100 * c:.2g} %" for c in cells) + " |", flush=True)


def time_table(bench, repeats=3):
    """Milliseconds of the passes, the least of several runs, at 1280×720, and the growth with pixels."""
    def milliseconds(picture, overrides):
        scene = fog_scenes.scene_text(fog_scenes.medium(*fog_scenes.MEDIA[2]))
        runs = [bench.composite(picture, scene, overrides)[1]["passes"] for _ in range(repeats)]
        return min(sum(p["ms"] for p in run) for run in runs)

    for width, height in ((640, 360), (1280, 720)):
        fog_scenes.write(bench.path(f"time{height}.exr"), *fog_scenes.night(width, height))
    naive = milliseconds("time720.exr", NAIVE)
    # no scattering, so no level: every image is read and written once
    copying = milliseconds("time720.exr", NAIVE + ["fog.media.0.scattering=0"])
    print("\n| filter | taps | fetch | ms | to naive 4×4 linear-bicubic | to no level |\n|---|---|---|---|---|---|")
    for label, overrides in (FILTERS[0], FILTERS[2], FILTERS[3], FILTERS[4]):
        for taps in (2, 4, 6):
            for fetch in ("bilinear", "linear-bicubic", "cubic-bicubic"):
                if label == "scatter" and fetch == "cubic-bicubic":
                    continue  # the same as linear-bicubic
                time = milliseconds("time720.exr", overrides + [f"fog.filter_size={taps}", f"fog.fetch={fetch}"])
                print(f"| {label} | {taps}×{taps} | {fetch} | {time:.0f} | {time / naive:.2f} | {time / copying:.2f} |", flush=True)
    small, large = milliseconds("time360.exr", []), milliseconds("time720.exr", [])
    print(f"\nFour times the pixels take {large / small:.2f} times as long.")


def write_png(path, pixels):
    """`pixels` [height, width, 3] of bytes."""
    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    chunks = ((b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(rows, 9)),
              (b"IEND", b""))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for name, data in chunks:
            file.write(struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)))


def picture(bench):
    """docs/images/fog-night.png: clear, exact, scatter; naive, masked, masked with separation."""
    night = fog_scenes.night(*SIZE)
    fog_scenes.write(bench.path("night.exr"), *night)
    scene = fog_scenes.scene_text(fog_scenes.medium(*fog_scenes.MEDIA[1]))
    panels = [night[0], bench.gathered("night.exr", scene)]
    panels += [bench.composite("night.exr", scene, FILTERS[i][1])[0] for i in (4, 0, 2, 3)]
    shown = [(255 * (p / (p + 0.3)) ** (1 / 2.2)).clip(0, 255).astype(numpy.uint8) for p in panels]
    rows = [numpy.concatenate(shown[i:i + 3], axis=1) for i in (0, 3)]
    target = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "docs", "images", "fog-night.png")
    write_png(target, numpy.concatenate(rows, axis=0).repeat(2, axis=0).repeat(2, axis=1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("lumulus")
    tables = {"filters": filter_table, "turn": turn_table, "sizes": size_table, "time": time_table,
              "picture": picture}
    parser.add_argument("--only", choices=tables)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(os.path.abspath(options.lumulus), folder)
        for name, table in tables.items():
            if options.only in (None, name):
                table(bench)


if __name__ == "__main__":
    main()
