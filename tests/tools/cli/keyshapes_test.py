# SPDX-License-Identifier: GPL-3.0-or-later
"""phonomime retarget keyshapes: what is chosen, what a rig's target does, what is said of a bad one."""
import csv
import json
import math
import re
import statistics
import struct
import sys

import phonomime_cli as cli
import shape_face
import tiny_corpus

sys.path.insert(0, str(cli.SOURCE_DIR / "tests/synth/export"))
import read_glb  # noqa: E402  by the specification alone


class KeyshapesTest(cli.DatabaseTest):
    CORPUS = {"emotions": ("neutral", "happiness"), "sentences": 8}

    def select(self, *arguments):
        self.keys = self.folder / "keys"
        return cli.run_json("retarget", "keyshapes", "select", self.database, "-o", self.keys, *arguments)

    def rows(self, path):
        with open(path, newline="") as file:
            return list(csv.DictReader(file))

    def fill(self, **members):
        """The rig with what `members` (a function of each keyshape's row) say of each keyshape."""
        rig = json.loads((self.keys / "rig.json").read_text())
        rows = self.rows(self.keys / "keyshapes.csv")
        for group in rig["sets"]:
            for keyshape in group["keyshapes"]:
                for name, member in members.items():
                    keyshape[name] = member(rows[keyshape["source"]], keyshape)
        (self.keys / "rig.json").write_text(json.dumps(rig))
        return rig

    def apply(self, motion, *outputs):
        return cli.run_json("retarget", "keyshapes", "apply", motion, "--db", self.database, "--rig",
                            self.keys / "rig.json", "-o", *outputs)

    def test_a_keyshape_is_decomposed_into_itself(self):
        report = self.select("-n", 4)
        names = [keyshape["name"] for keyshape in report["sets"][0]["keyshapes"]]
        self.assertEqual(len(names), 4)
        self.fill(weights=lambda row, keyshape: {keyshape["name"]: 1})
        # Each keyshape held for a while: its own weight is 1, the others' 0.
        rows = self.rows(self.keys / "keyshapes.csv")
        for chosen, row in enumerate(rows):
            held = self.folder / "held.csv"
            with open(held, "w", newline="") as file:
                writer = csv.DictWriter(file, row.keys(), lineterminator="\n")
                writer.writeheader()
                for frame in range(40):
                    writer.writerow(row | {"time": frame / 100})
            out = self.folder / "out.csv"
            self.apply(held, out)
            for frame in self.rows(out)[5:35]:
                for place, name in enumerate(names):
                    self.assertAlmostEqual(float(frame[name]), float(place == chosen), delta=0.02)

    def test_error_falls_with_the_number(self):
        for group in self.select("-n", 10, "--by-emotion")["sets"]:
            errors = [point["mean_square"] for point in group["curves"][0]["errors"]]
            self.assertEqual(errors, sorted(errors, reverse=True))
            self.assertTrue((self.keys / f"errors_{group['expression']}_face.svg").exists())

    def test_a_drawing_moves(self):
        self.select("-n", 3, "--target", "drawing")
        def draw(height):
            return f'<svg xmlns="http://www.w3.org/2000/svg"><ellipse cx="5" cy="5" rx="3" ry="{height}"/></svg>'
        (self.keys / "rest.svg").write_text(draw(0))
        for place in range(3):
            (self.keys / f"drawn_k{place:02}.svg").write_text(draw(place + 1))
        motion = self.folder / "motion.csv"
        cli.run_well("synth", "--db", self.database,
                     cli.write_transcript(self.folder / "hello.lab", ["b", "aa", "m"]), "-o", motion)
        self.apply(motion, self.folder / "out.svg")
        text = (self.folder / "out.svg").read_text()
        heights = re.search(r"'ry',\[(.*?)\]", text)[1].replace("'", "").split(",")
        self.assertGreater(len(set(heights)), 3)
        (self.keys / "drawn_k01.svg").write_text(draw(1).replace("ellipse", "circle"))
        self.assertRefused(cli.BAD_INPUT, ["drawn_k01.svg", "built otherwise"], "retarget", "keyshapes", "apply", motion,
                           "--db", self.database, "--rig", self.keys / "rig.json", "-o", self.folder / "no.svg")
        self.assertFalse((self.folder / "no.svg").exists())

    def test_same_bytes(self):
        self.select("-n", 4, "--method", "clusters")
        before = cli.contents(self.keys)
        self.select("-n", 4, "--method", "clusters")
        self.assertEqual(cli.contents(self.keys), before)

    def speak(self, *phonemes):
        motion = self.folder / "motion.csv"
        transcript = cli.write_transcript(self.folder / "hello.lab", phonemes or "b aa m iy p ow".split())
        cli.run_well("synth", "--db", self.database, transcript, "-o", motion, "--fps", 50)
        return motion

    def test_a_face_has_a_rig_as_fitted_and_moves_by_it(self):
        face = shape_face.write(self.folder / "face")
        report = self.select("-n", 6, "--face", face)
        self.assertTrue(report["fitted"])
        for keyshape in report["sets"][0]["keyshapes"]:
            self.assertEqual((self.keys / f"{keyshape['name']}.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        motion = self.speak()
        rig = ["--db", self.database, "--rig", self.keys / "rig.json", "--fps", 50]
        out, table = self.folder / "out.csv", self.folder / "table.csv"
        told = cli.run_json("retarget", "apply", motion, "--face", face, "--method", "keyshapes", *rig, "-o", out,
                            self.folder / "out.glb")
        self.assertEqual((told["method"], told["figures"]["keyshapes"]), ("keyshapes", 6))
        openings = [max(0.0, float(row["lip_up_y"]) - float(row["lip_lo_y"])) for row in self.rows(motion)]
        jaw = [float(row["jawOpen"]) for row in self.rows(out)]
        self.assertLessEqual(abs(len(jaw) - len(openings)), 1)
        self.assertGreater(statistics.correlation(jaw[:len(openings)], openings[:len(jaw)]), 0.9)
        cli.run_well("retarget", "keyshapes", "apply", motion, *rig, "-o", table)
        for one, other in zip(self.rows(out), self.rows(table)):
            for name in other:
                self.assertAlmostEqual(float(one[name]), float(other[name]), 5)
        smooth = self.folder / "smooth.csv"
        cli.run_well("retarget", "apply", motion, "--face", face, "--method", "keyshapes", *rig, "-o", smooth,
                     "--smoothness", 3)
        def roughness(path):
            values = [float(row["jawOpen"]) for row in self.rows(path)]
            return sum((b - a) ** 2 for a, b in zip(values, values[1:]))
        self.assertLess(roughness(smooth), 0.8 * roughness(out))

    def test_a_mesh_is_its_rest_and_what_its_keyshapes_add(self):
        """Of the written file, by the specification, at sampled times."""
        self.select("-n", 4, "--target", "mesh", "--face", tiny_corpus.write_face(self.folder / "face"))
        mesh, table = self.folder / "out.glb", self.folder / "out.csv"
        self.assertEqual(self.apply(self.speak(), mesh, table)["target"], "mesh")
        self.assertGreater((self.keys / "rest.glb").stat().st_size, 1000)
        poses = {name: read_glb.vertices(read_glb.Glb((self.keys / f"{name}.glb").read_bytes()), 0)
                 for name in ("rest", "k00", "k01", "k02", "k03")}
        glb = read_glb.Glb(mesh.read_bytes())
        rows, moved = self.rows(table), 0.0
        for row in rows[:: len(rows) // 7]:
            expected = list(poses["rest"])
            for name in ("k00", "k01", "k02", "k03"):
                weight = float(row[f"neutral/face/{name}"])
                expected = [e + weight * (k - r) for e, k, r in zip(expected, poses[name], poses["rest"])]
            found = read_glb.vertices(glb, float(row["time"]))
            self.assertLess(max(abs(a - b) for a, b in zip(found, expected)), 5e-3)
            moved = max(moved, max(abs(a - b) for a, b in zip(found, poses["rest"])))
        self.assertGreater(moved, 2.0)

    def test_a_figure_turns_its_jaw(self):
        self.select("-n", 4, "--target", "joints")
        document = {"asset": {"version": "2.0"}, "nodes": [{"name": "skull", "children": [1]}, {"name": "jaw"}],
                    "scenes": [{"nodes": [0]}], "scene": 0}
        text = json.dumps(document).encode().ljust(132)
        (self.keys / "rest.glb").write_bytes(
            struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text), len(text), b"JSON") + text)
        def turned(row, keyshape):
            half = 0.02 * (float(row["lip_up_y"]) - float(row["lip_lo_y"]))
            return {"jaw": [math.sin(half), 0, 0, math.cos(half)]}
        self.fill(rotations=turned)
        self.apply(self.speak(), self.folder / "out.glb", self.folder / "out.csv")
        glb = read_glb.Glb((self.folder / "out.glb").read_bytes())
        sampler = glb.sampler(1, "rotation")
        for row in self.rows(self.folder / "out.csv"):
            quaternion = read_glb.sample(sampler, 4, float(row["time"]), True)
            for value, part in zip(quaternion, "xyzw"):
                self.assertAlmostEqual(value, float(row[f"jaw_q{part}"]), 3)  # times have four decimals
        self.assertGreater(max(sampler[1][0::4]) - min(sampler[1][0::4]), 0.02)

    def test_expressions_are_blended_by_the_track(self):
        """T5.1, also of a mixture."""
        self.select("-n", 3, "--by-emotion")
        self.fill(weights=lambda row, keyshape: {keyshape["name"]: 1})
        motion, track = self.speak(), self.folder / "track.txt"
        track.write_text("0 9 happiness 0.4\n")
        out = self.folder / "out.csv"
        weights = {}
        for name, words in (("neutral", []), ("happiness", ["--emotion", "happiness"]),
                            ("track", ["--emotions", track]), ("half", ["--emotion", "happiness:0.5"])):
            cli.run_well("retarget", "keyshapes", "apply", motion, "--db", self.database, "--rig",
                         self.keys / "rig.json", "-o", out, *words)
            weights[name] = [[float(value) for key, value in row.items() if key != "time"] for row in self.rows(out)]
        for share, name in ((0.4, "track"), (0.5, "half")):
            for calm, happy, mixed in zip(weights["neutral"], weights["happiness"], weights[name]):
                for a, b, found in zip(calm, happy, mixed):
                    self.assertAlmostEqual(found, (1 - share) * a + share * b, 5)
        self.assertRefused(cli.BAD_INPUT, ['"happines"', "happiness, neutral", 'Did you mean "happiness"'], "retarget",
                           "keyshapes", "apply", motion, "--db", self.database, "--rig", self.keys / "rig.json",
                           "-o", out, "--emotion", "happines")

    def test_contrary_poses_are_pointed_out(self):
        self.select("-n", 3)
        rig = self.fill(weights=lambda row, keyshape: {"ears": int(keyshape["source"] == 0)})
        self.assertEqual(cli.run_json(*self.onto_ears())["conflicts"], [])
        keyshapes = rig["sets"][0]["keyshapes"]  # the first is an end of the first axis
        keyshapes.append(keyshapes[0] | {"name": "twin", "weights": {"ears": -1}})
        (self.keys / "rig.json").write_text(json.dumps(rig))
        conflicts = cli.run_json(*self.onto_ears())["conflicts"]
        self.assertTrue(conflicts)
        for conflict in conflicts:
            self.assertEqual(conflict["value"], "ears")
            self.assertIn("twin", [conflict[end] for end in ("from", "to", "other_from", "other_to")])
        self.assertRegex(cli.run_well(*self.onto_ears()), r"neutral, face: from \w+ to \w+ and from \w+ to \w+ the source changes "
                                              r"alike \(cosine [01]\.\d\d\), the target contrarily \(-[01]\.\d\d\), "
                                              r"most of all ears\n")

    def onto_ears(self):
        return ["retarget", "keyshapes", "apply", self.speak(), "--db", self.database, "--rig", self.keys / "rig.json",
                "-o", self.folder / "out.csv"]

    def test_bad_calls(self):
        self.select("-n", 3)
        motion, rig, out = self.speak(), self.keys / "rig.json", self.folder / "out.csv"
        select = ["retarget", "keyshapes", "select", self.database, "-o", self.folder / "more"]
        apply = ["retarget", "keyshapes", "apply", motion, "--db", self.database, "--rig", rig]
        face = shape_face.write(self.folder / "face")
        onto = ["retarget", "apply", motion, "--db", self.database, "--face", face, "-o", out]
        source = self.keys / "keyshapes.csv"
        cases = [
            (cli.USAGE, [*select, "-n", 0], ["1 to 1000"]),
            (cli.USAGE, [*select, "--method", "hul"], ["--method", 'Did you mean "hull"']),
            (cli.USAGE, [*select, "--target", "joint"], ["--target", 'Did you mean "joints"']),
            (cli.USAGE, [*select, "--parts", "face", "face"], ["--parts", "twice"]),
            (cli.BAD_INPUT, [*select, "--parts", "lowr"], ['"lowr"', 'Did you mean "lower"']),
            (cli.USAGE, ["retarget", "keyshapes", "selekt"], ["selekt", "select"]),
            (cli.USAGE, [*apply, "-o", self.folder / "x.svg"], ["x.svg", "retarget apply"]),
            (cli.USAGE, [*apply, "-o", out, "--smoothness", -1], ["smoothness"]),
            (cli.USAGE, [*apply, "-o", out, "--filter", 2], ["--filter", "0 to 1"]),
            (cli.IO, [*apply[:-1], self.folder / "none.json", "-o", out], ["none.json"]),
            (cli.USAGE, [*onto, "--method", "keyshapes"], ["--rig", "retarget keyshapes select"]),
            (cli.USAGE, [*onto, "--rig", rig], ["--rig", "keyshapes"]),
            (cli.USAGE, [*onto, "--emotion", "happiness"], ["--emotion", "keyshapes"]),
            (cli.USAGE, [*onto, "--dimensions", 3], ["--dimensions", "cross"]),
            (cli.USAGE, [*onto, "--method", "equations", "--ridge", 1], ["--ridge", "fit or keyshapes"]),
        ]
        for status, call, words in cases:
            with self.subTest(" ".join(map(str, call))):
                self.assertRefused(status, words, *call)
        self.fill(weights=lambda row, keyshape: {"jawOpne": 1})
        self.assertRefused(cli.BAD_INPUT, ["rig.json", '"jawOpne"', 'Did you mean "jawOpen"'], *onto, "--method",
                           "keyshapes", "--rig", rig)
        source.write_text(source.read_text().replace("lip_up_", "lip_upp_"))
        self.assertRefused(cli.BAD_INPUT, ["keyshapes.csv", '"lip_up"', "lip_upp"], *apply, "-o", out)


if __name__ == "__main__":
    cli.main()
