"""Writes EXR pictures that no renderer makes: scanlines of 32-bit floats, not compressed."""

import struct


def _attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def _header(width, height, names):
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = (("channels", "chlist", channels), ("compression", "compression", b"\0"),
                  ("dataWindow", "box2i", window), ("displayWindow", "box2i", window), ("lineOrder", "lineOrder", b"\0"),
                  ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", bytes(8)),
                  ("screenWindowWidth", "float", struct.pack("<f", 1)))
    return struct.pack("<ii", 20000630, 2) + b"".join(_attribute(*attribute) for attribute in attributes) + b"\0"


def write_exr(path, width, height, layers):
    """`layers`: name to width·height values, rows from the top."""
    names = sorted(layers)
    header = _header(width, height, names)
    line_bytes = 4 * width * len(names)
    first = len(header) + 8 * height
    with open(path, "wb") as file:
        file.write(header + struct.pack(f"<{height}Q", *(first + y * (line_bytes + 8) for y in range(height))))
        for y in range(height):
            file.write(struct.pack("<ii", y, line_bytes))
            for name in names:
                file.write(struct.pack(f"<{width}f", *layers[name][y * width:(y + 1) * width]))
