"""The Python module: python_test.py LUMULUS MAKE_VDB_FIXTURES FOLDER_OF_THE_MODULE [unittest arguments]."""

import ast
import io
import json
import os
import runpy
import signal
import sys
import threading
import time
import unittest
from contextlib import redirect_stdout
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
MODULE = Path(sys.argv.pop(3))
sys.path.insert(0, str(MODULE))
import numpy  # noqa: E402
import pyopenvdb as openvdb  # noqa: E402
import lumulus  # noqa: E402
from cli_test import CliTest  # noqa: E402

SCENE = """
image = { width = 32, height = 24 }
photon_map = { photons = 4000, generations = 2, seed = 5 }
preparation = { samples = 500 }
sky = { model = "constant" }
[[cloud]]
resolution = 24
"""
# photons for hours
LONG = {"photon_map.photons": 10**12, "photon_map.generations": 1000}


def some_density():
    """An array that no exchange of its axes leaves as it is."""
    x, y, z = numpy.meshgrid(numpy.arange(12), numpy.arange(9), numpy.arange(20), indexing="ij")
    return ((x + 2 * y + 3 * z) % 7 / 7.0 * (x > 1) * (y < 7)).astype(numpy.float32)


def layers(picture):
    return {name: picture[name] for name in picture}


class PythonTest(CliTest):
    def same(self, one, other):
        """Checks that pictures have the same bits."""
        self.assertEqual(list(one), list(other))
        for name in one:
            self.assertEqual(one[name].tobytes(), other[name].tobytes(), name)

    def by_command(self, command, scene, *more):
        path = self.folder / f"{command}.exr"
        result = self.run_lumulus(command, scene, "-o", path, "--quiet", *more)
        self.assertEqual(result.returncode, 0, result.stderr)
        return path


class Pictures(PythonTest):
    def test_bits_are_those_of_the_program(self):
        path = self.scene(SCENE)
        made = self.by_command("render", path, "--set", "cloud.0.albedo=[0.9, 1.0, 0.8]")
        scene = lumulus.Scene(path)
        scene.set("cloud.0.albedo", numpy.array([0.9, 1.0, 0.8]))
        picture = lumulus.render(scene)
        self.same(picture, lumulus.Picture.read(made))
        again = self.folder / "again.exr"
        picture.write(again)
        self.assertEqual(again.read_bytes(), made.read_bytes())
        picture.write(self.folder / "a.png")
        self.assertEqual((self.folder / "a.png").read_bytes()[1:4], b"PNG")

    def test_truth_and_errors_are_those_of_the_program(self):
        path = self.scene(SCENE)
        truth = self.by_command("reference", path, "--spp", 2, "--majorant", "local")
        scene = lumulus.Scene(path)
        self.same(lumulus.reference(scene, spp=2, majorant="local"), lumulus.Picture.read(truth))
        made = self.by_command("render", path)
        told = json.loads(self.run_lumulus("compare", made, truth, "--json").stdout)
        self.assertEqual(lumulus.compare(lumulus.Picture.read(made), truth), told)

    def test_layers(self):
        picture = lumulus.render(lumulus.Scene.from_text(SCENE))
        self.assertEqual({name: picture[name].shape for name in picture},
                         {"RGB": (24, 32, 3), "A": (24, 32, 1), "cloud": (24, 32, 4), "depth": (24, 32, 2),
                          "transmittance": (24, 32, 3)})
        self.assertEqual({array.dtype for array in layers(picture).values()}, {numpy.dtype(numpy.float32)})
        self.assertEqual(picture.channels("cloud"), ["cloud." + c for c in "RGBA"])
        self.assertEqual(picture["depth.Z"].shape, (24, 32, 1))
        self.assertEqual(picture["cloud.A"].tobytes(), picture["cloud"][..., 3:].tobytes())
        self.assertEqual(picture.attributes["seed"], "5")
        self.assertIn("depth.front", picture)
        self.assertNotIn("variance", picture)
        with self.assertRaisesRegex(KeyError, "the picture has A, RGB"):
            picture["fog"]
        again = lumulus.Picture({"RGB": picture.rgb, "cloud": picture["cloud"], "A": picture["A"][..., 0]})
        self.assertEqual(again.keys(), ["A", "RGB", "cloud"])
        for name in again:
            self.assertEqual(again[name].tobytes(), picture[name].tobytes(), name)
        for arrays in ({}, {"RGB": picture["A"]}, {"RGB": picture.rgb, "A": picture["A"][1:]}, {"A": picture["cloud"] > 0}):
            with self.assertRaises(lumulus.InputError):
                lumulus.Picture(arrays)

    def test_views_share_photons(self):
        scene = lumulus.Scene.from_text(SCENE)
        renderer = lumulus.Renderer(scene)
        self.assertEqual(renderer.trace(1), 1)
        self.assertEqual(renderer.trace(), 0)
        there = (900.0, 1500.0, 300.0)
        view = renderer.render(position=there)
        self.same(renderer.render(), lumulus.render(scene))
        scene.set("camera.position", there)
        self.same(view, lumulus.render(scene))
        self.assertEqual(renderer.statistics()["photons"], 4000)


class Densities(PythonTest):
    def scene_of(self, array, **keys):
        scene = lumulus.Scene.from_text(SCENE)
        scene.update({"cloud.0.extinction": 0.05} | keys)
        scene.set_density(array, voxel_size=(20, 25, 15), origin=(100, 50, -30))
        return scene

    def test_an_array_is_like_a_file(self):
        density = some_density()
        grid = openvdb.FloatGrid()
        grid.copyFromArray(density)
        grid.name = "density"
        grid.transform = openvdb.createLinearTransform(
            [[20, 0, 0, 0], [0, 25, 0, 0], [0, 0, 15, 0], [100, 50, -30, 1]])
        openvdb.write(str(self.folder / "a.vdb"), [grid])
        path = self.scene(SCENE.replace("resolution = 24", 'vdb = "a.vdb"\nextinction = 0.05'))
        made = lumulus.Picture.read(self.by_command("render", path))
        self.assertGreater(made["cloud.A"].max(), 0.5)
        for kind in (numpy.float32, numpy.float64):
            self.same(lumulus.render(self.scene_of(density.astype(kind))), made)
        self.same(lumulus.render(self.scene_of(numpy.asfortranarray(density))), made)
        self.same(lumulus.reference(self.scene_of(density), spp=1),
                  lumulus.Picture.read(self.by_command("reference", path, "--spp", 1)))

    def test_values_that_are_no_densities(self):
        for value in (numpy.nan, numpy.inf, -1.0):
            with self.subTest(value=value):
                array = some_density()
                array[3, 4, 5] = value
                with self.assertRaisesRegex(lumulus.InputError, r"holds the value \S+ at voxel \(3, 4, 5\) "
                                            r"\(NumPy array\): densities are finite and not negative"):
                    lumulus.render(self.scene_of(array))
                with self.assertWarnsRegex(UserWarning, "set to 0"):
                    clamped = lumulus.render(self.scene_of(array, **{"cloud.0.clamp": True}))
                array[3, 4, 5] = 0
                self.same(clamped, lumulus.render(self.scene_of(array)))

    def test_arrays_that_are_no_densities(self):
        for array, says in ((numpy.ones((4, 4, 4), int), "values of type int64, not float"),
                            (numpy.ones((4, 4)), "has 2 dimensions"), (numpy.ones((4, 0, 4)), "0 voxels along an axis"),
                            (numpy.ones((4, 4, 4), bool), "type bool")):
            with self.subTest(says=says), self.assertRaisesRegex(lumulus.InputError, says):
                self.scene_of(array)
        scene = lumulus.Scene.from_text(SCENE)
        with self.assertRaisesRegex(lumulus.InputError, 'no cloud "veil" .text.: it has 0'):
            scene.set_density(some_density(), 1.0, cloud="veil")
        scene.set_density(some_density(), -1.0)
        with self.assertRaisesRegex(lumulus.InputError, "a voxel has the edge -1 m"):
            lumulus.render(scene)


class Errors(PythonTest):
    def test_text_is_that_of_the_program(self):
        path = self.scene(SCENE)
        for key, value in (("sun.elevaton", 5), ("cloud.0.albedo", [1.0, 2.0, 0.5]), ("cloud.3.extinction", 1.0),
                           ("image.width", "wide"), ("sky.model", "blue"), ("photon_map.photons", -4)):
            with self.subTest(key=key):
                line = self.rejected("render", path, "-o", self.out / "a.exr", "--set", f"{key}={json.dumps(value)}")
                scene = lumulus.Scene(path)
                with self.assertRaises(lumulus.InputError) as thrown:
                    scene.set(key, value)
                self.assertEqual("lumulus: error: " + str(thrown.exception), line)
                scene.set("image.width", 8)  # nothing is left of the bad value

    def test_threads(self):
        for number in (0, -3, 1025):
            with self.assertRaisesRegex(lumulus.InputError, f"{number} is no number of threads"):
                lumulus.limit_threads(number)

    def test_files(self):
        missing = str(self.folder / "missing.toml")
        line = self.rejected("render", missing, "-o", self.out / "a.exr")
        with self.assertRaises(lumulus.InputError) as thrown:
            lumulus.Scene(missing)
        self.assertEqual("lumulus: error: " + str(thrown.exception), line)
        with self.assertRaisesRegex(lumulus.InputError, "missing.vdb does not exist .*scene.toml:2, cloud.0.vdb"):
            lumulus.Scene.from_text('[[cloud]]\nvdb = "missing.vdb"', name=str(self.folder / "scene.toml"))
        damaged = self.folder / "damaged.vdb"
        damaged.write_bytes((self.fixtures / "ball.vdb").read_bytes()[:2000])
        line = self.rejected("render", damaged, "-o", self.out / "a.exr")
        with self.assertRaises(lumulus.InputError) as thrown:
            lumulus.render(lumulus.Scene(damaged))
        self.assertEqual("lumulus: error: " + str(thrown.exception), line)
        with self.assertRaises(lumulus.InputError):
            lumulus.render(lumulus.Scene.from_text(SCENE)).write(self.folder / "a.gif")

    def test_kinds(self):
        self.assertTrue(issubclass(lumulus.InputError, lumulus.Error) and issubclass(lumulus.Error, Exception))
        scene = lumulus.Scene.from_text(SCENE)
        for arguments in ({}, {"spp": 1, "seconds": 1.0}, {"spp": 0}, {"seconds": float("nan")},
                          {"spp": 1, "majorant": "best"}):
            with self.subTest(arguments=arguments), self.assertRaises(lumulus.InputError):
                lumulus.reference(scene, **arguments)
        with self.assertRaisesRegex(lumulus.Error, "device"):
            lumulus.Renderer(scene, device="no such device")
        with self.assertRaisesRegex(lumulus.InputError, "a value of type object is none of a scene"):
            scene.set("cloud.0.albedo", object())


class Threads(PythonTest):
    def test_other_threads_go_on(self):
        scene = lumulus.Scene.from_text(SCENE)
        scene.set("photon_map.photons", 200000)
        working, steps = threading.Event(), []

        def count():
            working.wait(60)
            for i in range(20):
                time.sleep(0.001)
                steps.append(i)
        other = threading.Thread(target=count)
        other.start()
        counted = []

        def progress(step, done, total):
            if step == "photons" and done == 0:
                working.set()
            if step == "photons" and done == total:
                counted.append(len(steps))
        lumulus.render(scene, progress=progress)
        other.join()
        self.assertEqual(counted, [20])

    def interrupted(self, work):
        """Runs the work and ends it by Ctrl-C; returns how long the end took."""
        sent = []

        def send():
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)
        timer = threading.Timer(0.4, send)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            work()
        self.assertEqual(len(sent), 1)
        return time.monotonic() - sent[0]

    def test_interrupts(self):
        long, short = lumulus.Scene.from_text(SCENE), lumulus.Scene.from_text(SCENE)
        long.update(LONG)
        renderer = lumulus.Renderer(long)
        for work in (renderer.render, lambda: lumulus.reference(long, spp=10**6)):
            self.assertLess(self.interrupted(work), 5.0)
        with self.assertRaisesRegex(lumulus.Error, "was interrupted .* make a new one"):
            renderer.render()
        self.same(lumulus.render(short), lumulus.render(short))

    def test_what_progress_throws_ends_the_work(self):
        scene = lumulus.Scene.from_text(SCENE)
        scene.update(LONG)

        def progress(step, done, total):
            if step == "photons":
                raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            lumulus.render(scene, progress=progress)

    def test_one_renderer_in_two_threads(self):
        scene = lumulus.Scene.from_text(SCENE)
        renderer, pictures = lumulus.Renderer(scene), []
        both = [threading.Thread(target=lambda: pictures.append(renderer.render())) for _ in range(2)]
        for thread in both:
            thread.start()
        for thread in both:
            thread.join()
        self.same(*pictures)


class Stubs(unittest.TestCase):
    def test_names(self):
        """The stubs name what the module has: functions and classes, methods, and their arguments in order."""
        tree = ast.parse((Path(lumulus.__file__).parent / "__init__.pyi").read_text())
        functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
        classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
        self.assertEqual(set(functions) | set(classes), set(lumulus.__all__))
        for name, node in functions.items():
            self.same_arguments(getattr(lumulus, name), node)
        for name, node in classes.items():
            here = getattr(lumulus, name)
            methods = {item.name: item for item in node.body if isinstance(item, ast.FunctionDef)}
            if issubclass(here, Exception):
                continue
            mine = {key for key in vars(here) if not key.startswith("_") or key in methods}
            self.assertEqual(mine, set(methods), name)
            for method, item in methods.items():
                if not isinstance(vars(here)[method], property):
                    self.same_arguments(getattr(here, method), item)

    def same_arguments(self, function, node):
        signature = function.__doc__.split("\n", 1)[0]
        given = ast.parse("def f" + self.plain(signature) + ": pass").body[0].args
        for mine, theirs in ((given.args, node.args.args), (given.kwonlyargs, node.args.kwonlyargs)):
            if mine and mine[0].arg.startswith("arg"):  # pybind11's name of an argument without one
                continue
            self.assertEqual([arg.arg for arg in mine], [arg.arg for arg in theirs], signature)

    @staticmethod
    def plain(signature):
        """The arguments of a signature of pybind11, without types and defaults."""
        arguments = signature[signature.index("("):signature.rindex(") ->")]
        names, depth = [""], 0
        for mark in arguments[1:]:
            depth += (mark in "([{") - (mark in ")]}")
            if mark == "," and depth == 0:
                names.append("")
            else:
                names[-1] += mark
        return "(" + ", ".join(name.split(":")[0].split("=")[0].strip() for name in names) + ")"


class Example(PythonTest):
    def test_example(self):
        script = Path(__file__).parents[2] / "src/python/examples/cloud_from_numpy.py"
        said, before = io.StringIO(), sys.argv
        sys.argv = [str(script), str(self.folder)]
        try:
            with redirect_stdout(said):
                runpy.run_path(str(script), run_name="__main__")
        finally:
            sys.argv = before
        self.assertIn("refused: unknown key", said.getvalue())
        front = lumulus.Picture.read(self.folder / "side.exr")
        self.assertGreater(front["cloud.A"].max(), 0.9)
        self.assertTrue((self.folder / "front.png").is_file())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
