"""What error stays however many photons there are. Two Markdown tables over shipped scenes, the last columns of
which are the largest over the scenes.

Bands: relMSE of pictures with 1 to 6 bands against one with 8 from the same photons, so that there is no noise in it.
The rest: pictures against two independent references, less the noise that their two parts tell. Cells of the light field are
smaller where there are more photons, so that the number of them matters. Errors are divided by the squares of the picture,
those of billboards by the march's with as many photons: a pixel that billboards leave dark would count many times.
"""

from study.lumulus import Lumulus, add_common_options
from study.program import size_sets
from study.tables import Table, write_figures

SCENES = ["cumulus-side-lit", "cumulus-back-lit", "cumulus-front-lit", "cumulus-low-sun", "smoke"]
MANY = 8000000
# name, photons, overrides
VARIANTS = [("march, 0.2 M photons", 200000, []), ("march, 2 M photons", 2000000, []), ("march, 8 M photons", MANY, []),
            ("no cut, 8 M photons", MANY, ["photon_map.forward_cut=0"]),
            ("final, 24 M photons", 3 * MANY, ["photon_map.bands=6", "photon_map.forward_cut=10"]),
            ("billboards, 8 M photons", MANY, ["draw.mode=billboards"])]
# After two generations, in each half of the photons, this is reached: the picture has them all, and its noise is known.
ANY_NOISE = 1e6


def by_bands(lumulus, scenes):
    """Rows of (bands, error by scene)."""
    for scene in scenes:
        lumulus.render(scene, lumulus.path(scene, 8), ["photon_map.bands=8"])
    for bands in range(1, 7):
        errors = []
        for scene in scenes:
            picture = lumulus.path(scene, bands)
            lumulus.render(scene, picture, [f"photon_map.bands={bands}"])
            errors.append(lumulus.compare(picture, lumulus.path(scene, 8))["relmse"])
        yield bands, errors


def of_the_rest(lumulus, scenes, spp, fewer):
    """Rows of (variant, error by scene); photons are divided by `fewer`."""
    truths = {scene: [lumulus.reference(scene, lumulus.path(scene, "truth", seed), spp=spp, seed=seed)
                      for seed in (101, 102)] for scene in scenes}
    for name, photons, sets in VARIANTS:
        errors = []
        for scene in scenes:
            marched = lumulus.path(scene, "marched", photons)
            picture = marched if not sets else lumulus.path(scene, "picture")
            half = [f"photon_map.photons={photons // fewer}", "photon_map.generations=2"]
            stats = lumulus.render(scene, picture, half + sets, ["--target-error", ANY_NOISE])
            denominator = marched if "draw.mode=billboards" in sets else picture
            found = lumulus.compare(picture, *truths[scene], denominator=denominator)
            errors.append(found["relmse"] - stats["progressive"]["noise"])
        yield name, errors


def table(title, scenes, rows):
    result = Table([title] + scenes + ["largest"])
    for name, errors in rows:
        result.add({title: name, **dict(zip(scenes, errors))},
                   [str(name)] + [f"{error:.5f}" for error in errors + [max(errors)]])
    print()
    return result.figures


def add_options(parser):
    add_common_options(parser, width=160)
    parser.add_argument("--scenes", nargs="+", default=SCENES)
    parser.add_argument("--spp", type=int, default=512, help="of each reference")
    parser.add_argument("--fewer", type=int, default=1, help="divide photons by this, to try the study out")


def main(options):
    lumulus = Lumulus.of(options, size_sets(options.width))
    scenes = lumulus.scenes(options.scenes)
    write_figures(options, {"bands": table("bands", scenes, by_bands(lumulus, scenes)),
                            "rest": table("less the noise", scenes,
                                          of_the_rest(lumulus, scenes, options.spp, options.fewer))})
