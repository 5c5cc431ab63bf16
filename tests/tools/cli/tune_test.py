# SPDX-License-Identifier: GPL-3.0-or-later
"""`phonomime tune` from outside: weights and reports, the journal of stopped and killed runs, refused calls."""
import json
import pathlib
import signal
import subprocess
import time

import phonomime_cli as cli
import tiny_corpus

SMALL = {"--folds": "2", "--inner": "2", "--sentences": "4", "--starts": "2", "--descents": "1", "--evaluations": "6",
         "--only": "target,alpha3", "--blend": "2"}


def small(**others):
    """A small tuning, with some options otherwise."""
    options = {**SMALL, **{f"--{name}": str(value) for name, value in others.items()}}
    return [word for option in options.items() for word in option]


class TuneTest(cli.CliTest):
    @classmethod
    def setUpClass(cls):
        folder = cli.scratch_folder(cls.addClassCleanup)
        cls.corpus = tiny_corpus.Corpus(folder / "ann", sentences=16).write()
        cls.first = cls.tune(folder / "first")

    @classmethod
    def arguments(cls, folder, *flags, **others):
        return ["tune", cls.corpus, *small(**others), *flags, "-o", folder / "weights.json", "--report", folder / "report.html",
                "--report", folder / "report.json", "--report", folder / "report.txt"]

    @classmethod
    def tune(cls, folder, *flags, **others):
        """The bytes of the weights file and the reports."""
        folder = pathlib.Path(folder)
        folder.mkdir(exist_ok=True)
        cli.run_well(*cls.arguments(folder, "--quiet", *flags, **others))
        return cls.outputs(folder)

    @staticmethod
    def outputs(folder):
        return {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix in (".json", ".html", ".txt")}

    def test_what_it_finds_is_what_it_says(self):
        report = json.loads(self.first["report.json"])
        weights = json.loads(self.first["weights.json"])
        for part in (report["all"], *report["folds"]):
            best = min(part["looks"], key=lambda look: look["value"])
            self.assertEqual(part["weights"], best["weights"])
            self.assertAlmostEqual(part["looks"][0]["value"], part["inner"]["shipped"])
            self.assertAlmostEqual(best["value"], part["inner"]["tuned"])
            self.assertGreaterEqual(part["inner"]["gain"], 0)
            # Sampled points, the shipped weights, and one descent.
            self.assertLessEqual(len(part["looks"]), 1 + 1 + 2 + 6)
        self.assertGreater(report["inner"]["gain"], 0)
        for name, value in report["all"]["weights"].items():
            self.assertEqual(weights[name], value)
            if name not in ("target", "alpha3"):
                self.assertEqual(value, report["shipped"][name])
        self.assertEqual([weight["name"] for weight in report["weights"]], ["target", "alpha3"])
        self.assertNotIn("pnt", weights)

    def test_every_sentence_is_held_out_once_and_never_tuned_to_by_what_speaks_it(self):
        report = json.loads(self.first["report.json"])
        held_out = []
        for fold in report["folds"]:
            keys = [value["key"] for value in fold["held_out"]["values"]]
            self.assertFalse(set(keys) & {value["key"] for value in fold["inner"]["values"]})
            held_out += keys
        self.assertEqual(sorted(held_out), sorted(f"ann/neutral/u{i:03d}" for i in range(16)))
        self.assertEqual(report["held_out"]["sentences"], 16)

    def test_held_out_scores_are_those_of_evaluate(self):
        """The shipped weights on the outer folds: evaluate's own folds, another way through the program."""
        report = json.loads(self.first["report.json"])
        ours = {value["key"]: value["shipped"] for fold in report["folds"] for value in fold["held_out"]["values"]}
        evaluated = cli.run_json("evaluate", self.corpus, "--folds", "2", "--methods", "default", "--blend", "2")
        theirs = {sentence["key"]: sentence["values"]["squared_error"]
                  for sentence in evaluated["methods"][0]["sentences"]}
        self.assertEqual(ours, theirs)

    def test_tuned_weights_speak_as_the_tuning_heard_them(self):
        report = json.loads(self.first["report.json"])
        for fold in report["folds"]:
            path = self.folder / "fold.json"
            path.write_text(json.dumps(fold["weights"]))
            evaluated = cli.run_json("evaluate", self.corpus, "--folds", "2", "--fold", fold["fold"], "--methods",
                                     "default", "--blend", "2", "--weights", path)
            for ours, theirs in zip(fold["held_out"]["values"], evaluated["methods"][0]["sentences"], strict=True):
                self.assertEqual((ours["key"], ours["tuned"]), (theirs["key"], theirs["values"]["squared_error"]))

    def test_the_same_at_any_number_of_threads_and_other_with_another_seed(self):
        self.assertEqual(self.tune(self.folder / "one", threads=1), self.first)
        other = self.tune(self.folder / "other", seed=2)
        self.assertNotEqual(other["weights.json"], self.first["weights.json"])

    def test_a_run_that_was_killed_again_and_again_ends_as_if_it_had_not_been(self):
        folder = self.folder / "killed"
        folder.mkdir()
        journal = folder / "journal"
        call = [cli.PROGRAM, *map(str, self.arguments(folder, journal=journal))]
        sizes = []
        for number in (signal.SIGKILL, signal.SIGINT, signal.SIGKILL):
            seen = journal.stat().st_size if journal.exists() else 0
            with subprocess.Popen(call, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL) as process:
                while process.poll() is None and not (journal.exists() and journal.stat().st_size > seen + 900):
                    time.sleep(0.001)
                process.send_signal(number)
                process.wait(timeout=cli.TIME_LIMIT_S)
            if number == signal.SIGINT:
                self.assertIn(process.returncode, (cli.INTERRUPTED, cli.DONE))
            sizes.append(journal.stat().st_size)
        self.assertFalse(sizes[0] > sizes[1] or sizes[1] > sizes[2])
        journal.write_bytes(journal.read_bytes() + b'{"set":"all","wei')
        known = journal.read_bytes().count(b"\n") - 1
        said = cli.run(*self.arguments(folder, journal=journal, threads=1))
        self.assertEqual(said.returncode, cli.DONE, said.stderr)
        self.assertIn(f"{known} evaluations were taken from", said.stderr)
        self.assertEqual(self.outputs(folder), self.first)
        # All is known now: nothing is evaluated, the journal stays as it is.
        before = journal.read_bytes()
        self.assertEqual(self.tune(folder, journal=journal), self.first)
        self.assertEqual(journal.read_bytes(), before)

    def test_a_journal_serves_a_longer_search_but_no_other_run(self):
        journal = self.folder / "journal"
        self.tune(self.folder / "short", journal=journal)
        longer = self.tune(self.folder / "long", journal=journal, starts=4)
        self.assertEqual(self.tune(self.folder / "afresh", starts=4), longer)
        call = ("tune", self.corpus, "-o", self.folder / "weights.json", "--journal", journal)
        for words, options in ((["seed differs", "expected 2, got 1"], small(seed=2)),
                               (["objective differs", "lip_rmse"], small(objective="lip_rmse")),
                               (["cost differs", "paper"], small(cost="paper", only="alpha3")),
                               (["rest differs"], [*small(), "--no-rest"])):
            self.assertRefused(cli.BAD_INPUT, [journal, *words], *call, *options)
        changed = tiny_corpus.Corpus(self.folder / "ann", sentences=16)
        changed.sentences[3].seed += 1
        changed.sentences[3].__post_init__()
        changed.write()
        self.assertRefused(cli.BAD_INPUT, ["recordings differs"], "tune", changed.folder, *call[2:], *small())

    def test_a_time_limit_ends_the_search_and_is_told(self):
        outputs = self.tune(self.folder / "hasty", **{"time-limit": "0.00001"})
        report = json.loads(outputs["report.json"])
        self.assertTrue(report["out_of_time"])
        self.assertEqual(len(report["all"]["looks"]), 1)  # the shipped weights
        self.assertEqual(report["all"]["weights"], report["shipped"])
        self.assertEqual(report["verdict"], "no difference")

    def test_calls_that_are_refused(self):
        weights = self.folder / "weights.json"
        call = ("tune", self.corpus, "-o", weights)
        spoilt = self.folder / "spoilt"
        spoilt.write_text("no journal\n")
        for status, words, others in (
                (cli.USAGE, ["--folds", "2 to 100"], ("--folds", "1")),
                (cli.USAGE, ["--inner", "2 to 100"], ("--inner", "1")),
                (cli.USAGE, ["--sentences", "2"], ("--sentences", "2")),
                (cli.USAGE, ["--descents"], ("--descents", "0")),
                (cli.USAGE, ["--time-limit"], ("--time-limit", "-1")),
                (cli.USAGE, ["--objective", '"lip_rmze"', '"lip_rmse"'], ("--objective", "lip_rmze")),
                (cli.USAGE, ["--objective", "captured_joins"], ("--objective", "captured_joins")),
                (cli.USAGE, ["--only", '"alpha"', '"alpha1"'], ("--only", "alpha")),
                (cli.USAGE, ["alpha6", "one emotion"], ("--only", "alpha6")),
                (cli.USAGE, ["report.csv", ".html"], ("--report", self.folder / "report.csv")),
                (cli.USAGE, ["twice"], ("--report", weights)),
                (cli.USAGE, ["twice"], ("--journal", weights)),
                (cli.BAD_INPUT, ["fewer sentences", "17", "16"], ("--folds", "17")),
                (cli.BAD_INPUT, ["spoilt", "journal"], ("--journal", spoilt)),
                (cli.IO, ["nowhere"], ("--journal", self.folder / "nowhere" / "journal")),
        ):
            with self.subTest(" ".join(map(str, others))):
                self.assertRefused(status, words, *call, *others)
        self.assertRefused(cli.USAGE, ["weights.txt", ".json"], "tune", self.corpus, "-o", self.folder / "weights.txt")


if __name__ == "__main__":
    cli.main()
