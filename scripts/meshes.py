#!/usr/bin/python3
"""Writes meshes of its own making as glTF (.glb), for scenes and tests.

usage: scripts/meshes.py ball|aircraft|tower|hills -o FILE.glb [--metallic 0-1] [--roughness 0-1] [--colour R,G,B]
                         [--radius METRES] [--triangles N]

ball: a sphere about the origin. aircraft: a jet of 38 m whose nose points to −Z, about the origin. tower: an
observation tower of 120 m that stands on y = 0. hills: a square of 1 km of N triangles, for measurements. Lengths are
metres, +Y is up. The same arguments give the same bytes.
"""
import argparse
import json
import struct

import numpy as np


class Part:
    """Triangles of one material: positions and normals [n, 3], corners [m, 3]."""

    def __init__(self, positions, normals, corners, material):
        self.positions = np.asarray(positions, np.float32)
        self.normals = np.asarray(normals, np.float32)
        self.corners = np.asarray(corners, np.uint32)
        self.material = material


def grid_corners(rows, columns):
    """Two triangles for each cell of a grid of points, row by row."""
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = (row * columns + column).ravel()
    b, c = a + 1, a + columns
    return np.concatenate([np.stack([a, c, b], 1), np.stack([b, c, c + 1], 1)])


def lofted(sections, material):
    """A skin over closed outlines [rows, columns, 3] whose last point is the first one; normals by differences."""
    points = np.asarray(sections, float)
    rows, columns, _ = points.shape
    along = np.gradient(points, axis=0)
    ring = points[:, :-1]
    around = np.roll(ring, -1, axis=1) - np.roll(ring, 1, axis=1)
    around = np.concatenate([around, around[:, :1]], axis=1)
    normals = np.cross(along, around)
    length = np.linalg.norm(normals, axis=2, keepdims=True)
    normals = np.where(length > 1e-12, normals / np.maximum(length, 1e-12), [0.0, 1.0, 0.0])
    middle = points[:, :-1].mean(axis=1, keepdims=True)
    outwards = np.sign((normals * (points - middle)).sum(axis=2).sum())
    normals *= outwards if outwards != 0 else 1.0
    return Part(points.reshape(-1, 3), normals.reshape(-1, 3), grid_corners(rows, columns), material)


def ball(radius, material, rings=96):
    polar = np.linspace(0.0, np.pi, rings + 1)
    angle = np.linspace(0.0, 2.0 * np.pi, 2 * rings + 1)
    normals = np.stack([np.outer(np.sin(polar), np.cos(angle)), np.outer(np.cos(polar), np.ones_like(angle)),
                        np.outer(np.sin(polar), np.sin(angle))], axis=2).reshape(-1, 3)
    return Part(radius * normals, normals, grid_corners(rings + 1, 2 * rings + 1), material)


def body(stations, material, around=40):
    """A body of round sections: rows of z, middle height, half width, half height."""
    angle = np.linspace(0.0, 2.0 * np.pi, around + 1)
    sections = [np.stack([w * np.cos(angle), y + h * np.sin(angle), np.full_like(angle, z)], 1)
                for z, y, w, h in stations]
    return lofted(sections, material)


def profile(points=16):
    """Outline of a symmetric wing of four digits, chord and thickness 1: closed, x from 0 (nose) to 1."""
    x = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, points))
    y = 5.0 * (0.2969 * np.sqrt(x) - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
    upper = np.stack([x, y], 1)[::-1]
    lower = np.stack([x, -y], 1)[1:]
    outline = np.concatenate([upper, lower])
    return np.concatenate([outline, outline[:1]])


def wing(root, tip, root_chord, tip_chord, thickness, across, material, sections=10):
    """From the nose of the root to that of the tip; `across` is the direction of its thickness."""
    outline, across = profile(), np.asarray(across, float)
    rows = []
    for share in np.linspace(0.0, 1.0, sections):
        # the tip is rounded off
        chord = (1.0 - share) * root_chord + share * tip_chord
        thick = thickness * chord * np.sqrt(max(1e-4, 1.0 - max(0.0, (share - 0.9) / 0.1) ** 2))
        nose = (1.0 - share) * np.asarray(root, float) + share * np.asarray(tip, float)
        rows.append(nose + np.outer(outline[:, 0] * chord, [0.0, 0.0, 1.0]) + np.outer(outline[:, 1] * thick, across))
    return lofted(rows, material)


def aircraft():
    skin = {"name": "skin", "colour": [0.86, 0.87, 0.88], "metallic": 1.0, "roughness": 0.22}
    paint = {"name": "paint", "colour": [0.06, 0.12, 0.32], "metallic": 0.0, "roughness": 0.25}
    dark = {"name": "glass", "colour": [0.02, 0.02, 0.025], "metallic": 0.0, "roughness": 0.1}
    length, radius = 38.0, 2.0
    stations = []
    for s in np.linspace(0.0, 1.0, 56):
        nose, tail = min(1.0, s / 0.14), max(0.0, (s - 0.62) / 0.38)
        width = radius * max(1e-3, np.sqrt(1.0 - (1.0 - nose) ** 2)) * (1.0 - tail**1.6 * 0.96)
        stations.append([-0.45 * length + s * length, 0.55 * radius * tail**1.5, width, width * (1.0 - 0.1 * (1.0 - nose))])
    parts = [body(stations, skin)]
    for side in (-1.0, 1.0):
        parts.append(wing([side * 1.4, -0.8, -4.0], [side * 17.5, 0.9, 5.2], 7.2, 1.7, 0.11, [0, 1, 0], skin))
        parts.append(wing([side * 0.5, 1.2, 15.2], [side * 6.3, 1.6, 18.6], 3.6, 1.3, 0.1, [0, 1, 0], skin))
        engine = [[z, 0.0, r, r] for z, r in [(-3.3, 0.86), (-3.35, 0.98), (-3.2, 1.12), (-2.0, 1.22), (-0.5, 1.15),
                                              (0.7, 0.85), (1.3, 0.6), (1.35, 0.02)]]
        parts.append(moved(body(engine, paint, 32), [side * 5.6, -1.75, -0.8]))
        parts.append(moved(body([[-2.9, 0.0, 0.02, 0.02], [-2.9, 0.0, 0.95, 0.95]], dark, 32),
                           [side * 5.6, -1.75, -0.8]))
        parts.append(wing([side * 5.6, -0.6, -2.6], [side * 5.6, -1.3, -2.4], 3.6, 3.0, 0.08, [1, 0, 0], paint, 4))
    parts.append(wing([0.0, 1.6, 12.4], [0.0, 8.3, 18.6], 5.4, 2.1, 0.1, [1, 0, 0], paint))
    window = [[z, y, w, 0.34] for z, y, w in [(-15.35, 0.62, 0.9), (-14.9, 0.78, 1.2), (-14.4, 0.95, 1.38),
                                              (-14.15, 1.05, 1.3)]]
    parts.append(body(window, dark, 40))
    return parts


def moved(part, by):
    return Part(part.positions + np.asarray(by, np.float32), part.normals, part.corners, part.material)


def revolved(outline, material, around=96):
    """A body of rotation about +Y by its outline of (radius, y); corners of the outline stay sharp."""
    outline = np.asarray(outline, float)
    angle = np.linspace(0.0, 2.0 * np.pi, around + 1)
    positions, normals, corners = [], [], []
    for (r0, y0), (r1, y1) in zip(outline[:-1], outline[1:]):
        steep = np.array([y1 - y0, r0 - r1])
        steep = steep / max(np.linalg.norm(steep), 1e-12)
        for r, y in ((r0, y0), (r1, y1)):
            positions += [[r * np.cos(a), y, r * np.sin(a)] for a in angle]
            normals += [[steep[0] * np.cos(a), steep[1], steep[0] * np.sin(a)] for a in angle]
        corners.append(grid_corners(2, around + 1) + (len(positions) - 2 * (around + 1)))
    return Part(positions, normals, np.concatenate(corners), material)


def tower():
    concrete = {"name": "concrete", "colour": [0.52, 0.5, 0.47], "metallic": 0.0, "roughness": 0.9}
    steel = {"name": "steel", "colour": [0.75, 0.76, 0.78], "metallic": 1.0, "roughness": 0.3}
    glass = {"name": "glass", "colour": [0.03, 0.05, 0.06], "metallic": 0.0, "roughness": 0.08}
    red = {"name": "red", "colour": [0.7, 0.05, 0.03], "metallic": 0.0, "roughness": 0.5}
    light = {"name": "light", "colour": [0.1, 0.0, 0.0], "metallic": 0.0, "roughness": 0.5, "emission": [60.0, 3.0, 1.0]}
    parts = [revolved([(11, 0), (7.5, 6), (5.2, 20), (4.2, 40), (3.8, 72)], concrete),
             revolved([(3.8, 70), (11.5, 76), (12.5, 77)], concrete), revolved([(12.5, 77), (13.0, 81.5)], glass),
             revolved([(13.0, 81.5), (13.4, 82), (13.4, 83), (9.0, 85.5), (2.2, 86.5)], steel),
             revolved([(9.0, 85), (9.0, 88), (2.0, 89)], concrete),
             revolved([(0.0, 120.6), (0.35, 120.4), (0.35, 119.6), (0.0, 119.4)][::-1], light)]
    for i in range(6):
        low, high = 88.0 + 5.2 * i, 88.0 + 5.2 * (i + 1)
        wide = [1.5 * (1.0 - 0.14 * j) for j in (i, i + 1)]
        parts.append(revolved([(wide[0], low), (wide[1], high), (0.0, high)], red if i % 2 == 0 else steel, 32))
    return parts


def hills(triangles):
    """About so many triangles over a square of 1 km."""
    side = int(np.ceil(np.sqrt(triangles / 2))) + 1
    x, z = np.meshgrid(np.linspace(-500, 500, side), np.linspace(-500, 500, side), indexing="ij")
    y, slope_x, slope_z = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    for i in range(7):
        scale, height, angle = 2.0**i / 300.0, 40.0 / 1.9**i, 1.7 * i
        a, b = np.cos(angle) * scale, np.sin(angle) * scale
        phase = a * x + b * z + i
        other = a * z - b * x
        y += height * np.sin(phase) * np.cos(other)
        slope_x += height * (a * np.cos(phase) * np.cos(other) + b * np.sin(phase) * np.sin(other))
        slope_z += height * (b * np.cos(phase) * np.cos(other) - a * np.sin(phase) * np.sin(other))
    normals = np.stack([-slope_x, np.ones_like(x), -slope_z], 2).reshape(-1, 3)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    material = {"name": "ground", "colour": [0.3, 0.32, 0.2], "metallic": 0.0, "roughness": 0.9}
    return [Part(np.stack([x, y, z], 2).reshape(-1, 3), normals, grid_corners(side, side)[:, ::-1], material)]


def glb(parts):
    """The bytes of a .glb file."""
    document = {"asset": {"version": "2.0", "generator": "scripts/meshes.py of Lumulus"}, "scene": 0,
                "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": []}], "materials": [],
                "buffers": [], "bufferViews": [], "accessors": []}
    data, names = b"", []

    def accessor(values, component, kind, **more):
        nonlocal data
        document["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": values.nbytes})
        data += values.tobytes()
        document["accessors"].append({"bufferView": len(document["bufferViews"]) - 1, "componentType": component,
                                      "count": values.shape[0], "type": kind, **more})
        return len(document["accessors"]) - 1

    for part in parts:
        if part.material["name"] not in names:
            names.append(part.material["name"])
            of = part.material
            document["materials"].append(
                {"name": of["name"], "doubleSided": True, "emissiveFactor": [1.0, 1.0, 1.0] if "emission" in of else [0.0] * 3,
                 "pbrMetallicRoughness": {"baseColorFactor": [*of["colour"], 1.0], "metallicFactor": of["metallic"],
                                          "roughnessFactor": of["roughness"]}})
            if "emission" in of:
                strength = max(of["emission"])
                document["materials"][-1]["emissiveFactor"] = [e / strength for e in of["emission"]]
                document["materials"][-1]["extensions"] = {
                    "KHR_materials_emissive_strength": {"emissiveStrength": strength}}
                document["extensionsUsed"] = ["KHR_materials_emissive_strength"]
        document["meshes"][0]["primitives"].append(
            {"attributes": {"POSITION": accessor(part.positions, 5126, "VEC3", min=part.positions.min(0).tolist(),
                                                 max=part.positions.max(0).tolist()),
                            "NORMAL": accessor(part.normals, 5126, "VEC3")},
             "indices": accessor(np.ascontiguousarray(part.corners).ravel(), 5125, "SCALAR"),
             "material": names.index(part.material["name"])})
    document["buffers"].append({"byteLength": len(data)})
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text +
            struct.pack("<I4s", len(data), b"BIN\0") + data)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("kind", choices=["ball", "aircraft", "tower", "hills"])
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--metallic", type=float, default=0.0)
    parser.add_argument("--roughness", type=float, default=1.0)
    parser.add_argument("--colour", default="0.5,0.5,0.5", help="base colour of a ball, R,G,B")
    parser.add_argument("--radius", type=float, default=1.0, help="of a ball, metres")
    parser.add_argument("--triangles", type=int, default=1000000, help="of hills")
    options = parser.parse_args()
    material = {"name": "ball", "colour": [float(c) for c in options.colour.split(",")], "metallic": options.metallic,
                "roughness": options.roughness}
    parts = {"ball": lambda: [ball(options.radius, material)], "aircraft": aircraft, "tower": tower,
             "hills": lambda: hills(options.triangles)}[options.kind]()
    with open(options.output, "wb") as file:
        file.write(glb(parts))


if __name__ == "__main__":
    main()
