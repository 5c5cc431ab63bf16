# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the pictures that isomap_test leaves with readers that share no code with Phonomime.

usage: read_pictures.py FOLDER
"""

import base64
import pathlib
import struct
import sys
import unittest
import xml.etree.ElementTree as ElementTree
import zlib

FOLDER = pathlib.Path(sys.argv.pop())
SVG = "{http://www.w3.org/2000/svg}"
ROLES = ["motion node", "pruned", "suspect", "same triphone", "chosen"]
MARKS = ["at this time", "same triphone, at this time", "chosen, at this time", "picked"]


def paeth(left, up, corner):
    guess = left + up - corner
    return min((left, up, corner), key=lambda value: abs(guess - value))


def read_png(data):
    """Width, height and rows of (red, green, blue) of an 8-bit RGB file."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    place, packed = 8, b""
    while place < len(data):
        size, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + size]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[place + 8 + size:place + 12 + size])[0]
        if kind == b"IHDR":
            width, height, depth, colours, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            assert (depth, colours, interlaced) == (8, 2, 0)
        elif kind == b"IDAT":
            packed += body
        place += 12 + size
    stream, rows, above = zlib.decompress(packed), [], bytes(3 * width)
    for y in range(height):
        line = bytearray(stream[y * (3 * width + 1):(y + 1) * (3 * width + 1)])
        kind, line = line[0], line[1:]
        for i in range(3 * width):
            left = line[i - 3] if i >= 3 else 0
            corner = above[i - 3] if i >= 3 else 0
            line[i] = line[i] + (0, left, above[i], (left + above[i]) // 2,
                                 paeth(left, above[i], corner))[kind] & 255
        rows.append([tuple(line[3 * x:3 * x + 3]) for x in range(width)])
        above = line
    return width, height, rows


class Pictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.width, cls.height, cls.rows = read_png((FOLDER / "map.png").read_bytes())
        cls.plain = read_png((FOLDER / "plain.png").read_bytes())
        cls.svg = ElementTree.parse(FOLDER / "map.svg").getroot()
        lines = (FOLDER / "places.tsv").read_text(encoding="utf-8").splitlines()
        cls.places = {name: (float(x), float(y)) for name, x, y in map(str.split, lines)}

    def pixel(self, name, dx=0, dy=0):
        x, y = self.places[name]
        return self.rows[int(y + dy)][int(x + dx)]

    def assertDark(self, colour):
        self.assertLess(max(colour), 80)

    def test_sizes(self):
        self.assertEqual(self.width, 600)
        self.assertEqual(self.plain[:2], (600, 400))
        self.assertGreater(self.height, 400 + 36 + 26)
        self.assertEqual((self.svg.get("width"), self.svg.get("height")), ("600", str(self.height)))

    def test_densities_have_the_emotions_colours_over_white(self):
        red, green, blue = self.pixel("anger")
        self.assertGreater(red, green + 60)
        self.assertGreater(red, blue + 60)
        grey = self.pixel("neutral")
        self.assertEqual(max(grey), min(grey))
        self.assertLess(grey[0], 200)
        self.assertEqual(self.pixel("nothing"), (255, 255, 255))

    def test_trajectories(self):
        red, green, blue = self.pixel("suspect")
        self.assertTrue(red > 200 and 60 < green < 200 and blue < 60, (red, green, blue))
        self.assertDark(self.pixel("context_correct"))
        red, green, blue = self.pixel("chosen")
        self.assertTrue(red > 180 and green < 60 and 100 < blue < 200, (red, green, blue))
        red, green, blue = self.pixel("node")
        self.assertTrue(255 > green and red > green, (red, green, blue))

    def test_the_arrow_is_at_the_last_frame(self):
        self.assertNotEqual(self.pixel("chosen_end", dx=-8, dy=3), (255, 255, 255))
        self.assertEqual(self.pixel("chosen", dx=-8, dy=5), (255, 255, 255))

    def test_marks(self):
        self.assertEqual(self.pixel("time_correct_mark"), (255, 255, 255))
        self.assertLess(min(self.pixel("time_correct_mark", dx=dx) for dx in (2, 3, 4)), (160,) * 3)
        self.assertGreater(self.pixel("context_correct_mark")[1], 200)
        self.assertLess(self.pixel("context_correct_mark")[2], 60)
        self.assertLess(self.pixel("chosen_mark")[1], 60)
        self.assertDark(self.pixel("picked_mark"))
        self.assertDark(self.pixel("picked_mark", dx=7))

    def test_the_image_in_the_svg_is_the_density(self):
        image = self.svg.find(SVG + "image")
        data = image.get("{http://www.w3.org/1999/xlink}href")
        self.assertTrue(data.startswith("data:image/png;base64,"))
        width, height, rows = read_png(base64.b64decode(data.partition(",")[2], validate=True))
        self.assertEqual((width, height), (600, 400))
        for name in ("anger", "neutral", "nothing"):
            x, y = self.places[name]
            self.assertEqual(rows[int(y) - int(image.get("y"))][int(x)], self.pixel(name))

    def test_the_layers_of_the_svg(self):
        layers = self.svg.findall(SVG + "g")
        self.assertEqual([layer.get("id") for layer in layers], ROLES + MARKS + ["legend"])
        texts = [text.text for text in layers[-1].findall(SVG + "text")]
        self.assertEqual(texts, ['/w/ <b> & "c"', "anger", "neutral"] + ROLES + MARKS)
        chosen = layers[ROLES.index("chosen")].findall(SVG + "path")
        x, y = self.places["chosen_end"]
        self.assertTrue(chosen[1].get("d").endswith(f"L{x:.2f} {y:.2f}"), chosen[1].get("d"))
        self.assertTrue(chosen[2].get("d").startswith(f"M{x:.2f} {y:.2f}"), chosen[2].get("d"))


if __name__ == "__main__":
    unittest.main()
