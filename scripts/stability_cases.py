"""The cases of the stability report: what is run, what is expected and why."""

import math
import re
import subprocess
from dataclasses import dataclass
from typing import Callable

from layers import layer
from stability_fog import fog_cases
from stability_tools import Failure, Outcome, mean_and_error


@dataclass
class Case:
    name: str
    expected: str
    run: Callable
    reason: str = ""  # why it does not hold, where that is known
    seconds: float = 0.0  # a time limit of its own


# ---- layers

def judge(found, expected, photons, tolerance=0.0):
    """Fractions found and expected, and the largest deviation beyond `tolerance` in standard errors (binomial, of the
    expected fraction: that of the found one is zero where nothing was counted)."""
    texts, worst = [], 0.0
    for name, value in expected.items():
        error = math.sqrt(max(value * (1.0 - value), 0.0) / photons)
        beyond = max(abs(found[name] - value) - tolerance, 0.0) * math.copysign(1.0, found[name] - value)
        texts.append(f"{name} {found[name]:.6g} (expected {value:.6g})")
        # one photon is the finest step of a count
        z = 0.0 if abs(beyond) <= 1.0 / photons else beyond / max(error, 1e-9)
        worst = z if abs(z) > abs(worst) else worst
    return Outcome(", ".join(texts), worst, abs(worst) < 4.5)


def slab_case(name, why, expected, tolerance=0.0, **values):
    def run(lumulus):
        photons = values["photons"]
        found = lumulus.slab(**values)
        found["transmitted"] = found["transmitted_diffuse"] + found["transmitted_direct"]
        if found["lost"]:
            raise Failure(f"{found['lost']} photons lost")
        if abs(found["reflected"] + found["transmitted"] + found["absorbed"] - 1.0) > 1e-12:
            raise Failure("the fractions do not add up to 1")
        return judge(found, expected() if callable(expected) else expected, photons, tolerance)

    return Case(name, why, run)


def doubled(name, tau, g, albedo, photons=200000):
    """Against scripts/layers.py, whose own error is below 5e-5 (by the published layers)."""
    return slab_case(name, "by doubling (scripts/layers.py, good to 5e-5)", lambda: layer(tau, g, albedo), 5e-5, tau=tau,
                     g=g, albedo=albedo, mu0=1, photons=photons)


def backward_share(g):
    """Share of Henyey-Greenstein that is scattered by more than 90°."""
    return (1.0 - g) / (2.0 * g) * ((1.0 + g) / math.sqrt(1.0 + g * g) - 1.0)


# Of isotropic scattering without absorption (van de Hulst 1980): twice the extrapolation length, and the escape function
# √3/4·H(1) of vertical light.
EXTRAPOLATED, ESCAPE = 2 * 0.710446, math.sqrt(3.0) / 4.0 * 2.907810


def layers():
    thin = {"reflected": 0.0, "transmitted": 1.0, "absorbed": 0.0}
    yield slab_case("τ 0", "nothing is there: all goes through", thin, tau=0, g=0.85, albedo=1, mu0=0.5, photons=100000)
    yield slab_case("τ 1e-6, black", "1 − e^−τ is absorbed", {"absorbed": 1e-6}, tau=1e-6, g=0, albedo=0, mu0=1,
                    photons=10**7)
    yield doubled("τ 1, isotropic", 1.0, 0.0, 1.0)
    yield doubled("τ 1e2, isotropic", 1e2, 0.0, 1.0, 20000)
    for tau, photons in ((1e4, 256), (1e6, 64)):
        through = 4.0 / 3.0 * ESCAPE / (tau + EXTRAPOLATED)
        yield slab_case(f"τ {tau:g}, isotropic, {photons} photons", f"the diffusion limit: {through:.2g} goes through",
                        {"reflected": 1.0 - through, "transmitted": through, "absorbed": 0.0}, tau=tau, g=0, albedo=1,
                        mu0=1, photons=photons)
    yield doubled("τ 1e6, g .85, albedo .99", 1e6, 0.85, 0.99, 20000)
    yield slab_case("g −.999, τ 1", "in one dimension, where each turn reverses, R = τ/(1+τ); the lobe's width moves it "
                    "by the order of 1 − |g|: ±.001 allowed", {"reflected": 0.5, "transmitted": 0.5}, 1e-3, tau=1,
                    g=-0.999, albedo=1, mu0=1, photons=200000)
    for g in (0.0, 1e-6, 0.85):
        yield doubled(f"g {g:g}, τ 2, albedo .9", 2.0, g, 0.9)
    for g, tau in ((0.99, 1.0), (0.9999, 100.0)):
        share = tau * backward_share(g)
        yield slab_case(f"g {g:g}, τ {tau:g}", "to first order in 1 − g: τ times the share of the phase function beyond "
                        "90°; the second order is allowed for", {"reflected": share, "transmitted": 1.0 - share},
                        share * 3.0 * tau * (1.0 - g), tau=tau, g=g, albedo=1, mu0=1, photons=200000)
    for albedo in (1e-6, 0.5, 1 - 1e-6, 1):
        yield doubled(f"albedo {albedo:.7g}, τ 4, g .85", 4.0, 0.85, albedo)
    yield slab_case("albedo 0, τ 4", "e^−τ goes through, the rest is absorbed", {
        "reflected": 0.0, "transmitted": math.exp(-4.0), "absorbed": 1.0 - math.exp(-4.0)}, tau=4, g=0.85, albedo=0,
                    mu0=1, photons=200000)


# ---- pictures

def cloud_mean(picture):
    """Mean radiance, G, of the pixels in the middle: all of them see the thick of the ball."""
    g = picture.layers["G"]
    rows = range(picture.height * 3 // 8, picture.height * 5 // 8)
    columns = range(picture.width * 3 // 8, picture.width * 5 // 8)
    values = [g[y * picture.width + x] for y in rows for x in columns]
    return sum(values) / len(values)


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
                   counts["escaped"] == counts["photons"] and min(picture.layers["G"]) >= 0.0)


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
        subprocess.run([lumulus.fixtures, lumulus.folder], check=True)
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
        lumulus.output("cloud", "slab", "-o", path, "--resolution", resolution)
        picture = lumulus.render(f"cloud.0.vdb={path}", "photon_map.photons=1000", "image.width=64", "image.height=64",
                                 'camera.projection="orthographic"', "camera.vertical_fov=20",
                                 f"camera.position=[{450 * sine!r},{50 + 450 * cosine!r},0]", "camera.target=[0,50,0]",
                                 "camera.up=[0,0,1]")
        errors = [t - expected for t in picture.layers["transmittance.G"]]
        worst, mean = max(map(abs, errors)), sum(errors) / len(errors)
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


def maps(spp):
    def runs(lumulus):
        lumulus.render("photon_map.photons=1", "photon_map.generations=1")
        return Outcome("finite, energy closed", None, True)

    yield Case("1 photon", "a finite picture, the photon accounted for", runs)
    for bands in range(1, 9):
        yield against_reference(f"bands {bands}", spp, f"photon_map.bands={bands}", bound=0.15 if bands < 3 else 0.05)
    wide = "the light of one turn is summed for small angles only: 15° is what it is made for"
    uncut = "four bands do not hold a peak that is not cut: the row of six has it"
    for cut, reason in ((0, uncut), (45, wide), (90, wide)):
        yield against_reference(f"forward_cut {cut}°", spp, f"photon_map.forward_cut={cut}", reason=reason)
    yield against_reference("forward_cut 0°, 6 bands", spp, "photon_map.forward_cut=0", "photon_map.bands=6")
    yield against_reference("1 generation", spp, "photon_map.generations=1")
    yield against_reference("4096 generations", spp, "photon_map.generations=4096", "photon_map.photons=40960",
                            "photon_map.bands=3", "cloud.0.resolution=8", "preparation.samples=500", seconds=240)

    def many(lumulus):
        """Each collision in the thin ball is as rare with 2^31 photons at once as with 2^24 of other numbers."""
        thin = ("cloud.0.resolution=8", "cloud.0.extinction=1e-4")
        some = lumulus.render(*thin, "photon_map.photons=16777216", "photon_map.generations=16")
        most = lumulus.render(*thin, f"photon_map.photons={2**31}", "photon_map.generations=1")
        rates = [picture.statistics["events"] / picture.statistics["photons"] for picture in (some, most)]
        error = math.sqrt(rates[0] / some.statistics["photons"])
        counted = most.statistics["photons"] == most.statistics["escaped"] == 2**31
        bias = lumulus.compare(some.path, most.path)["relative_bias"]
        deviation = (rates[0] - rates[1]) / error
        return Outcome(f"{most.statistics['escaped']} photons escaped, {rates[1]:.6f} collisions each (2^24 photons: "
                       f"{rates[0]:.6f} ± {error:.1g}), pictures differ by {100 * bias:+.2f} %", deviation,
                       counted and abs(deviation) < 4.5 and abs(bias) < 0.01)

    yield Case("2^31 photons in one generation, τ .02", "every photon counted, collisions and light as with 2^24 photons in "
               "16 generations", many, seconds=3600)

    def refused(lumulus):
        done = lumulus.run("render", lumulus.scene, "-o", lumulus.folder / "refused.exr", "--quiet", *lumulus.overrides(
            ("photon_map.generations=4096", "photon_map.memory_budget=1", "photon_map.bands=8")))
        message = done.stderr.strip()
        numbers = re.search(r"needs [\d.]+ MiB.* its budget is 1\.00 MiB \(photon_map\.memory_budget\)", message)
        return Outcome(message, None, done.returncode == 2 and numbers is not None and "\n" not in message
                       and not (lumulus.folder / "refused.exr").exists())

    yield Case("4096 generations over the memory budget of 1 MiB", "refused with both numbers: exit code 2, no picture",
               refused)

    def averaged(lumulus):
        path = lumulus.folder / "large.vdb"
        lumulus.output("cloud", "sphere", "-o", path, "--resolution", 160)
        done = lumulus.run("render", lumulus.scene, "-o", lumulus.folder / "small.exr", "--quiet", *lumulus.overrides(
            (f"cloud.0.vdb={path}", "preparation.memory_budget=1", "photon_map.photons=1000")))
        message = done.stderr.strip().replace(str(path), path.name)
        return Outcome(message, None, done.returncode == 0 and "1 MiB" in message and "averaged to" in message)

    yield Case("density over the memory budget", "averaged to fewer voxels; a warning says so with both sizes", averaged)


def all_groups(spp):
    return (("Layers (`lumulus slab`)", list(layers())), ("White furnace", list(furnaces())),
            ("Media", list(media(spp))), ("Density fields", list(fields(spp))),
            ("Shapes and places", list(places(spp))), ("Cameras and suns", list(cameras(spp))),
            ("Photon map", list(maps(spp))), ("Fog (`lumulus composite`)", list(fog_cases(Case))))
