#!/usr/bin/python3
"""What error stays however many photons there are, over shipped scenes: two Markdown tables for docs/error-time.md, from
whose last columns, the largest over the scenes, src/progressive/bias.cpp has its figures.

Bands: relMSE of pictures with 1 to 6 bands against one with 8 from the same photons, so that there is no noise in it.
The rest: pictures against two independent references (large_score.py), less the noise that their halves tell. Cells of the
light field are smaller where there are more photons, so that the number of them matters. Errors are divided by the squares of
the picture, those of billboards by the march's with as many photons: a pixel that billboards leave dark would count many
times. Run it after scripts/build.sh.
Needs Debian's python3-numpy.
"""

from large_score import layers_of, score, squares_of
from measuring import Lumulus, Table, finish, parser_of, run, size_sets

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


def of_the_rest(lumulus, scenes, spp):
    """Rows of (variant, error by scene)."""
    truths = {scene: [lumulus.reference(scene, lumulus.path(scene, "truth", seed), spp=spp, seed=seed)
                      for seed in (101, 102)] for scene in scenes}
    marched = {}
    for name, photons, sets in VARIANTS:
        errors = []
        for scene in scenes:
            picture = lumulus.path(scene, "picture")
            half = [f"photon_map.photons={photons}", "photon_map.generations=2"]
            stats = lumulus.render(scene, picture, half + sets, ["--target-error", ANY_NOISE])
            layers = layers_of(picture)
            cloud = layers["transmittance.R"] < 0.999
            covered = cloud, squares_of(layers, cloud)
            if photons == MANY and not sets:
                marched[scene] = covered
            elif "draw.mode=billboards" in sets:
                covered = marched[scene]
            relmse, _ = score(layers, *map(layers_of, truths[scene]), *covered)
            errors.append(relmse - stats["progressive"]["noise"])
        yield name, errors


def table(title, scenes, rows):
    result = Table([title] + scenes + ["largest"])
    for name, errors in rows:
        result.add({title: name, **dict(zip(scenes, errors))},
                   [str(name)] + [f"{error:.5f}" for error in errors + [max(errors)]])
    print()
    return result.figures


def main():
    parser = parser_of(__doc__, width=160)
    parser.add_argument("--scenes", nargs="+", default=SCENES)
    parser.add_argument("--spp", type=int, default=512, help="of each reference")
    options = parser.parse_args()
    lumulus = Lumulus(options)
    lumulus.sets += size_sets(options.width)
    scenes = lumulus.scenes(options.scenes)
    finish(options, {"bands": table("bands", scenes, by_bands(lumulus, scenes)),
                     "rest": table("less the noise", scenes, of_the_rest(lumulus, scenes, options.spp))})


if __name__ == "__main__":
    run(main)
