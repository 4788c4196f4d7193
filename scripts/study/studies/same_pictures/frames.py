"""The cases of the frame service: both programs are started with the same configuration and asked the same."""

import tempfile

import numpy

from study.pictures import read_exr
from study.program import Failure
from study.service import ServiceError
from study.studies.same_pictures.side import Case

PRODUCTS = ["color", "cloud", "transmittance", "depth", "front"]
SUN = {"azimuth": -100, "elevation": 10}
CAMERA = {"position": [300, 50, 20], "target": [0, 100, 0], "vertical_fov": 60}
FOG = '[{kind="exponential", scattering=0.004, falloff=0.01, g=0.8, bottom=-200}]'
TILES = [{"width": 64, "height": 48, "tile": tile} for tile in ([0, 0, 33, 48], [33, 0, 31, 17], [33, 17, 31, 31])]
VIEWS = [{"width": 64, "height": 48}, {"width": 40, "height": 31, "camera": CAMERA},
         {"width": 48, "height": 24, "camera": {**CAMERA, "projection": "panorama"}},
         {"width": 48, "height": 36, "camera": {**CAMERA, "projection": "orthographic"}},
         {"width": 48, "height": 36, "camera": {"position": [0, 100, 300], "orientation": [1, 0, 0, 0],
                                                "frustum": [-0.2, 0.6, -0.3, 0.4]}}]


def exr_layers(data):
    with tempfile.NamedTemporaryFile(suffix=".exr") as file:
        file.write(data)
        file.flush()
        return read_exr(file.name)


# channels of the products that have several, as EXR files call them
CHANNELS = {"color": ["R", "G", "B", "A"], "cloud": ["cloud.R", "cloud.G", "cloud.B", "cloud.A"],
            "transmittance": ["transmittance.R", "transmittance.G", "transmittance.B"]}


def channels_of(name, values):
    """The channels of a product by the names that they have in an EXR file."""
    if name not in CHANNELS:
        return {name: values}
    return {channel: values[..., i] for i, channel in enumerate(CHANNELS[name][:values.shape[-1]])}


def layers_of(frame):
    """The layers of all views of a frame, by number and name; those of PNG and JPEG files are their bytes."""
    found = {}
    for i, view in enumerate(frame.info["views"]):
        if "products" in view:
            layers = {}
            for part in view["products"]:
                layers |= channels_of(part["name"], frame.values(part["name"], i))
        elif view["type"] == "exr":
            layers = exr_layers(frame.file(i))
        else:
            layers = {view["type"]: numpy.frombuffer(frame.file(i), "u1")}
        found |= {f"{i}.{name}": values for name, values in layers.items()}
    return found


def frame_case(name, requests, settings=(), quick=False, shown=None):
    """Frames of a scene of the client's own; the requests, dictionaries of fields, are asked one after the other, each
    when the one before has come. The first fills the ring of generations. `shown` takes what to compare from the client
    instead of the last frame."""
    def make(side):
        with side.client() as client:
            try:
                client.load_scene("small.toml", private=True, set=list(settings))
                for fields in requests:
                    frame = client.frame(**fields)
                frame = shown(client) if shown else frame
            except (OSError, ServiceError) as error:
                raise Failure(f"the service: {error}") from None
            return layers_of(frame)

    return Case(f"service: {name}", make, quick)


def composited(client):
    y, x = numpy.mgrid[0:30, 0:40].astype("f")
    color = numpy.stack([x / 40, y / 30, x * y], axis=-1)
    return client.composite(color.tobytes(), (10 + 20 * x).astype("f").tobytes(), 40, 30, encoding="float")


def changed(client):
    """A frame of another time after sun, extinction and wind were changed for all."""
    client.change(sun={"azimuth": 10, "elevation": 80}, extinction=0.04, wind=[5, 0, 0])
    return client.frame(time=20, products=PRODUCTS, encoding="float")


def frame_cases():
    every = {"products": PRODUCTS, "encoding": "float"}
    yield frame_case("all products, float", [every], quick=True)
    yield frame_case("all products, half", [{"products": PRODUCTS}])
    yield frame_case("EXR", [{"products": PRODUCTS, "encoding": "exr"}])
    yield frame_case("PNG", [{"encoding": "png", "exposure": -0.5}])
    yield frame_case("JPEG", [{"encoding": "jpeg", "quality": 90}])
    yield frame_case("tiles", [{**every, "views": TILES}], quick=True)
    yield frame_case("several cameras", [{**every, "views": VIEWS}])
    yield frame_case("several cameras, billboards", [{**every, "views": VIEWS}], ["draw.mode=billboards"])
    yield frame_case("a moved sun", [{}, {**every, "sun": SUN}], quick=True)
    yield frame_case("a moved sun, billboards", [{}, {**every, "sun": SUN}], ["draw.mode=billboards"])
    yield frame_case("a sun of another irradiance", [{}, {**every, "sun": {"irradiance": [3, 1, 0.5]}}])
    yield frame_case("another extinction", [{}, {**every, "extinction": 0.05}])
    yield frame_case("wind", [{}, {**every, "wind": [5, 1, 0], "time": 12.5}])
    yield frame_case("changed for all", [{}], shown=changed)
    yield frame_case("fog", [{"width": 160, "height": 90, **every}], [f"fog.media={FOG}"], quick=True)
    yield frame_case("fog, tiles", [{**every, "views": TILES}], [f"fog.media={FOG}"])
    yield frame_case("fog, masked", [{"width": 160, "height": 90, **every}], [f"fog.media={FOG}", "fog.filter=masked"])
    yield frame_case("composite", [], [f"fog.media={FOG}"], shown=composited)
