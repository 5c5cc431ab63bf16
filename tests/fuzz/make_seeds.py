# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes small valid files of each format as seeds: make_seeds.py FOLDER."""
import pathlib
import struct
import sys


def parameter(name, group, body):
    return struct.pack("<bb", len(name), group) + name + struct.pack("<h", len(body) + 2) + body


def c3d(floats):
    scale = -0.5 if floats else 0.5
    section = b"\x01\x50\x01\x54"
    section += parameter(b"POINT", -1, b"\0")
    section += parameter(b"USED", 1, struct.pack("<bbhb", 2, 0, 2, 0))
    section += parameter(b"FRAMES", 1, struct.pack("<bbhb", 2, 0, 3, 0))
    section += parameter(b"SCALE", 1, struct.pack("<bbfb", 4, 0, scale, 0))
    section += parameter(b"RATE", 1, struct.pack("<bbfb", 4, 0, 100.0, 0))
    section += parameter(b"LABELS", 1, struct.pack("<bbBB", -1, 2, 2, 2) + b"a b \0")
    section = (section + b"\0\0").ljust(512, b"\0")
    header = struct.pack("<BB5HfHHf", 2, 0x50, 2, 0, 1, 3, 10, scale, 3, 0, 100.0).ljust(512, b"\0")
    data = struct.pack("<24f" if floats else "<24h", *range(24)).ljust(512, b"\0")
    return header + section + data


TEXTGRID = """File type = "ooTextFile"
Object class = "TextGrid"

0
1
<exists>
2
"TextTier"
"bells"
0
1
1
0.5
"x"
"IntervalTier"
"phones"
0
1
2
0
0.5
""
0.5
1
"a""b"
"""

SEEDS = {
    "c3d": [c3d(False), c3d(True)],
    "textgrid": [TEXTGRID.encode(), TEXTGRID.encode("utf-16")],
    "xlabel": [b"separator ;\n#\n0.5 100 pau\n1 100 b ; x\n"],
    "htk_label": [b"0 2500000 pau\n2500000 5000000 b -1.5\n", b"0.0\t0.5\tpau\n0.5\t1\tb\n"],
    "marker_csv": [b"time,a_x,a_y,a_z\n0,1,2,3\n0.04,1,,3\n0.08,1,2,3\n", b"time,\"a\"\n0,1\n1,nan\n"],
    "live_link_csv": [b"Timecode,BlendShapeCount,JawOpen\n13:13:04:58.652,1,0.5\n"
                      b"13:13:05:00.652,1,0.25\n13:13:05:04.651,0,\n"],
}

for name, files in SEEDS.items():
    folder = pathlib.Path(sys.argv[1]) / name
    folder.mkdir(parents=True, exist_ok=True)
    for i, content in enumerate(files):
        (folder / str(i)).write_bytes(content)
