"""Plane-parallel layers of known answer: by doubling, in the diffusion limit, to first order, and in closed form."""

import math

from study.layers import layer
from study.program import Failure
from study.studies.stability.tools import Case, Outcome


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
    """Against study/layers.py, whose own error is below 5e-5 (by the published layers)."""
    return slab_case(name, "by doubling (study/layers.py, good to 5e-5)", lambda: layer(tau, g, albedo), 5e-5, tau=tau,
                     g=g, albedo=albedo, mu0=1, photons=photons)


def backward_share(g):
    """Share of Henyey-Greenstein that is scattered by more than 90°."""
    return (1.0 - g) / (2.0 * g) * ((1.0 + g) / math.sqrt(1.0 + g * g) - 1.0)


# Of isotropic scattering without absorption (van de Hulst 1980): twice the extrapolation length, and the escape function
# √3/4·H(1) of vertical light.
EXTRAPOLATED, ESCAPE = 2 * 0.710446, math.sqrt(3.0) / 4.0 * 2.907810


def layer_cases():
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
    yield slab_case("g −.999, τ 1", "in one dimension, where each scattering event reverses, R = τ/(1+τ); the lobe's width moves it "
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
