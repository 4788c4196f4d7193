#!/usr/bin/env python3
"""What a camera move costs when the photon map is full, against the path tracer's time for one sample in every pixel of
the same picture, and a generation of 100,000 photons beside it. Markdown on stdout.

A move is all that is drawn anew: radiance of the collectors towards the eye, light field, march or billboards; the time of
drawing less the passes that a move does not need (the sun's depths and what settles the photons). The goals are ratios
of at most 1/4 (march) and 1/10 (billboards), and a generation below a march.
"""

from measuring import Lumulus, Table, finish, parser_of, read_exr, run, size_sets

OF_A_GENERATION = ("trace", "sort", "gather", "accumulate")


def seconds_of(stats, names):
    return 1e-3 * sum(entry["ms"] for entry in stats["passes"] if entry["name"] in names)


def main():
    parser = parser_of(__doc__, width=1280)
    parser.add_argument("--scenes", nargs="+")
    parser.add_argument("--spp", type=int, default=2, help="samples that the path tracer's time is the mean of")
    options = parser.parse_args()
    lumulus = Lumulus(options)
    lumulus.sets += size_sets(options.width)
    table = Table(["scene", "path tracer, 1 sample, s", "march s", "ratio", "billboards s", "ratio", "100 k photons s"])
    for scene in lumulus.scenes(options.scenes):
        truth = lumulus.reference(scene, lumulus.path(scene, "tracer"), spp=options.spp)
        attributes = read_exr(truth)[3]
        figures = {"scene": scene, "width": options.width,
                   "tracer": float(attributes["seconds"]) / float(attributes["samples"])}
        for mode in ("march", "billboards"):
            sets = [f"draw.mode={mode}", "photon_map.photons=1000000", "photon_map.generations=10"]
            stats = {}
            for _ in range(2):  # the first run compiles shaders
                stats = lumulus.render(scene, lumulus.path(scene, mode), sets)
            # drawing holds the sun's depths and the last settling, which are passes; the rest of it is the move
            figures[mode] = stats["seconds"]["draw"] - seconds_of(stats, ("sun depth", "accumulate"))
            figures["generation"] = seconds_of(stats, OF_A_GENERATION) / stats["generations"]
        ratios = {mode: figures[mode] / figures["tracer"] for mode in ("march", "billboards")}
        table.add({**figures, "ratios": ratios},
                  [scene, f"{figures['tracer']:.2f}", f"{figures['march']:.2f}", f"{ratios['march']:.2f}",
                   f"{figures['billboards']:.2f}", f"{ratios['billboards']:.2f}", f"{figures['generation']:.2f}"])
    finish(options, table.figures)


if __name__ == "__main__":
    run(main)
