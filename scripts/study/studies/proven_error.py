"""Whether the error that `render --error-paths` states of a picture is the picture's, over many seeds. Of each seed a picture is
made and its error measured; then it is compared with a truth of many samples. Stated figures hold where they are within
one and two standard errors of those as often as a normal distribution is: 68 and 95 %. The truth's own noise is counted.
"""

import math

from study.lumulus import Lumulus, add_common_options
from study.program import size_sets
from study.tables import Table, write_figures

SCENES = ["cumulus-side-lit", "cumulus-haze", "two-clouds", "stratus", "sky-sunset"]


def add_options(parser):
    add_common_options(parser, width=160)
    parser.add_argument("--scenes", nargs="+", default=SCENES)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--photons", type=int, default=200_000)
    parser.add_argument("--paths", type=int, default=100_000, help="that measure an error")
    parser.add_argument("--spp", type=int, default=512, help="of the truth")


def measured(lumulus, scene, seed, options, truth):
    """What a picture states, what it is, and the standard errors of both."""
    picture = lumulus.path(scene, "picture")
    stats = lumulus.render(scene, picture, [f"photon_map.seed={seed}", f"photon_map.photons={options.photons}"],
                           ["--error-paths", options.paths])
    stated = stats["error"]
    found = lumulus.compare(picture, truth, denominator=picture)
    bias = found["relative_bias"] / (1 + found["relative_bias"])  # over the picture's mean
    noise = found["standard_error"]["relative_bias"]
    sigma = math.hypot(stated["bias_sigma"], noise)
    relmse = found["relmse"] - found["reference_noise"]
    error_seconds = stated["seconds"]
    return {"scene": scene, "seed": seed, "bias": stated["bias"], "bias_sigma": stated["bias_sigma"], "true_bias": bias,
            "z": (stated["bias"] - bias) / sigma, "relmse": stated["relmse"], "relmse_sigma": stated["relmse_sigma"],
            "true_relmse": relmse, "z_relmse": (stated["relmse"] - relmse) / stated["relmse_sigma"],
            "seconds": stats["seconds"]["total"] - error_seconds, "error_seconds": error_seconds, "lost": stated["lost"]}


def mean(figures, key):
    return sum(one[key] for one in figures) / len(figures)


def share(figures, key, sigmas):
    return f"{100 * sum(abs(one[key]) < sigmas for one in figures) / len(figures):.0f} %"


def main(options):
    lumulus = Lumulus.of(options, size_sets(options.width))
    table = Table(["scene", "seeds", "bias", "stated", "σ", "within 1 σ", "2 σ", "mean z", "relMSE", "stated", "σ", "within 2 σ",
                   "s of paths", "s of the picture"])
    everything = []
    for scene in lumulus.scenes(options.scenes):
        truth = lumulus.reference(scene, lumulus.path(scene, "truth"), spp=options.spp)
        figures = [measured(lumulus, scene, seed, options, truth) for seed in range(1, options.seeds + 1)]
        everything += figures
        table.add(figures, [scene, str(len(figures)), f"{100 * mean(figures, 'true_bias'):+.2f} %",
                            f"{100 * mean(figures, 'bias'):+.2f} %", f"{100 * mean(figures, 'bias_sigma'):.2f} %",
                            share(figures, "z", 1), share(figures, "z", 2), f"{mean(figures, 'z'):+.2f}",
                            f"{mean(figures, 'true_relmse'):.4f}", f"{mean(figures, 'relmse'):.4f}",
                            f"{mean(figures, 'relmse_sigma'):.4f}", share(figures, "z_relmse", 2),
                            f"{mean(figures, 'error_seconds'):.1f}", f"{mean(figures, 'seconds'):.1f}"])
    print(f"\nof all: within 1 σ {share(everything, 'z', 1)}, 2 σ {share(everything, 'z', 2)}; "
          f"relMSE within 2 σ {share(everything, 'z_relmse', 2)}")
    write_figures(options, everything)
