"""Plane-parallel layers of known answer through the photon walk and the reference's tracer. A table of deviations in
standard errors, of each seed (the largest) and of all seeds together.

The layers are those of a CSV file with the columns name, g, tau, albedo, mu0, reflected, transmitted_diffuse and
transmitted_direct (fractions of the incident flux over a black ground, Henyey-Greenstein; an empty field is not known;
lines with # are comments), and --random ones, against the doubling method (study/layers.py). Exit code 1 where a deviation
reaches 4, or where nothing is random and the value differs.

    scripts/study/run slab_table tests/cli/published_layers.csv --random 4
"""

import csv
import math
import pathlib
import random

from study.layers import layer
from study.lumulus import Lumulus, add_program_option
from study.program import Failure
from study.tables import print_head, print_row

PARAMETERS = ("tau", "g", "albedo", "mu0")
FRACTIONS = ("reflected", "transmitted_diffuse", "transmitted_direct")
METHODS = {"photon walk": (), "reference": ("--reference",)}
DOUBLING_ERROR = 5e-5  # of study/layers.py


def add_options(parser):
    add_program_option(parser)
    parser.add_argument("csv", type=pathlib.Path, nargs="?", help="known layers")
    parser.add_argument("--photons", default=4000000, type=int, help="of each seed")
    parser.add_argument("--seeds", default=3, type=int)
    parser.add_argument("--precision", default=0.0, type=float, help="how well the file's fractions are known")
    parser.add_argument("--random", default=0, type=int, metavar="N", help="N more layers that no table names")


def known_layers(path, precision):
    """(name, parameters, known fractions, how well they are known) of each row."""
    with open(path, newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if row.get("phase", "hg") != "hg":
                raise Failure(f"{row['name']}: phase {row['phase']}, only hg is known here")
            known = {name: float(row[name]) for name in FRACTIONS if row[name]}
            yield row["name"], {name: float(row[name]) for name in PARAMETERS}, known, precision


def random_layers(count):
    numbers = random.Random(20)
    for i in range(count):
        values = {"tau": round(10 ** numbers.uniform(-1.0, 1.5), 3), "g": round(numbers.uniform(-0.6, 0.85), 2),
                  "albedo": numbers.choice((1.0, round(numbers.uniform(0.3, 1.0), 3))),
                  "mu0": round(numbers.uniform(0.1, 1.0), 2)}
        found = layer(values["tau"], values["g"], values["albedo"], values["mu0"])
        direct = math.exp(-values["tau"] / values["mu0"])
        yield (f"random-{i + 1}", values, {"reflected": found["reflected"], "transmitted_direct": direct,
                                           "transmitted_diffuse": found["transmitted"] - direct}, DOUBLING_ERROR)


def deviation(found, expected, error, tolerance):
    """In standard errors, beyond the tolerance. Where nothing is random: 0, or infinity for another value."""
    beyond = math.copysign(max(abs(found - expected) - tolerance, 0.0), found - expected)
    if error > 0.0:
        return beyond / error
    # a table has seven digits at most
    return 0.0 if abs(beyond) <= 5e-7 else math.copysign(math.inf, beyond)


def report(name, method, results, known, tolerance):
    """Prints a row for each known fraction; returns the largest deviation."""
    worst = 0.0
    for fraction, expected in known.items():
        values = [result[fraction] for result in results]
        errors = [result["standard_error"][fraction] for result in results]
        mean, error = sum(values) / len(values), math.hypot(*errors) / len(errors)
        each = [deviation(value, expected, e, tolerance) for value, e in zip(values, errors)]
        largest, together = max(each, key=abs), deviation(mean, expected, error, tolerance)
        worst = max(worst, abs(largest), abs(together))
        print_row([name, method, fraction, f"{expected:.7f}", f"{mean:.7f} ± {error:.7f}", f"{largest:+.2f}",
                   f"{together:+.2f}"])
    lost = sum(result.get("lost", 0) for result in results)
    if lost:
        print(f"{name}: {lost} photons lost")
    return math.inf if lost else worst


def main(options):
    lumulus = Lumulus(options.lumulus)
    layers = [*(known_layers(options.csv, options.precision) if options.csv else ()), *random_layers(options.random)]
    if not layers:
        raise Failure("no layers: name a CSV file, or --random N")
    print_head(["layer", "by", "fraction", "expected", "found", "seed", "all"])
    worst = 0.0
    for name, values, known, tolerance in layers:
        for method, more in METHODS.items():
            results = [lumulus.slab(*more, **values, photons=options.photons, seed=seed)
                       for seed in range(1, options.seeds + 1)]
            worst = max(worst, report(name, method, results, known, tolerance))
    print(f"\n{len(layers)} layers, {options.seeds} seeds of {options.photons} photons each: largest deviation {worst:.2f} "
          "standard errors")
    return 0 if worst < 4.0 else 1
