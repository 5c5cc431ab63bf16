# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion onto a face with shapes of its own: what it offers, what is written, read by others."""
import csv
import math
import os
import pathlib
import subprocess
import sys
import types
import unittest

import phonomime_cli as cli
import shape_face
import tiny_corpus

sys.path.insert(0, str(cli.SOURCE_DIR / "tests/synth/export"))
import read_glb  # noqa: E402  by the specification alone

RATE_HZ = 50
FRAMES = 40
BROWSER_DIR = pathlib.Path(os.environ.get("PHONOMIME_BROWSER_DIR") or "nowhere")
ANGLES = ("HeadYaw", "HeadPitch", "HeadRoll", "LeftEyeYaw", "LeftEyePitch", "LeftEyeRoll", "RightEyeYaw",
          "RightEyePitch", "RightEyeRoll")


def weight(name, frame):
    """Made-up weights, 0 to 1."""
    return 0.5 - 0.5 * math.cos(0.1 * frame * (1 + sum(map(ord, name)) % 5))


def write_weights(path, names, frames=FRAMES):
    rows = [",".join(["time", *names])]
    for k in range(frames):
        rows.append(",".join([f"{k / RATE_HZ:.6f}", *(f"{weight(name, k):.6f}" for name in names)]))
    path.write_text("\n".join(rows) + "\n")
    return path


def write_live_link(path, values, frames=FRAMES):
    """values: {column: function of the frame}; 60 frames a second."""
    rows = [",".join(["Timecode", "BlendShapeCount", *values])]
    for k in range(frames):
        cells = [f"00:00:{k // 60:02d}:{k % 60:02d}.000", str(len(values)), *(f"{f(k):.10f}" for f in values.values())]
        rows.append(",".join(cells))
    path.write_text("\n".join(rows) + "\n")
    return path


def read_table(path):
    with open(path, newline="", encoding="ascii") as file:
        return list(csv.DictReader(file))


class RetargetTest(cli.CliTest):
    def setUp(self):
        super().setUp()
        self.face = shape_face.write(self.folder / "face")
        glb = read_glb.Glb((self.face / "face.glb").read_bytes())
        self.rest = [1000 * value for value in glb.numbers(0)]
        self.offsets = {name: [1000 * value for value in glb.numbers(2 + i)]
                        for i, name in enumerate(shape_face.SHAPES)}

    def apply(self, motion, *arguments):
        return cli.run_json("retarget", "apply", motion, "--face", self.face, *arguments)

    def assertShape(self, glb, time, weights):
        """The face in a file at a time is its rest plus the weighted offsets, in mm."""
        expected = list(self.rest)
        for name, share in weights.items():
            expected = [e + share * o for e, o in zip(expected, self.offsets[name])]
        found = read_glb.vertices(glb, time)
        self.assertLess(max(abs(a - b) for a, b in zip(found, expected)), 2e-3)

    # What a face offers

    def test_a_list_of_what_a_face_offers(self):
        offer = cli.run_json("retarget", "list", self.face)
        self.assertEqual([shape["name"] for shape in offer["shapes"]], list(shape_face.SHAPES))
        for shape in offer["shapes"]:
            rows = self.offsets[shape["name"]]
            furthest = max(math.hypot(*rows[i:i + 3]) for i in range(0, len(rows), 3))
            self.assertAlmostEqual(shape["extent_mm"], furthest, 4)
        self.assertEqual([shape["arkit"] for shape in offer["shapes"]],
                         ["JawOpen", "MouthSmileLeft", "MouthSmileRight", "BrowInnerUp", "BrowInnerUp", None])
        self.assertEqual(offer["arkit_shapes"], 4)
        self.assertEqual([node["name"] for node in offer["nodes"]], ["root", "skin"])
        self.assertEqual(offer["meshes"][0]["shapes"], len(shape_face.SHAPES))
        self.assertEqual(offer["markers"]["placed"], len(tiny_corpus.MARKERS))
        self.assertEqual(cli.run_well("retarget", "--list", self.face), cli.run_well("retarget", "list", self.face))

    def test_a_face_without_shapes(self):
        shape_face.write(self.face, shapes=())
        self.assertEqual(cli.run_json("retarget", "list", self.face)["shapes"], [])
        motion = write_weights(self.folder / "w.csv", ["jawOpen"])
        self.assertRefused(cli.BAD_INPUT, ["face.glb", "no shapes of its own"], "retarget", "apply", motion,
                           "--face", self.face, "-o", self.folder / "x.glb")

    # Weights by their names

    def test_weights_go_to_the_shapes_of_their_names(self):
        names = ["JawOpen", "mouth_smile_left", "mouthSmile_R", "BrowInnerUp"]
        motion = write_weights(self.folder / "w.csv", names)
        out = self.folder / "x.glb"
        report = self.apply(motion, "-o", out, self.folder / "x.csv")
        self.assertEqual((report["method"], report["frames"], report["moved"]), ("weights", FRAMES, 5))
        glb = read_glb.Glb(out.read_bytes())
        self.assertEqual(glb.json["meshes"][0]["extras"]["targetNames"], list(shape_face.SHAPES))
        self.assertEqual(glb.json["extras"], {"kept": "as it is"})
        for frame in (0, 7, 21, FRAMES - 1):
            self.assertShape(glb, frame / RATE_HZ, {
                "jawOpen": weight(names[0], frame), "mouthSmile_L": weight(names[1], frame),
                "mouthSmile_R": weight(names[2], frame), "browInnerUp_L": weight(names[3], frame),
                "browInnerUp_R": weight(names[3], frame)})
        table = read_table(self.folder / "x.csv")
        self.assertEqual(list(table[0]), ["time", *shape_face.SHAPES])
        for frame, row in enumerate(table):
            self.assertAlmostEqual(float(row["time"]), frame / RATE_HZ, 5)
            self.assertAlmostEqual(float(row["browInnerUp_R"]), weight("BrowInnerUp", frame), 5)
            self.assertEqual(float(row["wink"]), 0.0)

    def test_other_rates(self):
        motion = write_weights(self.folder / "w.csv", ["jawOpen"])
        self.apply(motion, "--fps", 25, "-o", self.folder / "x.csv")
        times = [float(row["time"]) for row in read_table(self.folder / "x.csv")]
        self.assertEqual(times, [round(k / 25, 6) for k in range(20)])

    def test_weights_of_shapes_that_are_not_there(self):
        motion = write_weights(self.folder / "w.csv", ["jawOpen", "winck"])
        call = ["retarget", "apply", motion, "--face", self.face, "-o", self.folder / "x.glb"]
        self.assertRefused(cli.BAD_INPUT, ["w.csv", '"winck"', 'Did you mean "wink"', "--skip-missing"], *call)
        self.assertEqual(cli.run_json(*call, "--skip-missing")["left_out"], ["winck"])
        motion.write_text("time,tail\n0,0.5\n0.1,1\n")
        self.assertRefused(cli.BAD_INPUT, ["w.csv", "jawOpen", '"tail"'], *call, "--skip-missing")

    # Live Link Face, head and all

    def test_a_live_link_take_in_and_out(self):
        values = {"JawOpen": lambda k: weight("JawOpen", k), "BrowInnerUp": lambda k: weight("b", k),
                  "MouthSmileLeft": lambda k: weight("s", k), "TongueOut": lambda k: 0.0}
        for i, name in enumerate(ANGLES):
            values[name] = lambda k, i=i: 0.02 * (i + 1) * math.sin(0.05 * k)
        motion = write_live_link(self.folder / "take.csv", values)
        outputs = [self.folder / f"x{suffix}" for suffix in (".livelink.csv", ".bvh", ".glb")]
        report = self.apply(motion, "-o", *outputs)
        self.assertEqual(report["left_out"], ["TongueOut"])
        rows = read_table(outputs[0])
        self.assertEqual(len(rows[0]), 63)
        self.assertEqual(len(rows), FRAMES)
        for k, row in enumerate(rows):
            self.assertEqual(row["BlendShapeCount"], "61")
            self.assertEqual(row["Timecode"], f"00:00:00:{k:02d}.000")
            for name, value in values.items():
                self.assertAlmostEqual(float(row[name]), value(k), 5, name)
            self.assertEqual(float(row["EyeBlinkLeft"]), 0.0)
        self.check_bvh(outputs[1], values)
        self.check_head(read_glb.Glb(outputs[2].read_bytes()), values)

    def check_bvh(self, path, values):
        lines = path.read_text().splitlines()
        self.assertIn("ROOT head", lines)
        channels = next(line.split()[2:] for line in lines if "CHANNELS" in line)
        start = lines.index("MOTION")
        self.assertEqual(lines[start + 1], f"Frames: {FRAMES}")
        self.assertAlmostEqual(float(lines[start + 2].split()[2]), 1 / 60, 6)
        for k, line in enumerate(lines[start + 3:]):
            row = dict(zip(channels, map(float, line.split())))
            self.assertAlmostEqual(row["Yrotation"], math.degrees(values["HeadYaw"](k)), 4)
            self.assertAlmostEqual(row["Xrotation"], -math.degrees(values["HeadPitch"](k)), 4)
            self.assertAlmostEqual(row["Zrotation"], -math.degrees(values["HeadRoll"](k)), 4)

    def check_head(self, glb, values):
        """The nose turns to the left for a positive yaw, up for a positive pitch, about the face's middle."""
        (head,) = [i for i, node in enumerate(glb.json["nodes"]) if node.get("name") == "head"]
        self.assertEqual(glb.json["scenes"][0]["nodes"], [head])
        frame = 30
        turn = read_glb.sample(glb.sampler(head, "rotation"), 4, frame / 60, True)
        ahead = read_glb.place([0.0, 0.0, 1.0], [0.0, 0.0, 0.0], turn)
        self.assertAlmostEqual(math.atan2(ahead[0], ahead[2]), values["HeadYaw"](frame), 5)
        self.assertAlmostEqual(math.asin(ahead[1]), values["HeadPitch"](frame), 5)
        moved = read_glb.sample(glb.sampler(head, "translation"), 3, frame / 60)
        moving = [i for i in range(len(self.rest) // 3)
                  if any(abs(v) > 0 for rows in self.offsets.values() for v in rows[3 * i:3 * i + 3])]
        middle = [0.5e-3 * (min(self.rest[3 * i + a] for i in moving) + max(self.rest[3 * i + a] for i in moving))
                  for a in range(3)]
        for found, expected in zip(read_glb.place(middle, moved, turn), middle):
            self.assertAlmostEqual(found, expected, 6)

    # Scripts, with stand-ins for the programs that run them

    def test_the_maya_script_keys_every_shape(self):
        motion = write_live_link(self.folder / "take.csv", {
            "JawOpen": lambda k: weight("JawOpen", k), "HeadYaw": lambda k: 0.01 * k, "HeadPitch": lambda k: 0.0,
            "HeadRoll": lambda k: 0.0})
        self.apply(motion, "-o", self.folder / "x.maya.py")
        keys = {}
        cmds = types.ModuleType("maya.cmds")
        cmds.ls = lambda type: ["blend"]
        cmds.listAttr = lambda plug, multi: ["jawOpen", "other"]
        cmds.warning = lambda text: keys.setdefault("warnings", []).append(text)
        cmds.setKeyframe = lambda plug, time, value: keys.setdefault(plug, []).append((time, value))
        cmds.objExists = lambda name: True
        cmds.setAttr = lambda plug, value: keys.setdefault(plug, value)
        mel = types.ModuleType("maya.mel")
        mel.eval = lambda text: 24.0
        self.run_script("x.maya.py", {"maya": types.ModuleType("maya"), "maya.cmds": cmds, "maya.mel": mel})
        self.assertEqual(len(keys["blend.jawOpen"]), FRAMES)
        for k, (time, value) in enumerate(keys["blend.jawOpen"]):
            self.assertAlmostEqual(time, 24 * k / 60, 5)
            self.assertAlmostEqual(value, weight("JawOpen", k), 5)
        self.assertNotIn("blend.other", keys)
        self.assertEqual(len(keys["warnings"]), len(shape_face.SHAPES) - 1)
        self.assertEqual(keys["phonomime_head.rotateOrder"], 2)
        self.assertAlmostEqual(keys["phonomime_head.rotateY"][20][1], math.degrees(0.2), 4)

    def test_the_blender_script_keys_every_shape(self):
        motion = write_weights(self.folder / "w.csv", ["jawOpen", "wink"])
        self.apply(motion, "-o", self.folder / "x.blender.py")
        curves = {}

        class Curve:
            def __init__(self, path):
                self.keyframe_points = self
                curves[path] = self

            def add(self, count):
                self.count = count

            def foreach_set(self, what, values):
                self.values = values

            def update(self):
                assert len(self.values) == 2 * self.count

        fcurves = types.SimpleNamespace(find=lambda path, index: None, new=lambda path, index: Curve(path))
        keys = types.SimpleNamespace(
            key_blocks={name: types.SimpleNamespace(slider_min=0.0) for name in ("jawOpen", "wink")},
            animation_data=types.SimpleNamespace(action=types.SimpleNamespace(fcurves=fcurves)))
        thing = types.SimpleNamespace(type="MESH", data=types.SimpleNamespace(shape_keys=keys))
        scene = types.SimpleNamespace(render=types.SimpleNamespace(fps=24, fps_base=1.0), objects=[thing], frame_end=1)
        bpy = types.ModuleType("bpy")
        bpy.context = types.SimpleNamespace(scene=scene)
        bpy.utils = types.SimpleNamespace(escape_identifier=lambda name: name)
        mathutils = types.ModuleType("mathutils")
        mathutils.Matrix = mathutils.Vector = None
        self.run_script("x.blender.py", {"bpy": bpy, "mathutils": mathutils})
        self.assertEqual(list(curves), ['key_blocks["jawOpen"].value', 'key_blocks["wink"].value'])
        pairs = curves['key_blocks["wink"].value'].values
        for k in range(FRAMES):
            self.assertAlmostEqual(pairs[2 * k], 1 + 24 * k / RATE_HZ, 4)
            self.assertAlmostEqual(pairs[2 * k + 1], weight("wink", k), 5)
        self.assertEqual(scene.frame_end, math.ceil(1 + 24 * (FRAMES - 1) / RATE_HZ))

    def run_script(self, name, modules):
        """The script where these modules stand in for the program's."""
        if "maya" in modules:
            modules["maya"].cmds, modules["maya"].mel = modules["maya.cmds"], modules["maya.mel"]
        for module, stand_in in modules.items():
            self.addCleanup(sys.modules.pop, module)
            sys.modules[module] = stand_in
        path = self.folder / name
        exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), {"__name__": "__main__"})

    # Calls that cannot be

    def test_bad_calls(self):
        motion = write_weights(self.folder / "w.csv", ["jawOpen"])
        markers = self.folder / "m.csv"
        markers.write_text("time,a_x,a_y,a_z\n0,1,2,3\n0.1,1,2,3\n")
        out = self.folder / "x.glb"
        cases = [
            (cli.USAGE, [motion, "-o", self.folder / "x.fbx"], ("x.fbx", ".maya.py")),
            (cli.USAGE, [motion, "-o", out, "--method", "fitt"], ("--method", '"fitt"', 'Did you mean "fit"')),
            (cli.USAGE, [motion, "-o", out, "--fps", "0.5"], ("--fps", "1 to 1000")),
            (cli.USAGE, [motion, "-o", out, "--filter", "2"], ("--filter", "0 to 1")),
            (cli.USAGE, [motion, "-o", out, "--audio", "x.wav"], ("--audio", ".html")),
            (cli.USAGE, [markers, "-o", out], ("m.csv", "--db")),
            (cli.USAGE, [markers, "-o", out, "--method", "weights"], ("--method", "markers")),
            (cli.IO, [self.folder / "none.csv", "-o", out], ("none.csv",)),
        ]
        for status, arguments, words in cases:
            with self.subTest(" ".join(map(str, arguments))):
                self.assertRefused(status, words, "retarget", "apply", *arguments, "--face", self.face)
        self.assertRefused(cli.IO, ["nowhere"], "retarget", "list", self.folder / "nowhere")


class RetargetedPageTest(cli.CliTest):
    def test_three_shows_the_shapes_at_their_times(self):
        """three.js in headless Chromium, in Phonomime's page."""
        driver = BROWSER_DIR / "drive.mjs"
        if not driver.is_file() or not os.environ.get("PHONOMIME_PLAYER_HTML"):
            self.skipTest("skipped: the browser driver is missing (target phonomime_browser)")
        face = shape_face.write(self.folder / "face")
        motion = write_weights(self.folder / "w.csv", ["jawOpen", "mouthSmile_L"])
        page = self.folder / "x.html"
        cli.run_well("retarget", "apply", motion, "--face", face, "-o", page, self.folder / "x.glb")
        result = subprocess.run(
            ["node", driver, page, pathlib.Path(__file__).with_name("retarget_page.mjs")], text=True,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False, timeout=cli.TIME_LIMIT_S)
        if result.returncode == 77:
            self.skipTest(f"skipped: {result.stderr.strip()}")
        self.assertEqual(result.returncode, 0, result.stderr)
        glb = read_glb.Glb((self.folder / "x.glb").read_bytes())
        found = cli.json.loads(result.stdout)
        self.assertGreater(len(found), 2)
        for time, places in found.items():
            expected = read_glb.vertices(glb, float(time))
            for vertex, place in places.items():
                for axis in range(3):
                    self.assertAlmostEqual(place[axis], expected[3 * int(vertex) + axis], 2)


class RetargetMarkersTest(cli.DatabaseTest):
    def setUp(self):
        super().setUp()
        self.face = shape_face.write(self.folder / "face")
        self.transcript = cli.write_transcript(self.folder / "hello.lab", "b aa m iy p ow".split())
        self.motion = self.folder / "hello.csv"
        cli.run_well("synth", "--db", self.database, self.transcript, "-o", self.motion)

    def apply(self, *arguments):
        return ["retarget", "apply", self.motion, "--db", self.database, "--face", self.face, *arguments]

    def follows_the_lips(self, table):
        """Correlation of the jaw's weight and the lips' opening, as far as the weight goes."""
        weights = [float(row["jawOpen"]) for row in read_table(table)]
        openings = [max(0.0, float(row["lip_up_y"]) - float(row["lip_lo_y"])) for row in read_table(self.motion)]
        self.assertLessEqual(abs(len(weights) - len(openings)), 1)
        self.assertTrue(all(0.0 <= weight <= 1.0 for weight in weights))
        widest = min((opening for weight, opening in zip(weights, openings) if weight > 0.95), default=max(openings))
        return correlation(weights[:len(openings)], [min(opening, widest) for opening in openings[:len(weights)]])

    def test_shapes_are_fitted_to_markers(self):
        """The opening of the lips is the jaw's weight."""
        cli.run_well(*self.apply("-o", self.folder / "x.csv", "--method", "fit"))
        self.assertGreater(self.follows_the_lips(self.folder / "x.csv"), 0.95)

    def test_equations_and_proposed_pairs_follow_the_jaw_too(self):
        pairs = self.folder / "pairs.tsv"
        report = cli.run_json("retarget", "references", self.database, "--face", self.face, "-o", pairs)
        lines = pairs.read_text().splitlines()
        self.assertEqual(len(lines), 1 + report["frames"])
        self.assertEqual(report["coverage"]["classes_met"], report["coverage"]["classes"])
        keys = {node["key"] for node in cli.run_json("nodes", self.database)}
        self.assertLessEqual({line.split("@")[0] for line in lines[1:]}, keys)
        for method in (["equations"], ["cross", "--pairs", pairs]):
            cli.run_well(*self.apply("-o", self.folder / "x.csv", "--method", *method))
            self.assertGreater(self.follows_the_lips(self.folder / "x.csv"), 0.9, method)

    def test_what_cross_mapping_is_given_wrongly(self):
        pairs = self.folder / "pairs.tsv"
        out = ["-o", self.folder / "x.csv", "--method"]
        self.assertRefused(cli.USAGE, ["--pairs", "retarget references"], *self.apply(*out, "cross"))
        self.assertRefused(cli.USAGE, ["--pairs", "cross"], *self.apply(*out, "fit", "--pairs", pairs))
        key = cli.run_json("nodes", self.database)[0]["key"]
        for text, said in ((f"frame\tjawOpne\n{key}@0\t1\n", ["jawOpne", "jawOpen"]),
                           (f"frame\tjawOpen\n{key}@9\t1\n", ["pairs.tsv:2", "outside the motion node"]),
                           ("frame\tjawOpen\nnobody#1@0\t1\n", ["pairs.tsv:2", "nobody#1"])):
            pairs.write_text(text)
            self.assertRefused(cli.BAD_INPUT, said, *self.apply(*out, "cross", "--pairs", pairs))

    def test_a_table_that_points_outside_the_mesh(self):
        table = self.face / "markers.tsv"
        table.write_text(table.read_text().replace("chin\t", "chin\t99"))
        self.assertRefused(cli.BAD_INPUT, ["markers.tsv", '"chin"', "vertex"], *self.apply("-o", self.folder / "x.glb"))
        table.unlink()
        self.assertRefused(cli.BAD_INPUT, ["face.glb", "markers.tsv"], *self.apply("-o", self.folder / "x.glb"))

    def test_a_mesh_that_is_no_face(self):
        places, triangles = shape_face.read_mask(tiny_corpus.write_face(self.folder / "mask"))
        flat = [[0.0, 0.0, 0.001 * i] for i in range(len(places))]
        (self.face / "face.glb").write_bytes(
            shape_face.glb_bytes(flat, triangles, {"jawOpen": shape_face.offsets(places, "jawOpen")}))
        self.assertRefused(cli.BAD_INPUT, ["face.glb", "do not have the shape of the markers"], *self.apply("-o", self.folder / "x.glb"))


def correlation(a, b):
    mean_a, mean_b = sum(a) / len(a), sum(b) / len(b)
    both = sum((x - mean_a) * (y - mean_b) for x, y in zip(a, b))
    return both / math.sqrt(sum((x - mean_a) ** 2 for x in a) * sum((y - mean_b) ** 2 for y in b))


if __name__ == "__main__":
    cli.main()
