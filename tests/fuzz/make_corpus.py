#!/usr/bin/python3
"""Writes the fuzzer's first inputs, one valid conversation a file: make_corpus.py FOLDER"""

import json
import os
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
}


def encoded(number, kind, fields, payload):
    text = json.dumps(fields).encode()
    return HEADER.pack(MAGIC, 1, TYPES[kind], number, len(text), 0, len(payload)) + text + payload


for name, message in CONVERSATIONS.items():
    with open(os.path.join(sys.argv[1], name), "wb") as file:
        # the first byte is the size of the pieces
        file.write(bytes([20]) + encoded(1, *HELLO) + encoded(2, *message))
