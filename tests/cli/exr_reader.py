"""Reads what Lumulus writes: scanline EXR files, ZIP, 32-bit float. For tests on machines without an EXR package."""

import struct
import zlib


def _terminated(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _header(data):
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError("not an EXR file")
    attributes, at = {}, 8
    while data[at] != 0:
        name, at = _terminated(data, at)
        kind, at = _terminated(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = (kind, data[at + 4:at + 4 + size])
        at += 4 + size
    return attributes, at + 1


def _channels(data):
    names, at = [], 0
    while data[at] != 0:
        name, at = _terminated(data, at)
        (kind,) = struct.unpack_from("<i", data, at)
        if kind != 2:
            raise ValueError(f"channel {name} is not 32-bit float")
        names.append(name)
        at += 16
    return names


def _unzip(block, size):
    if len(block) == size:  # did not get smaller: stored as it is
        return block
    raw = bytearray(zlib.decompress(block))
    for i in range(1, len(raw)):  # differences of neighbouring bytes
        raw[i] = (raw[i - 1] + raw[i] - 128) & 255
    half = (len(raw) + 1) // 2  # even bytes first, then the odd ones
    out = bytearray(len(raw))
    out[0::2], out[1::2] = raw[:half], raw[half:]
    return bytes(out)


def read_exr(path):
    """Returns (width, height, {layer: [floats, rows from the top]}, {attribute: text})."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = _header(data)
    if attributes["compression"][1] != b"\x03":
        raise ValueError("not ZIP")
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"][1])
    width, height = right - left + 1, bottom - top + 1
    names = _channels(attributes["channels"][1])
    layers = {name: [] for name in names}
    blocks = (height + 15) // 16
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        first, size = struct.unpack_from("<ii", data, offset)
        rows = min(16, bottom + 1 - first)
        pixels = _unzip(data[offset + 8:offset + 8 + size], rows * width * 4 * len(names))
        place = 0
        for _ in range(rows):
            for name in names:
                layers[name].extend(struct.unpack_from(f"<{width}f", pixels, place))
                place += 4 * width
    texts = {name: value.decode() for name, (kind, value) in attributes.items() if kind == "string"}
    return width, height, layers, texts
