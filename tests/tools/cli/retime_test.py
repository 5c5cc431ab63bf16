# SPDX-License-Identifier: GPL-3.0-or-later
"""`--retime`: phonemes at the tempo that their emotions have in the recordings."""
import shutil

import phonomime_cli as cli
import tiny_corpus

TEMPOS = {"sadness": 1.25, "anger": 0.8}  # against neutral
SLOW = TEMPOS["sadness"]


def durations(rows):
    return [end - start for (start, _), (end, _) in zip([(0.0, ""), *rows], rows)]


class RetimeTest(cli.CliTest):
    @classmethod
    def setUpClass(cls):
        folder = cli.scratch_folder(cls.addClassCleanup)
        corpus = tiny_corpus.Corpus(folder / "ann", sentences=20, emotions=("neutral", *TEMPOS))
        for i, sentence in enumerate(corpus.sentences):
            if tempo := TEMPOS.get(sentence.emotion):
                rows = [(tempo * end, label) for end, label in sentence.rows]
                corpus.sentences[i] = tiny_corpus.Sentence(sentence.id, rows, emotion=sentence.emotion, seed=sentence.seed)
        cls.made = folder / "ann.db"
        cli.run_well("import", corpus.write(), "--db", cls.made)

    def setUp(self):
        super().setUp()
        self.database = shutil.copy(self.made, self.folder / "ann.db")
        self.transcript = cli.write_transcript(self.folder / "hello.lab", ["b", "aa", "m", "iy"])

    def synth(self, *arguments):
        return ["synth", "--db", self.database, self.transcript, *arguments]

    def retimed(self, *arguments):
        result = self.folder / "hello.json"
        cli.run_well(*self.synth("--retime", "-o", result, *arguments))
        return cli.read_lab(self.folder / "hello.retimed.lab")

    def test_phonemes_take_the_tempo_of_their_emotion(self):
        rows = self.retimed("--emotion", "sadness")
        self.assertEqual([label for _, label in rows], ["pau", "b", "aa", "m", "iy", "pau"])
        before, after = durations(cli.read_lab(self.transcript)), durations(rows)
        for i, (was, now) in enumerate(zip(before, after)):
            with self.subTest(i):
                self.assertAlmostEqual(now / was, 1.0 if i in (0, 5) else SLOW, delta=0.08)

    def test_pauses_between_phonemes_follow(self):
        cli.write_transcript(self.transcript, ["b", "aa", "pau", "m", "iy"])
        before, after = durations(cli.read_lab(self.transcript)), durations(self.retimed("--emotion", "sadness"))
        for i, (was, now) in enumerate(zip(before, after)):
            with self.subTest(i):
                self.assertAlmostEqual(now / was, 1.0 if i in (0, 6) else SLOW, delta=0.08)

    def test_with_intensities_mixtures_and_changes_in_mid_sentence(self):
        cli.run_well("style", "train", self.database, "--content", 4, "--ridge", 1, "--styles", 2, "--unknown-content", 3)
        before = durations(cli.read_lab(self.transcript))
        track = self.folder / "track"
        calls = [(["--emotion", asked], 4 * [asked]) for asked in ("sadness:0.5", "sadness:1.5", "sadness:0.6+anger:0.3")]
        for first, second in (("sadness:0.5", "anger"), ("sadness:0.6+anger:0.3", "neutral"), ("sadness", "anger:1.5")):
            track.write_text(f"0 0.5 {first}\n0.5 9 {second}\n")
            calls.append((["--emotions", shutil.copy(track, self.folder / f"track{len(calls)}")], [first, first, second, second]))
        track.write_text("0.3 0.5 anger\n")
        calls.append((["--emotions", track, "--emotion", "sadness:0.5"], ["anger", "anger", "sadness:0.5", "sadness:0.5"]))
        for call, asked in calls:
            with self.subTest(asked):
                after = durations(self.retimed(*call))
                path = cli.run_json(*self.synth("--retime", *call))["path"]
                for i, mixture in enumerate(asked, start=1):
                    parts = [(*part.split(":"), "1")[:2] for part in mixture.split("+")]
                    ratio = 1 + sum(float(share) * (TEMPOS.get(name, 1) - 1) for name, share in parts)
                    self.assertAlmostEqual(after[i] / before[i], ratio, delta=0.1)
                    # What is asked for moves along.
                    self.assertEqual(path[i].get("asked", path[i]["emotion"]), mixture)

    def test_each_emotion_by_the_sentences_that_it_shares_with_neutral(self):
        """Where no sentence was said in all of them."""
        corpus = tiny_corpus.Corpus(self.folder / "eve", name="eve", sentences=8, first=30, emotions=("neutral", *TEMPOS))
        corpus.sentences = [sentence for i, sentence in enumerate(corpus.sentences)
                            if sentence.emotion == "neutral" or (sentence.emotion == "sadness") == (int(sentence.id[1:]) % 2 == 0)]
        for sentence in corpus.sentences:
            sentence.speaker = "eve"
        cli.run_well("import", corpus.write(), "--db", self.database)
        track = self.folder / "track"
        track.write_text("0 0.5 sadness\n0.5 9 anger\n")
        cli.run_well(*self.synth("--retime", "--speaker", "eve", "--emotions", track, "-o", self.folder / "eve.csv"))

    def test_the_motion_has_the_new_times(self):
        rows = self.retimed("--emotion", "sadness", "-o", self.folder / "hello.csv")
        path = cli.run_json(*self.synth("--retime", "--emotion", "sadness"))["path"]
        self.assertEqual([f"{row['end']:.4f}" for row in path], [f"{end:.4f}" for end, _ in rows])
        last = (self.folder / "hello.csv").read_text().splitlines()[-1]
        self.assertAlmostEqual(float(last.split(",")[0]), rows[-1][0], delta=1 / 30)

    def test_the_retimed_transcript_is_one(self):
        self.retimed("--emotion", "sadness")
        again = self.folder / "again.json"
        cli.run_well("synth", "--db", self.database, self.folder / "hello.retimed.lab", "--emotion", "sadness", "-o", again)
        first, second = ([row["node"] for row in cli.run_json("explain", name)["path"]]
                         for name in (self.folder / "hello.json", again))
        self.assertEqual(first, second)

    def test_neutral_speech_keeps_its_times(self):
        self.assertEqual(durations(self.retimed()), durations(cli.read_lab(self.transcript)))

    def test_constraints_move_along(self):
        node = next(node["key"] for node in cli.run_json("nodes", self.database, "--phoneme", "iy"))
        (self.folder / "use").write_text(f"at 0.61 use {node}\n")  # in /iy/ as transcribed, in /m/ as retimed
        path = cli.run_json(*self.synth("--retime", "--emotion", "sadness", "--constraints", self.folder / "use"))["path"]
        self.assertEqual(path[4]["node"], node)

    def test_an_emotion_without_the_same_sentences(self):
        self.assertRefused(cli.BAD_INPUT, ["joy"], *self.synth("--retime", "--emotion", "joy"))

    def test_a_sound_fixes_the_times(self):
        sound = self.folder / "hello.wav"
        sound.write_bytes(b"")
        self.assertRefused(cli.USAGE, ["--retime", "--audio", "--retime-with-audio"],
                           *self.synth("--retime", "--audio", sound, "-o", self.folder / "out.csv"))
        self.assertRefused(cli.USAGE, ["--retime"], *self.synth("--retime-with-audio"))

    def test_a_stream_is_said_as_it_comes(self):
        self.assertRefused(cli.USAGE, ["--retime", "--stream"], "synth", "--db", self.database, "--stream", "--retime")

    def test_the_transcript_is_no_output(self):
        self.assertRefused(cli.USAGE, ["hello.lab", "transcript itself"], *self.synth("-o", self.transcript))

    def test_a_batch_writes_each_transcript_once(self):
        manifest = self.folder / "lines.tsv"
        manifest.write_text("transcript\temotion\nhello.lab\tsadness\n")
        call = ["batch", manifest, "--db", self.database, "-o", self.folder / "out/{id}.csv", "--retime"]
        cli.run_well(*call)
        written = self.folder / "out/hello.retimed.lab"
        self.assertEqual(cli.read_lab(written), self.retimed("--emotion", "sadness"))
        self.assertEqual(cli.run_json(*call)["skipped"], 1)
        written.unlink()
        self.assertEqual(cli.run_json(*call)["done"], 1)


if __name__ == "__main__":
    cli.main()
