"""The studies' reader and writer of pictures: EXR by OpenImageIO, PNG by Pillow."""

import numpy
import OpenImageIO
from PIL import Image

from study.program import Failure


def opened(path):
    """The file, to be read. Raises Failure where it is no picture."""
    file = OpenImageIO.ImageInput.open(str(path))
    if file is None:
        raise Failure(f"{path} is not an EXR file: {(OpenImageIO.geterror().splitlines() or ['it cannot be read'])[0]}")
    return file


def read_exr(path):
    """Layers of an EXR file by name, each an array [height, width] of 32-bit floats with the rows from the top. Half
    floats are widened, which loses nothing. Raises Failure where the file cannot be read."""
    file = opened(path)
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
    file = opened(path)
    found = {one.name: one.value for one in file.spec().extra_attribs if isinstance(one.value, str)}
    file.close()
    return found


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


def as_image(intensity):
    """A Pillow image of display intensities [height, width, 3] from 0 to 1."""
    return Image.fromarray((255.0 * numpy.clip(intensity, 0.0, 1.0) + 0.5).astype(numpy.uint8))


def srgb(intensity):
    """Linear intensities from 0 to 1 as a screen is given them (IEC 61966-2-1)."""
    return numpy.where(intensity <= 0.0031308, 12.92 * intensity, 1.055 * intensity ** (1.0 / 2.4) - 0.055)


def tone_mapped(radiance, exposure):
    """Display intensities of radiance [height, width, 3] after some stops of exposure, as base/tonemap.cpp has them
    (Narkowicz 2015, sRGB), without its dither, which would not compress."""
    x = numpy.clip(radiance.astype(float) * 2.0**exposure, 0.0, 1e6)
    return srgb(numpy.minimum(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)))
