"""The studies' reader and writer of pictures: EXR by OpenImageIO, PNG by Pillow."""

import numpy
import OpenImageIO
from PIL import Image

from study.program import Failure


def read_exr(path):
    """Layers of an EXR file by name, each an array [height, width] of 32-bit floats with the rows from the top. Half
    floats are widened, which loses nothing. Raises Failure where the file cannot be read."""
    file = OpenImageIO.ImageInput.open(str(path))
    if file is None:
        raise Failure(f"{path} is not an EXR file: {OpenImageIO.geterror().splitlines()[0]}")
    try:
        names = file.spec().channelnames
        pixels = file.read_image(0, 0, 0, len(names), OpenImageIO.FLOAT)
        if pixels is None:
            raise Failure(f"{path} is not a whole EXR file: {file.geterror()}")
    finally:
        file.close()
    return {name: numpy.ascontiguousarray(pixels[..., i]) for i, name in enumerate(names)}


def read_attributes(path):
    """The attributes of an EXR file that are texts, by name."""
    file = OpenImageIO.ImageInput.open(str(path))
    if file is None:
        raise Failure(f"{path} is not an EXR file: {OpenImageIO.geterror().splitlines()[0]}")
    found = {one.name: one.value for one in file.spec().extra_attribs if isinstance(one.value, str)}
    file.close()
    return found


def layer(layers, name, path):
    """One of the layers, or a Failure that names what is missing."""
    if name not in layers:
        raise Failure(f"{path} has no layer {name}")
    return layers[name]


def rgb(layers):
    """Radiance [height, width, 3] of layers."""
    return numpy.stack([layers[name] for name in "RGB"], axis=-1)


def write_exr(path, layers):
    """Writes layers, arrays [height, width] by name, as 32-bit floats."""
    names = sorted(layers)
    pixels = numpy.stack([layers[name] for name in names], axis=-1).astype(numpy.float32)
    height, width, count = pixels.shape
    spec = OpenImageIO.ImageSpec(width, height, count, OpenImageIO.FLOAT)
    spec.channelnames = tuple(names)
    spec.attribute("compression", "none")
    file = OpenImageIO.ImageOutput.create(str(path))
    if not file.open(str(path), spec) or not file.write_image(pixels):
        raise Failure(f"{path} cannot be written: {file.geterror()}")
    file.close()


def write_png(path, intensity):
    """Writes display intensities [height, width, 3] from 0 to 1."""
    Image.fromarray((255.0 * numpy.clip(intensity, 0.0, 1.0) + 0.5).astype(numpy.uint8)).save(path, optimize=True)
