# SPDX-License-Identifier: GPL-3.0-or-later
"""`phonomime evaluate` from outside: folds and databases, reports, stops, and calls that are refused."""
import csv
import io
import json
import os
import pathlib
import signal
import subprocess
import time

import phonomime_cli as cli
import tiny_corpus

METHODS = ("default", "one_path", "paper", "mean_pose", "viseme_keyframes", "dominance", "triphone",
           "oracle")


def means(report, measure):
    """{method: mean over sentences of a measure} of a JSON report."""
    return {method["id"]: method["measures"][measure]["mean"] for method in report["methods"]}


class EvaluateTest(cli.CliTest):
    @classmethod
    def setUpClass(cls):
        folder = cli.scratch_folder(cls.addClassCleanup)
        cls.corpus = tiny_corpus.Corpus(folder / "ann", sentences=20).write()
        cls.report = cls.folds(folder)

    @classmethod
    def folds(cls, folder, *arguments, corpus=None):
        """The JSON report of two folds, with whatever `arguments` ask for besides."""
        path = pathlib.Path(folder) / "report.json"
        cli.run_well("evaluate", corpus or cls.corpus, "--folds", "2", "-o", path, "--quiet", *arguments)
        return json.loads(path.read_text())

    def keys(self, report, method=0):
        return [sentence["key"] for sentence in report["methods"][method]["sentences"]]

    def test_every_method_speaks_every_sentence(self):
        self.assertEqual(tuple(method["id"] for method in self.report["methods"]), METHODS)
        expected = sorted(f"ann/neutral/u{i:03d}" for i in range(20))
        for method in range(len(METHODS)):
            self.assertEqual(self.keys(self.report, method), expected)

    def test_the_oracle_is_nearest_and_the_mean_pose_far(self):
        errors = means(self.report, "squared_error")
        self.assertEqual(min(errors, key=errors.get), "oracle")
        self.assertGreater(errors["mean_pose"], 2 * errors["oracle"])
        self.assertIsNone(means(self.report, "aperture_correlation")["mean_pose"])
        self.assertGreater(means(self.report, "aperture_correlation")["oracle"], 0.8)

    def test_a_report_does_not_depend_on_threads_nor_on_the_fold_it_is_taken_from(self):
        self.assertEqual(self.folds(self.folder, "--threads", "1"), self.report)
        for fold in (1, 2):
            alone = self.folds(self.folder, "--fold", fold)
            for ours, theirs in zip(alone["methods"], self.report["methods"]):
                of_fold = [sentence for sentence in theirs["sentences"] if sentence["key"] in self.keys(alone)]
                for one, other in zip(ours["sentences"], of_fold, strict=True):
                    self.assertEqual(one["values"]["squared_error"], other["values"]["squared_error"])

    def test_a_sample_speaks_with_the_whole_training_data(self):
        sample = self.folds(self.folder, "--sentences", "5", "--methods", "triphone,paper")
        self.assertEqual([method["id"] for method in sample["methods"]], ["triphone", "paper"])
        self.assertEqual(len(self.keys(sample)), 5)
        whole = {sentence["key"]: sentence["values"]["squared_error"]
                 for sentence in self.report["methods"][METHODS.index("triphone")]["sentences"]}
        for sentence in sample["methods"][0]["sentences"]:
            self.assertEqual(sentence["values"]["squared_error"], whole[sentence["key"]])

    def test_the_seed_draws_other_folds(self):
        other = self.folds(self.folder, "--seed", "2", "--methods", "triphone")
        self.assertEqual(self.keys(other), self.keys(self.report))
        self.assertNotEqual(means(other, "squared_error")["triphone"],
                            means(self.report, "squared_error")["triphone"])

    def test_a_database_speaks_what_it_does_not_hold(self):
        database = self.folder / "part.db"
        held = tiny_corpus.Corpus(self.folder / "held", name="held", sentences=12)
        for sentence in held.sentences:
            sentence.speaker = "ann"
        cli.run_well("import", held.write(), "--db", database)
        before = database.read_bytes()
        report = cli.run_json("evaluate", self.corpus, "--db", database, "--methods", "paper,oracle")
        self.assertEqual(self.keys(report), [f"ann/neutral/u{i:03d}" for i in range(12, 20)])
        self.assertEqual(report["left_out"], 12)
        self.assertEqual(database.read_bytes(), before)
        self.assertRefused(cli.BAD_INPUT, ["holds every sentence"], "evaluate", held.folder, "--db", database)

    def test_reports_of_every_kind(self):
        paths = [self.folder / f"report.{kind}" for kind in ("html", "json", "csv", "txt")]
        outputs = [word for path in paths for word in ("-o", path)]
        printed = cli.run_well("evaluate", self.corpus, "--folds", "2", "--methods", "paper,mean_pose", "--sizes",
                               "--against", self.earlier(), *outputs)
        html, report, table, text = (path.read_text() for path in paths)
        self.assertEqual(text, printed)
        for method in ("paper", "mean_pose"):
            self.assertIn(method, printed)
        report = json.loads(report)
        self.assertEqual(report["format"], "phonomime-evaluation")
        rows = list(csv.DictReader(io.StringIO(table)))
        self.assertEqual(len(rows), 40)
        first = report["methods"][0]["sentences"][0]
        self.assertEqual(float(rows[0]["squared_error"]), first["values"]["squared_error"])
        self.assertNotRegex(html, r"""(?:src|href)\s*=\s*["']?(?:https?:)?//""")
        sizes = report["sizes"]
        self.assertEqual(sizes[-1]["sentences"], 10)
        self.assertEqual([size["nodes"] for size in sizes], sorted(size["nodes"] for size in sizes))
        for size in sizes:
            self.assertGreaterEqual(size["diphone_coverage"], size["triphone_coverage"])
        self.assertTrue(report["comparison"])

    def earlier(self):
        path = self.folder / "earlier.json"
        path.write_text(json.dumps(self.report))
        return path

    def test_a_text_in_several_emotions_is_held_out_in_all_of_them(self):
        corpus = tiny_corpus.Corpus(self.folder / "moods", name="moods", emotions=("neutral", "anger")).write()
        report = self.folds(self.folder, "--fold", "1", "--methods", "triphone", corpus=corpus)
        spoken = {tuple(key.split("/")[1:]) for key in self.keys(report)}
        self.assertTrue(spoken)
        for emotion, text in spoken:
            self.assertIn(({"neutral": "anger", "anger": "neutral"}[emotion], text), spoken)

    def test_emotions_are_recognised_where_they_are_asked_for(self):
        """Anger raises the cheek and the chin by what no other recording shows."""
        corpus = tiny_corpus.Corpus(self.folder / "moods", name="moods", sentences=10, emotions=("neutral", "anger"))
        for sentence in corpus.sentences:
            frames = tiny_corpus.motion_frames(sentence.rows, seed=sentence.seed)
            if sentence.emotion == "anger":
                names = list(tiny_corpus.MARKERS)
                frames = [tuple((x, y + 4 * (name in ("cheek", "chin")), z) for name, (x, y, z) in zip(names, frame))
                          for frame in frames]
            sentence.motion = tiny_corpus.c3d_bytes(list(tiny_corpus.MARKERS), frames)
        report = self.folds(self.folder, "--emotions", "--methods", "default", "--blend", "2", corpus=corpus.write())
        found = {trial["id"]: trial for trial in report["emotion_recognition"]["trials"]}
        self.assertEqual(list(found), ["recordings", "default", "default, changed", "default, alpha6 = 0", "paper",
                                       "paper, changed", "paper, alpha6 = 0"])
        for name in ("recordings", "default", "default, changed", "paper", "paper, changed"):
            self.assertEqual((found[name]["sentences"], found[name]["recognised"]), (20, 20), name)
            self.assertEqual(found[name]["taken_for"], {"anger": {"anger": 10}, "neutral": {"neutral": 10}})
        self.assertLess(found["paper, alpha6 = 0"]["recognised"], 20)
        self.assertEqual(report["emotion_recognition"]["closures"]["pairs"],
                         sum(sentence["values"]["closure_recall"] is not None
                             for sentence in report["methods"][0]["sentences"]))
        self.assertEqual(self.folds(self.folder, "--emotions", "--methods", "default", "--blend", "2", "--threads", "1",
                                    corpus=corpus.folder), report)
        self.assertRefused(cli.BAD_INPUT, ["one emotion"], "evaluate", self.corpus, "--folds", "2", "--emotions",
                           "--quiet")

    def test_calls_that_are_refused(self):
        report = self.folder / "report.json"
        report.write_text("of an earlier call")
        folds = ("evaluate", self.corpus, "--folds")
        database = self.folder / "old.db"
        database.write_text("no database")
        strange = self.folder / "strange.json"
        strange.write_text("{}")
        for status, words, call in (
                (cli.USAGE, ["--db", "--folds"], ("evaluate", self.corpus)),
                (cli.USAGE, ["--folds"], ("evaluate", self.corpus, "--folds", "2", "--db", database)),
                (cli.USAGE, ["--folds", "2 to 100", "1"], (*folds, "1")),
                (cli.USAGE, ["--fold", "0 to 3", "4"], (*folds, "3", "--fold", "4")),
                (cli.USAGE, ["--methods", '"papr"', '"paper"'], (*folds, "2", "--methods", "papr")),
                (cli.USAGE, ["--methods", "twice"], (*folds, "2", "--methods", "paper,paper")),
                (cli.USAGE, ["report.glb", ".html"], (*folds, "2", "-o", self.folder / "report.glb")),
                (cli.USAGE, ["twice"], (*folds, "2", "-o", report, "-o", report)),
                (cli.BAD_INPUT, ["fewer sentences", "21", "20"], (*folds, "21")),
                (cli.BAD_INPUT, ["strange.json"], (*folds, "2", "--against", strange)),
                (cli.IO, ["nowhere.json"], (*folds, "2", "--against", self.folder / "nowhere.json")),
                (cli.BAD_INPUT, ["old.db"], ("evaluate", self.corpus, "--db", database)),
                (cli.IO, ["nowhere"], ("evaluate", self.folder / "nowhere", "--folds", "2")),
        ):
            with self.subTest(" ".join(map(str, call[2:]))):
                self.assertRefused(status, words, *call)

    def test_a_stop_leaves_nothing_behind(self):
        temporary = self.folder / "temporary"
        temporary.mkdir()
        report = self.folder / "report.json"
        for number in (signal.SIGINT, signal.SIGTERM):
            with subprocess.Popen(
                    [cli.PROGRAM, "evaluate", self.corpus, "--folds", "10", "-o", report],
                    stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                    env={**os.environ, "TMPDIR": str(temporary)}) as process:
                while process.poll() is None and not list(temporary.iterdir()):
                    time.sleep(0.001)
                process.send_signal(number)
                printed, said = process.communicate(timeout=cli.TIME_LIMIT_S)
            self.assertEqual((process.returncode, printed, said),
                             (cli.INTERRUPTED, "", "phonomime: interrupted\n"))
            self.assertEqual(list(temporary.iterdir()), [])
            self.assertFalse(report.exists())


if __name__ == "__main__":
    cli.main()
