#!/usr/bin/env python3
"""Moves the sun from morning to evening in a stream, whose photons age in, and saves it: sun_sweep.py FOLDER"""

import argparse
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from lumulus_client import Client


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--address", default="127.0.0.1:7788")
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--width", type=int, default=320)
    parser.add_argument("--height", type=int, default=180)
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    with Client(options.address, name="sun sweep") as client:
        # photons of its own: the sun of others stays where it is
        client.load_scene(client.welcome["scene"], quality="interactive", private=True)
        wishes = {"width": options.width, "height": options.height, "encoding": "jpeg", "max_rate": 10}
        stream = client.start_stream(sun={"azimuth": -90, "elevation": 5}, **wishes)
        for number in range(options.frames):
            frame = client.next_frame(stream)
            path = os.path.join(options.folder, f"sun-{number:04}.jpg")
            with open(path, "wb") as file:
                file.write(frame.file())
            print(path, f"{frame.info['current_generations']} of {frame.info['generations']} generations see this sun")
            share = (number + 1) / options.frames
            sun = {"azimuth": -90 + 180 * share, "elevation": 5 + 160 * share * (1 - share)}
            client.start_stream(stream, sun=sun, **wishes)
        client.stop_stream(stream)


if __name__ == "__main__":
    main()
