#!/usr/bin/python3
"""A cloud from a NumPy array: from density to picture, truth and error. Cells begin with `# %%`, as notebooks of
editors (Spyder, VS Code, PyCharm) take them; as a program: cloud_from_numpy.py [FOLDER].
"""
# %% Where pictures go
import sys
from pathlib import Path

import numpy

import lumulus

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)

# %% A density along x, y (up) and z: a ball of 300 m with a flat bottom and bumps
edge = 12.5  # metres
x, y, z = numpy.meshgrid(*(edge * numpy.arange(-28, 29),) * 3, indexing="ij")
bumps = numpy.sin(x / 40) * numpy.sin(y / 35) * numpy.sin(z / 45)
density = numpy.clip((300 - numpy.sqrt(x**2 + y**2 + z**2) + 60 * bumps) / 60, 0, 1) * numpy.clip((y + 150) / 50, 0, 1)

# %% A scene of it. What the text leaves out has its default (docs/scene-format.md).
scene = lumulus.Scene.from_text("""
image = { width = 160, height = 120 }
sun = { azimuth = 60, elevation = 30 }
camera = { position = [0, 900, 1500], target = [0, 1000, 0] }
[[cloud]]
extinction = 0.05
""", quality="draft")
scene.set_density(density, voxel_size=edge, origin=(-28 * edge, 1000 - 28 * edge, -28 * edge))
scene.set("photon_map.seed", 7)

# %% Photons once, views as many as wanted
renderer = lumulus.Renderer(scene)
front = renderer.render()
side = renderer.render(position=(1500, 900, 0))
front.write(folder / "front.png")
side.write(folder / "side.exr")
print({name: front[name].shape for name in front})
print("mean radiance in front and from the side:", front.rgb.mean(), side.rgb.mean())

# %% How far it is from the truth
truth = lumulus.reference(scene, spp=4, majorant="local")
error = lumulus.compare(front, truth)
print(f"bias {100 * error['relative_bias']:.1f} % ± {100 * error['standard_error']['relative_bias']:.1f} %,"
      f" FLIP {error['flip']:.3f}")

# %% What is wrong with a scene is told in one line
try:
    scene.set("sun.elevaton", 5)
except lumulus.InputError as wrong:
    print("refused:", wrong)
