#!/usr/bin/python3
"""What the frame service adds to a frame: bytes on the wire, and milliseconds from the last pass to the client, at
1280×720 raw half, with the payload's hash and without, against a plain copy of the frame in memory.
service_overhead.py [--frames N]
"""

import argparse
import json
import os
import sys
import time

import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "tests", "service"))
from server import LUMULUS, Server

WIDTH, HEIGHT = 1280, 720
AWAY = {"position": [0, 100, 5000], "target": [0, 100, 6000]}  # from the cloud: what it takes to draw is no matter


def median(values):
    return sorted(values)[len(values) // 2]


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
    return {"frame_bytes": raw, "wire_bytes": sent / frames, "wire_overhead": sent / frames / raw - 1.0,
            "draw_ms": median(draw), "encode_ms": median(encode), "transfer_ms": median(transfer),
            "memcpy_ms": median(copies),
            "last_pass_to_client_over_memcpy": (median(encode) + median(transfer)) / median(copies)}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=20)
    options = parser.parse_args()
    server = Server(LUMULUS)
    try:
        with server.client() as client:
            client.frame(width=64, height=48)  # fills the ring
            result = {"with_hash": measure(client, options.frames),
                      "without_hash": measure(client, options.frames, hash=False)}
    finally:
        server.stop()
    print(json.dumps(result, indent=2))


if __name__ == "__main__":
    main()
