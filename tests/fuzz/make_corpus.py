#!/usr/bin/python3
"""Writes first inputs for a fuzz target, each a file: make_corpus.py chunks|exr|scene|session FOLDER

scripts/fuzz.sh takes the folder. For vdb it is what build/release/tests/make_vdb_fixtures writes.
"""

import json
import os
import pathlib
import re
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "service", "client", "python"))
from lumulus_client import HEADER, MAGIC, TYPES

HELLO = ("hello", {"version": 1, "token": "secret"}, b"")
HASH = "a" * 64
CONVERSATIONS = {
    "load-name": ("load_scene", {"name": "a.toml", "set": ["x=1"], "quality": "draft", "private": True}, b""),
    "load-text": ("load_scene", {"vdb": HASH}, b"[image]\nwidth = 3\n"),
    "upload": ("upload", {"hash": HASH, "size": 10, "offset": 2}, b"eightbyt"),
    "frame": ("frame", {"camera": {"position": [1, 2, 3], "target": [0, 0, 0], "up": [0, 1, 0], "vertical_fov": 30,
                                   "projection": "panorama"}, "width": 8, "height": 8, "tile": [0, 0, 4, 4],
                        "time": 1, "channel": 3, "queue": True, "extinction": 0.1, "wind": [1, 0, 0]}, b""),
    "views": ("frame", {"views": [{"camera": {"position": [0, 0, 0], "orientation": [1, 0, 0, 0],
                                              "frustum": [-1, 1, -1, 1]}}, {"width": 8}]}, b""),
    "products": ("frame", {"products": ["color", "depth"], "encoding": "exr", "budget": {"photons": 10}}, b""),
    "sun": ("frame", {"sun": {"azimuth": 1, "elevation": 2, "irradiance": [1, 2, 3]}, "encoding": "jpeg",
                      "quality": 90, "exposure": 1, "budget": {"milliseconds": 5}}, b""),
    "stream": ("start_stream", {"max_rate": 5, "when": "change"}, b""),
    "stop": ("stop_stream", {"stream": 1}, b""),
    "composite": ("composite", {"width": 1, "height": 1, "encoding": "png"}, bytes(16)),
    "cancel": ("cancel", {"request": 1}, b""),
    "statistics": ("statistics", {}, b""),
    "ping": ("ping", {}, b""),
    "scenes": ("list_scenes", {}, b""),
    "change": ("change", {"sun": {"direction_to": [0, 1, 0]}}, b""),
    "query": ("query", {"products": ["segments"]}, bytes(48)),
}


def encoded(number, kind, fields, payload):
    text = json.dumps(fields).encode()
    return HEADER.pack(MAGIC, 1, TYPES[kind], number, len(text), 0, len(payload)) + text + payload


def session_inputs():
    """One valid conversation each; the first byte is the size of the pieces in which it comes."""
    return {name: bytes([20]) + encoded(1, *HELLO) + encoded(2, *message) for name, message in CONVERSATIONS.items()}


def chunks_inputs():
    """Steps of tests/fuzz/chunks_input.h: flags, offset, length, what is added to the size."""
    def steps(*values):
        return b"".join(struct.pack("<BHHB", *step) for step in values)

    ten, many, last = 4, 8, 12  # files of 10, 300 and 600 bytes
    wrong, other_size, leaves = 16, 32, 128
    return {
        "empty": steps((0, 0, 0, 0)),
        "whole": steps((ten, 0, 10, 0), (ten + 1, 0, 10, 0)),
        "pieces": steps((many, 0, 100, 0), (many, 100, 100, 0), (many, 200, 100, 0)),
        "together": steps((many, 0, 100, 0), (many + 1, 0, 200, 0), (many, 100, 200, 0), (many + 1, 200, 100, 0)),
        "gap": steps((many, 0, 100, 0), (many, 150, 100, 0), (many, 0, 300, 0)),
        "wrong": steps((ten + wrong, 0, 10, 0), (ten, 0, 10, 0)),
        "size": steps((ten + other_size, 0, 10, 1), (ten, 0, 10, 0)),
        "full": steps((last, 0, 600, 0), (many + other_size, 0, 300, 200), (many, 0, 300, 0)),
        "leaves": steps((many, 0, 100, 0), (leaves, 0, 0, 0), (many, 100, 200, 0)),
        "several": steps((ten, 0, 5, 0), (many, 0, 5, 0), (last, 0, 5, 0), (0, 0, 0, 0), (ten + other_size, 0, 5, 1)),
    }


def scene_inputs():
    """The shipped scenes, one for each value that docs/scene-format.md shows of a key, and one with the rest."""
    root = pathlib.Path(__file__).resolve().parents[2]
    found = {path.stem: path.read_bytes() for path in (root / "configs" / "scenes").glob("*.toml")}
    section = ""
    for line in (root / "docs" / "scene-format.md").read_text().splitlines():
        if line.startswith("## "):
            section = re.match(r"[\w.\[\]]*", line[3:]).group()
            if section in ("[cloud.phase]", "[[fog.media]]", "[[surface]]"):
                section = {"[cloud.phase]": "[[cloud]]\n"}.get(section, "cloud = []\n") + section
        row = re.match(r"\| `(\w+)` \| (.*?) \| (.*?) \|", line)
        if not row or not section:
            continue
        key, allowed, default = row.groups()
        for value in sorted({*re.findall(r"`([^`]+)`", allowed + default), "[1, 2, 3]", "7", "true"}):
            found[f"{key}-{len(found)}"] = f"{section}\n{key} = {value}\n".encode()
    found["rest"] = b"""cloud = []
fog = { media = [{ kind = "height", visibility = 500, scale_height = 100 }], filter = "pyramid", near = 1, far = 9 }
[sun]
direction_to = [0, 1, 0]
[[surface]]
kind = "plane"
"""
    return found


def exr_inputs():
    """Small pictures in every compression, in lines and tiles, of several types, windows and parts."""
    import numpy
    import OpenImageIO as oiio  # Debian's python3-openimageio

    def picture(width, height, channels, kind, **attributes):
        spec = oiio.ImageSpec(width, height, len(channels), kind)
        spec.channelnames = channels
        for name, value in attributes.items():
            if name == "tile":
                spec.tile_width = spec.tile_height = value
            elif name == "corner":
                spec.x, spec.y = value
            else:
                spec.attribute(name, value)
        values = numpy.arange(width * height * len(channels), dtype=numpy.float32).reshape(height, width, len(channels))
        path = pathlib.Path(sys.argv[2]) / "made.exr"
        out = oiio.ImageOutput.create(str(path))
        out.open(str(path), spec)
        out.write_image(values / 16.0)
        out.close()
        content = path.read_bytes()
        path.unlink()
        return content

    rgb = ("R", "G", "B")
    found = {method: picture(5, 18, rgb, "half", compression=method) for method in (
        "none", "rle", "zip", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab")}
    found["floats"] = picture(3, 3, ("R", "G", "B", "A", "depth.Z"), "float", compression="zip")
    found["integers"] = picture(3, 3, ("id",), "uint32", compression="zip")
    found["tiles"] = picture(20, 20, rgb, "half", compression="zip", tile=16)
    found["window"] = picture(4, 4, rgb, "float", corner=(-3, 7), scene="a scene")
    return found


if __name__ == "__main__":
    kinds = {"chunks": chunks_inputs, "exr": exr_inputs, "scene": scene_inputs, "session": session_inputs}
    if len(sys.argv) != 3 or sys.argv[1] not in kinds:
        sys.exit(__doc__)
    for name, content in kinds[sys.argv[1]]().items():
        (pathlib.Path(sys.argv[2]) / name).write_bytes(content)
