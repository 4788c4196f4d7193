"""Clouds whose free paths go from ten voxels down to a hundredth of one, lit from the side, from behind and from the front,
against two independent references: relMSE and bias (docs/experiments/correction.md).
"""

from study.lumulus import Lumulus, add_common_options
from study.tables import Table, write_figures

# azimuth of the sun, where the camera looks towards −z
LIGHTS = {"side": 90.0, "back": 0.0, "front": 180.0}
SCENE = """[image]
width = 96
height = 64
[camera]
vertical_fov = 28.0
target = [0.0, {middle}, 0.0]
position = [0.0, {middle}, {distance}]
[sun]
azimuth = {azimuth}
elevation = 30.0
[sky]
model = "constant"
[[cloud]]
procedural = "{kind}"
resolution = 32
extinction = {extinction}
albedo = {albedo}
phase = {{ model = "hg", g = {g} }}
"""
# kind, edge of a voxel, height of the middle and distance of the camera, metres
CLOUDS = {"ball": ("sphere", 20.0 / 3.0, 100.0, 500.0), "cumulus": ("cumulus", 100.0 / 3.0, 320.0, 1800.0)}


def add_options(parser):
    add_common_options(parser)
    parser.add_argument("--spp", type=int, default=1000, help="of each reference (default %(default)s)")
    parser.add_argument("--clouds", default=",".join(CLOUDS), help="of these (default %(default)s)")
    parser.add_argument("--albedo", type=float, default=0.9)
    parser.add_argument("--g", type=float, default=0.0)
    parser.add_argument("--paths", default="10,3,1,0.3,0.1,0.03,0.01", help="mean free paths in voxels")
    parser.add_argument("--qualities", default="interactive,final")


def main(options):
    lumulus = Lumulus.of(options, [])
    table = Table(["cloud", "free path, voxels", "sun", "quality", "relMSE", "bias", "seconds"])
    for name, (kind, edge, middle, distance) in CLOUDS.items():
        if name not in options.clouds.split(","):
            continue
        for free_path in map(float, options.paths.split(",")):
            for light, azimuth in LIGHTS.items():
                label = f"{name}-{free_path:g}-{light}"
                scene = lumulus.path(label, suffix=".toml")
                scene.write_text(SCENE.format(azimuth=azimuth, kind=kind, middle=middle, distance=distance,
                                              albedo=options.albedo, g=options.g, extinction=1.0 / (free_path * edge)))
                truths = [lumulus.reference(scene, lumulus.path(label, "truth", seed), spp=options.spp, seed=seed)
                          for seed in (1, 2)]
                for quality in options.qualities.split(","):
                    picture = lumulus.path(label, quality)
                    stats = lumulus.render(scene, picture, [], ["--quality", quality])
                    found = lumulus.compare(picture, *truths)
                    error = found["standard_error"]
                    seconds = stats["seconds"]["total"] if stats else 0.0
                    table.add({"cloud": name, "free_path": free_path, "sun": light, "quality": quality, **found},
                              [name, f"{free_path:g}", light, quality, f"{found['relmse']:.4f} ± {error['relmse']:.4f}",
                               f"{100 * found['relative_bias']:+.2f} ± {100 * error['relative_bias']:.2f} %",
                               f"{seconds:.0f}"])
    write_figures(options, table.figures)
