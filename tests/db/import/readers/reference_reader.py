# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads recordings in its own way, from the formats' descriptions, for comparison.

reference_reader.py c3d FILE...   rows, columns (int32), rate (float64), then the points (float32),
                                  missing ones NaN, file after file
reference_reader.py rows FILE...  `file<TAB>start<TAB>end<TAB>label` of .lab and .TextGrid files
"""
import array
import re
import struct
import sys


def parameters(data):
    """{(group, name): (type, dimensions, bytes)} of a little-endian file's parameter section."""
    groups, values = {}, {}
    at = (data[0] - 1) * 512 + 4
    while True:
        length, group = struct.unpack_from("<bb", data, at)
        if length == 0:
            break
        name = data[at + 2:at + 2 + abs(length)].decode("ascii")
        link = at + 2 + abs(length)
        step = struct.unpack_from("<H", data, link)[0]
        if group < 0:
            groups[-group] = name
        else:
            kind, count = struct.unpack_from("<bB", data, link + 2)
            dimensions = list(data[link + 4:link + 4 + count])
            size = abs(kind)
            for d in dimensions:
                size *= d
            begin = link + 4 + count
            values[group, name] = (kind, dimensions, data[begin:begin + size])
        if step == 0:
            break
        at = link + step
    return {(groups[g], n): v for (g, n), v in values.items()}


def c3d(path, out):
    with open(path, "rb") as file:
        data = file.read()
    values = parameters(data)
    points = struct.unpack("<H", values["POINT", "USED"][2])[0]
    frames = struct.unpack("<H", values["POINT", "FRAMES"][2])[0]
    scale = struct.unpack("<f", values["POINT", "SCALE"][2])[0]
    rate = struct.unpack("<f", values["POINT", "RATE"][2])[0]
    analog = struct.unpack_from("<H", data, 4)[0]
    begin = (struct.unpack_from("<H", data, 16)[0] - 1) * 512
    nan = float("nan")
    result = array.array("f")
    per_frame = 4 * points + analog
    kind = "f" if scale < 0 else "h"
    everything = struct.unpack_from(f"<{frames * per_frame}{kind}", data, begin)
    factor = 1.0 if scale < 0 else scale
    for frame in range(frames):
        row = everything[frame * per_frame:frame * per_frame + 4 * points]
        for i in range(0, 4 * points, 4):
            if row[i + 3] < 0:
                result.extend((nan, nan, nan))
            else:
                result.extend([value * factor for value in row[i:i + 3]])
    out.write(struct.pack("<iid", frames, 3 * points, rate))
    out.write(result.tobytes())


def lab_rows(text):
    start = 0.0
    for line in text.split("#\n", 1)[1].splitlines():
        end, _, label = line.split()
        yield start, float(end), label
        start = float(end)


def textgrid_rows(text):
    """The tier of phones of a long TextGrid, by its words."""
    tier = next(part for part in re.split(r"item \[\d+\]:", text) if '"phones"' in part)
    for block in re.split(r"intervals \[\d+\]:", tier)[1:]:
        start, end, label = re.search(
            r'xmin = (\S+)\s+xmax = (\S+)\s+text = "(.*)"', block).groups()
        yield float(start), float(end), label


def rows(path, out):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    reader = textgrid_rows if path.endswith(".TextGrid") else lab_rows
    for start, end, label in reader(text):
        out.write(f"{path}\t{start!r}\t{end!r}\t{label}\n".encode())


for path in sys.argv[2:]:
    {"c3d": c3d, "rows": rows}[sys.argv[1]](path, sys.stdout.buffer)
