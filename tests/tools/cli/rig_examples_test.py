# SPDX-License-Identifier: GPL-3.0-or-later
"""A recorded sentence on four targets that share nothing with the speaker: a head with shapes, another mesh, a
jointed figure, a drawing. Each is posed by rule as an artist would, and opens its mouth as the speaker does.

Where PHONOMIME_EXAMPLES names a folder, the files stay there, to be looked at.
"""
import csv
import json
import math
import os
import pathlib
import re
import statistics
import struct
import subprocess
import sys

import phonomime_cli as cli

sys.path.insert(0, str(cli.SOURCE_DIR / "tests/synth/export"))
sys.path.insert(0, str(cli.SOURCE_DIR / "tests/support"))
import read_c3d  # noqa: E402
import read_glb  # noqa: E402

SENTENCE = "bbaf2n"  # "bin blue at f two now"
FPS = 25             # of the recording
BROW = "lm105"       # the middle of the right one
BROWSER_DIR = pathlib.Path(os.environ.get("PHONOMIME_BROWSER_DIR") or "nowhere")
VALIDATOR_DIR = pathlib.Path(os.environ.get("PHONOMIME_VALIDATOR_DIR") or "nowhere")

# A head, its jaw below the ear, and a brow: boxes of metres (middle, half sizes), by node.
FIGURE = {"skull": ((0, 0.06, 0), (0.07, 0.06, 0.07)), "jaw": ((0, -0.02, 0.03), (0.05, 0.015, 0.05)),
          "brow": ((0, 0.09, 0.075), (0.05, 0.008, 0.01))}


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def figure_glb():
    """Three boxes under three nodes; the jaw turns about an axis behind it."""
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    binary, views, accessors, meshes = b"", [], [], []
    for middle, half in FIGURE.values():
        corners = [[m + h * sign for m, h, sign in zip(middle, half, signs)]
                   for signs in ((x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1))]
        corners = [struct.unpack("<3f", struct.pack("<3f", *corner)) for corner in corners]
        indices = [quad[i] for quad in quads for i in (0, 1, 2, 0, 2, 3)]
        for data, size, target in ((b"".join(struct.pack("<3f", *corner) for corner in corners), 96, 34962),
                                   (struct.pack("<36H", *indices), 72, 34963)):
            views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": size, "target": target})
            binary += data
        accessors.append({"bufferView": len(views) - 2, "componentType": 5126, "type": "VEC3", "count": 8,
                          "min": list(map(min, zip(*corners))), "max": list(map(max, zip(*corners)))})
        accessors.append({"bufferView": len(views) - 1, "componentType": 5123, "type": "SCALAR", "count": 36})
        meshes.append({"primitives": [{"attributes": {"POSITION": len(accessors) - 2}, "indices": len(accessors) - 1}]})
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "meshes": meshes,
                "nodes": [{"name": "skull", "mesh": 0, "children": [1, 2]}, {"name": "jaw", "mesh": 1},
                          {"name": "brow", "mesh": 2}],
                "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(binary), len(text), b"JSON") + text
            + struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def drawing(opening, width, brows):
    """A face of millimetres: the mouth a curve of two bows, the brows lines."""
    left, right = 50 - width / 2, 50 + width / 2
    return f"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">
<circle cx="50" cy="50" r="46" fill="gold" stroke="black"/>
<circle cx="33" cy="40" r="5" fill="black"/><circle cx="67" cy="40" r="5" fill="black"/>
<path d="M25 {28 - brows:.3f} L41 {28 - brows:.3f} M59 {28 - brows:.3f} L75 {28 - brows:.3f}" stroke="black" stroke-width="2"/>
<path d="M{left:.3f} 70
 Q50 {70 - opening:.3f} {right:.3f} 70
 Q50 {70 + opening:.3f} {left:.3f} 70Z" fill="maroon" stroke="black"/>
</svg>
"""


@cli.needs_shared_data
class RigExamplesTest(cli.RecordingsTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        if os.environ.get("PHONOMIME_EXAMPLES"):
            cls.folder = pathlib.Path(os.environ["PHONOMIME_EXAMPLES"])
            cls.folder.mkdir(parents=True, exist_ok=True)
        data = cli.SHARED_DATA
        cls.motion = data / f"grid_s1/motion/{SENTENCE}.c3d"
        cls.landmarks = json.loads((data / "grid_s1/layout.json").read_text())["landmarks"]
        recording = read_c3d.read(cls.motion)
        names = [cls.landmarks[name] for name in ("lip_upper_inner", "lip_lower_inner")]
        upper, lower = (recording.names.index(name) for name in names)
        cls.apertures = [frame[upper][1] - frame[lower][1] for frame in recording.frames]

    def begin(self, name, *arguments):
        """A folder of keyshapes with its rig, chosen from all of grid_s1."""
        keys = self.folder / name
        report = cli.run_json("retarget", "keyshapes", "select", self.database, "-o", keys, "-n", 12, "--parts", "lower",
                              "upper", *arguments)
        for group in report["sets"]:
            self.assertLess(group["mean_square"], 0.25 * group["motion_square"])
        return keys

    def pose(self, keys, pose):
        """What `pose` says of each keyshape, by the aperture, width and brows that its markers show (mm)."""
        rig = json.loads((keys / "rig.json").read_text())
        table = rows(keys / "keyshapes.csv")
        place = lambda row, landmark, axis: float(row[f"{self.landmarks[landmark]}_{axis}"])
        calm = statistics.median(float(row[f"{BROW}_y"]) for row in table)
        for group in rig["sets"]:
            lower = group["part"] == "lower"
            for keyshape in group["keyshapes"]:
                row = table[keyshape["source"]]
                opening = place(row, "lip_upper_inner", "y") - place(row, "lip_lower_inner", "y")
                width = place(row, "mouth_corner_left", "x") - place(row, "mouth_corner_right", "x")
                brows = float(row[f"{BROW}_y"]) - calm
                pose(keyshape, opening if lower else 0, width if lower else 50, 0 if lower else brows)
        (keys / "rig.json").write_text(json.dumps(rig))

    def apply(self, keys, *outputs):
        return cli.run_json("retarget", "keyshapes", "apply", self.motion, "--db", self.database, "--rig",
                            keys / "rig.json", "-o", *outputs, "--fps", FPS)

    def assertOpensAlike(self, openings, least=0.9):
        self.assertLessEqual(abs(len(openings) - len(self.apertures)), 1)
        count = min(len(openings), len(self.apertures))
        found = statistics.correlation(openings[:count], self.apertures[:count])
        print(f"  opening correlates {found:.3f}")
        self.assertGreaterEqual(found, least)

    def test_a_head_with_shapes(self):
        """Weights as `select` fits them, on ICT-FaceKit's head."""
        face = cli.SHARED_DATA / "faces/ict"
        keys = self.begin("shapes", "--face", face)
        table = self.folder / "head.csv"
        report = cli.run_json("retarget", "apply", self.motion, "--db", self.database, "--face", face, "--method",
                              "keyshapes", "--rig", keys / "rig.json", "-o", table, self.folder / "head.glb", "--fps", FPS)
        self.assertEqual(report["figures"]["keyshapes"], 24)
        glb = read_glb.Glb((face / "ict_face.glb").read_bytes())
        skin = glb.json["meshes"][0]["primitives"][0]
        names = glb.json["meshes"][0]["extras"]["targetNames"]
        with open(face / "markers.tsv") as file:
            vertices = {line.split("\t")[0]: int(line.split("\t")[1]) for line in list(file)[1:]}
        upper, lower = (3 * vertices[self.landmarks[f"lip_{lip}_inner"]] + 1 for lip in ("upper", "lower"))
        slopes = {}
        for name, target in zip(names, skin["targets"]):
            offsets = glb.numbers(target["POSITION"])
            slopes[name] = offsets[upper] - offsets[lower]
        self.assertOpensAlike([sum(slope * float(row[name]) for name, slope in slopes.items()) for row in rows(table)])

    def test_another_mesh(self):
        """The canonical face, as `select` shows the keyshapes on it."""
        keys = self.begin("mesh", "--target", "mesh", "--face", cli.SHARED_DATA / "faces/canonical")
        self.apply(keys, self.folder / "mesh.glb")
        glb = read_glb.Glb((self.folder / "mesh.glb").read_bytes())
        upper, lower = (3 * int(self.landmarks[f"lip_{lip}_inner"][2:]) + 1 for lip in ("upper", "lower"))
        openings = []
        for k in range(len(self.apertures)):
            points = read_glb.vertices(glb, k / FPS)
            openings.append(points[upper] - points[lower])
        self.assertOpensAlike(openings)
        self.validate("mesh.glb")

    def test_a_jointed_figure(self):
        keys = self.begin("joints", "--target", "joints")
        (keys / "rest.glb").write_bytes(figure_glb())

        def pose(keyshape, opening, width, brows):
            turn = lambda angle: [math.sin(angle / 2), 0, 0, math.cos(angle / 2)]
            keyshape["rotations"] = {"jaw": turn(0.04 * opening), "brow": turn(-0.06 * brows)}
        self.pose(keys, pose)
        self.apply(keys, self.folder / "figure.glb", self.folder / "figure.csv")
        glb = read_glb.Glb((self.folder / "figure.glb").read_bytes())
        jaw = [node["name"] for node in glb.json["nodes"]].index("jaw")
        sampler = glb.sampler(jaw, "rotation")
        angles = [2 * math.asin(read_glb.sample(sampler, 4, k / FPS, True)[0]) for k in range(len(self.apertures))]
        self.assertOpensAlike(angles)
        self.validate("figure.glb")

    def test_a_drawing(self):
        keys = self.begin("drawing", "--target", "drawing")
        (keys / "rest.svg").write_text(drawing(0, 50, 0))
        self.pose(keys, lambda keyshape, *measures: (keys / keyshape["file"]).write_text(drawing(*measures)))
        out = self.folder / "drawing.svg"
        self.apply(keys, out)
        mouths = re.search(r"'d',\[('M[^]]*Z')\]", out.read_text())[1].strip("'").split("','")
        control = [[float(number) for number in re.findall(r"-?[0-9.]+", mouth)] for mouth in mouths]
        self.assertOpensAlike([numbers[7] - numbers[3] for numbers in control])
        driver = BROWSER_DIR / "drive.mjs"
        if not driver.is_file():
            return
        result = subprocess.run(["node", driver, out.resolve().as_uri(), pathlib.Path(__file__).with_name("drawing_page.mjs")],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False,
                                timeout=cli.TIME_LIMIT_S)
        if result.returncode != 77:
            self.assertEqual(result.returncode, 0, result.stderr)
            seen = json.loads(result.stdout)
            self.assertGreater(len(set(seen)), 3, "it moves")
            self.assertLessEqual(set(seen), set(mouths))

    def validate(self, name):
        """Khronos' validator finds no fault."""
        if not (VALIDATOR_DIR / "validate_glb.mjs").is_file():
            return
        only = self.folder / f"{name}.alone"
        only.mkdir(exist_ok=True)
        (only / name).write_bytes((self.folder / name).read_bytes())
        result = subprocess.run(["node", VALIDATOR_DIR / "validate_glb.mjs", only], stdout=subprocess.PIPE, text=True,
                                check=False, timeout=cli.TIME_LIMIT_S)
        self.assertEqual(result.returncode, 0, result.stdout)


if __name__ == "__main__":
    cli.main()
