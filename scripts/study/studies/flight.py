"""Does the level of detail of clouds jump while a camera flies towards and over a field? Each frame is held against the same
frame without levels of detail: their ratio, in the whole picture and in each of 4 by 4 parts of it, may not jump by more from
frame to frame than by the noise of both.

    scripts/study/run flight --frames 200 --folder /var/tmp/flight -o flight.png
"""

import math
import pathlib

import numpy
from PIL import Image

from study.lumulus import Lumulus, add_common_options
from study.pictures import read_exr
from study.program import Failure, size_sets
from study.studies.many_clouds import scene_of
from study.tables import write_figures

LARGEST_STEP = 0.005
PARTS = 4  # along each side


def path_text(frames):
    """Rows of a camera that comes from 4 km before the first cloud, climbs above it, and leaves over the field."""
    rows = ["frame,x,y,z,target_x,target_y,target_z"]
    for i in range(frames):
        along = i / max(1, frames - 1)
        height, z = 300.0 + 2600.0 * along ** 0.8, 2000.0 - 8000.0 * along
        rows.append(f"{i + 1},{200.0 * math.sin(3.0 * along):.3f},{height:.3f},{z:.3f},0.0,{height - 250.0 * along:.3f},"
                    f"{z - 2000.0:.3f}")
    return "\n".join(rows) + "\n"


def rendered(lumulus, scene, name, frames, sets):
    """Pictures of all frames, by one process."""
    lumulus.succeeded("render", *lumulus.scene_words(scene, sets), "--frames", f"1-{frames}", "-o",
                      lumulus.folder / f"{name}-####.exr", "--quiet", "--skip-existing")
    return [lumulus.folder / f"{name}-{i + 1:04d}.exr" for i in range(frames)]


def parts_of(picture):
    """Mean light of the clouds and what is before them in the whole picture and in its parts, and how much cloud is there."""
    layers = read_exr(picture)
    light, cover = layers["G"].astype(float), layers["cloud.A"].astype(float)
    rows = numpy.array_split(numpy.arange(light.shape[0]), PARTS)
    columns = numpy.array_split(numpy.arange(light.shape[1]), PARTS)
    cut = [(slice(None), slice(None))] + [numpy.ix_(r, c) for r in rows for c in columns]
    return numpy.array([light[part].mean() for part in cut]), numpy.array([cover[part].mean() for part in cut])


def steps(levels, whole):
    """Of each part from frame to frame: how much more the ratio of both pictures changed than 1. Frames, parts."""
    ratio = numpy.array([a[0] / b[0] for a, b in zip(levels, whole)])
    return numpy.abs(ratio[1:] / ratio[:-1] - 1.0)


def save_sheet(pictures, path, across=8, most=40):
    chosen = pictures[:: max(1, math.ceil(len(pictures) / most))]
    shown = []
    for picture in chosen:
        layers = read_exr(picture)
        values = numpy.stack([layers[c] for c in "RGB"], axis=-1).astype(float)
        shown.append((255.0 * numpy.clip(1.0 - numpy.exp(-1.4 * values), 0.0, 1.0) ** (1.0 / 2.2)).astype(numpy.uint8))
    height, width = shown[0].shape[:2]
    sheet = Image.new("RGB", (width * across, height * math.ceil(len(shown) / across)))
    for i, pixels in enumerate(shown):
        sheet.paste(Image.fromarray(pixels), (i % across * width, i // across * height))
    sheet.save(path, optimize=True)


def add_options(parser):
    add_common_options(parser, width=160)
    parser.add_argument("--frames", type=int, default=200)
    parser.add_argument("--clouds", type=int, default=50)
    parser.add_argument("--resolution", type=int, default=48, help="of each cloud")
    parser.add_argument("--photons", type=int, default=1000000)
    parser.add_argument("-o", "--output", type=pathlib.Path, help="a contact sheet of every few frames")


def main(options):
    lumulus = Lumulus.of(options, size_sets(options.width))
    scene = scene_of(lumulus, options.clouds, options.resolution)
    path = lumulus.path("path", suffix=".csv")
    path.write_text(path_text(options.frames))
    scene.write_text(scene.read_text() + f'[animate]\ncamera = "{path.name}"\n')
    sets = [f"photon_map.photons={options.photons}"]
    without = "preparation.level_of_detail=false"
    levels = rendered(lumulus, scene, "levels", options.frames, sets)
    if options.output:
        save_sheet(levels, options.output)
    whole = rendered(lumulus, scene, "whole", options.frames, [*sets, without])
    again = rendered(lumulus, scene, "again", options.frames, [*sets, without, "photon_map.seed=2"])
    parts = [[parts_of(picture) for picture in pictures] for pictures in (levels, whole, again)]
    found, noise = steps(parts[0], parts[1]), steps(parts[2], parts[1])
    figures = {"picture": float(found[:, 0].max()), "part": float(found[:, 1:].max()),
               "picture_noise": float(noise[:, 0].max()), "part_noise": float(noise[:, 1:].max()),
               "picture_rms": float(numpy.sqrt((found[:, 0] ** 2).mean())), "picture_rms_noise": float(numpy.sqrt((noise[:, 0] ** 2).mean())),
               "part_rms": float(numpy.sqrt((found[:, 1:] ** 2).mean())), "part_rms_noise": float(numpy.sqrt((noise[:, 1:] ** 2).mean()))}
    print("| step from frame to frame, % | largest | rms | largest of noise alone | rms of noise alone |\n|---|---|---|---|---|")
    for name in ("picture", "part"):
        words = [100.0 * figures[name + kind] for kind in ("", "_rms", "_noise", "_rms_noise")]
        print(f"| {name} | " + " | ".join(f"{word:.2f}" for word in words) + " |")
    write_figures(options, figures)
    if figures["picture"] > LARGEST_STEP:
        raise Failure("the level of detail jumps")
