"""Pictures that the fog's filters are measured on, made from nothing. An HDR night with many small lamps before and behind
the edges of buildings, and a step edge: colour and distance as one EXR file each, with scene files for their camera.

    scripts/study/run fog_scenes FOLDER
"""

import math
import pathlib

import numpy

from study.pictures import write_exr

FIELD_OF_VIEW = 40.0  # degrees, of the height
EYE = numpy.array([0.0, 6.0, 0.0])
SKY_DISTANCE = 1e10
FOG_ENDS = 1000.0  # metres: the masked filter's blurred depth drowns in a farther sky

# σs [1/m] and g, from clear to dense
MEDIA = [(0.004, 0.99), (0.002, 0.95), (0.01, 0.9), (0.03, 0.9)]


def rays(width, height, yaw):
    """Unit directions of the pixels' middles; yaw 0 looks along -Z."""
    tangent = math.tan(math.radians(FIELD_OF_VIEW) / 2)
    x = (2 * (numpy.arange(width) + 0.5) / width - 1) * tangent * width / height
    y = (1 - 2 * (numpy.arange(height) + 0.5) / height) * tangent
    x, y = numpy.meshgrid(x, y)
    c, s = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    directions = numpy.stack([x * c + s, y, x * s - c], axis=-1)
    return directions / numpy.linalg.norm(directions, axis=-1, keepdims=True)


def box_distance(directions, low, high):
    with numpy.errstate(divide="ignore", invalid="ignore"):
        a, b = (low - EYE) / directions, (high - EYE) / directions
    near, far = numpy.minimum(a, b).max(axis=-1), numpy.maximum(a, b).min(axis=-1)
    return numpy.where((near < far) & (near > 0), near, SKY_DISTANCE)


def lamps(random, count):
    """Position, radius [m] and radiance; as wide as one to three pixels of a picture 180 pixels high."""
    for _ in range(count):
        distance, azimuth = 10 ** random.uniform(1.5, 2.7), math.radians(random.uniform(-50, 50))
        place = EYE + distance * numpy.array([math.sin(azimuth), 0.0, -math.cos(azimuth)])
        place[1] = EYE[1] + random.uniform(-0.12, 0.25) * distance
        pixel = distance * 2 * math.tan(math.radians(FIELD_OF_VIEW) / 2) / 180
        yield place, random.uniform(0.6, 1.5) * pixel, 10 ** random.uniform(2.0, 4.0)


def night(width, height, yaw=0.0, seed=7):
    """Radiance [height, width, 3] and distance [height, width]: lamps up to 10^4 over a night of .01 to .3."""
    random = numpy.random.RandomState(seed)
    directions = rays(width, height, yaw)
    radiance = numpy.full((height, width, 3), 0.0) + numpy.array([0.010, 0.012, 0.020])
    with numpy.errstate(divide="ignore"):
        distance = numpy.where(directions[..., 1] < 0, -EYE[1] / directions[..., 1], SKY_DISTANCE)
    ground = distance < 2000
    distance = numpy.where(ground, distance, SKY_DISTANCE)
    radiance[ground] = [0.05, 0.045, 0.04]
    for _ in range(36):
        away, azimuth = 10 ** random.uniform(1.8, 2.8), math.radians(random.uniform(-60, 60))
        middle = EYE + away * numpy.array([math.sin(azimuth), 0.0, -math.cos(azimuth)])
        half = random.uniform(3.0, 16.0, 3) * numpy.array([1.0, 1.6, 1.0])
        middle[1] = half[1]
        hit = box_distance(directions, middle - half, middle + half)
        nearer = hit < distance
        distance[nearer] = hit[nearer]
        radiance[nearer] = random.uniform(0.03, 0.3) * numpy.array([1.0, 0.9, 0.8])
    scale = height / (2 * math.tan(math.radians(FIELD_OF_VIEW) / 2))
    for place, radius, power in lamps(random, 90):
        tint = numpy.array([1.0, random.uniform(0.5, 1.0), random.uniform(0.2, 1.0)])
        towards = place - EYE
        away = numpy.linalg.norm(towards)
        angle = numpy.linalg.norm(numpy.cross(directions, towards / away), axis=-1)
        front = (directions @ towards) > 0
        # a lamp's edge is as soft as a pixel, so that its power does not depend on where the pixels lie
        cover = numpy.clip((radius / away - angle) * scale + 0.5, 0, 1) * front * (distance > away)
        radiance = radiance * (1 - cover[..., None]) + cover[..., None] * power * tint
        distance = numpy.where(cover > 0, away, distance)
    return radiance, distance


def step(width, height):
    """A dim near half and a bright far half, and the other way round below."""
    radiance = numpy.empty((height, width, 3))
    distance = numpy.empty((height, width))
    left, above = numpy.arange(width) < width // 2, numpy.arange(height)[:, None] < height // 2
    distance[:] = numpy.where(left, 20.0, 400.0)
    radiance[:] = numpy.where(left == above, 0.05, 5.0)[..., None]
    return radiance, distance


def write(path, radiance, distance):
    write_exr(path, {**{name: radiance[..., i] for i, name in enumerate("RGB")}, "Z": distance})


def scene_text(media, yaw=0.0):
    """A scene file for composite; `media` is the text of [[fog.media]] entries, before which other keys of [fog] may stand."""
    target = EYE + numpy.array([math.sin(math.radians(yaw)), 0.0, -math.cos(math.radians(yaw))])
    return (f"cloud = []\n[camera]\nposition = {list(map(float, EYE))}\ntarget = {list(map(float, target))}\n"
            f"vertical_fov = {FIELD_OF_VIEW}\n[fog]\nsky_distance = {FOG_ENDS}\n{media}")


def medium(scattering, g):
    return f"[[fog.media]]\nscattering = {scattering}\ng = {g}\n"


def add_options(parser):
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--width", type=int, default=320)
    parser.add_argument("--height", type=int, default=180)
    parser.add_argument("--yaw", type=float, default=0.0, help="degrees that the camera is rotated by")


def main(options):
    options.folder.mkdir(parents=True, exist_ok=True)
    write(options.folder / "night.exr", *night(options.width, options.height, options.yaw))
    write(options.folder / "step.exr", *step(options.width, options.height))
    for i, (scattering, g) in enumerate(MEDIA):
        (options.folder / f"medium{i}.toml").write_text(scene_text(medium(scattering, g), options.yaw))
