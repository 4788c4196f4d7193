"""What the frame service adds to a frame. Bytes on the wire, and milliseconds from the last pass to the client, at 1280×720
raw half, with the payload's hash and without, against a plain copy of the frame in memory.
"""

import json
import time

import numpy

from study.lumulus import add_program_option
from study.service import Server, percentile

WIDTH, HEIGHT = 1280, 720
AWAY = {"position": [0, 100, 5000], "target": [0, 100, 6000]}  # from the cloud: what it takes to draw is no matter


def measure(client, frames, **fields):
    """Medians of milliseconds, and bytes on the wire."""
    encode, transfer, draw, copies = [], [], [], []
    sent = client.statistics()["sent_bytes_total"]
    for _ in range(frames):
        started = time.perf_counter()
        frame = client.frame(width=WIDTH, height=HEIGHT, budget={"photons": 0}, camera=AWAY, **fields)
        wall = 1e3 * (time.perf_counter() - started)
        spent = frame.info["milliseconds"]
        draw.append(spent["draw"])
        encode.append(spent["encode"])
        transfer.append(wall - spent["total"])
        started = time.perf_counter()
        numpy.frombuffer(frame.payload, "u1").copy()
        copies.append(1e3 * (time.perf_counter() - started))
    sent = client.statistics()["sent_bytes_total"] - sent
    raw = WIDTH * HEIGHT * 4 * 2
    medians = {name: percentile(values, 0.5) for name, values in (
        ("draw_ms", draw), ("encode_ms", encode), ("transfer_ms", transfer), ("memcpy_ms", copies))}
    return {"frame_bytes": raw, "wire_bytes": sent / frames, "wire_overhead": sent / frames / raw - 1.0, **medians,
            "last_pass_to_client_over_memcpy": (medians["encode_ms"] + medians["transfer_ms"]) / medians["memcpy_ms"]}


def add_options(parser):
    add_program_option(parser)
    parser.add_argument("--frames", type=int, default=20)


def main(options):
    server = Server(str(options.lumulus))
    try:
        with server.client() as client:
            client.frame(width=64, height=48)  # fills the ring
            result = {"with_hash": measure(client, options.frames),
                      "without_hash": measure(client, options.frames, hash=False)}
    finally:
        server.stop()
    print(json.dumps(result, indent=2))
