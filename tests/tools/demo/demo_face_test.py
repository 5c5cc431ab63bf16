# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo face's 52 shapes do what ARKit says they do."""
import importlib.machinery
import importlib.util
import math
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

SOURCE_DIR = pathlib.Path(__file__).resolve().parents[3]
DATA = pathlib.Path(os.environ.get("PHONOMIME_SHARED_DATA", SOURCE_DIR.parent / "shared" / "data"))
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("make_demo_face", str(SOURCE_DIR / "tools/demo/make_demo_face"))
demo = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
loader.exec_module(demo)
sys.path.insert(0, str(SOURCE_DIR / "tests/synth/export"))
import read_glb  # noqa: E402

SHAPES = """eyeBlinkLeft eyeLookDownLeft eyeLookInLeft eyeLookOutLeft eyeLookUpLeft eyeSquintLeft eyeWideLeft
eyeBlinkRight eyeLookDownRight eyeLookInRight eyeLookOutRight eyeLookUpRight eyeSquintRight eyeWideRight jawForward
jawRight jawLeft jawOpen mouthClose mouthFunnel mouthPucker mouthRight mouthLeft mouthSmileLeft mouthSmileRight
mouthFrownLeft mouthFrownRight mouthDimpleLeft mouthDimpleRight mouthStretchLeft mouthStretchRight mouthRollLower
mouthRollUpper mouthShrugLower mouthShrugUpper mouthPressLeft mouthPressRight mouthLowerDownLeft mouthLowerDownRight
mouthUpperUpLeft mouthUpperUpRight browDownLeft browDownRight browInnerUp browOuterUpLeft browOuterUpRight cheekPuff
cheekSquintLeft cheekSquintRight noseSneerLeft noseSneerRight tongueOut""".split()


@unittest.skipUnless(DATA.is_dir(), "skipped: needs the recordings in ../shared/data, which are not here")
class DemoFaceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="phonomime_demo_face_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        shutil.copy(DATA / "faces/canonical/canonical_face_model.obj", cls.folder / "face.obj")
        shutil.copy(DATA / "faces/canonical/markers.tsv", cls.folder)
        cls.parts, cls.names, _ = demo.make(cls.folder)
        cls.skin = cls.parts[0]

    def place(self, vertex, **weights):
        place = self.skin.places[vertex]
        for name, share in weights.items():
            place = demo.add(place, self.skin.shapes[name][vertex], share)
        return place

    def test_all_of_arkits_names(self):
        self.assertEqual(self.names, sorted(SHAPES))

    def test_lips_close_at_rest_and_with_mouth_close(self):
        for upper, lower in zip(demo.UPPER_INNER, demo.LOWER_INNER):
            self.assertLess(math.dist(self.place(upper), self.place(lower)), 1e-9)
            together = dict(jawOpen=1.0, mouthClose=1.0)
            self.assertLess(math.dist(self.place(upper, **together), self.place(lower, **together)), 1.0)

    def test_the_jaw_opens_the_mouth(self):
        opening = self.place(13, jawOpen=1.0)[1] - self.place(14, jawOpen=1.0)[1]
        self.assertTrue(15.0 < opening < 35.0, opening)
        self.assertLess(math.dist(self.place(4), self.place(4, jawOpen=1.0)), 0.5)  # not the nose
        self.assertLess(self.place(152, jawOpen=1.0)[1], self.place(152)[1] - 15.0)

    def test_a_blink_shuts_the_eye_and_leaves_the_other(self):
        for side, (upper, lower) in demo.EYES.items():
            other = demo.EYES["Left" if side == "Right" else "Right"]
            for u, l in zip(upper[1:-1], lower[1:-1]):
                blink = {"eyeBlink" + side: 1.0}
                self.assertLess(self.place(u, **blink)[1] - self.place(l, **blink)[1], 1.0)
            for v in other[0] + other[1]:
                self.assertEqual(self.place(v, **blink), self.place(v))

    def test_sides(self):
        """Shapes of a side move that side, and those of the other mirror them."""
        open_lips = demo.read_face(self.folder).places  # where no two vertices are at one place
        at = {(round(-x, 3), round(y, 3), round(z, 3)): v for v, (x, y, z) in enumerate(open_lips)}
        mirrored = [at.get(tuple(round(c, 3) for c in place)) for place in open_lips]
        self.assertGreater(sum(v is not None for v in mirrored), 400)
        for name in SHAPES:
            if not name.endswith("Left"):
                continue
            left, right = self.skin.shapes[name], self.skin.shapes[name[:-4] + "Right"]
            for v, twin in enumerate(mirrored):
                if twin is not None:
                    x, y, z = right[twin]
                    self.assertLess(math.dist(left[v], (-x, y, z)), 0.4, (name, v))
            if name not in ("jawLeft", "mouthLeft"):
                whole = sum(map(demo.length, left))
                on_left = sum(demo.length(o) for o, p in zip(left, self.skin.places) if p[0] > 0)
                self.assertGreater(on_left, 0.7 * whole, name)

    def test_directions(self):
        left = lambda name, v: demo.subtract(self.place(v, **{name: 1.0}), self.place(v))
        self.assertGreater(left("mouthSmileLeft", 291)[1], 5.0)
        self.assertLess(left("mouthFrownLeft", 291)[1], -5.0)
        self.assertGreater(left("mouthStretchLeft", 291)[0], 5.0)
        self.assertGreater(left("mouthLeft", 13)[0], 5.0)
        self.assertLess(left("mouthPucker", 291)[0], -5.0)
        self.assertGreater(left("mouthPucker", 0)[2], 4.0)
        self.assertGreater(left("browInnerUp", 336)[1], 5.0)
        self.assertLess(left("browDownLeft", 336)[1], -4.0)
        self.assertGreater(left("jawForward", 152)[2], 3.0)
        iris = next(part for part in self.parts if part.name == "iris")  # of the left eye
        ahead = max(range(len(iris.places)), key=lambda v: iris.places[v][2])
        self.assertGreater(iris.shapes["eyeLookOutLeft"][ahead][0], 3.0)
        self.assertGreater(iris.shapes["eyeLookUpLeft"][ahead][1], 3.0)
        tongue = next(part for part in self.parts if part.name == "tongue")
        self.assertGreater(max(offset[2] for offset in tongue.shapes["tongueOut"]), 25.0)

    def test_the_file(self):
        out = self.folder / "out/face.glb"
        self.assertEqual(self.run_main(out), 0)
        first = out.read_bytes()
        glb = read_glb.Glb(first)
        mesh = glb.json["meshes"][0]
        self.assertEqual(mesh["extras"]["targetNames"], sorted(SHAPES))
        self.assertEqual({len(p["targets"]) for p in mesh["primitives"]}, {52})
        self.assertEqual(glb.json["accessors"][mesh["primitives"][0]["attributes"]["POSITION"]]["count"], 468)
        places = glb.numbers(mesh["primitives"][0]["attributes"]["POSITION"])
        for i, value in enumerate(places):
            self.assertAlmostEqual(1000 * value, self.skin.places[i // 3][i % 3], 3)
        self.run_main(out)
        self.assertEqual(out.read_bytes(), first)

    def run_main(self, out):
        keep, sys.argv = sys.argv, ["make_demo_face", str(self.folder), str(out)]
        try:
            return demo.main()
        finally:
            sys.argv = keep


if __name__ == "__main__":
    program = unittest.main(exit=False, verbosity=2)
    if not program.result.wasSuccessful():
        sys.exit(1)
    sys.exit(77 if not DATA.is_dir() else 0)
