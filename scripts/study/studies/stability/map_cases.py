"""The photon map at its limits: photons, bands, generations, memory."""

import math
import re

from study.studies.stability.picture_cases import against_reference
from study.studies.stability.tools import Case, Outcome


def maps(spp):
    def runs(lumulus):
        lumulus.render("photon_map.photons=1", "photon_map.generations=1")
        return Outcome("finite, energy closed", None, True)

    yield Case("1 photon", "a finite picture, the photon accounted for", runs)
    for bands in range(1, 9):
        yield against_reference(f"bands {bands}", spp, f"photon_map.bands={bands}", bound=0.15 if bands < 3 else 0.05)
    wide = "the light of one scattering event is summed for small angles only: 15° is what it is made for"
    uncut = "four bands do not hold a peak that is not cut: with six the picture is as much too bright"
    for cut, reason in ((0, uncut), (45, wide), (90, wide)):
        yield against_reference(f"forward_cut {cut}°", spp, f"photon_map.forward_cut={cut}", reason=reason)
    yield against_reference("forward_cut 0°, 6 bands", spp, "photon_map.forward_cut=0", "photon_map.bands=6",
                            reason="nor do six: +10.1 % ± 0.5 with 2 million photons")
    yield against_reference("1 generation", spp, "photon_map.generations=1")
    yield against_reference("4096 generations", spp, "photon_map.generations=4096", "photon_map.photons=40960",
                            "photon_map.bands=3", "cloud.0.resolution=8", "preparation.samples=500", seconds=240)

    def many(lumulus):
        """Each collision in the thin ball is as rare with 2^31 photons at once as with 2^24 of other numbers."""
        thin = ("cloud.0.resolution=8", "cloud.0.extinction=1e-4")
        some = lumulus.render(*thin, "photon_map.photons=16777216", "photon_map.generations=16")
        most = lumulus.render(*thin, f"photon_map.photons={2**31}", "photon_map.generations=1")
        rates = [picture.statistics["events"] / picture.statistics["photons"] for picture in (some, most)]
        error = math.sqrt(rates[0] / some.statistics["photons"])
        counted = most.statistics["photons"] == most.statistics["escaped"] == 2**31
        bias = lumulus.compare(some.path, most.path)["relative_bias"]
        deviation = (rates[0] - rates[1]) / error
        return Outcome(f"{most.statistics['escaped']} photons escaped, {rates[1]:.6f} collisions each (2^24 photons: "
                       f"{rates[0]:.6f} ± {error:.1g}), pictures differ by {100 * bias:+.2f} %", deviation,
                       counted and abs(deviation) < 4.5 and abs(bias) < 0.01)

    yield Case("2^31 photons in one generation, τ .02", "every photon counted, collisions and light as with 2^24 photons in "
               "16 generations", many, seconds=3600)

    def refused(lumulus):
        done = lumulus.finished("render", *lumulus.scene_words(lumulus.scene, (
            "photon_map.generations=4096", "photon_map.memory_budget=1", "photon_map.bands=8")), "-o",
                                lumulus.path("refused"), "--quiet")
        message = done.complaint.strip()
        numbers = re.search(r"needs [\d.]+ MiB.* its budget is 1\.00 MiB \(photon_map\.memory_budget\)", message)
        return Outcome(message, None, done.code == 2 and numbers is not None and "\n" not in message
                       and not lumulus.path("refused").exists())

    yield Case("4096 generations over the memory budget of 1 MiB", "refused with both numbers: exit code 2, no picture",
               refused)

    def averaged(lumulus):
        path = lumulus.folder / "large.vdb"
        lumulus.succeeded("cloud", "sphere", "-o", path, "--resolution", 160)
        done = lumulus.finished("render", *lumulus.scene_words(lumulus.scene, (
            f"cloud.0.vdb={path}", "preparation.memory_budget=1", "photon_map.photons=1000")), "-o", lumulus.path("small"),
                                "--quiet")
        message = done.complaint.strip().replace(str(path), path.name)
        return Outcome(message, None, done.code == 0 and "2 MiB" in message and "memory_budget = 3 keeps all" in message)

    yield Case("density over the memory budget", "some bricks have fewer voxels; a warning says so with both sizes", averaged)
