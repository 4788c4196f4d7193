"""Stiff and extreme cases, with what is expected and why. Runs them through the lumulus executable and writes the report
docs/experiments/stiff-cases.md; the exit code is 1 where a row fails without a known reason.

    scripts/study/run stability --limit 8 --spp 48
"""

import os
import pathlib
import time

from study.lumulus import add_program_option
from study.program import ROOT, Failure
from study.studies.stability.fog_cases import fog_cases
from study.studies.stability.layer_cases import layer_cases
from study.studies.stability.map_cases import maps
from study.studies.stability.picture_cases import cameras, fields, furnaces, media, places
from study.studies.stability.tools import Lumulus, Outcome
from study.tables import markdown_row

HEAD = """# Stiff and extreme cases

Made by `scripts/study/run stability` (after `scripts/build.sh`); do not edit by hand. Each row runs the executable, with a time
limit of {limit:g} s. Every picture of the table is also checked for this: all layers finite; no coefficient saturated;
no photon lost; photons absorbed and escaped add up to those emitted.

The scene, where a row does not say otherwise: a ball of radius 100 m and optical thickness 4 (Henyey-Greenstein, g .85,
albedo 1) before sun and sky, 48×32 pixels, 60000 photons. *Bias* is the mean of picture − reference over the pixels
that the cloud covers, in parts of the mean reference (`lumulus compare`); the reference is `lumulus reference`, {spp}
samples per pixel. The deviation is in standard errors: of the photons for layers, of the reference (and, where stated, of
independent renders) for pictures. A picture also has the method's own bias (a finite number of bands and collectors),
so a row that compares with the reference holds where |bias| is below its bound plus 4 standard errors.
"""

TAIL = """
## Covered by tests instead

| case | why not here | test |
|---|---|---|
| coefficients at the fixed-point limit | lights do not change within `lumulus render` | `tests/stat/saturation_test.cpp`: later lights 10⁹ times brighter; saturation is counted, sums are clamped and never wrap |
| a ring of 4096 generations over the memory budget | `render` keeps the sum alone, whatever the number of generations | `tests/gpu/photon_ring_test.cpp`, `tests/unit/map_limits_test.cpp`: refused with both numbers |
| a generation larger than a buffer of the device | the limit depends on the device (128 MiB on lavapipe) | `tests/unit/map_limits_test.cpp`: refused with both numbers |
| more than 2³⁸ records in a generation, where a sum might wrap | days of work | `tests/unit/map_limits_test.cpp`: the trace ends with an error |
| more than 2³¹ photons in a layer | minutes to hours | by construction: a dispatch counts at most 2³⁰ photons (`src/photon/slab.cpp`), the sums have 64 bits |
| generations that replace others, in any lights | `render` traces each only once | `tests/gpu/photon_ring_test.cpp` |
"""


def all_groups(spp):
    """(title, cases) of each table."""
    return (("Layers (`lumulus slab`)", layer_cases()), ("White furnace", furnaces()), ("Media", media(spp)),
            ("Density fields", fields(spp)), ("Shapes and places", places(spp)), ("Cameras and suns", cameras(spp)),
            ("Photon map", maps(spp)), ("Fog (`lumulus composite`)", fog_cases()))


def add_options(parser):
    add_program_option(parser)
    parser.add_argument("--fixtures", type=pathlib.Path, help="the executable make_vdb_fixtures "
                        "(default: in tests/ beside lumulus)")
    parser.add_argument("--output", default=ROOT / "docs/experiments/stiff-cases.md", type=pathlib.Path)
    parser.add_argument("--only", default="", metavar="TEXT", help="run only cases whose name or group contains this")
    parser.add_argument("--limit", default=20.0, type=float, help="seconds that one run may take")
    parser.add_argument("--spp", default=128, type=int, help="samples per pixel of references")


def run_case(case, lumulus, limit):
    lumulus.limit = case.seconds or limit
    try:
        return case.run(lumulus)
    except Failure as failure:
        return Outcome(str(failure), None, False)


def verdict_of(case, outcome):
    return "holds" if outcome.holds else "off" if case.reason else "fails"


def row(case, outcome):
    deviation = "" if outcome.deviation is None else f"{outcome.deviation:+.1f}"
    shown = {"holds": "holds", "off": f"**off**: {case.reason}", "fails": "**fails**"}[verdict_of(case, outcome)]
    cells = (case.name, case.expected, outcome.text, deviation, shown)
    return markdown_row([cell.replace("|", "\\|").replace("\n", " ") for cell in cells])


def rows_of(title, cases, lumulus, options, counts):
    """The rows of a table; counts its verdicts."""
    rows = []
    for case in cases:
        if options.only not in title and options.only not in case.name:
            continue
        began = time.monotonic()
        outcome = run_case(case, lumulus, options.limit)
        verdict = verdict_of(case, outcome)
        counts[verdict] += 1
        rows.append(row(case, outcome))
        print(f"{time.monotonic() - began:5.1f} s  {verdict:5}  {title}: {case.name}: {outcome.text}", flush=True)
    return rows


def main(options):
    fixtures = options.fixtures or options.lumulus.parent / "tests/make_vdb_fixtures"
    for program in (options.lumulus, fixtures):
        if not os.access(program, os.X_OK):
            raise Failure(f"no program {program}: build it, or name another (--help)")
    lines = [HEAD.format(limit=options.limit, spp=options.spp)]
    counts = {"holds": 0, "off": 0, "fails": 0}
    start = time.monotonic()
    lumulus = Lumulus(options.lumulus.resolve(), fixtures.resolve())
    for title, cases in all_groups(options.spp):
        rows = rows_of(title, cases, lumulus, options, counts)
        if rows:
            lines += [f"\n## {title}\n", "| case | expected, and why | came out | deviation | verdict |",
                      "|---|---|---|---|---|", *rows]
    if not sum(counts.values()):
        raise Failure(f"no case or group has {options.only!r} in its name")
    lines.append(TAIL)
    lines.append(f"{counts['holds']} rows hold, {counts['off']} are off for a reason that stands beside them, "
                 f"{counts['fails']} fail.")
    options.output.write_text("\n".join(lines) + "\n")
    print(f"{lines[-1]} {time.monotonic() - start:.0f} s. {options.output}")
    return 1 if counts["fails"] else 0
