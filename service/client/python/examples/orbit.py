#!/usr/bin/env python3
"""Orbits the cloud once and saves the frames: orbit.py FOLDER [--address HOST:PORT] [--frames N]"""

import argparse
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from lumulus_client import Client


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--address", default="127.0.0.1:7788")
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--height", type=int, default=360)
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    with Client(options.address, name="orbit") as client:
        scene = client.load_scene(client.welcome["scene"], quality="interactive")
        x, y, z = scene["center"]
        distance = 2.5 * scene["radius"]
        for number in range(options.frames):
            angle = 2.0 * math.pi * number / options.frames
            camera = {"position": [x + distance * math.sin(angle), y, z + distance * math.cos(angle)],
                      "target": [x, y, z], "vertical_fov": 40}
            frame = client.frame(camera=camera, width=options.width, height=options.height, encoding="jpeg")
            path = os.path.join(options.folder, f"orbit-{number:04}.jpg")
            with open(path, "wb") as file:
                file.write(frame.file())
            print(path, f"{frame.info['milliseconds']['total']:.0f} ms")


if __name__ == "__main__":
    main()
