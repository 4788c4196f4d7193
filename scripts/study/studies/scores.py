"""Scores of the quality presets in every shipped scene, or from cameras and under suns that are in none (--unseen).
relMSE and bias against two independent references (which frees them of the references' noise), with the angle between the
view and the direction to the sun, and whether the goals are met. References that are in the folder already are gone on with
where they have fewer samples. Give them 256 or more: relative errors are divided by the references' squares, whose noise
adds about 1.5 times the square of a reference's own relMSE.

    scripts/study/run scores --vdb wdas_cloud_sixteenth.vdb --spp 512 --folder build/scores --json build/scores.json
    scripts/study/run scores --unseen --vdb wdas_cloud_sixteenth.vdb --spp 256 --folder build/unseen --modes march
"""

import math
import tomllib

from study.lumulus import SCENES, Lumulus, add_common_options, scene_values
from study.program import Failure, size_sets
from study.tables import Table, write_figures
from study.unseen_views import VIEWS

QUALITIES = ["draft", "interactive", "final"]
MODES = ["march", "billboards"]

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


def add_options(parser):
    add_common_options(parser, width=160)
    parser.add_argument("--scenes", nargs="+", help="names of shipped scenes, or of unseen views")
    parser.add_argument("--unseen", action="store_true", help="views of unseen_views.py instead of shipped scenes")
    parser.add_argument("--qualities", nargs="+", default=QUALITIES, choices=QUALITIES)
    parser.add_argument("--modes", nargs="+", default=MODES, choices=MODES)
    parser.add_argument("--spp", type=int, default=256, help="of each reference")


def score(lumulus, name, scene, sets, truths, mode, quality):
    """The figures of a row."""
    picture = lumulus.path(name, mode, quality)
    stats = lumulus.render(scene, picture, [*sets, f"draw.mode={mode}"], ["--quality", quality])
    found = lumulus.compare(picture, *truths)
    angle = sun_angle(scene, sets)
    return {"scene": name, "degrees_off_the_sun": angle, "mode": mode, "quality": quality, "relmse": found["relmse"],
            "relative_bias": found["relative_bias"], "flip": found["flip"], "seconds": stats["seconds"],
            "goals": verdict(quality, angle, found)}


def texts_of(figures):
    angle = figures["degrees_off_the_sun"]
    return [figures["scene"], "-" if angle is None else f"{angle:.0f}°", figures["mode"], figures["quality"],
            f"{figures['relmse']:.4f}", f"{100 * figures['relative_bias']:+.1f} %", f"{figures['flip']:.3f}",
            f"{figures['seconds']['total']:.1f}", figures["goals"]]


def main(options):
    lumulus = Lumulus.of(options, size_sets(options.width))
    table = Table(["scene", "view off the sun", "mode", "quality", "relMSE", "bias", "FLIP", "total s", "goals"])
    for name in options.scenes or (VIEWS if options.unseen else SCENES):
        if options.unseen and name not in VIEWS:
            raise Failure(f"no view {name} in unseen_views.py")
        scene, sets = VIEWS[name] if options.unseen else (name, [])
        if not lumulus.scenes([scene]):
            continue
        truths = [lumulus.reference(scene, lumulus.path(name, seed), sets, spp=options.spp, seed=seed)
                  for seed in (101, 102)]
        for mode in options.modes:
            for quality in options.qualities:
                figures = score(lumulus, name, scene, sets, truths, mode, quality)
                table.add(figures, texts_of(figures))
    write_figures(options, table.figures)
