"""Clouds whose voxels are flat (50:2:50 m), against two independent references: relMSE and bias of pictures with the light
that such clouds get by default, and with that of a quality as it is for others (docs/experiments/flat-voxels.md).
"""

from study.lumulus import Lumulus, add_common_options
from study.tables import Table, write_figures

CUMULUS = """[image]
width = 96
height = 14
[camera]
position = [0.0, 240.0, 7500.0]
target = [0.0, 60.0, 0.0]
vertical_fov = 3.5
[sun]
azimuth = 75.0
elevation = 30.0
[sky]
model = "constant"
[[cloud]]
resolution = 64
transform = [[3.2, 0.0, 0.0, 0.0], [0.0, 0.128, 0.0, 20.0], [0.0, 0.0, 3.2, 0.0]]
"""
BALL = """[image]
width = 96
height = 10
[camera]
vertical_fov = 5.0
[sky]
model = "constant"
[[cloud]]
procedural = "sphere"
resolution = 24
extinction = 0.08
transform = [[1.2, 0.0, 0.0, 0.0], [0.0, 0.048, 0.0, 0.0], [0.0, 0.0, 1.2, 0.0]]
"""
SCENES = {"cumulus": CUMULUS + "extinction = 0.04\n", "cumulus, thick": CUMULUS + "extinction = 0.12\n", "ball": BALL}
# of clouds whose voxels are cubes
USUAL = {"interactive": ["photon_map.bands=4", "photon_map.forward_cut=15"],
         "final": ["photon_map.bands=6", "photon_map.forward_cut=10"]}


def add_options(parser):
    add_common_options(parser)
    parser.add_argument("--spp", type=int, default=800, help="of each reference")


def main(options):
    lumulus = Lumulus.of(options, [])
    table = Table(["scene", "quality", "light", "relMSE", "bias"])
    for name, text in SCENES.items():
        scene = lumulus.path(name.replace(", ", "-"), suffix=".toml")
        scene.write_text(text)
        truths = [lumulus.reference(scene, lumulus.path(name, "truth", seed), spp=options.spp, seed=seed) for seed in (1, 2)]
        for quality, usual in USUAL.items():
            for light, sets in (("as usual", usual), ("of flat voxels", [])):
                picture = lumulus.path(name, quality, light)
                lumulus.render(scene, picture, sets, ["--quality", quality])
                found = lumulus.compare(picture, *truths)
                error = found["standard_error"]
                table.add({"scene": name, "quality": quality, "light": light, **found},
                          [name, quality, light, f"{found['relmse']:.4f} ± {error['relmse']:.4f}",
                           f"{100 * found['relative_bias']:+.1f} ± {100 * error['relative_bias']:.1f} %"])
    write_figures(options, table.figures)
