#!/usr/bin/python3
"""What a moving sun costs a stream that has a deadline: 320×180 of the cumulus with a budget of 33 ms, first under a sun
that stands still, then under one that moves with every frame, then still again until the frames are whole.
service_moving_sun.py [--seconds N] [--budget MS]
"""

import argparse
import json
import os
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "tests", "service"))
from server import LUMULUS, Server


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def described(frames):
    """Times of frames, and what was left out of them."""
    totals = [frame["milliseconds"]["total"] for frame in frames]
    return {"frames": len(frames), "met": sum(frame["budget_met"] for frame in frames) / len(frames),
            "p50_ms": percentile(totals, 0.5), "p99_ms": percentile(totals, 0.99), "worst_ms": max(totals),
            "sun_depth_ms": percentile([frame["milliseconds"]["passes"].get("sun depth", 0.0) for frame in frames], 0.5),
            "reduction": percentile([frame["reduction"] for frame in frames], 0.5),
            "sun_reduction": percentile([frame.get("sun_reduction", 1) for frame in frames], 0.5)}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=10.0, help="of each part")
    parser.add_argument("--budget", type=float, default=33.0, help="milliseconds")
    options = parser.parse_args()
    with open(os.path.join(HERE, "..", "configs", "scenes", "cumulus.toml")) as file:
        server = Server(LUMULUS, scene=file.read())
    result = {}
    try:
        with server.client() as client:
            client.load_scene("small.toml", quality="interactive")
            client.frame(width=320, height=180)  # fills the ring
            wishes = {"width": 320, "height": 180, "budget": {"milliseconds": options.budget}}
            stream = client.start_stream(**wishes)
            for part, moves in (("still", False), ("moving", True), ("still_again", False)):
                frames, until = [], time.monotonic() + options.seconds
                while time.monotonic() < until:
                    frames.append(client.next_frame(stream).info)
                    if moves:
                        angle = 100.0 * (until - time.monotonic()) / options.seconds
                        client.start_stream(stream, sun={"azimuth": angle, "elevation": 30}, **wishes)
                result[part] = described(frames)
            result["sun_reduction_at_the_end"] = frames[-1].get("sun_reduction", 1)
    finally:
        server.stop()
    print(json.dumps(result, indent=2))


if __name__ == "__main__":
    main()
