"""The tables of docs/fog.md. Every filter of the fog against the exact one, on the pictures of the study fog_scenes; --only
picture writes docs/images/fog-night.png.

    scripts/study/run fog_tables --only filters
"""

import numpy
from PIL import Image

from study.lumulus import Lumulus, add_program_option
from study.pictures import as_image, read_exr, rgb
from study.program import ROOT
from study.studies import fog_scenes
from study.tables import print_head, print_row

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
    """Runs `composite`; pictures are asked for again and again, the exact ones are made only once."""

    def __init__(self, options):
        self.lumulus, self.exact, self.scale = Lumulus(options.lumulus), {}, options.scale

    def path(self, name):
        return self.lumulus.path(name, suffix="")

    def size(self, width, height):
        """A size divided by the option --scale."""
        return width // self.scale, height // self.scale

    def composite(self, picture, scene, overrides):
        """RGB [height, width, 3] and the statistics."""
        self.path("scene.toml").write_text(scene)
        statistics = self.lumulus.composite(self.path(picture), self.path("scene.toml"), self.path("out.exr"), overrides)
        return rgb(read_exr(self.path("out.exr"))), statistics

    def gathered(self, picture, scene):
        key = (picture, scene)
        if key not in self.exact:
            self.exact[key] = self.composite(picture, scene, ["fog.filter=gather"])[0]
        return self.exact[key]


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
    size = bench.size(*SIZE)
    for name, (radiance, distance) in {"night": fog_scenes.night(*size), "step": fog_scenes.step(*size)}.items():
        fog_scenes.write(bench.path(name + ".exr"), radiance, distance)
        print(f"\n{name}\n")
        print_head(["filter"] + [f"σs {s}, g {g}" for s, g in fog_scenes.MEDIA])
        for label, overrides in FILTERS:
            cells = []
            for scattering, g in fog_scenes.MEDIA:
                scene = fog_scenes.scene_text(fog_scenes.medium(scattering, g))
                sharp = sharp_light(scattering, radiance, distance)
                image = bench.composite(name + ".exr", scene, overrides)[0]
                cells.append("{:.3f} / {:.3f} / {:.3f}".format(*errors(image, bench.gathered(name + ".exr", scene), sharp)))
            print_row([label] + cells)


def rotation_table(bench, frames=5, degrees=0.1):
    """A slow rotation: rms of the change of scattered light between frames that the exact filter does not show, in parts of
    the rms of its own change."""
    scattering, g = fog_scenes.MEDIA[2]
    scenes = [fog_scenes.scene_text(fog_scenes.medium(scattering, g), i * degrees) for i in range(frames)]
    pictures = [fog_scenes.night(*bench.size(*SIZE), i * degrees) for i in range(frames)]
    for i, picture in enumerate(pictures):
        fog_scenes.write(bench.path(f"rotation{i}.exr"), *picture)
    sharp = [sharp_light(scattering, *picture) for picture in pictures]
    exact = [bench.gathered(f"rotation{i}.exr", scene) for i, scene in enumerate(scenes)]
    change = numpy.diff(numpy.array(exact) - sharp, axis=0)
    print()
    print_head(["filter", "change that the exact filter does not show"])
    for label, overrides in FILTERS:
        images = [bench.composite(f"rotation{i}.exr", scene, overrides)[0] for i, scene in enumerate(scenes)]
        excess = numpy.diff(numpy.array(images) - sharp, axis=0) - change
        print_row([label, f"{numpy.sqrt((excess ** 2).mean() / (change ** 2).mean()):.3f}"])


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
    width, height = bench.size(1280, 720)
    finest = fog_scenes.night(width, height)
    print()
    print_head(["medium", f"{width // 4}×{height // 4}", f"{width // 2}×{height // 2}"])
    for scattering, g in fog_scenes.MEDIA:
        scene = fog_scenes.scene_text(fog_scenes.medium(scattering, g))
        images = []
        for factor in (1, 2, 4):
            fog_scenes.write(bench.path("size.exr"), *reduced(*finest, 4 // factor))
            image = bench.composite("size.exr", scene, [])[0]
            images.append(image.reshape(height // 4, factor, width // 4, factor, 3).mean(axis=(1, 3)))
        truth = images[-1]
        cells = [((i - truth) ** 2 / (truth ** 2 + 0.01 * truth.mean() ** 2)).mean() for i in images[:-1]]
        print_row([f"σs {scattering}, g {g}"] + [f"{100 * c:.2g} %" for c in cells])


def time_table(bench, repeats=3):
    """Milliseconds of the passes, the least of several runs, at 1280×720, and the growth with pixels."""
    def milliseconds(picture, overrides):
        scene = fog_scenes.scene_text(fog_scenes.medium(*fog_scenes.MEDIA[2]))
        runs = [bench.composite(picture, scene, overrides)[1]["passes"] for _ in range(repeats)]
        return min(sum(p["ms"] for p in run) for run in runs)

    for name, size in (("small.exr", (640, 360)), ("large.exr", (1280, 720))):
        fog_scenes.write(bench.path(name), *fog_scenes.night(*bench.size(*size)))
    naive = milliseconds("large.exr", NAIVE)
    # no scattering, so no level: every image is read and written once
    copying = milliseconds("large.exr", NAIVE + ["fog.media.0.scattering=0"])
    print()
    print_head(["filter", "taps", "fetch", "ms", "to naive 4×4 linear-bicubic", "to no level"])
    for label, overrides in (FILTERS[0], FILTERS[2], FILTERS[3], FILTERS[4]):
        for taps in (2, 4, 6):
            for fetch in ("bilinear", "linear-bicubic", "cubic-bicubic"):
                if label == "scatter" and fetch == "cubic-bicubic":
                    continue  # the same as linear-bicubic
                time = milliseconds("large.exr", overrides + [f"fog.filter_size={taps}", f"fog.fetch={fetch}"])
                print_row([label, f"{taps}×{taps}", fetch, f"{time:.0f}", f"{time / naive:.2f}", f"{time / copying:.2f}"])
    small, large = milliseconds("small.exr", []), milliseconds("large.exr", [])
    print(f"\nFour times the pixels take {large / small:.2f} times as long.")


def picture(bench):
    """docs/images/fog-night.png: clear, exact, scatter; naive, masked, masked with separation."""
    night = fog_scenes.night(*bench.size(*SIZE))
    fog_scenes.write(bench.path("night.exr"), *night)
    scene = fog_scenes.scene_text(fog_scenes.medium(*fog_scenes.MEDIA[1]))
    panels = [night[0], bench.gathered("night.exr", scene)]
    panels += [bench.composite("night.exr", scene, FILTERS[i][1])[0] for i in (4, 0, 2, 3)]
    shown = [(p / (p + 0.3)) ** (1 / 2.2) for p in panels]
    sheet = as_image(numpy.concatenate([numpy.concatenate(shown[i:i + 3], axis=1) for i in (0, 3)], axis=0))
    sheet = sheet.resize((2 * sheet.width, 2 * sheet.height), Image.Resampling.NEAREST)
    sheet.save(ROOT / "docs/images/fog-night.png", optimize=True)


TABLES = {"filters": filter_table, "rotation": rotation_table, "sizes": size_table, "time": time_table, "picture": picture}


def add_options(parser):
    add_program_option(parser)
    parser.add_argument("--only", choices=TABLES, help="one of the tables instead of all")
    parser.add_argument("--scale", type=int, default=1, choices=(1, 2, 4), help="divide sizes by this, to try the study out")


def main(options):
    bench = Bench(options)
    for name, table in TABLES.items():
        if options.only in (None, name):
            table(bench)
