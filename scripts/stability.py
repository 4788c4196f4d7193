"""The stability report: runs stiff and extreme cases through the lumulus executable, writes docs/stability.md."""

import argparse
import os
import pathlib
import sys
import tempfile
import time

from stability_cases import all_groups
from stability_tools import Failure, Lumulus, Outcome

ROOT = pathlib.Path(__file__).resolve().parent.parent

HEAD = """# Stiff and extreme cases

Made by `scripts/stability.sh` (after `scripts/build.sh`); do not edit by hand. Each row runs the executable, with a time
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


def options():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--lumulus", default=ROOT / "build/release/lumulus", type=pathlib.Path, help="the executable")
    parser.add_argument("--fixtures", type=pathlib.Path, help="the executable make_vdb_fixtures "
                        "(default: in tests/ beside lumulus)")
    parser.add_argument("--output", default=ROOT / "docs/stability.md", type=pathlib.Path)
    parser.add_argument("--only", default="", metavar="TEXT", help="run only cases whose name or group contains this")
    parser.add_argument("--limit", default=20.0, type=float, help="seconds that one run may take")
    parser.add_argument("--spp", default=128, type=int, help="samples per pixel of references")
    return parser.parse_args()


def run_case(case, lumulus, limit):
    lumulus.seconds = case.seconds or limit
    try:
        return case.run(lumulus)
    except Failure as failure:
        return Outcome(str(failure), None, False)


def row(case, outcome):
    deviation = "" if outcome.deviation is None else f"{outcome.deviation:+.1f}"
    verdict = "holds" if outcome.holds else f"**off**: {case.reason}" if case.reason else "**fails**"
    cells = (case.name, case.expected, outcome.text, deviation, verdict)
    return "| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in cells) + " |"


def main():
    chosen = options()
    fixtures = chosen.fixtures or chosen.lumulus.parent / "tests/make_vdb_fixtures"
    for program in (chosen.lumulus, fixtures):
        if not os.access(program, os.X_OK):
            sys.exit(f"stability: error: no program {program}: build it, or name another (--help)")
    lines = [HEAD.format(limit=chosen.limit, spp=chosen.spp)]
    counts = {"holds": 0, "off": 0, "fails": 0}
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        lumulus = Lumulus(chosen.lumulus.resolve(), folder, fixtures.resolve(), chosen.limit)
        for title, cases in all_groups(chosen.spp):
            rows = []
            for case in cases:
                if chosen.only not in title and chosen.only not in case.name:
                    continue
                began = time.monotonic()
                outcome = run_case(case, lumulus, chosen.limit)
                verdict = "holds" if outcome.holds else "off" if case.reason else "fails"
                counts[verdict] += 1
                rows.append(row(case, outcome))
                print(f"{time.monotonic() - began:5.1f} s  {verdict:5}  {title}: {case.name}: {outcome.text}", flush=True)
            if rows:
                lines += [f"\n## {title}\n", "| case | expected, and why | came out | deviation | verdict |",
                          "|---|---|---|---|---|", *rows]
    lines.append(TAIL)
    lines.append(f"{counts['holds']} rows hold, {counts['off']} are off for a reason that stands beside them, "
                 f"{counts['fails']} fail.")
    chosen.output.write_text("\n".join(lines) + "\n")
    print(f"{lines[-1]} {time.monotonic() - start:.0f} s. {chosen.output}")
    return 1 if counts["fails"] else 0


if __name__ == "__main__":
    sys.exit(main())
