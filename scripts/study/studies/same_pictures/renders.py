"""The cases of `render`, `reference` and `composite`: each shipped scene, and variations of some."""

import numpy

from study.pictures import read_exr, write_exr
from study.program import size_sets, with_sets
from study.studies.same_pictures.side import Case

WIDTH, HEIGHT = 160, 90
SCENES = ["cumulus", "cumulus-side-lit", "cumulus-back-lit", "cumulus-front-lit", "cumulus-low-sun", "cumulus-haze",
          "cirrus", "stratus", "smoke", "furnace", "disney-cloud"]
FEW_PHOTONS = ["photon_map.photons=40000", "photon_map.generations=4"]
SMALL = [*size_sets(WIDTH, HEIGHT), *FEW_PHOTONS, "preparation.samples=2000"]
SMALL_CLOUD = ["cloud.0.resolution=64"]
BESIDE = ["camera.position=[430,150,1180]", "camera.target=[0,300,0]"]
FOG = '[{kind="homogeneous", scattering=[0.0004, 0.0006, 0.001], absorption=0.0001, g=0.8, emission=1e-5, bottom=-300, top=1500}, ' \
      '{kind="sphere", scattering=0.004, center=[0, 200, 300], radius=250.0}]'

# name, scene, overrides, whether it is one of the quick cases
VARIATIONS = [
    ("panorama", "cumulus", [*BESIDE, "camera.projection=panorama"], True),
    ("panorama, billboards", "cumulus", [*BESIDE, "camera.projection=panorama", "draw.mode=billboards"], False),
    ("orthographic", "cumulus", ["camera.projection=orthographic"], False),
    ("orthographic, billboards", "cumulus", ["camera.projection=orthographic", "draw.mode=billboards"], True),
    ("inside the cloud", "cumulus", ["camera.position=[13,291,7]", "camera.target=[60,310,-100]"], False),
    ("moved sun", "cumulus", ["sun.azimuth=-100", "sun.elevation=8"], False),
    ("sun in the picture", "cumulus", [*BESIDE, "sun.azimuth=340", "sun.elevation=7", "sun.angular_diameter=2"], False),
    ("sun below the horizon", "cumulus", ["sun.direction_to=[0.9,-0.3,0.2]"], False),
    ("no sun", "cumulus", ["sun.irradiance=0"], False),
    ("another seed", "cumulus", ["photon_map.seed=7", "photon_map.first_generation=3"], False),
    ("tolerance 0", "cumulus", ["draw.tolerance=0"], True),
    ("1 band", "cumulus", ["photon_map.bands=1"], False),
    ("6 bands, forward cut 10°", "cumulus", ["photon_map.bands=6", "photon_map.forward_cut=10"], False),
    ("no forward cut", "cumulus", ["photon_map.forward_cut=0"], False),
    ("local majorant", "cumulus", ["photon_map.majorant=local"], False),
    ("global majorant", "cumulus", ["photon_map.majorant=global"], False),
    ("absorbing, coloured", "cumulus", ["cloud.0.albedo=[1.0, 0.9, 0.5]"], False),
    ("phase schlick", "cumulus", ["cloud.0.phase.model=schlick", "cloud.0.phase.g=0.6"], False),
    ("phase rayleigh", "cumulus", ["cloud.0.phase.model=rayleigh"], False),
    ("phase murky", "cumulus", ["cloud.0.phase.model=murky"], False),
    ("sheared", "cumulus", ["cloud.0.transform=[[1,0.7,0,50],[0,1,0,0],[0,0.3,-1,0]]"], False),
    ("far from the origin", "cumulus", ["cloud.0.transform=[[1,0,0,1e6],[0,1,0,0],[0,0,1,-1e6]]"], False),
    ("procedural sphere", "cumulus", ["cloud.0.procedural=sphere", "cloud.0.extinction=0.02"], False),
    ("procedural slab", "cumulus", ["cloud.0.procedural=slab", "cloud.0.extinction=0.02"], False),
    ("averaged density", "cumulus", ["preparation.memory_budget=1", "cloud.0.resolution=128"], False),
    ("odd size", "cumulus", size_sets(83, 61), False),
    ("fog masked", "cumulus-haze", ["fog.filter=masked"], True),
    ("fog naive", "cumulus-haze", ["fog.filter=naive"], False),
    ("fog gather", "cumulus-haze", ["fog.filter=gather", *size_sets(64, 36)], False),
    ("fog scatter, 2 taps, bilinear", "cumulus-haze", ["fog.filter_size=2", "fog.fetch=bilinear"], False),
    ("fog masked, 6 taps, cubic", "cumulus-haze", ["fog.filter=masked", "fog.filter_size=6", "fog.fetch=cubic-bicubic",
                                                   "fog.depth_lookups=0"], False),
    ("fog, billboards", "cumulus-haze", ["draw.mode=billboards"], False),
    ("fog of two media", "cumulus", [f"fog.media={FOG}"], False),
    ("fog, panorama", "cumulus-haze", [*BESIDE, "camera.projection=panorama"], False),
    ("fog, no cloud", "cumulus-haze", ["cloud=[]", *BESIDE], False),
]
SURFACES = '[{kind="plane", albedo=0.3}, {kind="sphere", position=[200, 100, 300], radius=60.0, emission=2.0}]'
REFERENCES = [("reference", "cumulus", [], True),
              ("reference, smoke", "smoke", [], False),
              ("reference, droplets", "stratus", [], False),
              ("reference, fog", "cumulus-haze", [], False),
              ("reference, fog and surfaces", "cumulus-haze", [f"surface={SURFACES}", *BESIDE], False)]
COMPOSITES = ["scatter", "masked", "naive", "gather"]


def scene_words(scene, vdb, overrides):
    """Overrides that make a scene small, and the data of the Disney cloud."""
    shape = [f"cloud.0.vdb={vdb.resolve()}"] if scene == "disney-cloud" else SMALL_CLOUD
    if "cloud=[]" in overrides:
        shape = []
    return with_sets([*SMALL, *shape, *overrides])


def file_name(name):
    return name.replace(" ", "-").replace(",", "").replace("°", "")


def picture_case(command, name, scene, quick, overrides, folder, vdb, more=()):
    def make(side):
        return side.picture(command, folder / f"{scene}.toml", file_name(name), *scene_words(scene, vdb, overrides), *more)

    return Case(name, make, quick)


def shipped(folder, vdb):
    """Each shipped scene, marched and by billboards."""
    for scene in SCENES:
        if scene == "disney-cloud" and not vdb:
            continue
        for mode in ("march", "billboards"):
            quick = (scene, mode) in (("cumulus", "march"), ("cumulus", "billboards"), ("smoke", "march"),
                                      ("cumulus-haze", "march"))
            yield picture_case("render", f"{scene}, {mode}", scene, quick, [f"draw.mode={mode}"], folder, vdb)


def from_a_file(folder):
    """A cloud that `lumulus cloud` wrote, with an override of its grid."""
    def make(side):
        path = side.folder / "stratus.vdb"
        side.succeeded("cloud", "stratus", "-o", path, "--resolution", 48, "--seed", 3)
        return side.picture("render", folder / "cumulus.toml", "from-a-file",
                            *with_sets([*SMALL, f"cloud.0.vdb={path}", "cloud.0.grid=density"]))

    return Case("cloud from a VDB file", make)


def composite_case(fog_filter):
    """A step edge of light and depth, through the haze."""
    def make(side):
        y, x = numpy.mgrid[0:36, 0:64]
        light = numpy.where((x < 32) == (y < 18), 0.05, 5.0)
        color, output = side.path("step"), side.path("composite", fog_filter)
        write_exr(color, {"R": light, "G": 0.5 * light, "B": light * light, "Z": numpy.where(x < 32, 20.0, 400.0)})
        scene = side.folder / "step.toml"
        scene.write_text("cloud = []\n[camera]\nposition = [0, 6, 0]\ntarget = [0, 6, -1]\n"
                         "[[fog.media]]\nscattering = 0.01\ng = 0.9\n")
        side.composite(color, scene, output, [f"fog.filter={fog_filter}"])
        return read_exr(output)

    return Case(f"composite, {fog_filter}", make, fog_filter == "scatter")


def render_cases(folder, vdb):
    """All of them; those of the Disney cloud where `vdb` names its file."""
    yield from shipped(folder, vdb)
    for name, scene, overrides, quick in VARIATIONS:
        yield picture_case("render", name, scene, quick, overrides, folder, vdb)
    yield from_a_file(folder)
    yield picture_case("render", "progressive, to an error", "cumulus", True, [], folder, vdb, ["--target-error", "0.02"])
    yield picture_case("render", "progressive, billboards", "smoke", False, ["draw.mode=billboards"], folder, vdb,
                       ["--target-error", "0.05"])
    for name, scene, overrides, quick in REFERENCES:
        yield picture_case("reference", name, scene, quick, overrides, folder, vdb, ["--spp", "2"])
    for fog_filter in COMPOSITES:
        yield composite_case(fog_filter)
