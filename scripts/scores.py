#!/usr/bin/env python3
"""Scores of the quality presets in every shipped scene: relMSE and bias against two independent references (which frees
them of the references' noise), with the angle between the view and the direction to the sun. Markdown on stdout.

    scripts/scores.py --vdb wdas_cloud_sixteenth.vdb --spp 512 --folder build/scores --json build/scores.json
"""

import math

from measuring import Lumulus, Table, finish, parser_of, run, scene_values, size_sets

QUALITIES = ["draft", "interactive", "final"]


def sun_angle(scene):
    """Degrees between where the camera looks and the sun; None where the camera places itself."""
    values = scene_values(scene)
    camera, sun = values.get("camera", {}), values.get("sun", {})
    if "position" not in camera:
        return None
    look = [t - p for t, p in zip(camera["target"], camera["position"])]
    a, e = math.radians(sun.get("azimuth", 70.0)), math.radians(sun.get("elevation", 35.0))
    to_sun = [math.cos(e) * math.sin(a), math.sin(e), -math.cos(e) * math.cos(a)]
    return math.degrees(math.acos(sum(x * y for x, y in zip(look, to_sun)) / math.hypot(*look)))


def main():
    parser = parser_of(__doc__, width=160)
    parser.add_argument("--scenes", nargs="+")
    parser.add_argument("--qualities", nargs="+", default=QUALITIES, choices=QUALITIES)
    parser.add_argument("--modes", nargs="+", default=["march", "billboards"], choices=["march", "billboards"])
    parser.add_argument("--spp", type=int, default=256, help="of each reference")
    options = parser.parse_args()
    lumulus = Lumulus(options)
    lumulus.sets += size_sets(options.width)
    table = Table(["scene", "view off the sun", "mode", "quality", "relMSE", "bias", "FLIP", "total s"])
    for scene in lumulus.scenes(options.scenes):
        truths = [lumulus.reference(scene, lumulus.path(scene, "truth", seed), spp=options.spp, seed=seed)
                  for seed in (101, 102)]
        angle = sun_angle(scene)
        for mode in options.modes:
            for quality in options.qualities:
                picture = lumulus.path(scene, mode, quality)
                stats = lumulus.render(scene, picture, [f"draw.mode={mode}"], ["--quality", quality])
                found = lumulus.compare(picture, *truths)
                figures = {"scene": scene, "degrees_off_the_sun": angle, "mode": mode, "quality": quality,
                           "relmse": found["relmse"], "relative_bias": found["relative_bias"], "flip": found["flip"],
                           "seconds": stats["seconds"]}
                table.add(figures, [scene, "-" if angle is None else f"{angle:.0f}°", mode, quality,
                                    f"{found['relmse']:.4f}", f"{100 * found['relative_bias']:+.1f} %",
                                    f"{found['flip']:.3f}", f"{stats['seconds']['total']:.1f}"])
    finish(options, table.figures)


if __name__ == "__main__":
    run(main)
