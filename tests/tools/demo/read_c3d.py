# SPDX-License-Identifier: GPL-3.0-or-later
"""An independent reader for the C3D files of the demo corpus, after the C3D User Guide.

Prints "rate frames markers", then one line "frame name x y z residual" for each point.
"""
import struct
import sys


def parameters(section):
    """Yields (group, name, type, dimensions, raw bytes) of a parameter section."""
    groups, items, at = {}, [], 4
    while section[at]:
        length = abs(struct.unpack_from("b", section, at)[0])
        number = struct.unpack_from("b", section, at + 1)[0]
        name = section[at + 2 : at + 2 + length].decode("ascii")
        body = at + 2 + length
        (step,) = struct.unpack_from("<H", section, body)
        if number < 0:
            groups[-number] = name
        else:
            kind, rank = struct.unpack_from("bB", section, body + 2)
            dimensions = list(section[body + 4 : body + 4 + rank])
            size = abs(kind)
            for d in dimensions:
                size *= d
            first = body + 4 + rank
            items.append((number, name, kind, dimensions, section[first : first + size]))
        if not step:
            break
        at = body + step
    return {(groups[n], name): (kind, dims, raw) for n, name, kind, dims, raw in items}


def main(path):
    data = open(path, "rb").read()
    assert len(data) % 512 == 0 and data[1] == 0x50
    start = (data[0] - 1) * 512
    section = data[start : start + 512 * data[start + 2]]
    assert section[1] == 0x50 and section[3] == 84, "not Intel"
    found = parameters(section)
    word = lambda name: struct.unpack("<H", found["POINT", name][2])[0]
    real = lambda name: struct.unpack("<f", found["POINT", name][2])[0]
    count, frames, scale = word("USED"), word("FRAMES"), real("SCALE")
    assert found["POINT", "UNITS"][2] == b"mm"
    assert struct.unpack_from("<H", data, 2)[0] == count
    assert struct.unpack_from("<HH", data, 6) == (1, frames)
    assert struct.unpack_from("<f", data, 12)[0] == scale
    assert struct.unpack_from("<H", data, 16)[0] == word("DATA_START")
    assert struct.unpack_from("<f", data, 20)[0] == real("RATE")
    _, (width, labels), raw = found["POINT", "LABELS"]
    names = [raw[width * i : width * (i + 1)].decode("ascii").strip() for i in range(labels)]
    print(real("RATE"), frames, count)
    at, form, factor = (word("DATA_START") - 1) * 512, "<4f", 1.0
    if scale > 0:
        form, factor = "<4h", scale
    step = struct.calcsize(form)
    for k in range(frames):
        for name in names:
            x, y, z, residual = struct.unpack_from(form, data, at)
            at += step
            print(k, name, repr(x * factor), repr(y * factor), repr(z * factor), residual)


main(sys.argv[1])
