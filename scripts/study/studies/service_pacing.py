"""How many frames of a stream come in time. The default scene is asked for every 33 ms, under a moving camera and a moving
sun, in two sizes; then for 16 views of one moment. A frame is in time when it was encoded within the budget, counted from
the moment at which it was due; moments that passed without a frame are late ones. Streams count from their first frame.
"""

import math
import pathlib
import time

from study.lumulus import add_program_option, scene_file
from study.service import Server, percentile
from study.tables import Table, write_figures

SIZES = ((160, 90), (320, 180))
SPEED = 40.0  # degrees a second, of the sun or the camera


def camera_at(scene, degrees):
    """A camera on a circle round the cloud that sees all of it."""
    angle, distance = math.radians(degrees), 2.6 * scene["radius"]
    x, y, z = scene["center"]
    return {"position": [x + distance * math.sin(angle), y + 0.2 * distance, z - distance * math.cos(angle)],
            "target": scene["center"], "vertical_fov": 40}


def mean_passes(frames):
    """Milliseconds a frame of each pass of the renderer."""
    total = {}
    for frame in frames:
        for name, milliseconds in frame["milliseconds"]["passes"].items():
            total[name] = total.get(name, 0.0) + milliseconds
    return {name: round(value / len(frames), 2) for name, value in sorted(total.items(), key=lambda item: -item[1])}


def described(frames, due, budget):
    """Figures of the frames that came, of `due` that could have come."""
    times = [frame["milliseconds"] for frame in frames]
    totals = [t["total"] for t in times]
    rounded = {"due": due, "frames": len(frames), "in_time": sum(total <= budget for total in totals) / due,
               "p50_ms": percentile(totals, 0.5), "p99_ms": percentile(totals, 0.99),
               "waited_ms": percentile([t["waited"] for t in times], 0.5),
               "draw_ms": percentile([t["draw"] for t in times], 0.5),
               "encode_ms": percentile([t["encode"] for t in times], 0.5),
               "reduction": percentile([frame["reduction"] for frame in frames], 0.5),
               "reduction_p95": percentile([frame["reduction"] for frame in frames], 0.95),
               "sun_reduction": percentile([frame["sun_reduction"] for frame in frames], 0.5),
               "current_generations": percentile([frame["current_generations"] for frame in frames], 0.5)}
    return {**{key: round(value, 3) for key, value in rounded.items()}, "passes": mean_passes(frames)}


def streamed(client, wishes, moved, options):
    """The frames of some seconds after the first, each answered with the wishes of its successor, which `moved` gives by
    the seconds. Adds the milliseconds until the first, in which light of the client's own is made."""
    asked = time.monotonic()
    stream = client.start_stream(**wishes, **moved(0.0))
    client.next_frame(stream)
    begin = time.monotonic()
    frames = []
    while (now := time.monotonic() - begin) < options.seconds:
        client.start_stream(stream, **wishes, **moved(now))
        frames.append(client.next_frame(stream).info)
    client.stop_stream(stream)
    due = (frames[-1]["number"] - frames[0]["number"] + 1 if "every" in wishes else
           round(options.seconds * 1e3 / options.every))
    return {"first_ms": round(1e3 * (begin - asked)), **described(frames, max(due, len(frames)), options.every)}


def row(case, figures):
    reductions = f"{figures['reduction']} ({figures['reduction_p95']})"
    return [case, str(figures["due"]), str(figures["frames"]), f"{100 * figures['in_time']:.0f} %", f"{figures['p50_ms']:.1f}",
            f"{figures['p99_ms']:.1f}", f"{figures['draw_ms']:.1f}", f"{figures['encode_ms']:.1f}", reductions,
            str(figures["sun_reduction"]), str(figures.get("first_ms", ""))]


def add_options(parser):
    add_program_option(parser)
    parser.add_argument("--seconds", type=float, default=5.0, help="of each part")
    parser.add_argument("--every", type=float, default=1000 / 30, help="milliseconds between frames, and their budget")
    parser.add_argument("--encoding", default="jpeg", help="of the frames (default %(default)s)")
    parser.add_argument("--max-rate", action="store_true", help="streams by max_rate, whose late frames move the others")
    parser.add_argument("--width", type=int, help="of streams: only of this width")
    parser.add_argument("--only", choices=("camera", "sun", "views"), help="only this part")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="of the scene")
    parser.add_argument("--frames", type=int, default=10, help="of 16 views")
    parser.add_argument("--json", type=pathlib.Path, help="write all figures, with the passes, to this file")


def views_of(client, scene, options, apart):
    """Frames of 4 by 4 channels that look past each other, their eyes so many degrees `apart` round the cloud. The eyes
    move from frame to frame."""
    frames = []
    for i in range(options.frames):
        views = []
        for k in range(16):
            left, bottom = 0.4 * (k % 4) - 0.8, 0.225 * (k // 4) - 0.45
            camera = {**camera_at(scene, apart * k + i), "frustum": [left, left + 0.4, bottom, bottom + 0.225]}
            del camera["vertical_fov"]
            views.append({"camera": camera, "width": 160, "height": 90})
        frames.append(client.frame(views=views, budget={"milliseconds": 100}, encoding=options.encoding).info)
    return frames


def parts(client, scene, options):
    """Yields name and figures of each part."""
    every = {"budget": {"milliseconds": options.every}, "encoding": options.encoding}
    every.update({"max_rate": 1000 / options.every} if options.max_rate else {"every": options.every})
    for width, height in SIZES:
        if options.only == "views" or options.width not in (None, width):
            continue
        wishes = {**every, "width": width, "height": height}
        if options.only != "sun":
            camera = lambda seconds: {"camera": camera_at(scene, SPEED * seconds)}
            yield f"{width}×{height}, moving camera", streamed(client, wishes, camera, options)
        if options.only != "camera":
            sun = lambda seconds: {"sun": {"azimuth": SPEED * seconds % 360, "elevation": 35}}
            yield f"{width}×{height}, moving sun", streamed(client, wishes, sun, options)
            client.load_scene("small.toml", quality="interactive", set=options.set)  # gives its own light up
    if options.only in (None, "views") and options.width in (None, 160):
        for eyes, apart in (("one eye", 0.0), ("16 eyes", 22.5)):
            frames = views_of(client, scene, options, apart)
            yield f"16 views of 160×90 from {eyes}, 100 ms", described(frames, options.frames, 100.0)


def main(options):
    server = Server(str(options.lumulus), scene=scene_file("cumulus").read_text())
    table = Table(["", "due", "came", "in time", "p50 ms", "p99 ms", "draw", "encode", "reduction (p95)",
                   "of the sun", "first ms"])
    try:
        with server.client() as client:
            scene = client.load_scene("small.toml", quality="interactive", set=options.set)
            client.frame(width=160, height=90)  # fills the ring
            for name, figures in parts(client, scene, options):
                table.add({"case": name, **figures}, row(name, figures))
    finally:
        server.stop()
    write_figures(options, table.figures)
