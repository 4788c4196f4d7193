"""Pictures in stiff and extreme cases: a white furnace, and variations of the plain scene against the reference."""

import math

import numpy

from study.program import succeeded
from study.studies.stability.tools import Case, Outcome, mean_and_error


def cloud_mean(picture):
    """Mean radiance, G, of the pixels in the middle: all of them see the thick of the ball."""
    g = picture.layers["G"]
    height, width = g.shape
    return float(g[height * 3 // 8:height * 5 // 8, width * 3 // 8:width * 5 // 8].mean(dtype=float))


def white(tau, photons):
    return (f"cloud.0.extinction={tau / 200.0!r}", "sun.irradiance=0", "sky.radiance=1", f"photon_map.photons={photons}",
            "photon_map.generations=2")


def furnace(tau, photons, bound=0.01):
    """Four independent renders say how large the noise is."""
    def run(lumulus):
        pictures = [lumulus.render(*white(tau, photons), seed=seed) for seed in range(1, 5)]
        mean, error = mean_and_error([cloud_mean(picture) for picture in pictures])
        deviation = (mean - 1.0) / error if error > 1e-7 else 0.0
        return Outcome(f"{mean:.5f} ± {error:.1g}", deviation, abs(mean - 1.0) < bound + 4.0 * error)

    return Case(f"τ {tau:g}, {photons} photons", f"radiance 1 ± {bound:g}: equal light from everywhere fills what does not "
                "absorb", run)


def furnaces():
    for tau, photons in ((0, 1000), (1e-6, 1000), (1, 20000), (1e2, 20000)):
        yield furnace(tau, photons)
    for tau, photons in ((1e4, 300), (1e6, 20)):
        yield Case(f"τ {tau:g}, {photons} photons", "finite, energy closed, no photon lost. (The mean is not judged: light "
                   "gets in by the few photons that wander on for millions of collisions)",
                   lambda lumulus, t=tau, p=photons: deep(lumulus, t, p))


def deep(lumulus, tau, photons):
    picture = lumulus.render(*white(tau, photons))
    counts = picture.statistics
    return Outcome(f"{counts['events']} collisions, {counts['escaped']} of {counts['photons']} photons escaped", None,
                   counts["escaped"] == counts["photons"] and picture.layers["G"].min() >= 0.0)


def against_reference(name, spp, *sets, bound=0.05, why="", reason="", prepare=None, seconds=0.0):
    def run(lumulus):
        more = prepare(lumulus) if prepare else ()
        picture, truth = lumulus.render(*sets, *more), lumulus.reference(*sets, *more, spp=spp)
        found = lumulus.compare(picture.path, truth)
        bias, error = found["relative_bias"], found["standard_error"]["relative_bias"] or 0.0
        text = f"bias {100 * bias:+.2f} % ± {100 * error:.2f} %, relMSE {found['relmse']:.2g}"
        return Outcome(text, bias / error if error > 0.0 else None, abs(bias) < bound + 4.0 * error)

    return Case(name, f"{why + ': ' if why else ''}the reference's picture, |bias| < {100 * bound:g} %", run, reason,
                seconds)


def media(spp):
    for g in (-0.999, 0, 1e-6, 0.85, 0.99, 0.9999):
        yield against_reference(f"g {g:g}", spp, f"cloud.0.phase.g={g!r}", reason="" if g > -0.9 else (
            "the sun's beam goes to and fro along itself; the bands of a collector smear it over all directions (with the "
            "sky alone the row holds, below)"))
    yield against_reference("g -0.999, sky alone", spp, "cloud.0.phase.g=-0.999", "sun.irradiance=0")
    for albedo in ("0", "1e-6", "0.5", "0.999999", "1", "[1.0, 0.5, 0.0]"):
        yield against_reference(f"albedo {albedo}", spp, f"cloud.0.albedo={albedo}")
    for extinction, photons in ((0.1, 60000), (0.5, 60000), (50, 1000), (5000, 20)):
        yield against_reference(
            f"extinction {extinction:g} 1/m, albedo .9, g 0", spp, f"cloud.0.extinction={extinction}",
            "cloud.0.albedo=0.9",
            "cloud.0.phase.g=0", f"photon_map.photons={photons}", "photon_map.generations=2", why=f"free path {1 / extinction:g} m in voxels of 6.25 m",
            reason="collectors and the sun's grid of optical depths are no finer than a voxel, and the eye sees a skin that is "
            "thinner and brighter than their mean (at 0.5 1/m, 64 samples per pixel: sun alone −30 %, sky alone −38 %)")


def fixture(lumulus, name, extinction):
    """The files of make_vdb_fixtures, written once."""
    path = lumulus.folder / name
    if not path.exists():
        succeeded(lumulus.fixtures, lumulus.folder)
    return f"cloud.0.vdb={path}", f"cloud.0.extinction={extinction!r}"


def fields(spp):
    for name, file, extinction, why in (
            ("one voxel", "one-voxel.vdb", 1.0, "a tent of 2 voxels' width"),
            ("one voxel of 1e6 in a field of 1", "spike.vdb", 1e-4, "one voxel sets the majorant"),
            ("checkerboard", "checkerboard.vdb", 0.3, "the steepest gradients everywhere")):
        yield against_reference(name, spp, why=why,
                                prepare=lambda lumulus, f=file, e=extinction: fixture(lumulus, f, e))


def uniform(slant, resolution, reason=""):
    """Transmittance of a layer 100 m high, seen along parallel rays: σL is 2 over the cosine of the slant."""
    angle = math.radians(slant)
    sine, cosine = math.sin(angle), math.cos(angle)
    expected = math.exp(-2.0 / cosine)

    def run(lumulus):
        path = lumulus.folder / f"layer-{resolution}.vdb"
        lumulus.succeeded("cloud", "slab", "-o", path, "--resolution", resolution)
        picture = lumulus.render(f"cloud.0.vdb={path}", "photon_map.photons=1000", "image.width=64", "image.height=64",
                                 'camera.projection="orthographic"', "camera.vertical_fov=20",
                                 f"camera.position=[{450 * sine!r},{50 + 450 * cosine!r},0]", "camera.target=[0,50,0]",
                                 "camera.up=[0,0,1]")
        errors = picture.layers["transmittance.G"].astype(float) - expected
        worst, mean = numpy.abs(errors).max(), errors.mean()
        return Outcome(f"largest error of a pixel {worst:.1e}, mean error {mean:+.1e}", None, worst < 1e-3)

    return Case(f"uniform layer, {slant}° off the vertical, voxels of {400 / resolution:g} m",
                f"every pixel e^(−σL) = {expected:.4f} to 1e-3: no trace of the borders of leaves and cells", run, reason)


def same_picture(name, why, *sets, bound=0.01):
    """The picture of the plain scene, of which another seed shows the noise."""
    def run(lumulus):
        plain, changed, other = lumulus.render(), lumulus.render(*sets), lumulus.render(seed=2)
        found, noise = lumulus.compare(changed.path, plain.path), lumulus.compare(other.path, plain.path)
        return Outcome(f"bias {100 * found['relative_bias']:+.3f} %, relMSE {found['relmse']:.2g} (another seed: "
                       f"{noise['relmse']:.2g})", None,
                       abs(found["relative_bias"]) < bound and found["relmse"] < 2.0 * noise["relmse"])

    return Case(name, why, run)


def matrix(*rows):
    return "cloud.0.transform=[" + ",".join(str(list(row)) for row in rows) + "]"


def scaled(voxel):
    scale = voxel / 6.25
    return (matrix((scale, 0.0, 0.0, 0.0), (0.0, scale, 0.0, 0.0), (0.0, 0.0, scale, 0.0)),
            f"cloud.0.extinction={0.02 / scale!r}")


def places(spp):
    for slant in (0, 30):
        yield uniform(slant, 256)
        yield uniform(slant, 64, "the march takes one sample a voxel, at an offset that differs from pixel to pixel: at the "
                      "layer's faces, where the density rises within one voxel, pixels differ, their mean does not")
    same = "the same picture as the plain scene: only optical depths count"
    yield same_picture("voxels of 1 mm", same, *scaled(1e-3))
    yield same_picture("voxels of 10 km", same, *scaled(1e4))
    yield same_picture("cloud 1e7 m from the origin", "the same picture: positions on the GPU are relative to the cloud",
                       matrix((1.0, 0.0, 0.0, 1e7), (0.0, 1.0, 0.0, 1e7), (0.0, 0.0, 1.0, -1e7)))
    yield against_reference("scales 1, .2 and 3", spp, matrix((1, 0, 0, 0), (0, 0.2, 0, 0), (0, 0, 3, 0)))
    yield against_reference("shear", spp, matrix((1, 0.7, 0, 0), (0, 1, 0, 0), (0, 0.3, 1, 0)))
    yield against_reference("mirrored", spp, matrix((-1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0)))


NEAR_EYE = ("most likely for this: the light of a collector is worked out for the direction from its centre to the eye; "
            "near the eye rays have other directions (sun alone −15 % whatever the number of photons, with g 0 +3 %, sky "
            "alone 0 %)")


def cameras(spp):
    for name, position, target in (("inside the cloud", (13, 91, 7), (60, 110, -100)),
                                   ("at a corner of a voxel", (0, 100, 0), (60, 110, -100)),
                                   ("on the cloud's face", (0, 100, 100), (0, 100, 0)),
                                   ("looking along an axis", (0, 100, 300), (0, 100, 0)),
                                   ("straight down", (0, 400, 0.0), (0, 100, 0))):
        up = ("camera.up=[0,0,1]",) if name == "straight down" else ()
        yield against_reference(name, spp, f"camera.position={list(position)}", f"camera.target={list(target)}", *up,
                                reason=NEAR_EYE if target[0] == 60 else "")
    for name, direction in (("sun along an axis", "[1,0,0]"), ("sun in the zenith", "[0,1,0]"),
                            ("sun below the horizon", "[0.9,-0.3,0.2]")):
        yield against_reference(name, spp, f"sun.direction_to={direction}")
