# SPDX-License-Identifier: GPL-3.0-or-later
"""A corpus that is wrong is refused with one line, and the database is as it was."""
import json
import os
import struct

import phonomime_cli as cli
import tiny_corpus

C3D, LAB = "motion/neutral_u001.c3d", "alignment/neutral_u001.lab"


def textgrid(intervals, end):
    rows = "".join(
        f'        intervals [{i + 1}]:\n            xmin = {a}\n            xmax = {b}\n            text = "{label}"\n'
        for i, (a, b, label) in enumerate(intervals))
    return (f'File type = "ooTextFile"\nObject class = "TextGrid"\n\nxmin = 0\nxmax = {end}\ntiers? <exists>\nsize = 1\n'
            f'item []:\n    item [1]:\n        class = "IntervalTier"\n        name = "phones"\n        xmin = 0\n'
            f"        xmax = {end}\n        intervals: size = {len(intervals)}\n{rows}")


def patched(data, at, form, *values):
    """The bytes with others in their place."""
    copy = bytearray(data)
    struct.pack_into(form, copy, at, *values)
    return bytes(copy)


def parameter_at(data, name):
    """Where the data of a C3D parameter without dimensions begins."""
    at = data.index(name, 512)
    return at + len(name) + 2 + 2


class BadCorpusTest(cli.DatabaseTest):
    """Each test spoils a corpus that would be taken, next to a database that already holds another."""

    CORPUS = {"name": "old", "first": 50}

    def setUp(self):
        super().setUp()
        self.corpus = tiny_corpus.Corpus(self.folder / "new")
        self.spoilt = self.corpus.sentences[1]

    def assertImportRefused(self, *words, status=cli.BAD_INPUT, options=()):
        """Into a new database (none appears) and into one that holds another corpus (as it was)."""
        self.corpus.write()
        for database in ("none.db", "made.db"):
            line = self.assertRefused(status, words, "import", self.corpus.folder, "--db", self.folder / database, *options)
        return line

    def test_the_corpus_is_good_before_it_is_spoilt(self):
        self.corpus.write()
        for database in ("none.db", "made.db"):
            cli.run_well("import", self.corpus.folder, "--db", self.folder / database)

    # C3D

    def test_truncated_c3d(self):
        whole = self.spoilt.motion
        for length in (0, 1, 100, 511, 600, 900, len(whole) // 2, len(whole) - 1024):
            with self.subTest(length=length):
                self.spoilt.motion = whole[:length]
                self.assertImportRefused(C3D)

    def test_hostile_c3d(self):
        good = self.spoilt.motion
        data_start = parameter_at(good, b"DATA_START")
        frames = parameter_at(good, b"FRAMES")
        used = parameter_at(good, b"USED")
        labels = good.index(b"LABELS", 512) + 6 + 2 + 1 + 1  # its dimensions: width, number
        cases = {
            "points beyond the data": patched(patched(good, 2, "<H", 65535), used, "<H", 65535),
            "a last frame of 65535": patched(patched(good, 8, "<H", 65535), frames, "<H", 65535),
            "frames that run backwards": patched(patched(good, 6, "<HH", 60, 3), frames, "<H", 0),
            "data behind the end": patched(patched(good, 16, "<H", 60000), data_start, "<H", 60000),
            "data in the parameters": patched(patched(good, 16, "<H", 2), data_start, "<H", 2),
            "parameters behind the end": patched(good, 0, "<B", 255),
            "parameters in the header": patched(good, 0, "<B", 0),
            "not a C3D's second byte": patched(good, 1, "<B", 0x51),
            "an unknown processor": patched(good, 512 + 3, "<B", 99),
            "labels of another size": patched(good, labels, "<BB", 255, 255),
            "a parameter that points behind the end": patched(good, good.index(b"POINT", 512) + 5, "<H", 65000),
            "a parameter that points at itself": patched(good, good.index(b"RATE", 512) + 4, "<H", 0),
            "an array of a negative size": patched(good, used - 2, "<bB", -2, 7),
            "a rate of 0": patched(patched(good, 20, "<f", 0.0), parameter_at(good, b"RATE"), "<f", 0.0),
            "a negative rate": patched(patched(good, 20, "<f", -50.0), parameter_at(good, b"RATE"), "<f", -50.0),
            "a rate that is not a number":
                patched(patched(good, 20, "<f", float("nan")), parameter_at(good, b"RATE"), "<f", float("nan")),
            "a scale that is not a number":
                patched(patched(good, 12, "<f", float("nan")), parameter_at(good, b"SCALE"), "<f", float("nan")),
            "text": b"time,lip_up_x\n0,1\n" * 100,
            "noise": bytes((i * 7919) % 251 for i in range(4096)),
        }
        for name, data in cases.items():
            with self.subTest(name):
                self.spoilt.motion = data
                self.assertImportRefused(C3D)

    def test_another_unit_than_the_layouts(self):
        frames = tiny_corpus.motion_frames(self.spoilt.rows)
        self.spoilt.motion = tiny_corpus.c3d_bytes(list(tiny_corpus.MARKERS), frames, units="cm")
        self.assertImportRefused(C3D, "unit", "(expected mm, got cm)")

    def test_a_marker_that_the_motion_lacks(self):
        names = ["chinn" if name == "chin" else name for name in tiny_corpus.MARKERS]
        self.spoilt.motion = tiny_corpus.c3d_bytes(names, tiny_corpus.motion_frames(self.spoilt.rows))
        self.assertImportRefused(C3D, '"chin"')

    def test_markers_missing_throughout(self):
        frames = tiny_corpus.motion_frames(self.spoilt.rows)
        chin = list(tiny_corpus.MARKERS).index("chin")
        nan = (float("nan"),) * 3
        cases = {
            "every marker missing": [[None] * len(frame) for frame in frames],
            "every marker NaN": [[nan] * len(frame) for frame in frames],
        }
        for name, spoilt in cases.items():
            with self.subTest(name):
                self.spoilt.motion = tiny_corpus.c3d_bytes(list(tiny_corpus.MARKERS), spoilt)
                self.assertImportRefused(C3D)
        with self.subTest("one marker NaN in all sentences"):
            for sentence in self.corpus.sentences:
                spoilt = [[nan if i == chin else point for i, point in enumerate(frame)]
                          for frame in tiny_corpus.motion_frames(sentence.rows)]
                sentence.motion = tiny_corpus.c3d_bytes(list(tiny_corpus.MARKERS), spoilt)
            self.assertImportRefused("chin")

    # Alignments

    def test_a_lab_that_runs_backwards(self):
        self.spoilt.alignment = "#\n0.3 100 pau\n0.9 100 b\n0.5 100 aa\n1.2 100 pau\n"
        self.assertImportRefused(f"{LAB}:4", "0.5", "0.9")

    def test_textgrids_with_overlapping_or_reversed_intervals(self):
        end = self.spoilt.rows[-1][0]
        self.spoilt.alignment_name = "alignment/u001.TextGrid"
        self.spoilt.alignment = textgrid([(0, 0.4, ""), (0.4, 0.6, "B"), (0.6, end, "")], end)
        self.corpus.write()
        cli.run_well("import", self.corpus.folder, "--db", self.folder / "good.db")
        cases = {
            "overlapping": [(0, 0.4, ""), (0.35, 0.6, "B"), (0.6, end, "")],
            "reversed": [(0, 0.4, ""), (0.6, 0.4, "B"), (0.6, end, "")],
            "out of order": [(0.4, 0.6, "B"), (0, 0.4, ""), (0.6, end, "")],
            "truncated": [(0, 0.4, ""), (0.4, 0.6, "B")],
        }
        for name, intervals in cases.items():
            with self.subTest(name):
                text = textgrid(intervals, end)
                self.spoilt.alignment = text[:-40] if name == "truncated" else text
                self.assertImportRefused("alignment/u001.TextGrid:")

    def test_an_alignment_longer_or_shorter_than_its_motion(self):
        end = self.spoilt.rows[-1][0]
        for what, other in (("longer", end + 0.5), ("shorter", end - 0.5)):
            with self.subTest(what):
                self.spoilt.alignment = f"#\n0.3 100 pau\n0.5 100 b\n{other:.3f} 100 pau\n"
                self.assertImportRefused("sentences.tsv:3", LAB, C3D, what, "--tolerance")
        self.spoilt.alignment = f"#\n0.3 100 pau\n0.5 100 b\n{end + 0.08:.3f} 100 pau\n"
        self.corpus.write()
        cli.run_well("import", self.corpus.folder, "--db", self.folder / "tolerated.db")
        self.assertImportRefused(LAB, "longer", options=("--tolerance", "0.05"))

    def test_an_unknown_phoneme_is_told_with_candidates(self):
        self.spoilt.alignment = "#\n0.3 100 pau\n0.5 100 b\n0.7 100 axx\n1.2 100 pau\n"
        self.assertImportRefused(f"{LAB}:4", '"axx"', "arpabet", '"ax"')

    # The table and what it names

    def test_a_repeated_sentence(self):
        self.corpus.sentences[2].id = self.spoilt.id
        self.assertImportRefused("sentences.tsv:4", "ann/neutral/u001", "line 3")

    def test_a_sentence_that_the_database_has(self):
        again = tiny_corpus.Corpus(self.folder / "new", name="old", first=50).write()
        self.assertRefused(cli.BAD_INPUT, ["old/neutral/u050", "sentences.tsv:2"], "import", again, "--db", self.folder / "made.db")

    def test_another_layout_than_the_databases(self):
        self.corpus.layout["groups"].pop()
        self.corpus.write()
        self.assertRefused(cli.BAD_INPUT, ["layout"], "import", self.corpus.folder, "--db", self.folder / "made.db")

    def test_paths_that_leave_the_folder(self):
        outside = self.folder / "outside.c3d"
        outside.write_bytes(self.spoilt.motion)
        self.spoilt.motion = None
        for name in ("../outside.c3d", "motion/../../outside.c3d", str(outside)):
            with self.subTest(name):
                self.spoilt.motion_name = name
                self.assertImportRefused("sentences.tsv:3", name)
        with self.subTest("a link"):
            self.spoilt.motion_name = "motion/link.c3d"
            self.corpus.write()
            os.symlink(outside, self.corpus.folder / "motion/link.c3d")
            self.assertImportRefused("motion/link.c3d")
        with self.subTest("a linked folder"):
            self.spoilt.motion_name = "elsewhere/outside.c3d"
            self.corpus.write()
            os.symlink(self.folder, self.corpus.folder / "elsewhere")
            self.assertImportRefused("elsewhere/outside.c3d")
        with self.subTest("the layout"):
            self.spoilt.motion_name = "motion/link.c3d"
            self.corpus.description["layout"] = "../layout.json"
            self.assertImportRefused("corpus.json", "../layout.json")

    def test_files_that_are_not_there(self):
        """By status 4, whoever names them: the call, corpus.json or the table of sentences."""
        with self.subTest("the folder"):
            self.assertRefused(cli.IO, ["nowhere", "corpus.json"], "import", self.folder / "nowhere", "--db", self.folder / "none.db")
        with self.subTest("corpus.json"):
            (self.folder / "empty").mkdir()
            self.assertRefused(cli.IO, ["empty", '"corpus.json"'], "import", self.folder / "empty", "--db", self.folder / "none.db")
        for member in ("layout", "sentences", "phoneme_set"):
            with self.subTest(member):
                described = self.corpus.description[member]
                self.corpus.description[member] = "none.json"
                self.assertImportRefused("corpus.json", '"none.json"', "No such file", status=cli.IO)
                self.corpus.description[member] = described
        with self.subTest("alignment"):
            self.corpus.sentences[3].alignment_name = "alignment/none.lab"
            self.corpus.sentences[3].alignment = None
            self.assertImportRefused("sentences.tsv:5", "alignment/none.lab", status=cli.IO)
        with self.subTest("motion"):
            self.spoilt.motion_name = "motion/none.c3d"
            self.spoilt.motion = None
            self.assertImportRefused("sentences.tsv:3", "motion/none.c3d", status=cli.IO)

    def test_json_and_tables_that_do_not_fit(self):
        def spoil(name, text):
            self.corpus.write()
            (self.corpus.folder / name).write_text(text)
            return self.assertRefused(cli.BAD_INPUT, [name], "import", self.corpus.folder, "--db", self.folder / "made.db")
        spoil("corpus.json", "{")
        spoil("corpus.json", "[" * 100000)
        misspelt = json.dumps({**self.corpus.description, "phoneme_sett": "arpabet"})
        self.assertIn("phoneme_sett", spoil("corpus.json", misspelt))
        spoil("layout.json", '{"format": "phonomime-layout", "version": 2}')
        self.assertIn("motion", spoil("sentences.tsv", "id\talignment\nu1\ta.lab\n"))
        self.assertIn("colour", spoil("sentences.tsv", "id\tmotion\talignment\tcolour\n"))
        spoil("sentences.tsv", "id\tmotion\talignment\n")

    def test_faulty_sentences_are_left_out_on_demand(self):
        self.spoilt.motion = self.spoilt.motion[:900]
        self.corpus.write()
        report = cli.run_json("import", self.corpus.folder, "--db", self.folder / "rest.db", "--skip-faulty")
        self.assertIn("neutral_u001.c3d", str(report))
        self.assertEqual(cli.run_json("info", self.folder / "rest.db")["sentences"], len(self.corpus.sentences) - 1)


if __name__ == "__main__":
    cli.main()
