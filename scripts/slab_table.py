#!/usr/bin/python3
"""Plane-parallel layers of known answer through the photon walk and the reference's tracer: a table of deviations in
standard errors, of each seed (the largest) and of all seeds together.

The layers are those of a CSV file with the columns name, g, tau, albedo, mu0, reflected, transmitted_diffuse and
transmitted_direct (fractions of the incident flux over a black ground, Henyey-Greenstein; an empty field is not known;
lines with # are comments), and --random ones, against scripts/layers.py. Exit code 1 where a deviation reaches 4, or
where nothing is random and the value differs.

Example: scripts/slab_table.py layers.csv --random 4
"""

import argparse
import csv
import json
import math
import os
import pathlib
import random
import subprocess
import sys

from layers import layer

ROOT = pathlib.Path(__file__).resolve().parent.parent
PARAMETERS = ("tau", "g", "albedo", "mu0")
FRACTIONS = ("reflected", "transmitted_diffuse", "transmitted_direct")
METHODS = {"photon walk": (), "reference": ("--reference",)}
DOUBLING_ERROR = 5e-5  # of scripts/layers.py


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("csv", type=pathlib.Path, nargs="?", help="known layers")
    parser.add_argument("--lumulus", default=ROOT / "build/release/lumulus", type=pathlib.Path, help="the executable")
    parser.add_argument("--photons", default=4000000, type=int, help="of each seed")
    parser.add_argument("--seeds", default=3, type=int)
    parser.add_argument("--precision", default=0.0, type=float, help="how well the file's fractions are known")
    parser.add_argument("--random", default=0, type=int, metavar="N", help="N more layers that no table names")
    return parser.parse_args()


def known_layers(path, precision):
    """(name, parameters, known fractions, how well they are known) of each row."""
    with open(path, newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if row.get("phase", "hg") != "hg":
                raise ValueError(f"{row['name']}: phase {row['phase']}, only hg is known here")
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


def traced(program, values, photons, seed, more):
    words = [word for name, value in values.items() for word in (f"--{name}", repr(value))]
    done = subprocess.run([program, "slab", "--json", "--photons", str(photons), "--seed", str(seed), *words, *more],
                          capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"slab_table: error: lumulus slab ended with code {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def deviation(found, expected, error, tolerance):
    """In standard errors, beyond the tolerance. Where nothing is random: 0, or infinity for another value."""
    beyond = math.copysign(max(abs(found - expected) - tolerance, 0.0), found - expected)
    if error > 0.0:
        return beyond / error
    # a table has seven digits at most
    return 0.0 if abs(beyond) <= 5e-7 else math.copysign(math.inf, beyond)


def report(name, method, results, known, tolerance):
    """Prints a line for each known fraction; returns the largest deviation."""
    worst = 0.0
    for fraction, expected in known.items():
        values = [result[fraction] for result in results]
        errors = [result["standard_error"][fraction] for result in results]
        mean, error = sum(values) / len(values), math.hypot(*errors) / len(errors)
        each = [deviation(value, expected, e, tolerance) for value, e in zip(values, errors)]
        largest, together = max(each, key=abs), deviation(mean, expected, error, tolerance)
        worst = max(worst, abs(largest), abs(together))
        print(f"{name:<20} {method:<12} {fraction:<20} {expected:>10.7f} {mean:>10.7f} ±{error:<10.7f} {largest:>+6.2f} "
              f"{together:>+6.2f}", flush=True)
    lost = sum(result.get("lost", 0) for result in results)
    if lost:
        print(f"{name}: {lost} photons lost")
    return math.inf if lost else worst


def main():
    chosen = options()
    program = chosen.lumulus.resolve()
    if not os.access(program, os.X_OK):
        sys.exit(f"slab_table: error: no program {program}: build it, or name another (--help)")
    layers = [*(known_layers(chosen.csv, chosen.precision) if chosen.csv else ()), *random_layers(chosen.random)]
    if not layers:
        sys.exit("slab_table: error: no layers: name a CSV file, or --random N")
    print(f"{'layer':<20} {'by':<12} {'fraction':<20} {'expected':>10} {'found':>10} {'±':<11} {'seed':>6} {'all':>6}")
    worst = 0.0
    for name, values, known, tolerance in layers:
        for method, more in METHODS.items():
            results = [traced(program, values, chosen.photons, seed, more)
                       for seed in range(1, chosen.seeds + 1)]
            worst = max(worst, report(name, method, results, known, tolerance))
    print(f"{len(layers)} layers, {chosen.seeds} seeds of {chosen.photons} photons each: largest deviation {worst:.2f} "
          "standard errors")
    return 0 if worst < 4.0 else 1


if __name__ == "__main__":
    sys.exit(main())
