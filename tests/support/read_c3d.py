# SPDX-License-Identifier: GPL-3.0-or-later
"""A reader of Intel C3D files that shares nothing with Phonomime's, after the C3D User Guide.

As a script: prints "rate frames markers", then one line "frame name x y z residual" for each point.
"""
import dataclasses
import struct
import sys

BLOCK = 512


@dataclasses.dataclass
class Recording:
    rate_hz: float
    names: list   # of the markers
    frames: list  # of each frame, for each marker (x, y, z, residual) in mm; residual -1 = missing


def parameters(section):
    """{(group, name): (type, dimensions, bytes)} of a parameter section."""
    groups, items, at = {}, [], 4
    while section[at]:
        length, number = struct.unpack_from("bb", section, at)
        length = abs(length)
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


def read(path):
    """A Recording; an AssertionError where header and parameters do not agree."""
    with open(path, "rb") as file:
        data = file.read()
    assert len(data) % BLOCK == 0 and data[1] == 0x50
    start = (data[0] - 1) * BLOCK
    section = data[start : start + BLOCK * data[start + 2]]
    assert section[1] == 0x50 and section[3] == 84, "not Intel"
    found = parameters(section)
    word = lambda name: struct.unpack("<H", found["POINT", name][2])[0]
    real = lambda name: struct.unpack("<f", found["POINT", name][2])[0]
    count, length, scale, begin = word("USED"), word("FRAMES"), real("SCALE"), word("DATA_START")
    assert found["POINT", "UNITS"][2] == b"mm"
    in_header, analog, first, last = struct.unpack_from("<4H", data, 2)
    assert (in_header, first, last) == (count, 1, length)
    assert struct.unpack_from("<f", data, 12)[0] == scale
    assert struct.unpack_from("<H", data, 16)[0] == begin
    assert struct.unpack_from("<f", data, 20)[0] == real("RATE")
    _, (width, labels), raw = found["POINT", "LABELS"]
    names = [raw[width * i : width * (i + 1)].decode("ascii").strip() for i in range(labels)]
    form, factor = ("f", 1.0) if scale < 0 else ("h", scale)
    each = 4 * count + analog
    numbers = struct.unpack_from(f"<{length * each}{form}", data, (begin - 1) * BLOCK)
    frames = [[(x * factor, y * factor, z * factor, residual)
               for x, y, z, residual in zip(*(row[axis : 4 * count : 4] for axis in range(4)))]
              for row in (numbers[each * k : each * (k + 1)] for k in range(length))]
    return Recording(real("RATE"), names, frames)


def main(path):
    recording = read(path)
    print(recording.rate_hz, len(recording.frames), len(recording.names))
    for k, frame in enumerate(recording.frames):
        for name, (x, y, z, residual) in zip(recording.names, frame):
            print(k, name, repr(x), repr(y), repr(z), residual)


if __name__ == "__main__":
    main(sys.argv[1])
