# SPDX-License-Identifier: GPL-3.0-or-later
"""Corpora of a few made-up sentences: ten markers of a face that opens and closes its mouth.

    corpus = Corpus(folder)                    # six sentences of speaker "ann"
    corpus.sentences[0].alignment = "#\n..."   # spoil what a test is about
    corpus.write()
"""
import dataclasses
import json
import math
import pathlib
import random
import struct

RATE_HZ = 50
FACE_SPACING_CM = 0.5
PHONEMES = ("aa", "b", "d", "eh", "f", "iy", "k", "l", "m", "n", "ow", "p", "s", "t", "uw")

# Rest pose in mm (right of the picture, up, towards the camera) and regions.
MARKERS = {
    "brow_top": ((0, 60, 0), ["forehead", "rigid"]),
    "temple_r": ((-50, 40, -20), ["rigid"]),
    "temple_l": ((50, 40, -20), ["rigid"]),
    "nose": ((0, 10, 20), ["nose", "rigid"]),
    "lip_up": ((0, -25, 15), ["lips"]),
    "lip_lo": ((0, -30, 15), ["lips"]),
    "corner_r": ((-25, -30, 5), ["lips"]),
    "corner_l": ((25, -30, 5), ["lips"]),
    "chin": ((0, -55, 10), ["jaw"]),
    "cheek": ((40, -10, 0), ["cheeks"]),
}
LAYOUT = {
    "format": "phonomime-layout", "version": 1, "kind": "markers", "unit": "mm",
    "axes": {"x": "right of the picture", "y": "up", "z": "towards the camera"},
    "reference": "nose",
    "groups": [{"name": name, "regions": regions} for name, (_, regions) in MARKERS.items()],
    "landmarks": {"lip_upper_inner": "lip_up", "lip_lower_inner": "lip_lo",
                  "mouth_corner_right": "corner_r", "mouth_corner_left": "corner_l"},
}


def _block(size):
    return -(-size // 512)


def c3d_bytes(labels, frames, rate_hz=RATE_HZ, units="mm"):
    """A C3D file of Intel floats; frames[k][i] is (x, y, z), None where the marker is missing."""
    def parameter(group, name, kind, dimensions, data):
        body = struct.pack("<bB", kind, len(dimensions)) + bytes(dimensions) + data + b"\0"
        return struct.pack("<bb", len(name), group) + name + struct.pack("<H", len(body) + 2) + body

    def parameters(data_start):
        width = max(map(len, labels))
        return (b"\1\x50" + bytes([blocks, 84]) + struct.pack("<bb", 5, -1) + b"POINT" + struct.pack("<HB", 3, 0)
                + parameter(1, b"USED", 2, [], struct.pack("<H", len(labels)))
                + parameter(1, b"SCALE", 4, [], struct.pack("<f", -0.01))
                + parameter(1, b"RATE", 4, [], struct.pack("<f", rate_hz))
                + parameter(1, b"DATA_START", 2, [], struct.pack("<H", data_start))
                + parameter(1, b"FRAMES", 2, [], struct.pack("<H", len(frames)))
                + parameter(1, b"UNITS", -1, [len(units)], units.encode())
                + parameter(1, b"LABELS", -1, [width, len(labels)],
                            b"".join(label.encode().ljust(width) for label in labels))
                + b"\0\0")

    blocks = 0
    blocks = _block(len(parameters(0)))
    data_start = 2 + blocks
    header = struct.pack("<BBHHHHHfHHf", 2, 0x50, len(labels), 0, 1, len(frames), 0, -0.01, data_start, 0, rate_hz)
    points = b"".join(struct.pack("<4f", *point, 0) if point else struct.pack("<4f", 0, 0, 0, -1)
                      for frame in frames for point in frame)
    return (header.ljust(512, b"\0") + parameters(data_start).ljust(512 * blocks, b"\0")
            + points.ljust(512 * _block(len(points)), b"\0"))


def _openness(phoneme):
    return 0.0 if phoneme in "bmp" else 1.0 + PHONEMES.index(phoneme) if phoneme in PHONEMES else 2.0


def motion_frames(rows, rate_hz=RATE_HZ, seed=0):
    """Marker frames of an alignment of (end in seconds, label), with a head that nods and drifts."""
    noise = random.Random(seed)
    frames, opening = [], 2.0
    for k in range(round(rows[-1][0] * rate_hz) + 1):
        t = k / rate_hz
        goal = _openness(next((label for end, label in rows if t < end), "pau"))
        opening += 0.5 * (goal - opening)
        angle = 0.05 * math.sin(1.3 * t + seed)
        frame = []
        for name, ((x, y, z), regions) in MARKERS.items():
            if "rigid" not in regions:
                share = {"lip_lo": -1.0, "chin": -0.9, "lip_up": 0.1}.get(name, 0.2)
                y += share * opening + 0.05 * noise.random()
                x *= 1 - 0.01 * opening * ("corner" in name)
                z += 0.1 * opening * math.sin(3 * t)
            frame.append((x + 2 * math.sin(t), y * math.cos(angle) - z * math.sin(angle),
                          y * math.sin(angle) + z * math.cos(angle)))
        frames.append(tuple(frame))
    if rows[-1][1] != "pau":
        raise ValueError("a sentence ends in silence")
    return frames


@dataclasses.dataclass
class Sentence:
    """One line of the sentence table, and its files' bytes (None: the file is not written)."""
    id: str
    rows: list
    speaker: str = ""
    emotion: str = ""
    seed: int = 0
    span: tuple = None
    alignment: object = dataclasses.field(init=False)  # text or bytes
    motion: bytes = dataclasses.field(init=False)
    alignment_name: str = dataclasses.field(init=False)
    motion_name: str = dataclasses.field(init=False)

    def __post_init__(self):
        self.alignment = "#\n" + "".join(f"{end:.4f} 100 {label}\n" for end, label in self.rows)
        self.motion = c3d_bytes(list(MARKERS), motion_frames(self.rows, seed=self.seed))
        stem = f"{self.emotion or 'neutral'}_{self.id}"
        self.alignment_name = f"alignment/{stem}.lab"
        self.motion_name = f"motion/{stem}.c3d"


def some_rows(seed, phonemes=12):
    """An alignment of random phonemes between two silences."""
    pick = random.Random(seed)
    rows, t = [(0.3, "pau")], 0.3
    for _ in range(phonemes):
        t += pick.choice((0.06, 0.08, 0.1, 0.14))
        rows.append((t, pick.choice(PHONEMES)))
    return [*rows, (t + 0.3, "pau")]


class Corpus:
    def __init__(self, folder, name="ann", sentences=6, phonemes=12, first=0, emotions=("neutral",)):
        self.folder = pathlib.Path(folder)
        self.description = {"format": "phonomime-corpus", "version": 1, "name": name, "phoneme_set": "arpabet",
                            "layout": "layout.json", "sentences": "sentences.tsv"}
        self.layout = json.loads(json.dumps(LAYOUT))
        self.sentences = [
            Sentence(f"u{first + i:03d}", some_rows(first + i, phonemes), emotion=emotion,
                     seed=100 * e + first + i)
            for e, emotion in enumerate(emotions) for i in range(sentences)]

    def write(self):
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / "corpus.json").write_text(json.dumps(self.description))
        (self.folder / "layout.json").write_text(json.dumps(self.layout))
        lines = ["id\tspeaker\temotion\tmotion\talignment\tstart\tend"]
        for one in self.sentences:
            start, end = one.span or ("", "")
            lines.append(f"{one.id}\t{one.speaker}\t{one.emotion}\t{one.motion_name}\t{one.alignment_name}\t{start}\t{end}")
            for name, data in ((one.motion_name, one.motion), (one.alignment_name, one.alignment)):
                if data is not None:
                    path = self.folder / name
                    path.parent.mkdir(parents=True, exist_ok=True)
                    path.write_bytes(data.encode() if isinstance(data, str) else data)
        (self.folder / "sentences.tsv").write_text("\n".join(lines) + "\n")
        return self.folder


def write_face(folder):
    """A mask whose vertices include every marker's rest position, and the table that says which."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    columns, rows = 25, 27  # x from -6 to 6 cm, y from -6.5 to 6.5 cm
    depth = lambda x, y: 2.0 - 0.1 * (x * x + 0.3 * y * y)
    vertices = [(FACE_SPACING_CM * (c - 12), FACE_SPACING_CM * (r - 13)) for r in range(rows) for c in range(columns)]
    lines = [f"v {x} {y} {depth(x, y):.4f}" for x, y in vertices]
    for r in range(rows - 1):
        for c in range(columns - 1):
            a = r * columns + c + 1
            lines += [f"f {a} {a + 1} {a + columns}", f"f {a + 1} {a + columns + 1} {a + columns}"]
    (folder / "mask.obj").write_text("\n".join(lines) + "\n")
    table = ["marker\tvertex"]
    for name, ((x, y, _), _) in MARKERS.items():
        table.append(f"{name}\t{vertices.index((x / 10, y / 10))}")
    (folder / "markers.tsv").write_text("\n".join(table) + "\n")
    return folder
