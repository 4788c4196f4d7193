#!/usr/bin/env python3
"""Puts a ground plane, drawn here, into the scene's medium: composite_depth.py FILE.png"""

import argparse
import array
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from lumulus_client import Client

FAR = 20000.0  # metres, where the sky begins


def ground_plane(width, height, fov, eye_height):
    """Colour and distance of a chequered plane below a level view, as arrays of floats."""
    color, depth = array.array("f"), array.array("f")
    tangent = math.tan(math.radians(0.5 * fov))
    for row in range(height):
        up = tangent * (1.0 - 2.0 * (row + 0.5) / height)
        for column in range(width):
            right = tangent * (2.0 * (column + 0.5) / width - 1.0) * width / height
            ahead = eye_height / -up if up < 0.0 else FAR
            distance = ahead * math.sqrt(1.0 + up * up + right * right)
            if distance >= FAR:
                color.extend((0.12, 0.22, 0.42))
                depth.append(FAR)
            else:
                shade = 0.8 if (math.floor(ahead / 50.0) + math.floor(ahead * right / 50.0)) % 2 else 0.2
                color.extend((shade, shade, shade))
                depth.append(distance)
    return color, depth


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file")
    parser.add_argument("--address", default="127.0.0.1:7788")
    parser.add_argument("--visibility", type=float, default=1500.0, help="metres")
    parser.add_argument("--width", type=int, default=320)
    parser.add_argument("--height", type=int, default=180)
    options = parser.parse_args()
    fog = f'cloud = []\n[[fog.media]]\nkind = "homogeneous"\nvisibility = {options.visibility}\n'
    color, depth = ground_plane(options.width, options.height, 40.0, 20.0)
    with Client(options.address, name="composite") as client:
        client.load_scene(toml=fog)
        frame = client.composite(color.tobytes(), depth.tobytes(), options.width, options.height, encoding="png",
                                 camera={"position": [0, 20, 0], "target": [0, 20, -1], "vertical_fov": 40})
        with open(options.file, "wb") as file:
            file.write(frame.file())


if __name__ == "__main__":
    main()
