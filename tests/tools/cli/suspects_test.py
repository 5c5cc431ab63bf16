# SPDX-License-Identifier: GPL-3.0-or-later
"""`phonomime suspects`: faults that were planted in real recordings are found, the rest is left in peace.

docs/curation.md says by which sentences the limits were chosen; faults are planted here in the others.
"""
import csv
import io
import math
import unittest
import zlib

import phonomime_cli
import plant_faults
import tiny_corpus
from phonomime_cli import BAD_INPUT, IO, SHARED_DATA, USAGE, run, run_json, run_well

STORED_HZ = 100
NEAR_S = 0.08  # of a fault: neither clean nor sure to be spoilt


def is_other_half(sentence):
    return zlib.crc32(sentence.encode()) & 1 == 1


def stored_frames(start_s, end_s):
    return range(math.ceil(start_s * STORED_HZ - 1e-6), math.ceil(end_s * STORED_HZ - 1e-6))


@phonomime_cli.needs_shared_data
class PlantedFaultsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = phonomime_cli.scratch_folder(cls.addClassCleanup)
        cls.faults = plant_faults.plant(SHARED_DATA / "grid_s1", cls.folder / "corpus", is_other_half, seed=7)
        cls.database = cls.folder / "planted.db"
        cls.report = run_json("import", cls.folder / "corpus", "--db", cls.database)
        cls.nodes = [n for n in run_json("nodes", cls.database) if not n["has_gap"]]
        cls.suspects = {s["key"]: s for s in run_json("suspects", cls.database)}

    def spoilt(self, fault):
        """Nodes with a stored frame at or between the recorded frames that were changed."""
        frames = set(stored_frames(fault.first_s, fault.last_s + 0.5 / STORED_HZ))
        return [n for n in self.nodes if n["sentence"] == fault.sentence
                and frames.intersection(stored_frames(n["start"], n["end"]))]

    def recall(self, kind, names_marker=False):
        found = missed = 0
        for fault in self.faults:
            if fault.kind == kind:
                for node in self.spoilt(fault):
                    suspect = self.suspects.get(node["key"])
                    groups = {g for mark in suspect["marks"] for g in mark["groups"]} if suspect else set()
                    good = bool(groups & set(fault.markers)) if names_marker else suspect is not None
                    found, missed = found + good, missed + (not good)
        self.assertGreater(found + missed, 60, kind)
        return found / (found + missed)

    def test_what_the_planting_is_worth(self):
        """Enough faults of each kind to measure a recall of 0.95 by."""
        self.assertGreater(len(self.faults), 250)
        self.assertFalse(any(not is_other_half(f.sentence) for f in self.faults))

    def test_swaps_jumps_and_freezes_are_found(self):
        recalls = {kind: self.recall(kind) for kind in plant_faults.KINDS}
        print("recall", {kind: round(value, 4) for kind, value in recalls.items()})
        for kind in ("swap", "jump", "freeze"):
            self.assertGreaterEqual(recalls[kind], 0.95, kind)
        self.assertGreaterEqual(recalls["drift"], 0.9)

    def test_the_marker_at_fault_is_named(self):
        for kind in plant_faults.KINDS:
            self.assertGreaterEqual(self.recall(kind, names_marker=True), 0.9, kind)

    def test_clean_nodes_are_left_in_peace(self):
        by_sentence = {fault.sentence: fault for fault in self.faults}
        clean = alarms = 0
        for node in self.nodes:
            fault = by_sentence.get(node["sentence"])
            if not fault or node["end"] < fault.first_s - NEAR_S or node["start"] > fault.last_s + NEAR_S:
                clean += 1
                alarms += node["key"] in self.suspects
        print(f"false alarms {alarms} of {clean}")
        self.assertGreater(clean, 10000)
        self.assertLessEqual(alarms, 0.01 * clean)

    def test_the_worst_come_first(self):
        scores = [s["score"] for s in self.suspects.values()]
        self.assertEqual(scores, sorted(scores, reverse=True))
        self.assertGreaterEqual(min(scores), 1.0)
        for suspect in self.suspects.values():
            self.assertEqual(suspect["score"], max(mark["score"] for mark in suspect["marks"]))

    def test_import_and_suspects_say_the_same(self):
        told = {}
        for suspect in self.suspects.values():
            for reason in {mark["reason"] for mark in suspect["marks"]}:
                told[reason] = told.get(reason, 0) + 1
        reported = {reason: count for reason, count in self.report["suspects"].items() if count}
        self.assertEqual(told, reported)
        again = {s["key"]: s for s in run_json("suspects", self.database, "--judge")}
        self.assertEqual(again, self.suspects)
        listed = {n["key"] for n in run_json("nodes", self.database, "--suspect")}
        self.assertEqual(listed, set(self.suspects))

    def test_marks_lie_where_the_fault_is(self):
        for fault in self.faults:
            if fault.kind != "jump":
                continue
            for node in self.spoilt(fault):
                marks = [m for m in self.suspects.get(node["key"], {"marks": []})["marks"] if m["reason"] == "jump"]
                for mark in marks:
                    if set(mark["groups"]) & set(fault.markers):
                        self.assertLess(mark["start"], fault.last_s + 0.05)
                        self.assertGreater(mark["end"], fault.first_s - 0.05)


class SuspectsVerbTest(phonomime_cli.DatabaseTest):
    """A corpus in which one marker jumps in one sentence."""

    @classmethod
    def setUpClass(cls):
        folder = phonomime_cli.scratch_folder(cls.addClassCleanup)
        corpus = tiny_corpus.Corpus(folder / "corpus", sentences=12)
        spoilt = corpus.sentences[3]
        frames = [list(frame) for frame in tiny_corpus.motion_frames(spoilt.rows, seed=spoilt.seed)]
        lip = list(tiny_corpus.MARKERS).index("corner_r")
        for k in range(40, 44):
            x, y, z = frames[k][lip]
            frames[k][lip] = (x, y + 9.0, z)
        spoilt.motion = tiny_corpus.c3d_bytes(list(tiny_corpus.MARKERS), frames)
        run_well("import", corpus.write(), "--db", folder / "made.db")
        cls.made, cls.sentence = (folder / "made.db").read_bytes(), spoilt.id

    def test_the_jump_is_told_with_its_figures(self):
        suspects = run_json("suspects", self.database, "--reason", "jump")
        self.assertTrue(suspects)
        for suspect in suspects:
            self.assertEqual(suspect["sentence"], self.sentence)
        mark = next(m for m in suspects[0]["marks"] if m["reason"] == "jump")
        self.assertIn("corner_r", mark["groups"])
        self.assertIn("corner_r", mark["text"])
        self.assertIn(" mm", mark["text"])
        self.assertIn("limit", mark["text"])
        self.assertEqual(run_json("suspects", self.database, "--reason", "swapped"), [])

    def test_filters_limit_and_forms_agree(self):
        every = run_json("suspects", self.database)
        keys = [s["key"] for s in every]
        self.assertEqual(run_well("suspects", self.database, "--keys").split(), keys)
        self.assertEqual([s["key"] for s in run_json("suspects", self.database, "--limit", 1)], keys[:1])
        phoneme = every[0]["phoneme"]
        self.assertEqual([s["key"] for s in run_json("suspects", self.database, "--phoneme", phoneme)],
                         [s["key"] for s in every if s["phoneme"] == phoneme])
        rows = list(csv.DictReader(io.StringIO(run_well("suspects", self.database, "--csv"))))
        self.assertEqual([(r["key"], r["reason"], r["text"]) for r in rows],
                         [(s["key"], m["reason"], m["text"]) for s in every for m in s["marks"]])
        text = run("suspects", self.database)
        self.assertEqual([line.split("\t")[0] for line in text.stdout.splitlines()], ["key", *keys])
        self.assertEqual(text.stderr, f"{len(keys)} suspects\n")
        self.assertEqual(run("suspects", self.database, "--quiet").stderr, "")

    def test_keys_go_into_prune(self):
        """Every form in which suspects are printed for people or tables names the same nodes to prune."""
        keys = run_well("suspects", self.database, "--keys")
        listing = self.folder / "bad.txt"
        for form in (["--keys"], ["--csv"], ["--quiet"]):
            listing.write_text(run_well("suspects", self.database, *form))
            run_well("prune", self.database, "--from", listing, "--reason", "jump")
            self.assertEqual(run_well("suspects", self.database, "--keys"), "", form)
            self.assertEqual(run_well("suspects", self.database, "--keys", "--pruned"), keys)
            run_well("undo", self.database)

    def test_bad_calls_are_refused(self):
        self.assertRefused(USAGE, ["--reason", "jump"], "suspects", self.database, "--reason", "jmp")
        self.assertRefused(USAGE, ["--limit"], "suspects", self.database, "--limit", -1)
        self.assertRefused(USAGE, ["--keys"], "suspects", self.database, "--csv", "--keys")
        self.assertRefused(BAD_INPUT, ["phoneme", "zz"], "suspects", self.database, "--phoneme", "zz")
        self.assertRefused(IO, ["none.db"], "suspects", self.folder / "none.db", "--judge")

    def test_judging_anew_changes_nothing_where_nothing_has_changed(self):
        before = phonomime_cli.state(self.database)
        run_well("suspects", self.database, "--judge")
        self.assertEqual(phonomime_cli.state(self.database), before)
        other = self.folder / "other.db"
        other.write_bytes(self.made)
        run_well("suspects", other, "--judge", "--threads", 1)
        self.assertEqual(run_json("suspects", other), run_json("suspects", self.database))


if __name__ == "__main__":
    phonomime_cli.main()
