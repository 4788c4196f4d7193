"""Clouds and fog in one light, against two independent references: cumulus-haze.toml as it is shipped, and variants of it.
relMSE and bias of all pixels and of those that show a cloud in linear radiance, which two references free of their noise
(relative errors are against the picture, since references of few samples are too noisy to divide by), and the same of what
an older program makes of the scene (--before). References that are in the folder already are gone on with.

    scripts/study/run fog_light --folder build/fog-light --spp 256
    scripts/study/run fog_light --sky atmosphere --folder build/fog-air --spp 256
"""

import numpy

from study.lumulus import Lumulus, add_common_options
from study.pictures import read_exr, rgb
from study.program import size_sets
from study.tables import Table, write_figures

SCENE = "cumulus-haze"
# Goals of the qualities for |bias| and relMSE.
GOALS = {"final": (0.02, 1e-2), "interactive": (0.04, 2e-2)}


def media(*texts):
    return "fog.media=[" + ", ".join("{ " + text + " }" for text in texts) + "]"


def exponential(**values):
    return media('kind = "exponential", falloff = 0.004, g = 0.85, ' +
                 ", ".join(f"{key} = {value}" for key, value in values.items()))


LAYER = media('kind = "homogeneous", visibility = 200, top = -200, g = 0.85')
# Overrides of the shipped scene.
CASES = {
    "haze": [],
    "visibility 10 km": [exponential(visibility=10000)],
    "visibility 200 km": [exponential(visibility=200000)],
    "layer, seen from above": [LAYER, "camera.position=[0, 150, 1600]", "camera.target=[0, 0, 0]"],
    "layer, seen from within": [LAYER, "camera.position=[0, -240, 1600]", "camera.target=[0, 0, 0]"],
    "sun at 5 degrees": ["sun.elevation=5"],
    "sun behind the cloud": ["camera.position=[-1500, 0, 550]", "camera.target=[0, 50, 0]", "sun.elevation=10"],
    "thick, seen from within": [media('kind = "homogeneous", visibility = 500, top = 700, g = 0.85'),
                                "camera.position=[0, 0, 900]", "camera.target=[0, 0, 0]"],
    "absorbing haze": [exponential(scattering=0.0019, absorption=0.0001)],
    "sun at 60 degrees": ["sun.elevation=60"],
    "sun at 20 degrees": ["sun.elevation=20"],
    "layer below the cloud": [media('kind = "homogeneous", visibility = 1500, top = 0, g = 0.85'),
                              "camera.position=[0, 150, 1600]", "camera.target=[0, 0, 0]"],
    "two clouds": ['cloud=[{ procedural = "cumulus", resolution = 128 }, { procedural = "cumulus", resolution = 128, '
                   'seed = 3, transform = [[1, 0, 0, 900], [0, 1, 0, 100], [0, 0, 1, -300]] }]'],
}


def add_options(parser):
    add_common_options(parser, width=160)
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES))
    parser.add_argument("--sky", default="constant", choices=["constant", "atmosphere"])
    parser.add_argument("--quality", default="final", choices=["interactive", "final"])
    parser.add_argument("--spp", type=int, default=256, help="of each reference")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1], help="of the pictures")
    parser.add_argument("--before", help="another executable, whose pictures of the same scenes are judged too")


def whole(picture, truths):
    """Bias by channel and relMSE over all pixels."""
    seen, first, second = (rgb(read_exr(path)).astype(float) for path in (picture, *truths))
    truth = 0.5 * (first + second)
    bias = seen.mean(axis=(0, 1)) / truth.mean(axis=(0, 1)) - 1
    return list(bias), float(numpy.mean((seen - first) * (seen - second) / (seen ** 2 + 1e-12)))


def judged(lumulus, name, sets, truths, options, seed):
    """The figures of a row."""
    picture = lumulus.path(name.replace(" ", "-").replace(",", ""), options.quality, seed)
    stats = lumulus.render(SCENE, picture, [*sets, f"photon_map.seed={seed}"], ["--quality", options.quality])
    found = lumulus.compare(picture, *truths, denominator=picture)
    biases, error = whole(picture, truths)
    bias, relmse = GOALS[options.quality]
    return {"scene": name, "seed": seed, "bias": biases, "relmse": error, "cloud_relmse": found["relmse"],
            "cloud_bias": found["relative_bias"], "seconds": stats["seconds"]["total"],
            "meets": max(map(abs, biases)) <= bias and error <= relmse}


def main(options):
    sets = [*size_sets(options.width), f'sky.model="{options.sky}"']
    lumulus = Lumulus.of(options, sets)
    table = Table(["scene", "seed", "bias of R, G, B", "relMSE", "bias, cloud", "relMSE, cloud", "total s", "goals"])
    for name in options.cases:
        words = name.replace(" ", "-").replace(",", "")
        truths = [lumulus.reference(SCENE, lumulus.path(words, "truth", seed), CASES[name], spp=options.spp, seed=seed)
                  for seed in (101, 102)]
        programs = [("", lumulus)]
        if options.before:
            programs.append((" (before)", Lumulus(options.before, lumulus.folder / "before", [*options.set, *sets])))
        for suffix, program in programs:
            for seed in options.seeds:
                figures = judged(program, name, CASES[name], truths, options, seed)
                figures["scene"] += suffix
                biases = ", ".join(f"{100 * bias:+.1f}" for bias in figures["bias"])
                table.add(figures, [figures["scene"], str(seed), f"{biases} %", f"{figures['relmse']:.4f}",
                                    f"{100 * figures['cloud_bias']:+.1f} %", f"{figures['cloud_relmse']:.4f}",
                                    f"{figures['seconds']:.1f}", "meets" if figures["meets"] else "misses"])
    write_figures(options, table.figures)
