#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the GLB files of a folder by the glTF 2.0 specification and nothing else, and compares the
vertices at sampled times with what E11 and E15 gave there (NAME.expected beside NAME.glb: uint32
times, uint32 vertices; for each time its seconds and x, y, z of every vertex in mm, as doubles).
"""

import array
import bisect
import json
import math
import pathlib
import struct
import sys

TOLERANCE_MM = 0.01
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
FORMATS = {5126: "f", 5125: "I", 5123: "H"}


class Glb:
    def __init__(self, data):
        magic, version, length = struct.unpack_from("<4sII", data, 0)
        assert magic == b"glTF" and version == 2 and length == len(data), "container"
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON", "first chunk"
        self.json = json.loads(data[20 : 20 + size])
        _, kind = struct.unpack_from("<I4s", data, 20 + size)
        assert kind == b"BIN\0", "second chunk"
        self.binary = data[28 + size :]

    def numbers(self, index):
        """All numbers of an accessor, one after the other."""
        accessor = self.json["accessors"][index]
        width = WIDTHS[accessor["type"]]
        count = accessor["count"] * width
        if "bufferView" in accessor:
            values = self.packed(accessor, accessor["componentType"], count)
        else:
            values = array.array(FORMATS[accessor["componentType"]], [0] * count)
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            places = self.packed(sparse["indices"], sparse["indices"]["componentType"], sparse["count"])
            others = self.packed(sparse["values"], accessor["componentType"], sparse["count"] * width)
            for i, place in enumerate(places):
                values[width * place : width * place + width] = others[width * i : width * i + width]
        return values

    def packed(self, where, component, count):
        """So many numbers from a buffer view on."""
        view = self.json["bufferViews"][where["bufferView"]]
        assert "byteStride" not in view, "packed arrays are enough here"
        first = view.get("byteOffset", 0) + where.get("byteOffset", 0)
        values = array.array(FORMATS[component])
        values.frombytes(self.binary[first : first + count * values.itemsize])
        if sys.byteorder == "big":
            values.byteswap()
        return values

    def sampler(self, node, path):
        """(times, values) of the one channel that drives a node's property, or None."""
        for animation in self.json.get("animations", []):
            for channel in animation["channels"]:
                if channel["target"] == {"node": node, "path": path}:
                    sampler = animation["samplers"][channel["sampler"]]
                    assert sampler.get("interpolation", "LINEAR") == "LINEAR"
                    return self.numbers(sampler["input"]), self.numbers(sampler["output"])
        return None


def sample(sampler, width, time, spherical=False):
    times, values = sampler
    key = lambda k: list(values[k * width : (k + 1) * width])
    after = bisect.bisect_left(times, time)
    if after < len(times) and abs(times[after] - time) < 1e-6:
        return key(after)
    if after == 0 or after == len(times):
        return key(min(after, len(times) - 1))
    part = (time - times[after - 1]) / (times[after] - times[after - 1])
    a, b = key(after - 1), key(after)
    if not spherical:
        return [x + part * (y - x) for x, y in zip(a, b)]
    cosine = sum(x * y for x, y in zip(a, b))
    if cosine < 0:
        b, cosine = [-y for y in b], -cosine
    angle = math.acos(min(cosine, 1.0))
    if angle < 1e-9:
        return a
    left, right = math.sin((1 - part) * angle), math.sin(part * angle)
    return [(left * x + right * y) / math.sin(angle) for x, y in zip(a, b)]


def place(point, translation, rotation):
    x, y, z, w = rotation
    px, py, pz = point
    tx, ty, tz = 2 * (y * pz - z * py), 2 * (z * px - x * pz), 2 * (x * py - y * px)
    return [
        px + w * tx + y * tz - z * ty + translation[0],
        py + w * ty + z * tx - x * tz + translation[1],
        pz + w * tz + x * ty - y * tx + translation[2],
    ]


def parents(nodes):
    return {child: index for index, node in enumerate(nodes) for child in node.get("children", [])}


def vertices(glb, time):
    """Every vertex of the face in mm in the world, in the order of its primitives."""
    nodes = glb.json["nodes"]
    (index,) = [i for i, node in enumerate(nodes) if "mesh" in node]
    mesh = glb.json["meshes"][nodes[index]["mesh"]]
    targets = len(mesh["primitives"][0].get("targets", []))
    names = mesh.get("extras", {}).get("targetNames", [])
    assert len(names) == targets == len(set(names)), "each target has a name of its own"
    driver = glb.sampler(index, "weights")
    weights = sample(driver, targets, time) if driver else nodes[index].get("weights", mesh.get("weights", []))
    assert all(abs(weight) <= 1.0 for weight in weights), "Blender limits shape keys to [-1, 1]"
    transforms = []
    node = index
    while node is not None:
        moved, turned = glb.sampler(node, "translation"), glb.sampler(node, "rotation")
        assert "scale" not in nodes[node] and "matrix" not in nodes[node]
        transforms.append(
            (
                sample(moved, 3, time) if moved else nodes[node].get("translation", [0, 0, 0]),
                sample(turned, 4, time, True) if turned else nodes[node].get("rotation", [0, 0, 0, 1]),
            )
        )
        node = parents(nodes).get(node)
    result = []
    for primitive in mesh["primitives"]:
        points = list(glb.numbers(primitive["attributes"]["POSITION"]))
        for weight, target in zip(weights, primitive.get("targets", [])):
            if weight != 0:
                points = [p + weight * d for p, d in zip(points, glb.numbers(target["POSITION"]))]
        for first in range(0, len(points), 3):
            point = points[first : first + 3]
            for translation, rotation in transforms:
                point = place(point, translation, rotation)
            result.extend(1000.0 * value for value in point)
    return result


def compare(path):
    glb = Glb(path.read_bytes())
    expected = path.with_suffix(".expected").read_bytes()
    times, count = struct.unpack_from("<II", expected, 0)
    worst = 0.0
    moved = 0.0
    first = None
    for k in range(times):
        row = struct.unpack_from(f"<{1 + 3 * count}d", expected, 8 + k * 8 * (1 + 3 * count))
        found = vertices(glb, row[0])
        assert len(found) == 3 * count, f"{path.name}: {len(found) // 3} vertices, not {count}"
        worst = max(worst, max(abs(a - b) for a, b in zip(found, row[1:])))
        first = first or found
        moved = max(moved, max(abs(a - b) for a, b in zip(found, first)))
    print(f"{path.name}: {count} vertices at {times} times, off by {worst:.6f} mm, moving {moved:.1f} mm")
    return worst <= TOLERANCE_MM and moved > 0.5


def main():
    files = sorted(pathlib.Path(sys.argv[1]).glob("*.glb"))
    results = [compare(path) for path in files]
    return 0 if results and all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
