"""The halo of a small lamp in fog: the truth of the path tracer, the filter's, and two Gaussians that come near it."""

import numpy

from study.lumulus import Lumulus, add_common_options
from study.pictures import read_exr, rgb
from study.program import size_sets
from study.tables import Table, write_figures

DEPTHS = (1, 2, 4, 8)
DISTANCE, RADIUS, FIELD_OF_VIEW, G = 100.0, 1.0, 60.0, 0.9
RINGS = ((1.5, 3), (3, 6), (6, 12), (12, 24), (24, 36))  # pixels from the lamp at a height of 72
SCENE = f"""
cloud = []
camera = {{ position = [0, 0, 0], target = [0, 0, -1], vertical_fov = {FIELD_OF_VIEW} }}
sun = {{ irradiance = 0 }}
sky = {{ radiance = 0 }}
fog = {{ media = [{{ kind = "ellipsoid", half_size = [300, 300, 300], g = {G} }}] }}
[[surface]]
kind = "sphere"
position = [0, 0, -{DISTANCE}]
radius = {RADIUS}
albedo = 0
emission = 1000
"""


def add_options(parser):
    add_common_options(parser, width=128)
    parser.add_argument("--spp", default=64, type=int, help="samples per pixel of the truth")


class Halo:
    """Pictures of the lamp as green channels, and rings around it."""

    def __init__(self, options):
        self.lumulus = Lumulus.of(options, size_sets(options.width))
        self.scene = self.lumulus.path("lamp", suffix=".toml")
        self.scene.write_text(SCENE)
        self.spp, self.clear_path = options.spp, self.lumulus.path("clear")
        self.clear = self.reference("clear", 64, ["fog.media=[]"])
        height, width = self.clear.shape
        y, x = numpy.mgrid[:height, :width] + 0.5
        self.radius = numpy.hypot(x - width / 2, y - height / 2)
        self.pixels_per_radian = height / 2 / numpy.tan(numpy.radians(FIELD_OF_VIEW / 2))
        scale = height / 72
        self.rings = [(self.radius >= a * scale) & (self.radius < b * scale) for a, b in RINGS]

    def reference(self, name, spp, sets):
        path = self.lumulus.path(name)
        return rgb(read_exr(self.lumulus.reference(self.scene, path, sets, spp)))[..., 1].astype(float)

    def truth(self, depth):
        return self.reference(f"truth-{depth}", self.spp, [f"fog.media.0.scattering={depth / DISTANCE}"])

    def filtered(self, depth, key="scattering"):
        path = self.lumulus.path(key, depth)
        self.lumulus.composite(self.clear_path, self.scene, path,
                               [*self.lumulus.sets, f"fog.media.0.{key}={depth / DISTANCE}"])
        return rgb(read_exr(path))[..., 1].astype(float)

    def profile(self, picture):
        return numpy.array([picture[ring].mean() for ring in self.rings])

    def gaussian(self, deviation):
        """The profile of a halo of energy 1 and this standard deviation in pixels."""
        return self.profile(numpy.exp(-0.5 * (self.radius / deviation) ** 2) / (2 * numpy.pi * deviation ** 2))


def two_gaussians(halo, truth, width):
    """Deviations over `width` and energies of the two Gaussians whose rings differ least from the truth's, in parts."""
    best = (numpy.inf,)
    for core in numpy.geomspace(0.05, 1.0, 25):
        for skirt in numpy.geomspace(max(0.5, 1.3 * core), 6.0, 25):
            parts = numpy.stack([halo.gaussian(core * width), halo.gaussian(skirt * width)], axis=1) / truth[:, None]
            energies = numpy.linalg.lstsq(parts, numpy.ones(len(truth)), rcond=None)[0]
            error = numpy.sqrt(numpy.mean((parts @ energies - 1) ** 2))
            if min(energies) >= 0 and error < best[0]:
                best = (error, core, skirt, *energies)
    return best


def main(options):
    halo = Halo(options)
    table = Table(["τ", *(f"{a:g} to {b:g} pixels" for a, b in RINGS), "energy in the frame: truth", "filter",
                   "core: width, share", "skirt: width, share", "error"])
    for depth in DEPTHS:
        straight = halo.filtered(depth, "absorption")
        truth, filtered = halo.truth(depth) - straight, halo.filtered(depth) - straight
        scattered = halo.clear.sum() * (1 - numpy.exp(-depth))
        width = numpy.sqrt(depth * (1 - G) / 8) * halo.pixels_per_radian
        ratios = halo.profile(filtered) / halo.profile(truth)
        error, core, skirt, core_energy, skirt_energy = two_gaussians(halo, halo.profile(truth), width)
        shares = core_energy / scattered, skirt_energy / scattered
        table.add([depth, *ratios, truth.sum() / scattered, filtered.sum() / scattered, core, skirt, *shares, error],
                  [str(depth), *(f"{ratio:.2f}" for ratio in ratios), f"{truth.sum() / scattered:.3f}",
                   f"{filtered.sum() / scattered:.3f}", f"{core:.2f} W, {shares[0]:.2f}", f"{skirt:.2f} W, {shares[1]:.2f}",
                   f"{error:.2f}"])
    write_figures(options, table.figures)
