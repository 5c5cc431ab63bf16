# SPDX-License-Identifier: GPL-3.0-or-later
"""Asking for a recorded sentence, with its own timing, gives the recording back."""
import csv
import json
import math
import sqlite3
import struct
import sys

import phonomime_cli as cli

sys.path.insert(0, str(cli.SOURCE_DIR / "tests/support"))
import read_c3d

SILENCE = ("pau", "sil", "sp", "")
SENTENCES = 24
RATE_HZ = 100
# Markers of the lips, jaw, cheeks and nose: the distances between them do not know where the head is.
MARKERS = ("lm61", "lm291", "lm0", "lm17", "lm13", "lm14", "lm152", "lm78", "lm308", "lm205", "lm425", "lm1")


def read_recording(path):
    """Rate, and the markers of each frame: {name: (x, y, z)}, without those that are missing."""
    recording = read_c3d.read(path)
    return recording.rate_hz, [{name: point for name, (*point, residual) in zip(recording.names, frame) if residual >= 0}
                               for frame in recording.frames]


def read_motion(path, names):
    """These markers of each frame of a marker CSV."""
    with open(path, newline="") as file:
        header, *rows = csv.reader(file)
    at = {name: header.index(f"{name}_x") for name in names}
    return [{name: tuple(map(float, row[i:i + 3])) for name, i in at.items()} for row in rows]


def head_size(frame, names):
    """Root mean square distance of markers from their centroid."""
    centre = [sum(frame[name][axis] for name in names) / len(names) for axis in range(3)]
    return math.sqrt(sum(math.dist(frame[name], centre) ** 2 for name in names) / len(names))


def squared_errors_mm(made, recorded, rigid):
    """Of the distance of each pair of markers; none where one of them is missing in the recording. One
    camera made the recordings: the head's size there is not that of the database (--scale)."""
    names = [name for name in MARKERS if name in recorded]
    there = [name for name in rigid if name in recorded]
    size = head_size(made, there) / head_size(recorded, there)
    return [(math.dist(made[a], made[b]) - size * math.dist(recorded[a], recorded[b])) ** 2
            for i, a in enumerate(names) for b in names[:i]]


def root_mean(squares):
    return math.sqrt(sum(squares) / len(squares))


def pca_error_mm(database):
    """RMS of the distance of two markers that the PCA leaves out: the variance not explained is spread
    over the channels, and a distance changes with one channel of either marker."""
    connection = sqlite3.connect(f"file:{database}?mode=ro", uri=True)
    total, variance, mean = connection.execute("SELECT total_variance, variance, mean FROM pca").fetchone()
    connection.close()
    explained = sum(struct.unpack(f"<{len(variance) // 8}d", variance))
    return math.sqrt(2 * (total - explained) / (len(mean) // 8))


@cli.needs_shared_data
class ResynthesisTest(cli.RecordingsTest):
    @classmethod
    def setUpClass(cls):
        """Sentences without a silence inside, a gap or a suspect, spread over the corpus."""
        super().setUpClass()
        spoilt = {node["sentence"] for flag in ("--gaps", "--suspect")
                  for node in cli.run_json("nodes", cls.database, flag)}
        whole = []
        for path in sorted((cli.SHARED_DATA / "grid_s1/alignment").glob("*.lab")):
            inner = [label for _, label in cli.read_lab(path)[1:-1]]
            if path.stem not in spoilt and not set(inner) & set(SILENCE):
                whole.append(path)
        cls.sentences = whole[:: len(whole) // SENTENCES][:SENTENCES]
        cls.outputs = {}
        for path in cls.sentences:
            motion, result = (cls.folder / f"{path.stem}.{kind}" for kind in ("csv", "json"))
            cli.run_well("synth", "--db", cls.database, path, "--fps", RATE_HZ, "-o", motion, "-o", result)
            cls.outputs[path] = motion, json.loads(result.read_text())

    def test_there_are_sentences_enough(self):
        self.assertGreaterEqual(len(self.sentences), 20)
        self.assertEqual(cli.run_json("info", self.database)["rate"], RATE_HZ)

    def test_its_own_nodes_come_back_all_joins_captured(self):
        for path, (_, result) in self.outputs.items():
            with self.subTest(path.stem):
                spoken = result["path"][1:-1]
                self.assertEqual([row["node"] for row in spoken],
                                 [f"s1/neutral/{path.stem}#{row['index']}" for row in spoken])
                self.assertEqual([row["captured"] for row in spoken], [False] + [True] * (len(spoken) - 1))
                self.assertEqual(result["cost"], 0)
                self.assertEqual(result["blend"], [])

    def test_the_motion_is_the_recorded_one(self):
        """At the recorded frames that the phonemes hold, to twice what the PCA leaves out (E11)."""
        left_out_mm = pca_error_mm(self.database)
        bound_mm = 2 * left_out_mm
        rigid = cli.rigid_markers(cli.SHARED_DATA / "grid_s1")
        every, worst = [], 0.0
        for path, (motion, result) in self.outputs.items():
            rate, recorded = read_recording(cli.SHARED_DATA / f"grid_s1/motion/{path.stem}.c3d")
            made = read_motion(motion, {*MARKERS, *rigid})
            start, end = result["path"][1]["start"], result["path"][-2]["end"]
            spoken = [k for k in range(len(recorded)) if start <= k / rate < end]
            squares = [square for k in spoken
                       for square in squared_errors_mm(made[round(k / rate * RATE_HZ)], recorded[k], rigid)]
            self.assertGreater(len(squares), 500)
            every += squares
            worst = max(worst, root_mean(squares))
        print(f"\ndistances of markers: RMS {root_mean(every):.3f} mm over {len(self.outputs)} sentences, "
              f"worst sentence {worst:.3f} mm, the PCA alone {left_out_mm:.3f} mm")
        self.assertLess(root_mean(every), bound_mm)
        self.assertLess(worst, 1.5 * bound_mm)


if __name__ == "__main__":
    cli.main()
