#!/usr/bin/python3
"""Lights a cloud by a look-up, as another engine would: light_from_vdb.py LUMULUS FOLDER [PHOTONS].

`lumulus bake` writes the light of a cloud, `lumulus render` a picture of it. This script marches through the cloud's
density with the light of the grids, by NumPy alone, and compares its picture's mean with that of the renderer.
Needs Debian's python3-numpy and python3-openvdb, and python3-openimageio to read the picture.
"""
import json
import math
import subprocess
import sys
from pathlib import Path

import numpy
import OpenImageIO
import pyopenvdb as openvdb

lumulus, folder, photons = sys.argv[1], Path(sys.argv[2]), sys.argv[3] if len(sys.argv) > 3 else "2000000"
folder.mkdir(parents=True, exist_ok=True)
WIDTH, HEIGHT, FIELD_OF_VIEW = 64, 48, math.radians(40)
EYE, TARGET = numpy.array([500.0, 700.0, 1900.0]), numpy.array([0.0, 850.0, 0.0])
SKY = 0.3
(folder / "scene.toml").write_text(f"""
image = {{ width = {WIDTH}, height = {HEIGHT} }}
camera = {{ position = {EYE.tolist()}, target = {TARGET.tolist()}, vertical_fov = 40 }}
sun = {{ azimuth = 60, elevation = 35, irradiance = [3.0, 2.9, 2.7], angular_diameter = 0 }}
sky = {{ model = "constant", radiance = [{SKY}, {SKY}, {SKY}] }}
photon_map = {{ photons = {photons} }}
[[cloud]]
vdb = "cloud.vdb"
extinction = 0.03
""")


def run(*arguments):
    subprocess.run([lumulus, *map(str, arguments), "--quiet"], check=True)


class Field:
    """A grid as an array, looked up between its values; 0 outside."""

    def __init__(self, grid):
        low, high = grid.evalActiveVoxelBoundingBox()
        self.low = numpy.array(low)
        size = numpy.array(high) - self.low + 1
        vectors = () if isinstance(grid, openvdb.FloatGrid) else (3,)
        self.values = numpy.zeros((*size, *vectors), numpy.float32)
        grid.copyToArray(self.values, ijk=low)
        # grids of Lumulus have no rotation: metres to index is a scale and a shift
        self.origin = numpy.array(grid.transform.indexToWorld((0.0, 0.0, 0.0)))
        self.edge = numpy.array(grid.transform.voxelSize())
        self.lower = self.origin + (self.low - 1) * self.edge
        self.upper = self.origin + (numpy.array(high) + 1) * self.edge

    def __call__(self, points):
        at = (points - self.origin) / self.edge - self.low
        base = numpy.floor(at).astype(int)
        share = at - base
        result = 0.0
        for corner in numpy.ndindex(2, 2, 2):
            index = base + corner
            inside = numpy.all((index >= 0) & (index < self.values.shape[:3]), axis=-1)
            weight = numpy.prod(numpy.where(corner, share, 1 - share), axis=-1) * inside
            index = numpy.clip(index, 0, numpy.array(self.values.shape[:3]) - 1)
            value = self.values[index[..., 0], index[..., 1], index[..., 2]]
            result = result + (weight[..., None] if value.ndim > weight.ndim else weight) * value
        return result


# %% What the renderer writes
run("cloud", "cumulus", "-o", folder / "cloud.vdb", "--resolution", 96)
run("bake", folder / "scene.toml", "-o", folder / "light.vdb")
run("render", folder / "scene.toml", "-o", folder / "picture.exr")

# %% What another engine reads
conventions = json.loads((folder / "light.json").read_text())
cloud = conventions["clouds"][0]
assert cloud["phase"]["model"] == "hg"
g, extinction, albedo = cloud["phase"]["g"], cloud["extinction"], numpy.array(cloud["albedo"])
to_sun = numpy.array(conventions["direction_to_sun"])
density = Field(openvdb.read(str(folder / "cloud.vdb"), "density"))
light = {name: Field(openvdb.read(str(folder / "light.vdb"), name))
         for name in ["sun"] + [f"sh{i}" for i in range(9)]}

# %% Rays of all pixels
forward = (TARGET - EYE) / numpy.linalg.norm(TARGET - EYE)
right = numpy.cross(forward, [0, 1, 0])
right /= numpy.linalg.norm(right)
up = numpy.cross(right, forward)
column, row = numpy.meshgrid((numpy.arange(WIDTH) + 0.5) / WIDTH * 2 - 1, 1 - (numpy.arange(HEIGHT) + 0.5) / HEIGHT * 2)
tangent = math.tan(FIELD_OF_VIEW / 2)
rays = forward + tangent * (column[..., None] * WIDTH / HEIGHT * right + row[..., None] * up)
rays /= numpy.linalg.norm(rays, axis=-1, keepdims=True)

# %% The light that is scattered towards the eye: direction v = -ray, so that -v of the conventions is the ray
x, y, z = rays[..., 0], rays[..., 1], rays[..., 2]
basis = [0 * x + 0.28209479177387814, 0.4886025119029199 * y, 0.4886025119029199 * z, 0.4886025119029199 * x,
         1.0925484305920792 * x * y, 1.0925484305920792 * y * z, 0.31539156525252005 * (3 * z * z - 1),
         1.0925484305920792 * x * z, 0.5462742152960396 * (x * x - y * y)]
moments = [g ** (0 if i == 0 else 1 if i < 4 else 2) for i in range(9)]
cosine = (rays * to_sun).sum(axis=-1)
phase = (1 - g * g) / (4 * math.pi * (1 + g * g - 2 * g * cosine) ** 1.5)

# %% The march
with numpy.errstate(divide="ignore"):
    faces = numpy.stack([(density.lower - EYE) / rays, (density.upper - EYE) / rays])
near, far = numpy.maximum(faces.min(axis=0).max(axis=-1), 0), faces.max(axis=0).min(axis=-1)
STEPS = 160
step = numpy.maximum(far - near, 0) / STEPS
transmittance, radiance = numpy.ones((HEIGHT, WIDTH)), numpy.zeros((HEIGHT, WIDTH, 3))
for i in range(STEPS):
    points = EYE + (near + (i + 0.5) * step)[..., None] * rays
    depth = extinction * density(points) * step
    lit = numpy.flatnonzero(depth.ravel() > 0)
    if lit.size == 0:
        continue
    there = points.reshape(-1, 3)[lit]
    source = phase.ravel()[lit, None] * light["sun"](there)
    for k in range(9):
        source += (moments[k] * basis[k].ravel()[lit])[:, None] * light[f"sh{k}"](there)
    scattered = numpy.zeros((HEIGHT * WIDTH, 3))
    scattered[lit] = albedo * source
    radiance += (transmittance * -numpy.expm1(-depth))[..., None] * scattered.reshape(HEIGHT, WIDTH, 3)
    transmittance *= numpy.exp(-depth)
radiance += transmittance[..., None] * SKY

# %% Beside the renderer's picture
picture = OpenImageIO.ImageBuf(str(folder / "picture.exr"))
names = picture.spec().channelnames
pixels = picture.get_pixels(OpenImageIO.FLOAT)
truth = numpy.stack([pixels[..., names.index(c)] for c in "RGB"], axis=-1)
clouded = pixels[..., names.index("cloud.A")] > 0.01
ratio = radiance[clouded].mean(axis=0) / truth[clouded].mean(axis=0)
print("mean of the cloud's pixels over the renderer's, R, G, B:", " ".join(f"{value:.4f}" for value in ratio))
numpy.save(folder / "marched.npy", radiance.astype(numpy.float32))
sys.exit(0 if numpy.all(abs(ratio - 1) < 0.03) else 1)
