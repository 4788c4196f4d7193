"""Clouds that scatter backwards, against two independent references: the bias of pictures by g, by the side from which the sun
shines, and under both skies (docs/experiments/backward-peak.md).

    scripts/study/run backward_peak --folder build/backward-peak --g -0.95 -0.99 --sky atmosphere
"""

import math

from study.lumulus import Lumulus, add_common_options
from study.tables import Table, write_figures

SCENE = """[image]
width = 48
height = 27
[cloud.0]
resolution = 48
extinction = 0.08
""".replace("[cloud.0]", "[[cloud]]")
# Degrees between the azimuths of sun and camera as seen from the cloud, and the sun's elevation.
VIEWS = {"sun behind the viewer": (0, 45), "from the side": (90, 45), "sun behind the cloud": (180, 20),
         "low sun, from the side": (90, 8), "from below": (60, 60), "from above": (120, 30)}
HEIGHTS = {"from below": -500.0, "from above": 900.0}
AWAY = 1600.0
SUN_AZIMUTH = 70.0


def view_sets(name):
    """Overrides for the camera and the sun of a view."""
    beside, elevation = VIEWS[name]
    azimuth = math.radians(SUN_AZIMUTH + beside)
    x, z = AWAY * math.sin(azimuth), -AWAY * math.cos(azimuth)
    return [f"camera.position=[{x:.1f}, {HEIGHTS.get(name, 0.0)}, {z:.1f}]", "camera.target=[0.0, 0.0, 0.0]",
            f"sun.azimuth={SUN_AZIMUTH}", f"sun.elevation={elevation}"]


def add_options(parser):
    add_common_options(parser)
    parser.add_argument("--spp", type=int, default=400, help="of each reference")
    parser.add_argument("--g", type=float, nargs="+", default=[-0.95, -0.99])
    parser.add_argument("--sky", nargs="+", default=["atmosphere", "constant"], choices=["atmosphere", "constant"])
    parser.add_argument("--views", nargs="+", default=list(VIEWS), choices=VIEWS)
    parser.add_argument("--quality", nargs="+", default=["interactive", "final"], choices=["draft", "interactive", "final"])
    parser.add_argument("--before", type=str, help="another executable, whose pictures are judged too")


def main(options):
    lumulus = Lumulus.of(options, [])
    programs = {"": lumulus}
    if options.before:
        programs["before"] = Lumulus(options.before, lumulus.folder / "before", options.set)
    scene = lumulus.path("scene", suffix=".toml")
    scene.write_text(SCENE)
    table = Table(["sky", "g", "view", "quality", "program", "relMSE", "bias"])
    for sky in options.sky:
        for g in options.g:
            for view in options.views:
                sets = [*view_sets(view), f'sky.model="{sky}"', f"cloud.0.phase.g={g}"]
                words = view.replace(" ", "-").replace(",", "")
                truths = [lumulus.reference(scene, lumulus.path(sky, g, words, "truth", seed), sets, spp=options.spp, seed=seed)
                          for seed in (101, 102)]
                for quality in options.quality:
                    for program, one in programs.items():
                        picture = one.path(sky, g, words, quality)
                        one.render(scene, picture, sets, ["--quality", quality])
                        found = one.compare(picture, *truths)
                        error = found["standard_error"]
                        table.add({"sky": sky, "g": g, "view": view, "quality": quality, "program": program, **found},
                                  [sky, f"{g:g}", view, quality, program, f"{found['relmse']:.4f}",
                                   f"{100 * found['relative_bias']:+.1f} ± {100 * error['relative_bias']:.1f} %"])
    write_figures(options, table.figures)
