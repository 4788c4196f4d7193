#!/usr/bin/env python3
"""Moves the sun from morning to evening in a stream, whose photons age in, and saves it: sun_sweep.py FOLDER"""

from common import connect, parser, save


def main():
    options = parser(__doc__, width=320, height=180, frames=24).parse_args()
    with connect(options, "sun sweep") as client:
        # photons of its own: the sun of others stays where it is
        client.load_scene(client.welcome["scene"], quality="interactive", private=True)
        wishes = {"width": options.width, "height": options.height, "encoding": "jpeg", "max_rate": 10}
        stream = client.start_stream(sun={"azimuth": -90, "elevation": 5}, **wishes)
        for number in range(options.frames):
            frame = client.next_frame(stream)
            path = save(frame, options.folder, f"sun-{number:04}.jpg")
            print(path, f"{frame.info['current_generations']} of {frame.info['generations']} generations see this sun")
            share = (number + 1) / options.frames
            sun = {"azimuth": -90 + 180 * share, "elevation": 5 + 160 * share * (1 - share)}
            client.start_stream(stream, sun=sun, **wishes)
        client.stop_stream(stream)


if __name__ == "__main__":
    main()
