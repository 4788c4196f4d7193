#!/usr/bin/python3
"""Scores of the quality presets in every shipped scene, or from cameras and under suns that are in none (--unseen):
relMSE and bias against two independent references (which frees them of the references' noise), with the angle between the
view and the direction to the sun, and whether the goals are met. References that are in the folder already are
gone on with where they have fewer samples. Give them 256 or more: relative errors are divided by the references' squares,
whose noise adds about 1.5 times the square of a reference's own relMSE. Markdown on stdout.

    scripts/scores.py --vdb wdas_cloud_sixteenth.vdb --spp 512 --folder build/scores --json build/scores.json
    scripts/scores.py --unseen --vdb wdas_cloud_sixteenth.vdb --spp 256 --folder build/unseen --modes march
"""

import math
import tomllib

from measuring import SCENES, Lumulus, Table, finish, parser_of, run, scene_values, size_sets
from unseen_views import VIEWS

QUALITIES = ["draft", "interactive", "final"]


# Goals at `final` for relMSE and |bias|: further than this from the sun, and nearer.
NEAR_SUN = 20.0
FINAL_FAR, FINAL_NEAR = (2e-3, 0.01), (6e-3, 0.02)
INTERACTIVE_RELMSE = 2e-2


def sun_angle(scene, sets):
    """Degrees between where the camera looks and the sun; None where the camera places itself."""
    values, changed = scene_values(scene), tomllib.loads("\n".join(sets))
    camera, sun = ({**values.get(name, {}), **changed.get(name, {})} for name in ("camera", "sun"))
    if "position" not in camera:
        return None
    look = [t - p for t, p in zip(camera["target"], camera["position"])]
    a, e = math.radians(sun.get("azimuth", 70.0)), math.radians(sun.get("elevation", 35.0))
    to_sun = [math.cos(e) * math.sin(a), math.sin(e), -math.cos(e) * math.cos(a)]
    return math.degrees(math.acos(sum(x * y for x, y in zip(look, to_sun)) / math.hypot(*look)))


def verdict(quality, angle, found):
    """What is missed of the goals; the camera that places itself looks away from the sun."""
    near = angle is not None and angle <= NEAR_SUN
    relmse, bias = {"final": FINAL_NEAR if near else FINAL_FAR,
                    "interactive": (INTERACTIVE_RELMSE, math.inf)}.get(quality, (math.inf, math.inf))
    missed = [name for name, value, goal in (("relMSE", found["relmse"], relmse),
                                             ("bias", abs(found["relative_bias"]), bias)) if value > goal]
    return "misses " + ", ".join(missed) if missed else "meets" if quality != "draft" else "-"


def main():
    parser = parser_of(__doc__, width=160)
    parser.add_argument("--scenes", nargs="+", help="names of shipped scenes, or of unseen views")
    parser.add_argument("--unseen", action="store_true", help="views of scripts/unseen_views.py instead of shipped scenes")
    parser.add_argument("--qualities", nargs="+", default=QUALITIES, choices=QUALITIES)
    parser.add_argument("--modes", nargs="+", default=["march", "billboards"], choices=["march", "billboards"])
    parser.add_argument("--spp", type=int, default=256, help="of each reference")
    options = parser.parse_args()
    lumulus = Lumulus(options)
    lumulus.sets += size_sets(options.width)
    table = Table(["scene", "view off the sun", "mode", "quality", "relMSE", "bias", "FLIP", "total s", "goals"])
    for name in options.scenes or (VIEWS if options.unseen else SCENES):
        scene, sets = VIEWS[name] if options.unseen else (name, [])
        if not lumulus.scenes([scene]):
            continue
        truths = [lumulus.reference(scene, lumulus.path(name, seed), sets, spp=options.spp, seed=seed)
                  for seed in (101, 102)]
        angle = sun_angle(scene, sets)
        for mode in options.modes:
            for quality in options.qualities:
                picture = lumulus.path(name, mode, quality)
                stats = lumulus.render(scene, picture, [*sets, f"draw.mode={mode}"], ["--quality", quality])
                found = lumulus.compare(picture, *truths)
                figures = {"scene": name, "degrees_off_the_sun": angle, "mode": mode, "quality": quality,
                           "relmse": found["relmse"], "relative_bias": found["relative_bias"], "flip": found["flip"],
                           "seconds": stats["seconds"], "goals": verdict(quality, angle, found)}
                table.add(figures, [name, "-" if angle is None else f"{angle:.0f}°", mode, quality,
                                    f"{found['relmse']:.4f}", f"{100 * found['relative_bias']:+.1f} %",
                                    f"{found['flip']:.3f}", f"{stats['seconds']['total']:.1f}", figures["goals"]])
    finish(options, table.figures)


if __name__ == "__main__":
    run(main)
