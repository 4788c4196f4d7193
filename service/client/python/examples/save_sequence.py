#!/usr/bin/env python3
"""Saves frames as linear EXR files, the cloud drifting with the wind: save_sequence.py FOLDER"""

import argparse
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from lumulus_client import Client


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--address", default="127.0.0.1:7788")
    parser.add_argument("--frames", type=int, default=10)
    parser.add_argument("--step", type=float, default=1.0, help="seconds between frames")
    parser.add_argument("--wind", type=float, nargs=3, default=[10.0, 0.0, 0.0], help="m/s")
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--height", type=int, default=360)
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    with Client(options.address, name="sequence") as client:
        client.load_scene(client.welcome["scene"], quality="interactive", private=True)
        client.change(wind=options.wind)
        for number in range(options.frames):
            frame = client.frame(time=number * options.step, width=options.width, height=options.height,
                                 encoding="exr", products=["color", "transmittance", "depth"])
            path = os.path.join(options.folder, f"frame-{number:04}.exr")
            with open(path, "wb") as file:
                file.write(frame.file())
            print(path, frame.info["photons"], "photons")


if __name__ == "__main__":
    main()
