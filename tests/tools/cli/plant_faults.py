# SPDX-License-Identifier: GPL-3.0-or-later
"""Plants the faults of optical capture in a copy of a corpus of C3D files, and tells where."""
import dataclasses
import json
import math
import pathlib
import random
import shutil
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import read_c3d  # noqa: E402

KINDS = ("swap", "jump", "freeze", "drift")


@dataclasses.dataclass
class Fault:
    sentence: str  # id
    kind: str
    markers: list
    first_s: float  # times of the first and the last recorded frame that were changed
    last_s: float


class Points:
    """The points of an Intel C3D file, to read and to change in place."""

    def __init__(self, path):
        self.path = path
        self.data = bytearray(path.read_bytes())
        recording = read_c3d.read(path)
        self.names, self.rate_hz, self.frames = recording.names, recording.rate_hz, recording.frames
        start = (self.data[0] - 1) * read_c3d.BLOCK
        found = read_c3d.parameters(bytes(self.data[start : start + read_c3d.BLOCK * self.data[start + 2]]))
        (self.scale,) = struct.unpack("<f", found["POINT", "SCALE"][2])
        (begin,) = struct.unpack("<H", found["POINT", "DATA_START"][2])
        (analog,) = struct.unpack_from("<H", self.data, 4)
        self.form, self.size = ("f", 4) if self.scale < 0 else ("h", 2)
        self.first, self.each = (begin - 1) * read_c3d.BLOCK, 4 * len(self.names) + analog

    def place(self, frame, marker):
        return self.frames[frame][marker][:3]

    def is_there(self, frame, marker):
        return self.frames[frame][marker][3] >= 0

    def put(self, frame, marker, place):
        numbers = place if self.scale < 0 else [round(x / self.scale) for x in place]
        struct.pack_into(f"<3{self.form}", self.data,
                         self.first + self.size * (self.each * frame + 4 * marker), *numbers)

    def save(self):
        self.path.write_bytes(bytes(self.data))


def _speech(path):
    """Start and end of the speech in an xlabel file, or nothing."""
    start, end, t = None, None, 0.0
    for line in path.read_text().splitlines():
        fields = line.split()
        if len(fields) < 3:
            continue
        if fields[2].lower() not in ("pau", "sil", "sp", "h#"):
            start, end = t if start is None else start, float(fields[0])
        t = float(fields[0])
    return None if start is None else (start, end)


def _offset(length, pick):
    direction = [pick.gauss(0, 1) for _ in range(3)]
    norm = math.sqrt(sum(x * x for x in direction))
    return [length * x / norm for x in direction]


def _near(points, marker, free, least):
    """The other free markers, nearest first, from `least` mm on."""
    at = points.place(0, marker)
    return sorted((m for m in free if m != marker and math.dist(at, points.place(0, m)) >= least),
                  key=lambda m: math.dist(at, points.place(0, m)))


def _plant(points, kind, marker, free, speech, pick):
    """Changes the points; returns (markers, first frame, frames), or nothing where a marker is missing."""
    seconds = {"swap": (0.08, 0.16, 0.32, 99.0), "jump": (0.04, 0.08, 0.16, 0.32),
               "freeze": (0.12, 0.16, 0.24, 0.4), "drift": (0.4, 0.6)}[kind]
    seconds = pick.choice(seconds)
    count = min(len(points.frames), max(1, round(seconds * points.rate_hz)))
    latest = min(len(points.frames) - count, int(speech[1] * points.rate_hz) - count)
    first = 0 if seconds > 9 else pick.randint(math.ceil(speech[0] * points.rate_hz),
                                               max(math.ceil(speech[0] * points.rate_hz), latest))
    markers = [marker]
    if kind == "swap":
        markers.append(pick.choice(_near(points, marker, free, 5.0)[:9]))
    elif kind == "freeze":
        markers += _near(points, marker, free, 0.0)[: pick.choice((0, 0, 3, 7))]
    frames = range(first, min(first + count, len(points.frames)))
    if not all(points.is_there(k, m) for k in frames for m in markers):
        return None
    offset = _offset(pick.uniform(5, 15) if kind == "jump" else pick.uniform(6, 10), pick)
    for k in frames:
        share = 1.0 if kind == "jump" else (k - first + 1) / len(frames)
        for i, m in enumerate(markers):
            if kind == "swap":
                points.put(k, m, points.place(k, markers[1 - i]))
            elif kind == "freeze":
                points.put(k, m, points.place(first, m))
            else:
                points.put(k, m, [x + share * d for x, d in zip(points.place(k, m), offset)])
    return markers, first, len(frames)


def plant(source, target, chosen, seed):
    """Copies the corpus and plants one fault in each chosen sentence, the kinds in turn. `chosen` is
    asked for each id. Returns the faults."""
    source, target = pathlib.Path(source), pathlib.Path(target)
    shutil.copytree(source, target)
    pick = random.Random(seed)
    groups = json.loads((source / "layout.json").read_text())["groups"]
    movable = {g["name"] for g in groups if "rigid" not in g["regions"]}
    mouth = {g["name"] for g in groups if {"lips", "jaw"} & set(g["regions"])}
    header, *lines = (source / "sentences.tsv").read_text().splitlines()
    faults = []
    for line in lines:
        row = dict(zip(header.split("\t"), line.split("\t")))
        if not row["alignment"].endswith(".lab") or not chosen(row["id"]):
            continue
        kind = KINDS[len(faults) % len(KINDS)]
        points = Points(target / row["motion"])
        free = [m for m, name in enumerate(points.names) if name in movable]
        pool = [m for m in free if points.names[m] in mouth] if pick.random() < 0.5 else free
        done = _plant(points, kind, pick.choice(pool), free, _speech(target / row["alignment"]), pick)
        if done:
            points.save()
            markers, first, count = done
            faults.append(Fault(row["id"], kind, [points.names[m] for m in markers],
                                first / points.rate_hz, (first + count - 1) / points.rate_hz))
    return faults
