# SPDX-License-Identifier: GPL-3.0-or-later
"""phonomime style, and what emotions do in synth beyond what was recorded: less, more, mixed, borrowed."""
import csv
import json
import shutil
import signal
import sqlite3

import phonomime_cli as cli
import tiny_corpus

# How the corners of the lips go up and apart in the made-up happiness, the chin down in anger: mm.
HAPPINESS, ANGER = 4.0, -3.0
# Where bob's face is another than ann's: mm.
BOB = {"corner_r": (-6, -8, 3), "corner_l": (6, -8, 3), "chin": (0, -15, 4), "cheek": (8, 0, -6), "lip_lo": (0, -1, 2)}
SPOKEN = "b aa m eh p iy s ow l f".split()


def shift(sentence, emotion):
    """The sentence's own motion, with the emotion's marks on the speaker's face (which hardly turns)."""
    frames = []
    for frame in tiny_corpus.motion_frames(sentence.rows, seed=7):
        moved = list(frame)
        for i, name in enumerate(tiny_corpus.MARKERS):
            x, y, z = (a + b for a, b in zip(moved[i], BOB.get(name, (0, 0, 0)) if sentence.speaker == "bob" else (0, 0, 0)))
            moved[i] = (x, y, z)
            if emotion == "happiness" and name.startswith("corner"):
                moved[i] = (x, y + HAPPINESS, z)
            if emotion == "anger" and name == "chin":
                moved[i] = (x, y + ANGER, z)
        frames.append(tuple(moved))
    sentence.motion = tiny_corpus.c3d_bytes(list(tiny_corpus.MARKERS), frames)


def corpus(folder, speaker, emotions, first=0):
    made = tiny_corpus.Corpus(folder, name=speaker, sentences=8, first=first, emotions=emotions)
    for sentence in made.sentences:
        sentence.speaker = speaker
        shift(sentence, sentence.emotion)
    return made.write()


def table(path):
    """{column: [numbers]} of a marker CSV."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def moved(before, after, column):
    """By how much a column moved, on the average over the frames that speak."""
    a, b = table(before), table(after)
    pairs = [(p, q) for t, p, q in zip(a["time"], a[column], b[column]) if 0.5 < t < 0.9]
    return sum(q - p for p, q in pairs) / len(pairs)


class StyleTest(cli.CliTest):
    """A database of ann in three emotions, with a model, and of bob, who is always neutral."""

    @classmethod
    def setUpClass(cls):
        folder = cli.scratch_folder(cls.addClassCleanup)
        database = folder / "made.db"
        ann = corpus(folder / "ann", "ann", ("neutral", "happiness", "anger"))
        cli.run_well("import", ann, "--db", database)
        cli.run_well("import", corpus(folder / "bob", "bob", ("neutral",), first=3), "--db", database)
        cls.untrained = database.read_bytes()
        cls.trained_json = cli.run_json("style", "train", database, "--speaker", "ann")
        cls.made = database.read_bytes()
        cls.recording = ann / "motion" / "neutral_u000.c3d"
        cls.labels = ann / "alignment" / "neutral_u000.lab"

    def setUp(self):
        super().setUp()
        self.database = self.folder / "made.db"
        self.database.write_bytes(self.made)
        self.transcript = cli.write_transcript(self.folder / "hello.lab", SPOKEN)

    def said(self, name, *arguments, speaker="ann"):
        """What synth prints, that writes `name`."""
        return cli.run_well("synth", "--db", self.database, "--speaker", speaker, self.transcript,
                            "-o", self.folder / name, *arguments)

    def synth(self, name, *arguments, speaker="ann"):
        self.said(name, *arguments, speaker=speaker)
        return self.folder / name

    def synth_json(self, *arguments, speaker="ann"):
        return cli.run_json("synth", "--db", self.database, "--speaker", speaker, self.transcript, *arguments)

    def prune_one(self):
        cli.prune(self.database, cli.run_json("nodes", self.database, "--speaker", "ann")[0]["key"])

    # train, show

    def test_what_was_trained_is_shown(self):
        shown = cli.run_json("style", "show", self.database, "--speaker", "ann")
        self.assertEqual(shown, self.trained_json)
        self.assertEqual(shown["state"], "fresh")
        self.assertEqual(sorted(shown["model"]["styles"]), ["anger", "happiness", "neutral"])
        self.assertEqual(shown["sentences"], [f"u{i:03d}" for i in range(8)])
        self.assertEqual(shown["nodes"], 8 * 12)
        curve = shown["model"]["unknown"]["convergence"]
        self.assertEqual(curve, sorted(curve, reverse=True))
        errors = shown["error"]
        self.assertLess(errors["reconstruction"], errors["translation"])
        self.assertLess(errors["translation"], errors["unchanged"])
        text = cli.run_well("style", "show", self.database, "--speaker", "ann")
        for word in ("fresh", "happiness up to", "held out", "contact", "converged"):
            self.assertIn(word, text)

    def test_training_again_changes_no_byte_of_the_model(self):
        rows = lambda: [sqlite3.connect(self.database).execute(f"SELECT * FROM {name}").fetchall()
                        for name in ("style_models", "style_matrices")]
        before = rows()
        cli.run_well("style", "train", self.database, "--speaker", "ann", "--threads", 1)
        self.assertEqual(rows(), before)

    def test_options_are_taken(self):
        trained = cli.run_json("style", "train", self.database, "--speaker", "ann", "--bundle", 1, "--content", 4,
                               "--ridge", 0.5, "--styles", 2, "--unknown-content", 3, "--coefficients", "--emotion", "anger", "neutral")
        model = trained["model"]
        self.assertEqual((model["bundle"], model["content_size"], model["ridge"]), (1, 4, 0.5))
        self.assertEqual((model["unknown"]["style_size"], model["unknown"]["content_size"]), (2, 3))
        self.assertEqual(sorted(model["styles"]), ["anger", "neutral"])
        self.assertEqual(model["vectors"], "coefficients")
        self.assertIsNone(trained["chosen"])

    def test_what_cannot_be_trained_changes_nothing(self):
        self.assertRefused(cli.BAD_INPUT, ["at least 2"], "style", "train", self.database, "--speaker", "bob")
        self.assertRefused(cli.BAD_INPUT, ["joy"], "style", "train", self.database, "--speaker", "ann",
                           "--emotion", "joy", "neutral")
        self.assertRefused(cli.USAGE, ["bundle"], "style", "train", self.database, "--speaker", "ann", "--bundle", 2)
        self.assertRefused(cli.IO, ["none.db"], "style", "train", self.folder / "none.db")
        self.assertRefused(cli.BAD_INPUT, ["no style model of speaker bob", "style train"],
                           "style", "show", self.database, "--speaker", "bob")

    # Stale models

    def test_a_pruning_or_an_import_makes_a_model_stale(self):
        pruned = lambda: self.prune_one()
        imported = lambda: cli.run_well("import", corpus(self.folder / "more", "eve", ("neutral",), first=9),
                                        "--db", self.database)
        for change in (pruned, imported):
            self.database.write_bytes(self.made)
            change()
            shown = cli.run_json("style", "show", self.database, "--speaker", "ann")
            self.assertEqual(shown["state"], "stale")
            for call in (["synth", "--db", self.database, self.transcript, "--emotion", "happiness:0.5",
                          "-o", self.folder / "out.csv"],
                         ["style", "apply", self.database, self.recording, "--to", "anger", "-o", self.folder / "out.csv"]):
                self.assertRefused(cli.BAD_INPUT, ["stale", "style train"], *call, "--speaker", "ann")
            # What needs no model goes on.
            self.synth("plain.csv", "--emotion", "happiness")
        cli.run_well("style", "train", self.database, "--speaker", "ann")
        self.synth("half.csv", "--emotion", "happiness:0.5")

    def test_an_undone_pruning_makes_it_fresh_again(self):
        self.prune_one()
        cli.run_well("undo", self.database)
        self.assertEqual(cli.run_json("style", "show", self.database, "--speaker", "ann")["state"], "fresh")

    def test_without_a_model(self):
        self.database.write_bytes(self.untrained)
        for emotion in ("happiness:0.5", "happiness:0.6+anger:0.3"):
            self.assertRefused(cli.BAD_INPUT, ["no style model of speaker ann", "style train"],
                               "synth", "--db", self.database, "--speaker", "ann", self.transcript,
                               "--emotion", emotion, "-o", self.folder / "out.csv")
        said = cli.run_well("synth", "--db", self.database, "--speaker", "bob", self.transcript, "--emotion", "happiness")
        self.assertIn("bob never recorded happiness: other motion stands in", said)

    def test_damaged_models_are_refused(self):
        spoils = ("UPDATE style_models SET trained_json = '{'", "UPDATE style_models SET trained_json = '{}'",
                  "DELETE FROM style_matrices WHERE name = 'known_bases'",
                  "UPDATE style_matrices SET numbers = zeroblob(8) WHERE name = 'known_bases'",
                  "UPDATE style_matrices SET row_count = 1, column_count = 1, numbers = zeroblob(8)",
                  "UPDATE style_matrices SET row_count = 1000000, column_count = 1000000")
        for spoil in spoils:
            with self.subTest(spoil):
                self.database.write_bytes(self.made)
                connection = sqlite3.connect(self.database)
                with connection:
                    connection.execute(spoil)
                connection.close()
                for call in (["style", "show", self.database],
                             ["style", "apply", self.database, self.recording, "--to", "anger"]):
                    self.assertRefused(cli.BAD_INPUT, ["made.db"], *call, "--speaker", "ann")

    # In synth

    def test_one_is_as_recorded_and_zero_is_neutral_to_the_last_bit(self):
        whole = self.synth("whole.csv", "--emotion", "happiness").read_bytes()
        self.assertEqual(self.synth("one.csv", "--emotion", "happiness:1").read_bytes(), whole)
        neutral = self.synth("neutral.csv").read_bytes()
        self.assertNotEqual(neutral, whole)
        self.assertEqual(self.synth("zero.csv", "--emotion", "happiness:0").read_bytes(), neutral)
        self.assertEqual(self.synth("zeros.csv", "--emotion", "happiness:0+anger:0").read_bytes(), neutral)
        self.database.write_bytes(self.untrained)  # neither needs a model
        self.assertEqual(self.synth("again.csv", "--emotion", "happiness:1").read_bytes(), whole)
        self.assertEqual(self.synth("again0.csv", "--emotion", "happiness:0").read_bytes(), neutral)

    def test_intensities_scale_the_emotion(self):
        whole = self.synth("whole.csv", "--emotion", "happiness")
        for intensity in (0.25, 0.5, 1.25, 1.5):
            with self.subTest(intensity):
                path = self.synth("some.csv", "--emotion", f"happiness:{intensity}")
                for column in ("corner_r_y", "corner_l_y"):
                    self.assertAlmostEqual(moved(whole, path, column), (intensity - 1) * HAPPINESS, delta=0.4)
                self.assertAlmostEqual(moved(whole, path, "chin_y"), 0, delta=0.4)

    def test_emotions_mix(self):
        happy = self.synth("whole.csv", "--emotion", "happiness")
        mixed = self.synth("mixed.csv", "--emotion", "happiness:0.6+anger:0.3")
        self.assertAlmostEqual(moved(happy, mixed, "corner_l_y"), -0.4 * HAPPINESS, delta=0.4)
        self.assertAlmostEqual(moved(happy, mixed, "chin_y"), 0.3 * ANGER, delta=0.4)

    def test_a_result_says_what_the_style_did(self):
        result = self.synth_json("--emotion", "happiness:0.6+anger:0.3")
        sounding = [row for row in result["path"] if row["phoneme"] != "pau"]
        self.assertEqual({row["asked"] for row in sounding}, {"happiness:0.6+anger:0.3"})
        self.assertEqual({row["emotion"] for row in sounding}, {"happiness"})
        self.assertGreater(result["style"]["change"], 0.1)
        self.assertGreater(result["style"]["contacts"], 0)
        self.assertEqual(result["style"]["contacts_left"], 0)
        plain = self.synth_json("--emotion", "happiness")
        self.assertNotIn("style", plain)
        self.assertNotIn("asked", plain["path"][1])
        self.assertNotIn("style:", self.said("plain.json", "--emotion", "happiness"))
        words = ("--emotion", "happiness:0.6+anger:0.3")
        told = self.said("said.json", *words)
        style = result["style"]
        line = (f"style: changed by {style['change']:.2f} (root mean square, mm a marker or weight); contacts of the "
                f"lips: {style['contacts']}, of which {style['contacts_moved']} had to be mended, 0 could not be\n")
        self.assertIn(line, told)
        text = cli.run_well("explain", self.folder / "said.json")
        self.assertIn("happiness:0.6+anger:0.3", text)
        self.assertIn(line, text)

    def test_a_track_glides(self):
        """No jump of the corners from frame to frame where the emotion changes."""
        track = self.folder / "track"
        track.write_text("0 0.8 neutral\n0.8 2 happiness\n")
        gliding = table(self.synth("glides.csv", "--emotions", track, "--blend", 1, "--fps", 100))
        self.database.write_bytes(self.untrained)
        jumping = table(self.synth("jumps.csv", "--emotions", track, "--blend", 1, "--fps", 100))
        step = lambda of: max(abs(b - a) for t, a, b in zip(of["time"], of["corner_l_y"], of["corner_l_y"][1:])
                              if 0.6 < t < 1.0)
        self.assertLess(step(gliding), 0.7 * step(jumping))

    def test_an_emotion_that_was_never_recorded_is_borrowed(self):
        neutral = self.synth("neutral.csv", speaker="bob")
        said = cli.run_well("synth", "--db", self.database, "--speaker", "bob", self.transcript,
                            "--emotion", "happiness", "-o", self.folder / "happy.csv")
        self.assertIn("bob never recorded happiness: it is borrowed from the style model of ann", said)
        self.assertAlmostEqual(moved(neutral, self.folder / "happy.csv", "corner_l_y"), HAPPINESS, delta=0.15)
        # Nobody lends its tempo.
        said = cli.run_well("synth", "--db", self.database, "--speaker", "bob", self.transcript, "--retime",
                            "--emotion", "happiness", "-o", self.folder / "happy.csv")
        self.assertIn("happiness 1 (never recorded)", said)
        self.assertAlmostEqual(moved(neutral, self.folder / "happy.csv", "corner_l_y"), HAPPINESS, delta=0.15)
        self.assertRefused(cli.BAD_INPUT, ['"joy"', "neutral"], "synth", "--db", self.database, "--speaker", "bob",
                           self.transcript, "--emotion", "joy", "-o", self.folder / "out.csv")

    def test_a_stream_refuses_what_acts_after_a_search(self):
        for arguments in (["--emotion", "happiness:0.5"], ["--emotion", "happiness:0.6+anger:0.3"]):
            self.assertRefused(cli.BAD_INPUT, ["a stream", "synth"], "synth", "--db", self.database, "--speaker", "ann",
                               "--stream", *arguments)

    def test_a_batch_is_done_anew_with_another_model(self):
        manifest = self.folder / "lines.tsv"
        manifest.write_text("transcript\temotion\nhello.lab\thappiness:0.5\n")
        call = ("batch", manifest, "--db", self.database, "--speaker", "ann", "-o", self.folder / "{id}.csv")
        done = lambda: json.loads(cli.run_well(*call, "--json"))["done"]
        self.assertEqual(done(), 1)
        self.assertEqual(done(), 0)
        cli.run_well("style", "train", self.database, "--speaker", "ann", "--content", 3, "--ridge", 1)
        self.assertEqual(done(), 1)

    # apply

    def apply(self, name, *arguments, motion=None):
        path = self.folder / name
        cli.run_well("style", "apply", self.database, "--speaker", "ann", motion or self.recording, "-o", path, *arguments)
        return path

    def test_a_recording_gets_another_emotion(self):
        before = self.apply("before.csv", "--from", "neutral", "--to", "neutral")
        for to, corner, chin in (("happiness", HAPPINESS, 0), ("happiness:0.5", 0.5 * HAPPINESS, 0),
                                 ("anger:1.5", 0, 1.5 * ANGER), ("happiness:0.6+anger:0.3", 0.6 * HAPPINESS, 0.3 * ANGER)):
            with self.subTest(to):
                after = self.apply("after.csv", "--from", "neutral", "--to", to, "--transcript", self.labels)
                self.assertAlmostEqual(moved(before, after, "corner_l_y"), corner, delta=0.4)
                self.assertAlmostEqual(moved(before, after, "chin_y"), chin, delta=0.4)

    def test_an_emotion_that_is_kept_changes_nothing(self):
        kept = self.apply("kept.csv", "--from", "neutral", "--to", "neutral")
        again = self.apply("again.csv", "--from", "neutral", "--to", "neutral", motion=kept)
        first, second = table(kept), table(again)
        self.assertEqual(len(first["time"]), len(second["time"]))
        for column, values in first.items():
            for a, b in zip(values, second[column]):
                self.assertAlmostEqual(a, b, delta=0.002, msg=column)

    def test_the_emotion_is_found(self):
        for emotion in ("neutral", "happiness", "anger"):
            motion = self.recording.parent / f"{emotion}_u001.c3d"
            report = cli.run_json("style", "apply", self.database, "--speaker", "ann", motion, "--to", "neutral")
            self.assertEqual((report["from"], report["from_found"]), (emotion, True))
            self.assertEqual(min(report["distances"], key=report["distances"].get), emotion)

    def test_the_kinds_of_outputs(self):
        face = tiny_corpus.write_face(self.folder / "face")
        outputs = [self.folder / f"out.{kind}" for kind in cli.KINDS if kind != "txt"]
        words = [word for path in outputs for word in ("-o", path)]
        cli.run_well("style", "apply", self.database, "--speaker", "ann", self.recording, "--to", "anger", "--face", face,
                     "--transcript", self.labels, *words)
        for path in outputs:
            self.assertGreater(path.stat().st_size, 100)
        self.assertEqual(json.loads((self.folder / "out.json").read_text())["from"], "neutral")

    def test_bad_calls_of_apply(self):
        call = ["style", "apply", self.database, "--speaker", "ann", self.recording, "-o", self.folder / "out.csv"]
        self.assertRefused(cli.USAGE, ["--to"], *call)
        self.assertRefused(cli.BAD_INPUT, ["joy"], *call, "--to", "joy")
        self.assertRefused(cli.BAD_INPUT, ["joy"], *call, "--to", "anger", "--from", "joy")
        self.assertRefused(cli.USAGE, [".txt"], *call, "--to", "anger", "-o", self.folder / "out.txt")
        self.assertRefused(cli.USAGE, ["face"], *call, "--to", "anger", "-o", self.folder / "out.glb")
        self.assertRefused(cli.IO, ["none.c3d"], "style", "apply", self.database, "--speaker", "ann",
                           self.folder / "none.c3d", "--to", "anger")
        other = self.folder / "other.csv"
        other.write_text("time,a,b\n0,0,0\n0.02,0,0\n")
        self.assertRefused(cli.BAD_INPUT, ["other.csv", "another kind"], "style", "apply", self.database, "--speaker",
                           "ann", other, "--to", "anger")
        self.assertRefused(cli.BAD_INPUT, ["longer than the motion"], *call, "--to", "anger", "--transcript",
                           cli.write_transcript(self.folder / "long.lab", 80 * ["aa"]))


class StyleKillTest(cli.CliTest):
    def test_a_training_that_is_killed_leaves_the_database_whole(self):
        database = self.folder / "made.db"
        cli.run_well("import", corpus(self.folder / "ann", "ann", ("neutral", "happiness")), "--db", database)
        whole = cli.run_until("style", "train", str(database)).work_s
        made = cli.run_json("style", "show", database)
        connection = sqlite3.connect(database)
        with connection:
            connection.execute("DELETE FROM style_matrices")
            connection.execute("DELETE FROM style_models")
        connection.close()
        before = database.read_bytes()
        nodes = cli.run_json("nodes", database)
        for i in range(12):
            with self.subTest(i):
                database.write_bytes(before)
                cli.run_until("style", "train", str(database), number=9, after_s=whole * (0.4 + 0.06 * i))
                shown = cli.run("style", "show", database, "--json")
                if shown.returncode == cli.DONE:
                    self.assertEqual(json.loads(shown.stdout), made)
                else:
                    self.assertIn("no style model", shown.stderr)
                self.assertEqual(cli.run_json("nodes", database), nodes)

    def test_a_training_that_is_interrupted_says_so_and_leaves_all_as_it_was(self):
        database = self.folder / "made.db"
        cli.run_well("import", corpus(self.folder / "ann", "ann", ("neutral", "happiness")), "--db", database)
        call = ("style", "train", str(database), "--threads", "1")
        before, before_bytes = cli.contents(self.folder), database.read_bytes()
        trained = self.folder.parent / (self.folder.name + ".trained.db")
        shutil.copyfile(database, trained)
        self.addCleanup(trained.unlink)
        whole = cli.run_until("style", "train", str(trained), "--threads", "1").work_s
        stops = []
        for i, number in enumerate(3 * [signal.SIGINT, signal.SIGTERM]):
            with self.subTest(i):
                stop = cli.run_until(*call, number=number, after_s=whole * (i + 0.5) / 6)
                self.assertIn(stop.status, (cli.DONE, cli.INTERRUPTED, -number), stop.said)
                if stop.status == cli.DONE:
                    database.write_bytes(before_bytes)
                    continue
                self.assertEqual(cli.contents(self.folder), before)
                if stop.status == cli.INTERRUPTED:
                    self.assertEqual(stop.said, "phonomime: interrupted\n")
                    stops.append(stop.work_s / whole)
        # In mid-work, not only before or after it.
        self.assertTrue(any(0.3 < share < 0.8 for share in stops), stops)


if __name__ == "__main__":
    cli.main()
