#!/usr/bin/env python3
"""Puts a ground plane, drawn here, into the scene's medium: composite_depth.py FILE, a .png, .jpg or .exr"""

import array
import math
import os

from common import connect, parser, save

ENCODINGS = {".png": "png", ".jpg": "jpeg", ".exr": "exr"}
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
    arguments = parser(__doc__, target="file", width=320, height=180)
    arguments.add_argument("--visibility", type=float, default=1500.0, help="metres")
    options = arguments.parse_args()
    suffix = os.path.splitext(options.file)[1]
    if suffix not in ENCODINGS:
        arguments.error(f"{options.file}: end its name in one of {', '.join(ENCODINGS)}")
    fog = f'cloud = []\n[[fog.media]]\nkind = "homogeneous"\nvisibility = {options.visibility}\n'
    color, depth = ground_plane(options.width, options.height, 40.0, 20.0)
    with connect(options, "composite") as client:
        client.load_scene(toml=fog)
        frame = client.composite(color.tobytes(), depth.tobytes(), options.width, options.height,
                                 encoding=ENCODINGS[suffix],
                                 camera={"position": [0, 20, 0], "target": [0, 20, -1], "vertical_fov": 40})
        save(frame, options.file)


if __name__ == "__main__":
    main()
