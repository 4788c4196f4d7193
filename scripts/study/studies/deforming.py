"""A cloud that deforms while the wind carries it: error over time of frames that go on with the light of those before,
beside frames that begin anew with as many photons (docs/sequences.md). The change from frame to frame is taken along the
motion, and told over that of the truth, which has a hundred times the photons.
"""

import json

import numpy

from study.lumulus import Lumulus, add_common_options
from study.pictures import read_exr, rgb
from study.tables import Table, write_figures

WIND, SWIRL = (10.0, 0.0, 0.0), 4.0
SCENE = """[image]
width = {width}
height = {height}
[camera]
position = [120.0, 500.0, 1900.0]
target = [120.0, 300.0, 0.0]
vertical_fov = 40.0
[sun]
azimuth = 120.0
elevation = 35.0
[sky]
model = "constant"
[preparation]
samples = {samples}
[animate]
fps = 1.0
[[cloud]]
vdb = "moving_####.vdb"
frames = [0, {last}]
"""
EYE, TARGET = numpy.array([120.0, 500.0, 1900.0]), numpy.array([120.0, 300.0, 0.0])


def add_options(parser):
    add_common_options(parser, width=160)
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--resolution", type=int, default=96, help="voxels along the cloud")
    parser.add_argument("--photons", type=int, default=40000, help="of a frame")
    parser.add_argument("--truth", type=int, default=100, help="times as many for the truth")
    parser.add_argument("--samples", type=int, default=5000, help="of the gradient: more of them make more collectors")
    parser.add_argument("--means", type=int, nargs="+", default=[2, 4, 8, 16], help="frames that the light is the mean of")


def axes():
    back = (EYE - TARGET) / numpy.linalg.norm(EYE - TARGET)
    right = numpy.cross([0.0, 1.0, 0.0], back)
    right /= numpy.linalg.norm(right)
    return numpy.stack([right, numpy.cross(back, right), back])


def velocity(place, seconds, wave):
    """That of `lumulus cloud --wind --swirl` (vdb/deform.cpp), at places [..., 3]."""
    phase = 2.0 * numpy.pi / wave * (place - seconds * numpy.array(WIND))
    s, c = numpy.sin(phase), numpy.cos(phase)
    flow = [s[..., 2] + c[..., 1], s[..., 0] + c[..., 2], s[..., 1] + c[..., 0]]
    return numpy.array(WIND) + SWIRL / numpy.sqrt(3.0) * numpy.stack(flow, axis=-1)


def seen_before(depth, seconds, wave):
    """Columns and rows where what pixels show was a second before."""
    height, width = depth.shape
    tangent = numpy.tan(numpy.radians(20.0))
    x, y = numpy.meshgrid(numpy.arange(width) + 0.5, numpy.arange(height) + 0.5)
    local = numpy.stack([(2.0 * x - width) / height * tangent, (1.0 - 2.0 * y / height) * tangent, -numpy.ones_like(x)],
                        axis=-1)
    ray = local @ axes()
    place = EYE + depth[..., None] * ray / numpy.linalg.norm(ray, axis=-1, keepdims=True)
    before = (place - velocity(place, seconds, wave) - EYE) @ axes().T
    column = (before[..., 0] / -before[..., 2] / tangent * height + width) / 2.0 - 0.5
    row = (1.0 - before[..., 1] / -before[..., 2] / tangent) * height / 2.0 - 0.5
    return column, row


def sampled(picture, column, row):
    """Linear between the pixels."""
    height, width = picture.shape[:2]
    x, y = numpy.clip(column, 0, width - 1.001), numpy.clip(row, 0, height - 1.001)
    i, j = x.astype(int), y.astype(int)
    u, v = (x - i)[..., None], (y - j)[..., None]
    return ((1 - v) * ((1 - u) * picture[j, i] + u * picture[j, i + 1]) +
            v * ((1 - u) * picture[j + 1, i] + u * picture[j + 1, i + 1]))


def changes(lumulus, name, frames, wave):
    """Root mean squares of the change from frame to frame, along the motion, where the cloud is dense."""
    result = []
    for frame in range(1, frames):
        truth = read_exr(lumulus.path(f"truth_{frame:04}"))
        now, before = (rgb(read_exr(lumulus.path(f"{name}_{each:04}"))) for each in (frame, frame - 1))
        dense = truth["transmittance.G"] < 0.1
        column, row = seen_before(numpy.where(dense, truth["depth.Z"], 1e4), float(frame), wave)
        change = now - sampled(before, column, row)
        result.append(float(numpy.sqrt(numpy.mean(change[dense] ** 2))))
    return numpy.array(result)


def rendered(lumulus, options, name, sets):
    done = lumulus.succeeded("render", *lumulus.scene_words(lumulus.folder / "deforming.toml", sets), "--frames",
                             f"0-{options.frames - 1}", "-o", lumulus.path(name + "_####"), "--quiet", "--skip-existing")
    return done.seconds / options.frames


def main(options):
    lumulus = Lumulus.of(options)
    files = lumulus.folder / "moving_####.vdb"
    lumulus.succeeded("cloud", "cumulus", "--resolution", options.resolution, "-o", files, "--frames",
                      f"0-{options.frames - 1}", "--fps", 1, "--wind", ",".join(map(str, WIND)), "--swirl", SWIRL, "--quiet")
    info = json.loads(lumulus.succeeded("info", lumulus.folder / "moving_0000.vdb", "--json").output)
    grid = next(each for each in info["grids"] if each["name"] == "density")
    wave = 0.5 * options.resolution * grid["voxel_size"][0]
    height = options.width * 9 // 16
    (lumulus.folder / "deforming.toml").write_text(
        SCENE.format(width=options.width, height=height, samples=options.samples, last=options.frames - 1))
    photons = [f"photon_map.photons={options.photons}", "photon_map.generations=4"]
    rendered(lumulus, options, "truth", [f"photon_map.photons={options.truth * options.photons}"])
    of_truth = changes(lumulus, "truth", options.frames, wave)
    runs = {"anew": []}
    runs |= {f"mean of {n}": ["photon_map.transfer=true", f"photon_map.transfer_frames={n}"] for n in options.means}
    table = Table(["light", "relMSE, last half", "over anew", "frames 1, 2, 4, 8", "bias", "change over the truth's", "s/frame"])
    anew = None
    for name, sets in runs.items():
        word = name.replace(" ", "-")
        seconds = rendered(lumulus, options, word, [*photons, *sets])
        found = [lumulus.compare(lumulus.path(f"{word}_{frame:04}"), lumulus.path(f"truth_{frame:04}"))
                 for frame in range(options.frames)]
        errors = numpy.array([each["relmse"] for each in found])
        half = options.frames // 2
        late = float(errors[half:].mean())
        anew = anew or late
        bias = float(numpy.mean([each["relative_bias"] for each in found[half:]]))
        change = changes(lumulus, word, options.frames, wave)
        coherence = float(numpy.sqrt(numpy.mean(change[half - 1:] ** 2) / numpy.mean(of_truth[half - 1:] ** 2)))
        early = ", ".join(f"{errors[frame]:.3f}" for frame in (1, 2, 4, 8) if frame < options.frames)
        table.add({"light": name, "relmse": errors.tolist(), "late": late, "bias": bias, "change": coherence,
                   "seconds": seconds},
                  [name, f"{late:.4f}", f"{late / anew:.2f}", early, f"{100 * bias:+.1f} %", f"{coherence:.2f}",
                   f"{seconds:.2f}"])
    write_figures(options, table.figures)
