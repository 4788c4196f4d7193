"""A day in 48 frames and a climb from the ground through clouds to 400 km in 60, as panoramas. Every frame is looked at for
values that are no numbers, and the zenith is held against what `lumulus sky` finds for it in double precision: their ratio
may not jump from frame to frame.

    scripts/study/run sky_journeys --folder /var/tmp/journeys -o journeys
"""

import json
import math
import pathlib

import numpy
from PIL import Image

from study.lumulus import Lumulus, add_common_options
from study.pictures import read_exr
from study.program import Failure
from study.tables import write_figures

EFFICACY = 683.0 * numpy.array([0.2126, 0.7152, 0.0722])  # lm/W of Rec. 709
LARGEST_JUMP = 0.02
SCENE = """
[image]
width = {width}
height = {height}
exposure_mode = "auto"
[camera]
projection = "panorama"
position = [0.0, 2.0, 0.0]
target = [0.0, 2.0, -1.0]
[sun]
azimuth = 120.0
elevation = 25.0
[sky]
model = "atmosphere"
[photon_map]
photons = {photons}
[preparation]
samples = 1000
[[cloud]]
procedural = "cumulus"
resolution = 48
transform = [[2.0, 0.0, 0.0, {x}], [0.0, 2.0, 0.0, 1000.0], [0.0, 0.0, 2.0, {z}]]
"""


def day(frames):
    """Overrides of each frame: a summer's day, with its night, at 48° north."""
    for i in range(frames):
        minutes = round(24 * 60 * i / frames)
        yield ["time.utc=2026-06-29T%02d:%02d:00Z" % divmod(minutes, 60), "time.latitude=48.0", "time.longitude=11.0",
               "moon.shines=true"]


def climb(frames):
    """The same of a climb with equal ratios of heights."""
    for i in range(frames):
        height = 2.0 * (400e3 / 2.0) ** (i / max(1, frames - 1))
        yield [f"camera.position=[0.0,{height},0.0]", f"camera.target=[0.0,{height},-1.0]"]


def zenith(layers):
    """Mean luminance [cd/m²] of what the upper row sees beside the clouds; none where they cover half of it."""
    free = layers["cloud.A"][0] < 1e-3
    if free.mean() < 0.5:
        return None
    row = numpy.stack([layers[name][0] for name in "RGB"], axis=-1)[free]
    return float((row.astype(float) @ EFFICACY).mean())


def frames_of(lumulus, scene, name, journey):
    """Figures of each frame, and their pictures."""
    found, pictures = [], []
    for i, sets in enumerate(journey):
        picture, shown = lumulus.path(name, i), lumulus.path(name, i, suffix=".png")
        lumulus.render(scene, picture, sets, ["-o", shown])
        layers = read_exr(picture)
        bad = sum(int((~numpy.isfinite(values)).sum()) for values in layers.values())
        words = lumulus.scene_words(scene, sets)
        truth = json.loads(lumulus.succeeded("sky", *words, "--json").output)
        mean = float((numpy.stack([layers[c] for c in "RGB"], axis=-1).astype(float) @ EFFICACY).mean())
        found.append({"frame": i, "bad": bad, "mean": mean, "zenith": zenith(layers),
                      "true_zenith": truth["sky"]["zenith_luminance"], "sun": truth["sun"]["elevation"]})
        pictures.append(shown)
    return found, pictures


def largest_jump(frames):
    """Of the ratio of zenith and truth, from one frame to the next; frames whose zenith is all but black are left out."""
    ratios = [frame["zenith"] / frame["true_zenith"] if frame["zenith"] and frame["true_zenith"] > 1e-6 else None
              for frame in frames]
    return max((abs(b / a - 1.0) for a, b in zip(ratios, ratios[1:]) if a and b), default=math.nan)


def save_sheet(pictures, path, across):
    images = [Image.open(picture).convert("RGB") for picture in pictures]
    width, height = images[0].size
    sheet = Image.new("RGB", (width * across, height * math.ceil(len(images) / across)))
    for i, image in enumerate(images):
        sheet.paste(image, (i % across * width, i // across * height))
    sheet.save(path, optimize=True)


def add_options(parser):
    add_common_options(parser, width=160)
    parser.add_argument("--frames", type=int, nargs=2, default=[48, 60], help="of the day and of the climb")
    parser.add_argument("--photons", type=int, default=200_000, help="of each frame")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True,
                        help="the sheets are OUTPUT-day.png and OUTPUT-climb.png")


def main(options):
    lumulus = Lumulus(options.lumulus, options.folder, options.set)
    figures = {}
    for name, journey, x, z in (("day", day(options.frames[0]), 0.0, -2500.0), ("climb", climb(options.frames[1]), 0.0, 0.0)):
        scene = lumulus.path(name, suffix=".toml")
        scene.write_text(SCENE.format(width=options.width, height=options.width // 2, photons=options.photons, x=x, z=z))
        frames, pictures = frames_of(lumulus, scene, name, journey)
        save_sheet(pictures, options.output.with_name(f"{options.output.name}-{name}.png"), across=6)
        figures[name] = {"frames": frames, "bad": sum(frame["bad"] for frame in frames), "jump": largest_jump(frames)}
        print(f"{name}: {len(frames)} frames, {figures[name]['bad']} values that are no numbers, largest jump of the "
              f"zenith against the truth {100.0 * figures[name]['jump']:.2f} %", flush=True)
    write_figures(options, figures)
    if any(found["bad"] or found["jump"] > LARGEST_JUMP for found in figures.values()):
        raise Failure("a journey breaks")
