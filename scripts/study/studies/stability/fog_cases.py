"""Cases of the stability report for the fog: `composite` of a small picture with lamps of 1e5, through stiff media."""

import math
import random

import numpy

from study.pictures import read_exr, write_exr
from study.program import Failure
from study.studies.stability.tools import Case, Outcome

CAMERA = "cloud = []\n[camera]\nposition = {eye}\ntarget = {target}\nup = {up}\nvertical_fov = 60\n"


def picture(path, width, height, distance):
    """A dim picture with lamps of 1e5; `distance` of a pixel by its index."""
    numbers = random.Random(1)
    count = width * height
    light = [1e5 if numbers.random() < 0.02 else 0.1 for _ in range(count)]
    layers = {"R": light, "G": light, "B": light, "Z": [distance(i) for i in range(count)]}
    write_exr(path, {name: numpy.reshape(values, (height, width)) for name, values in layers.items()})
    return light


def composite(lumulus, media, width=40, height=24, distance=lambda i: 50.0, eye=(0, 10, 0), target=(0, 10, -1),
              up=(0, 1, 0)):
    """Input and output of one channel. Fails where a value is not finite or below 0."""
    color, scene, output = (lumulus.path(name, suffix="") for name in ("fog.exr", "fog.toml", "fogged.exr"))
    light = picture(color, width, height, distance)
    scene.write_text(CAMERA.format(eye=list(eye), target=list(target), up=list(up)) + "[[fog.media]]\n" + media)
    lumulus.composite(color, scene, output)
    values = read_exr(output)["G"].ravel()
    if not (numpy.isfinite(values) & (values >= 0.0)).all():
        raise Failure("a value is not finite or below 0")
    return light, values.tolist()


def kept(name, why, media, share, tolerance=0.02, **view):
    """A case whose picture keeps that share of its light."""
    def run(lumulus):
        light, values = composite(lumulus, media, **view)
        found = sum(values) / sum(light)
        return Outcome(f"{found:.6g} of the light (expected {share:.6g})", None,
                       abs(found - share) <= tolerance * share + 1e-30)

    return Case(name, why, run)


def mixed(lumulus):
    """Depths from nothing to the sky side by side: finite is what is asked for."""
    depths = (0.0, 1e-6, 1.0, 1e4, 1e10, float("inf"))
    light, values = composite(lumulus, "visibility = 50\n", distance=lambda i: depths[i % len(depths)])
    return Outcome(f"{sum(values) / sum(light):.4g} of the light", None, True)


def fog_cases():
    for visibility in (1, 100, 1e6):
        for g in (0, 0.9, 0.9999):
            yield kept(f"visibility {visibility:g} m, g {g:g}", "nothing is absorbed: all light is kept",
                       f"visibility = {visibility}\ng = {g}\n", 1.0)
    for falloff in (1e-9, 1e-3, 0.1, 10):
        medium = f'kind = "exponential"\nabsorption = 1e-4\nfalloff = {falloff}\n'
        depth = -1e-4 * math.expm1(-falloff * 1e4) / falloff
        yield kept(f"falloff {falloff:g}, looking down from 10 km", "∫ϱ to the ground in closed form", medium,
                   math.exp(-depth), 0.01, distance=lambda i: 1e4, eye=(0, 1e4, 0), target=(0, 0, 0), up=(0, 0, -1), width=1,
                   height=1)
        above = 1e-4 * math.exp(-falloff * 100) * 1000
        yield kept(f"falloff {falloff:g}, exactly level at 100 m", "the same density along the whole path", medium,
                   math.exp(-above), 1e-3, distance=lambda i: 1000.0, eye=(0, 100, 0), target=(0, 100, -1), width=1,
                   height=1)
        up = 1e-4 * math.exp(-falloff * 1e4) * (-math.expm1(-falloff * 5e4) / falloff)
        yield kept(f"falloff {falloff:g}, looking up from 10 km", "∫ϱ over 50 km in closed form", medium, math.exp(-up), 1e-3,
                   distance=lambda i: 5e4, eye=(0, 1e4, 0), target=(0, 2e4, 0), up=(0, 0, -1), width=1, height=1)
    sphere = 'kind = "sphere"\nabsorption = 0.01\nradius = 100\n'
    yield kept("in the middle of a sphere", "∫ϱ = 2R/3", sphere, math.exp(-2 / 3), 1e-3, distance=lambda i: 500.0,
               eye=(0, 0, 0), target=(0, 0, -1))
    yield kept("1e6 m from a sphere, through its middle", "∫ϱ = 4R/3", sphere, math.exp(-4 / 3), 1e-2,
               distance=lambda i: 2e6, eye=(0, 0, 1e6), target=(0, 0, 0), width=1, height=1)
    for width, height in ((1, 1), (2, 1), (8191, 3), (3, 700)):
        yield kept(f"{width}×{height} pixels", "all light is kept", "visibility = 100\n", 1.0, width=width, height=height)
    yield Case("depths 0, 1e-6, 1, 1e4, 1e10 and infinity side by side", "finite, nothing below 0", mixed)
