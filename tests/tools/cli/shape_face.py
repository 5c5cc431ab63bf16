# SPDX-License-Identifier: GPL-3.0-or-later
"""A face with shapes of its own: tiny_corpus' mask as a GLB with morph targets."""
import json
import math
import struct

import tiny_corpus

# Shape: middle of what it moves (mm, right of the picture and up), spread, offset at weight 1 (mm).
SHAPES = {
    "jawOpen": ((0, -55), 18.0, (0, -12, -4)),
    "mouthSmile_L": ((25, -30), 9.0, (6, 7, -2)),
    "mouthSmile_R": ((-25, -30), 9.0, (-6, 7, -2)),
    "browInnerUp_L": ((10, 50), 10.0, (0, 8, 0)),
    "browInnerUp_R": ((-10, 50), 10.0, (0, 8, 0)),
    "wink": ((20, 30), 8.0, (0, -3, 0)),
}


def read_mask(folder):
    """Places in mm and triangles of the mask."""
    places, triangles = [], []
    for line in (folder / "mask.obj").read_text().splitlines():
        words = line.split()
        if words[0] == "v":
            places.append([10 * float(word) for word in words[1:]])
        else:
            triangles.append([int(word) - 1 for word in words[1:]])
    return places, triangles


def offsets(places, shape):
    (x, y), spread, way = SHAPES[shape]
    return [[math.exp(-0.5 * math.dist(place[:2], (x, y)) ** 2 / spread**2) * part for part in way] for place in places]


def glb_bytes(places, triangles, shapes):
    """In metres, under a node that is moved by (0, 0, 0); shapes: {name: offsets in mm}."""
    binary, views, accessors = bytearray(), [], []

    def add(code, rows, kind, component):
        flat = [value for row in rows for value in row]
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": 4 * len(flat)})
        binary.extend(struct.pack(f"<{len(flat)}{code}", *flat))
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": kind,
                          "count": len(flat) if kind == "SCALAR" else len(rows)})
        if kind == "VEC3":
            stored = list(struct.iter_unpack("<3f", binary[-4 * len(flat):]))
            accessors[-1].update(min=list(map(min, zip(*stored))), max=list(map(max, zip(*stored))))
        return len(accessors) - 1

    metres = lambda rows: [[0.001 * value for value in row] for row in rows]
    primitive = {"attributes": {"POSITION": add("f", metres(places), "VEC3", 5126)},
                 "indices": add("I", triangles, "SCALAR", 5125)}
    if shapes:
        primitive["targets"] = [{"POSITION": add("f", metres(rows), "VEC3", 5126)} for rows in shapes.values()]
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"name": "root", "children": [1]}, {"name": "skin", "mesh": 0}],
                "meshes": [{"name": "mask", "primitives": [primitive], "extras": {"targetNames": list(shapes)}}],
                "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}],
                "extras": {"kept": "as it is"}}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) + struct.pack("<I4s", len(text), b"JSON")
            + text + struct.pack("<I4s", len(binary), b"BIN\0") + bytes(binary))


def write(folder, shapes=tuple(SHAPES)):
    """face.glb and markers.tsv in a folder, which is returned."""
    tiny_corpus.write_face(folder)
    places, triangles = read_mask(folder)
    (folder / "mask.obj").unlink()
    (folder / "face.glb").write_bytes(glb_bytes(places, triangles, {name: offsets(places, name) for name in shapes}))
    return folder
