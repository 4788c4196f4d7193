#!/usr/bin/env python3
"""Orbits the cloud once and saves the frames: orbit.py FOLDER [--address HOST:PORT] [--frames N]"""

import math

from common import connect, parser, save


def main():
    options = parser(__doc__, frames=24).parse_args()
    with connect(options, "orbit") as client:
        scene = client.load_scene(client.welcome["scene"], quality="interactive")
        x, y, z = scene["center"]
        distance = 2.5 * scene["radius"]
        for number in range(options.frames):
            angle = 2.0 * math.pi * number / options.frames
            camera = {"position": [x + distance * math.sin(angle), y, z + distance * math.cos(angle)],
                      "target": [x, y, z], "vertical_fov": 40}
            frame = client.frame(camera=camera, width=options.width, height=options.height, encoding="jpeg")
            path = save(frame, options.folder, f"orbit-{number:04}.jpg")
            print(path, f"{frame.info['milliseconds']['total']:.0f} ms")


if __name__ == "__main__":
    main()
