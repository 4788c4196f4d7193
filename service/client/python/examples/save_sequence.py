#!/usr/bin/env python3
"""Saves frames as linear EXR files, the cloud drifting with the wind: save_sequence.py FOLDER"""

from common import connect, parser, save


def main():
    arguments = parser(__doc__, frames=10)
    arguments.add_argument("--step", type=float, default=1.0, help="seconds between frames")
    arguments.add_argument("--wind", type=float, nargs=3, default=[10.0, 0.0, 0.0], help="m/s")
    options = arguments.parse_args()
    with connect(options, "sequence") as client:
        client.load_scene(client.welcome["scene"], quality="interactive", private=True)
        client.change(wind=options.wind)
        for number in range(options.frames):
            frame = client.frame(time=number * options.step, width=options.width, height=options.height,
                                 encoding="exr", products=["color", "cloud", "transmittance", "depth"])
            print(save(frame, options.folder, f"frame-{number:04}.exr"), frame.info["photons"], "photons")


if __name__ == "__main__":
    main()
