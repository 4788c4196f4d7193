"""What a moving sun costs a stream that has a deadline. 320×180 of the cumulus, first under a sun that stands still, then
under one that moves with every frame, then still again until the frames are whole.
"""

import json
import time

from study.lumulus import add_program_option, scene_file
from study.service import Server, percentile


def described(frames):
    """Times of frames, and what was left out of them."""
    totals = [frame["milliseconds"]["total"] for frame in frames]
    return {"frames": len(frames), "met": sum(frame["budget_met"] for frame in frames) / len(frames),
            "p50_ms": percentile(totals, 0.5), "p99_ms": percentile(totals, 0.99), "worst_ms": max(totals),
            "shadow_volume_ms": percentile([frame["milliseconds"]["passes"].get("shadow volume", 0.0) for frame in frames], 0.5),
            "reduction": percentile([frame["reduction"] for frame in frames], 0.5),
            "sun_reduction": percentile([frame.get("sun_reduction", 1) for frame in frames], 0.5)}


def streamed(client, stream, wishes, seconds, moves):
    """The frames of some seconds; the sun moves by 100 degrees meanwhile if it moves."""
    frames, until = [], time.monotonic() + seconds
    while time.monotonic() < until:
        frames.append(client.next_frame(stream).info)
        if moves:
            angle = 100.0 * (until - time.monotonic()) / seconds
            client.start_stream(stream, sun={"azimuth": angle, "elevation": 30}, **wishes)
    return frames


def add_options(parser):
    add_program_option(parser)
    parser.add_argument("--seconds", type=float, default=10.0, help="of each part")
    parser.add_argument("--budget", type=float, default=33.0, help="milliseconds")


def main(options):
    server = Server(str(options.lumulus), scene=scene_file("cumulus").read_text())
    result = {}
    try:
        with server.client() as client:
            client.load_scene("small.toml", quality="interactive")
            client.frame(width=320, height=180)  # fills the ring
            wishes = {"width": 320, "height": 180, "budget": {"milliseconds": options.budget}}
            stream = client.start_stream(**wishes)
            for part, moves in (("still", False), ("moving", True), ("still_again", False)):
                frames = streamed(client, stream, wishes, options.seconds, moves)
                result[part] = described(frames)
            result["sun_reduction_at_the_end"] = frames[-1].get("sun_reduction", 1)
    finally:
        server.stop()
    print(json.dumps(result, indent=2))
