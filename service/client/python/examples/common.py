"""What the examples share: their options, the connection, saved files."""

import argparse
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from lumulus_client import Client


def parser(description, target="folder", width=640, height=360, frames=None):
    """An argparse parser that knows what every example asks for."""
    result = argparse.ArgumentParser(description=description)
    result.add_argument(target)
    result.add_argument("--address", default="127.0.0.1:7788", help="HOST:PORT or unix:PATH")
    result.add_argument("--token-file", help="file with the server's token in its first line")
    result.add_argument("--width", type=int, default=width)
    result.add_argument("--height", type=int, default=height)
    if frames is not None:
        result.add_argument("--frames", type=int, default=frames)
    return result


def connect(options, name):
    token = ""
    if options.token_file:
        with open(options.token_file) as file:
            token = file.readline().strip()
    return Client(options.address, token=token, name=name)


def save(frame, *path):
    """Writes the frame's first view, an image file; returns its path."""
    path = os.path.join(*path)
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    with open(path, "wb") as file:
        file.write(frame.file())
    return path
