"""The fog's filters against the path-traced truth. Lamps and markings on a plain under homogeneous fog of optical depth
1, 2, 4 and 8 at the middle of the picture, as in figure 8 of Elek, Ritschel and Seidel 2013.

All surfaces give off light and reflect none, so that the filter is given exactly what the fog is given. Each depth is
rendered without the light that the fog scatters in from sun and sky, which the filters do not model
(fog.inscattering = false), and with it. Prints tables in Markdown; FOLDER gets the EXR files (a second run goes on with
the references that are there) and fog-truth.png: for each depth the truth, what the first filter makes of the clear
picture, their difference in hue, saturation and brightness (as red, green and blue; white is 20 %), the truth with sun
and sky in the fog, and the filter's difference from that. Some 20 minutes on two cores; the time goes into the references.

    scripts/study/run fog_truth build/fog-truth
"""

import pathlib
import sys

import numpy

from study.lumulus import Lumulus, add_program_option
from study.pictures import as_image, read_exr, rgb, srgb
from study.program import size_sets
from study.tables import print_head, print_row

DEPTHS = (1, 2, 4, 8)
DISTANCE = 69.6  # metres from the eye to the middle of the picture
WHITE_DIFFERENCE = 0.2

SCENE = """
cloud = []
camera = { position = [0, 40, 0], target = [0, 0, -57] }
sun = { azimuth = 120, elevation = 40, irradiance = 3 }
sky = { radiance = [0.2, 0.3, 0.5] }
fog = { media = [{ kind = "ellipsoid", center = [0, 40, 0], half_size = [300, 300, 300], g = 0.9 }] }
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


def scene_text():
    text = SCENE
    for kind, position, radius, emission in THINGS:
        text += f'[[surface]]\nkind = "{kind}"\nposition = {list(position)}\nalbedo = 0\nemission = {list(emission)}\n'
        text += f"radius = {radius}\n" if radius else ""
    return text


class Runs:
    """Pictures made by the program, as arrays [height, width, 3]."""

    def __init__(self, options):
        self.options, self.lumulus = options, Lumulus(options.lumulus, options.folder, size_sets(options.width))
        self.scene = self.lumulus.path("scene", suffix=".toml")
        self.scene.write_text(scene_text())
        self.clear = self.path("clear-1")
        self.reference("clear", 64, 1, ["fog.media=[]"])

    def path(self, name):
        path = self.lumulus.path(name, self.options.width)
        print("making", path.name, file=sys.stderr, flush=True)
        return path

    def reference(self, name, spp, seed, settings):
        path = self.path(f"{name}-{seed}")
        self.lumulus.new_reference(self.scene, path, settings, spp, seed, ["--resume"])
        return rgb(read_exr(path))

    def truths(self, depth, inscattering):
        """Two independent references."""
        settings = [f"fog.media.0.scattering={depth / DISTANCE}", f"fog.inscattering={str(inscattering).lower()}"]
        name = f"truth-{depth}-{'with' if inscattering else 'without'}"
        return [self.reference(name, self.options.spp, seed, settings) for seed in (1, 2)]

    def composite(self, name, settings):
        path = self.path(name)
        self.lumulus.composite(self.clear, self.scene, path, [*self.lumulus.sets, *settings])
        return rgb(read_exr(path))

    def filtered(self, depth, kind):
        return self.composite(f"{kind}-{depth}", [f"fog.media.0.scattering={depth / DISTANCE}", f"fog.filter={kind}"])

    def attenuated(self, depth):
        """What comes straight through the fog."""
        return self.composite(f"straight-{depth}", [f"fog.media.0.absorption={depth / DISTANCE}"])


def display(radiance):
    """Intensities from 0 to 1 as a screen shows them."""
    return srgb(numpy.clip(radiance, 0.0, 1.0))


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
    around = numpy.abs(h0 - h1)
    hue = 2 * numpy.minimum(around, 1 - around) * numpy.minimum(s0, s1)
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
    return [str(depth), f"`{kind}`", f"{relative_rmse(picture, truths, straight):.3f}", f"{100 * bias:+.1f} %",
            f"{rmse:.3f}", f"{noise:.3f}", f"{hue:.1f} %", f"{saturation:.1f} %", f"{brightness:.1f} %"]


def print_table(title, rows):
    print(f"\n{title}\n")
    print_head(["τ", "filter", "relative RMSE of the scattered part", "bias", "RMSE of the shown intensities",
                "noise in it", "hue", "saturation", "brightness"])
    for cells in rows:
        print_row(cells)


def add_options(parser):
    add_program_option(parser)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--spp", default=256, type=int, help="samples per pixel of each of the two references")
    parser.add_argument("--width", default=192, type=int, help="pixels; 16:9")
    parser.add_argument("--filters", default="scatter,masked,naive,gather", help="the first one is in the picture")


def main(options):
    runs, kinds = Runs(options), options.filters.split(",")
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
    as_image(numpy.concatenate(sheet, axis=0)).save(options.folder / "fog-truth.png", optimize=True)
