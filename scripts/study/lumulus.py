"""The lumulus executable and a folder for its pictures: every study calls it through this class."""

import json
import pathlib
import tempfile
import tomllib

from study.program import ROOT, Failure, finished, succeeded, with_sets

# All shipped scenes but the furnace, in which nothing is to be seen, and the haze, which is the default scene with fog.
SCENES = ["cumulus", "cumulus-side-lit", "cumulus-back-lit", "cumulus-front-lit", "cumulus-low-sun", "disney-cloud",
          "cirrus", "stratus", "smoke"]


def scene_file(scene):
    """The file of a scene that is named (a shipped one) or a path."""
    return scene if isinstance(scene, pathlib.Path) else ROOT / "configs/scenes" / f"{scene}.toml"


def scene_values(scene):
    """The keys of a scene file as nested dictionaries."""
    return tomllib.loads(scene_file(scene).read_text())


def add_program_option(parser):
    parser.add_argument("--lumulus", default=ROOT / "build/release/lumulus", type=pathlib.Path, help="the executable")


def add_common_options(parser, width=None):
    """The options that most studies have; `width` is the default width of pictures where there is one."""
    add_program_option(parser)
    parser.add_argument("--folder", type=pathlib.Path, help="for pictures, which stay there (default: gone afterwards)")
    parser.add_argument("--json", type=pathlib.Path, help="write the figures to this file too")
    parser.add_argument("--vdb", type=pathlib.Path, help="wdas_cloud_sixteenth.vdb, without which disney-cloud is left out")
    parser.add_argument("--set", action="append", default=[], help="override section.key=value; may repeat")
    if width:
        parser.add_argument("--width", type=int, default=width, help="of pictures, 16:9 (default %(default)s)")


class Lumulus:
    """`sets` are overrides of every scene, `limit` the seconds that one run may take. Without a folder pictures are gone
    with the object."""

    def __init__(self, program, folder=None, sets=(), vdb=None, limit=None):
        self.program, self.vdb, self.limit, self.sets = program, vdb, limit, list(sets)
        self._temporary = None if folder else tempfile.TemporaryDirectory()
        self.folder = folder or pathlib.Path(self._temporary.name)
        self.folder.mkdir(parents=True, exist_ok=True)

    @classmethod
    def of(cls, options, sets=()):
        """By the common options of the command line."""
        return cls(options.lumulus, options.folder, [*options.set, *sets], options.vdb)

    def path(self, *words, suffix=".exr"):
        """A file of the folder."""
        return self.folder / ("-".join(map(str, words)) + suffix)

    def scenes(self, wanted=None):
        """Those that are wanted, or all, as far as there is data for them."""
        for scene in wanted or []:
            if not scene_file(scene).exists():
                raise Failure(f"no scene {scene} in configs/scenes")
        return [scene for scene in wanted or SCENES if scene != "disney-cloud" or self.vdb]

    def scene_words(self, scene, sets=()):
        """A scene and its overrides as words of the command line."""
        data = [f"cloud.0.vdb={self.vdb.resolve()}"] if scene == "disney-cloud" else []
        return [scene_file(scene), *with_sets([*self.sets, *data, *sets])]

    def finished(self, *words, **how):
        """The finished process, whatever its exit code."""
        return finished(self.program, *words, limit=self.limit, **how)

    def succeeded(self, *words, **how):
        """The finished process; Failure where its exit code is not 0."""
        return succeeded(self.program, *words, limit=self.limit, **how)

    def render(self, scene, output, sets=(), words=(), **how):
        """The statistics of a picture, with the process's "rss_bytes" and "process_seconds"."""
        done = self.succeeded("render", *self.scene_words(scene, sets), "-o", output, "--quiet", "--stats", "-", *words,
                              **how)
        return {**json.loads(done.output), "rss_bytes": done.rss_bytes, "process_seconds": done.seconds}

    def reference(self, scene, output, sets=(), spp=64, seed=101, words=()):
        """The path of a reference by the faster majorant. A picture that is there already is gone on with up to these
        samples, or, without its sums, kept."""
        if self.sums_of(output).exists() or not output.exists():
            self.new_reference(scene, output, sets, spp, seed, ["--resume", *words])
        return output

    def new_reference(self, scene, output, sets=(), spp=64, seed=101, words=()):
        """The finished process of a reference."""
        return self.succeeded("reference", *self.scene_words(scene, sets), "-o", output, "--spp", spp, "--majorant",
                              "local", "--seed", seed, "--quiet", *words)

    @staticmethod
    def sums_of(output):
        """Where a reference has its exact sums."""
        return output.with_name(output.name + ".sums")

    def composite(self, color, scene, output, sets=()):
        """The statistics of a picture of another renderer, seen through the fog of a scene."""
        return json.loads(self.succeeded("composite", "--color", color, "--scene", scene_file(scene), "-o", output,
                                         "--stats", "-", *with_sets(sets)).output)

    def compare(self, picture, *truths, denominator=None, words=()):
        """The measures of `lumulus compare`. relMSE is divided by the squares of `denominator`, where there is one."""
        more = ["--denominator", denominator] if denominator else []
        return json.loads(self.succeeded("compare", picture, *truths, "--json", *more, *words).output)

    def slab(self, *words, **values):
        """The fractions of the light that a plane-parallel layer reflects, transmits and absorbs."""
        options = [word for name, value in values.items() for word in (f"--{name}", repr(value))]
        return json.loads(self.succeeded("slab", "--json", *options, *words).output)
