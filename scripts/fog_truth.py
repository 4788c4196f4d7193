#!/usr/bin/python3
"""The fog's filters against the path-traced truth: lamps and markings on a plain under homogeneous fog of optical depth
1, 2, 4 and 8 at the middle of the picture, as in figure 8 of Elek, Ritschel and Seidel 2013.

All surfaces give off light and reflect none, so that the filter is given exactly what the fog is given. Each depth is
rendered without the light that the fog scatters in from sun and sky, which the filters do not model
(fog.inscattering = false), and with it. Prints tables in Markdown; FOLDER gets the EXR files (a second run goes on with
the references that are there) and fog-truth.png: for each depth the truth, what the first filter makes of the clear
picture, their difference in hue, saturation and brightness (as red, green and blue; white is 20 %), the truth with sun
and sky in the fog, and the filter's difference from that.

    scripts/fog_truth.py FOLDER [--spp 256] [--width 192] [--filters scatter,masked,naive,gather]

Needs python3-numpy. Some 20 minutes on two cores; the time goes into the references."""

import argparse
import pathlib
import struct
import subprocess
import sys
import zlib

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "cli"))
from exr_reader import read_exr  # noqa: E402

DEPTHS = (1, 2, 4, 8)
DISTANCE = 69.6  # metres from the eye to the middle of the picture
WHITE_DIFFERENCE = 0.2

SCENE = """
cloud = []
image = { width = %d, height = %d }
camera = { position = [0, 40, 0], target = [0, 0, -57] }
sun = { azimuth = 120, elevation = 40, irradiance = 3 }
sky = { radiance = [0.2, 0.3, 0.5] }
fog = { sky_distance = 300, media = [{ g = 0.9 }] }
"""

# kind, place, radius and radiance of what lies on the plain and hovers above it
THINGS = (("plane", (0, 0, 0), None, (0.25, 0.22, 0.2)),
          ("sphere", (-12, 4, -40), 4, (4, 0.6, 0.3)),
          ("sphere", (6, 3, -36), 3, (0.3, 2, 0.5)),
          ("sphere", (14, 6, -64), 6, (0.4, 0.8, 5)),
          ("sphere", (-14, 8, -88), 8, (0.02, 0.02, 0.02)),
          ("sphere", (24, 8, -120), 8, (6, 4, 1.5)),
          ("sphere", (2, 14, -62), 2, (12, 11, 9)),
          ("disc", (-4, 0.01, -52), 5, (0.02, 0.02, 0.02)),
          ("disc", (34, 0.01, -76), 8, (1, 0.9, 0.2)))


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--lumulus", default=ROOT / "build/release/lumulus", type=pathlib.Path, help="the executable")
    parser.add_argument("--spp", default=256, type=int, help="samples per pixel of each of the two references")
    parser.add_argument("--width", default=192, type=int, help="pixels; 16:9")
    parser.add_argument("--filters", default="scatter,masked,naive,gather", help="the first one is in the picture")
    return parser.parse_args()


def scene_text(width):
    text = SCENE % (width, width * 9 // 16)
    for kind, position, radius, emission in THINGS:
        text += f'[[surface]]\nkind = "{kind}"\nposition = {list(position)}\nalbedo = 0\nemission = {list(emission)}\n'
        text += f"radius = {radius}\n" if radius else ""
    return text


class Runs:
    """Pictures made by the program, as arrays [height, width, 3]."""

    def __init__(self, wanted):
        self.wanted, self.folder = wanted, wanted.folder
        self.folder.mkdir(parents=True, exist_ok=True)
        self.scene = self.folder / f"scene-{wanted.width}.toml"
        self.scene.write_text(scene_text(wanted.width))
        self.clear = self.reference("clear", 64, 1, ["fog.media=[]"])[1]

    def run(self, command, name, arguments, settings):
        path = self.folder / f"{name}-{self.wanted.width}.exr"
        sets = [word for setting in settings for word in ("--set", setting)]
        print("making", path.name, file=sys.stderr, flush=True)
        subprocess.run([self.wanted.lumulus, command, *arguments, "-o", path, *sets], check=True)
        width, height, layers, _ = read_exr(path)
        picture = numpy.stack([numpy.array(layers[c]) for c in "RGB"], axis=-1)
        return picture.reshape(height, width, 3), path

    def reference(self, name, spp, seed, settings):
        arguments = [self.scene, "--spp", str(spp), "--seed", str(seed), "--resume", "--quiet"]
        return self.run("reference", f"{name}-{seed}", arguments, settings)

    def truths(self, depth, inscattering):
        """Two independent references."""
        settings = [f"fog.media.0.scattering={depth / DISTANCE}", f"fog.inscattering={str(inscattering).lower()}"]
        name = f"truth-{depth}-{'with' if inscattering else 'without'}"
        return [self.reference(name, self.wanted.spp, seed, settings)[0] for seed in (1, 2)]

    def composite(self, name, settings):
        return self.run("composite", name, ["--color", self.clear, "--scene", self.scene], settings)[0]

    def filtered(self, depth, kind):
        return self.composite(f"{kind}-{depth}", [f"fog.media.0.scattering={depth / DISTANCE}", f"fog.filter={kind}"])

    def attenuated(self, depth):
        """What comes straight through the fog."""
        return self.composite(f"straight-{depth}", [f"fog.media.0.absorption={depth / DISTANCE}"])


def display(radiance):
    """Intensities from 0 to 1 as a screen shows them (IEC 61966-2-1)."""
    x = numpy.clip(radiance, 0.0, 1.0)
    return numpy.where(x < 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def hsb(intensity):
    """Hue (a circle, 0 to 1), saturation and brightness."""
    high, low = intensity.max(axis=-1), intensity.min(axis=-1)
    spread = high - low
    safe = numpy.where(spread > 0, spread, 1.0)
    red, green, blue = numpy.moveaxis(intensity, -1, 0)
    sextant = numpy.where(high == red, (green - blue) / safe,
                          numpy.where(high == green, 2 + (blue - red) / safe, 4 + (red - green) / safe))
    return sextant / 6 % 1, spread / numpy.where(high > 0, high, 1.0), high


def hsb_difference(a, b):
    """Of two pictures of intensities; hue as a share of half the circle, weighted by the lesser saturation: the hue of
    grey is none."""
    (h0, s0, b0), (h1, s1, b1) = hsb(a), hsb(b)
    turn = numpy.abs(h0 - h1)
    hue = 2 * numpy.minimum(turn, 1 - turn) * numpy.minimum(s0, s1)
    return numpy.stack([hue, numpy.abs(s0 - s1), numpy.abs(b0 - b1)], axis=-1)


def relative_rmse(picture, truths, straight):
    """Root of mean square error over root mean square of the part that is scattered, free of the references' noise."""
    a, b = truths
    error = numpy.mean((picture - a) * (picture - b))
    return numpy.sqrt(max(0.0, error) / numpy.mean((a - straight) * (b - straight)))


def row(depth, kind, picture, truths, straight):
    truth = (truths[0] + truths[1]) / 2
    shown = display(truth)
    noise = numpy.sqrt(numpy.mean((display(truths[0]) - display(truths[1])) ** 2)) / 2
    rmse = numpy.sqrt(numpy.mean((display(picture) - shown) ** 2))
    hue, saturation, brightness = 100 * hsb_difference(display(picture), shown).mean(axis=(0, 1))
    bias = picture.mean() / truth.mean() - 1
    return (f"| {depth} | `{kind}` | {relative_rmse(picture, truths, straight):.3f} | {100 * bias:+.1f} % | {rmse:.3f} "
            f"| {noise:.3f} | {hue:.1f} % | {saturation:.1f} % | {brightness:.1f} % |")


def print_table(title, rows):
    print(f"\n{title}\n\n| τ | filter | relative RMSE of the scattered part | bias | RMSE of the shown intensities | noise "
          "in it | hue | saturation | brightness |\n|---|---|---|---|---|---|---|---|---|")
    print("\n".join(rows), flush=True)


def write_png(path, intensity):
    """Intensities from 0 to 1."""
    pixels = (255 * numpy.clip(intensity, 0, 1) + 0.5).astype(numpy.uint8)
    height, width, _ = pixels.shape

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines = b"".join(b"\0" + line.tobytes() for line in pixels)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))


def main():
    wanted = options()
    runs, kinds = Runs(wanted), wanted.filters.split(",")
    without, with_light, sheet = [], [], []
    for depth in DEPTHS:
        straight = runs.attenuated(depth)
        truths = {inscattering: runs.truths(depth, inscattering) for inscattering in (False, True)}
        pictures = [runs.filtered(depth, kind) for kind in kinds]
        for kind, picture in zip(kinds, pictures):
            without.append(row(depth, kind, picture, truths[False], straight))
            with_light.append(row(depth, kind, picture, truths[True], straight))
        filtered = display(pictures[0])
        plain, lit = (display((truths[i][0] + truths[i][1]) / 2) for i in (False, True))
        sheet.append(numpy.concatenate([plain, filtered, hsb_difference(filtered, plain) / WHITE_DIFFERENCE, lit,
                                        hsb_difference(filtered, lit) / WHITE_DIFFERENCE], axis=1))
    print_table("Without light of sun and sky scattered in by the fog:", without)
    print_table("With it:", with_light)
    write_png(wanted.folder / "fog-truth.png", numpy.concatenate(sheet, axis=0))


if __name__ == "__main__":
    main()
