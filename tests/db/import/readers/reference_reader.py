# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads recordings in its own way, from the formats' descriptions, for comparison.

reference_reader.py c3d FILE...   rows, columns (int32), rate (float64), then the points (float32),
                                  missing ones NaN, file after file
reference_reader.py rows FILE...  `file<TAB>start<TAB>end<TAB>label` of .lab and .TextGrid files
"""
import array
import pathlib
import re
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "support"))
import read_c3d

MISSING = (float("nan"),) * 3


def c3d(path, out):
    recording = read_c3d.read(path)
    out.write(struct.pack("<iid", len(recording.frames), 3 * len(recording.names), recording.rate_hz))
    for frame in recording.frames:
        for *point, residual in frame:
            out.write(array.array("f", MISSING if residual < 0 else point).tobytes())


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
