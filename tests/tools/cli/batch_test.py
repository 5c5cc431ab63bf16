# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch gives what synth gives for each row, does what is not done yet and nothing else, and goes on
after failures, kills and stops."""
import json
import os
import pty
import random
import shutil
import signal
import subprocess
import time

import batch_table
import phonomime_cli as cli
import tiny_corpus


class SameBytesTest(batch_table.BatchTest):
    ROWS = 6
    KINDS = cli.KINDS

    def setUp(self):
        super().setUp()
        tiny_corpus.write_face(self.folder / "face")
        (self.folder / "track").write_text("0 0.7 neutral\n0.7 1.3 happiness\n")
        (self.folder / "constraints").write_text("3 use neutral/u003#4\n")  # of another phoneme: a warning with its place
        (self.folder / "weights.json").write_text('{"format": "phonomime-weights", "version": 1, "alpha3": 9}')
        for row, more in zip(self.rows, (
                {}, {"emotion": "happiness"}, {"emotions": "track"}, {"constraints": "constraints"},
                {"weights": "weights.json", "fps": "59.94"}, {"emotion": "neutral", "weights": "weights.json"})):
            row.update(more)
        self.options = ["--face", self.folder / "face", "--emotion", "happiness", "--runners-up", "2"]

    def synth(self, row):
        options = [*self.options]
        for column in ("emotion", "emotions", "constraints", "weights", "fps"):
            if column in row:
                paths = column not in ("emotion", "fps")
                options += [f"--{column}", self.folder / row[column] if paths else row[column]]
        # As a later option would not replace an earlier one, the call's emotion goes where the row has one.
        if "emotion" in row:
            at = options.index("--emotion")
            del options[at:at + 2]
        for output in row["outputs"].split(";"):
            options += ["-o", self.folder / output]
        cli.run_well("synth", self.folder / row["transcript"], "--db", self.database, *options)

    def test_of_every_kind_in_any_order_on_any_number_of_threads(self):
        self.out.mkdir()
        for row in self.rows:
            self.synth(row)
        alone = self.outputs()
        self.assertEqual(len(alone), self.ROWS * len(self.KINDS))
        self.assertEqual(len(set(alone.values())), len(alone))
        for threads in (1, 2, 5):
            for shuffle in range(2):
                with self.subTest(threads=threads, shuffle=shuffle):
                    shutil.rmtree(self.out)
                    random.Random(shuffle).shuffle(self.rows)
                    batch_table.write_manifest(self.manifest, self.rows)
                    self.assertEqual(self.batch(*self.options, "--threads", threads), self.all_are("done"))
                    got = self.outputs()
                    self.assertEqual(sorted(got), sorted(alone))
                    for name, data in alone.items():
                        self.assertTrue(got[name] == data, f"{name} differs")

    def test_outputs_for_every_row(self):
        """From the command line, with the id, into folders that are made."""
        batch_table.write_manifest(self.manifest, [{"transcript": "t00.lab"}, {"transcript": "t01.lab", "id": "two"}])
        self.batch("-o", self.out / "{id}/{id}.csv", "-o", self.out / "all" / "{id}.txt")
        self.assertEqual(sorted(self.outputs()), ["all/t00.txt", "all/two.txt", "t00/t00.csv", "two/two.csv"])


class ResumeTest(batch_table.BatchTest):
    def test_what_is_done_is_skipped(self):
        self.assertEqual(self.batch(), self.all_are("done"))
        before = cli.contents(self.folder)
        inodes = {path: path.stat().st_ino for path in self.out.rglob("*")}
        self.assertEqual(self.batch("--threads", 1), self.all_are("skipped"))
        self.assertEqual(cli.contents(self.folder), before)
        self.assertEqual({path: path.stat().st_ino for path in self.out.rglob("*")}, inodes)
        self.assertEqual(self.batch("--redo"), self.all_are("done"))
        self.assertNotEqual({path: path.stat().st_ino for path in self.out.rglob("*")}, inodes)

    def test_an_edit_redoes_what_it_touches(self):
        weights = self.folder / "weights.json"
        weights.write_text('{"format": "phonomime-weights", "version": 1, "alpha2": 0.3}')
        for row in self.rows[:2]:
            row["weights"] = weights.name
        batch_table.write_manifest(self.manifest, self.rows)
        self.batch()

        def redone():
            return [name for name, status in self.batch().items() if status == "done"]

        self.write_transcript("t05", 77)
        self.assertEqual(redone(), ["t05"])
        (self.out / "t03.csv").unlink()
        self.assertEqual(redone(), ["t03"])
        with open(self.out / "t04.json", "a", encoding="utf-8") as output:
            output.write("\n")
        self.assertEqual(redone(), ["t04"])
        weights.write_text('{"format": "phonomime-weights", "version": 1, "alpha2": 0.4}')
        self.assertEqual(redone(), ["t00", "t01"])
        os.utime(self.folder / "t06.lab")
        self.rows[6]["id"] = "t06"
        batch_table.write_manifest(self.manifest, [*self.rows[4:], *self.rows[:4]])
        self.assertEqual(redone(), [])
        self.rows[7]["fps"] = "24"
        batch_table.write_manifest(self.manifest, self.rows)
        self.assertEqual(redone(), ["t07"])
        self.assertEqual(len(self.batch("--smoothing", 2)), self.ROWS)
        self.assertEqual(self.report["done"], self.ROWS)

    def test_the_recordings_count_not_their_file(self):
        self.batch()
        moved = self.folder / "moved.db"
        self.database.rename(moved)
        self.database = moved
        self.assertEqual(self.batch(), self.all_are("skipped"))
        cli.run_well("import", tiny_corpus.Corpus(self.folder / "more", name="ann", sentences=1, first=90).write(),
                     "--db", self.database)
        self.assertEqual(self.batch(), self.all_are("done"))

    def test_a_failed_row_stops_no_other(self):
        good = (self.folder / "t02.lab").read_text()
        (self.folder / "t02.lab").write_text("#\n0.3 100 pau\n0.4 100 axx\n")
        result = cli.run(*self.call())
        self.assertEqual(result.returncode, cli.BAD_INPUT)
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), 2, result.stderr)
        self.assertTrue(lines[0].startswith(f'failed: {self.manifest}:4 (t02): {self.folder}/t02.lab:3: phoneme "axx"'))
        self.assertEqual(lines[1], f"phonomime: {self.manifest}: 1 of 8 rows failed")
        self.assertRegex(result.stdout, r"^8 rows: 7 done, 0 skipped, 1 failed; [\d.]+ s\n$")
        self.assertEqual({name.split(".")[0] for name in self.outputs()}, set(self.names) - {"t02"})

        (self.folder / "t05.lab").unlink()
        statuses = self.batch(status=cli.IO)
        self.assertEqual(statuses, {**self.all_are("skipped"), "t02": "failed", "t05": "failed"})
        by_id = {row["id"]: row for row in self.report["rows"]}
        self.assertEqual((by_id["t02"]["line"], by_id["t02"]["exit_status"]), (4, cli.BAD_INPUT))
        self.assertEqual((by_id["t05"]["line"], by_id["t05"]["exit_status"]), (7, cli.IO))
        self.assertIn("t05.lab", by_id["t05"]["error"])
        self.assertIn("t05.csv", self.outputs())  # as it was

        (self.folder / "t02.lab").write_text(good)
        self.write_transcript("t05", 5)
        self.assertEqual(self.batch(), {**self.all_are("skipped"), "t02": "done"})

    def test_a_bad_manifest_changes_nothing(self):
        for rows, words in (
                ([{"transcript": "t00.lab"}], (f"{self.manifest}:2: the row has no output",)),
                ([*self.rows, {"transcript": "x/t00.lab", "outputs": "x.csv"}], (f"{self.manifest}:10: id \"t00\" is there twice",)),
                ([*self.rows, {"transcript": "x.lab", "outputs": "out/t03.csv"}],
                 (f"{self.manifest}:10: output", "written by line 5 too")),
                ([*self.rows, {"transcript": "x.lab", "outputs": "t00.csv", "fps": "fast"}],
                 (f"{self.manifest}:10: fps is not a number",))):
            batch_table.write_manifest(self.manifest, rows)
            self.assertRefused(cli.BAD_INPUT, words, *self.call())
        self.manifest.write_text("id\tfile\na\tb\n")
        self.assertRefused(cli.BAD_INPUT, (f"{self.manifest}:1: unknown column \"file\"",), *self.call())
        self.assertRefused(cli.USAGE, ("--shard: is not a shard", "\"3/2\""), *self.call("--shard", "3/2"))
        self.assertRefused(cli.IO, (self.folder / "none.tsv",), "batch", self.folder / "none.tsv", "--db", self.database)


class StopTest(batch_table.BatchTest):
    """Kills and stops in the midst of work."""
    ROWS = 24
    PHONEMES = 24
    CORPUS = {"sentences": 60, "emotions": ("neutral", "happiness")}

    def setUp(self):
        super().setUp()
        self.batch()
        self.whole = self.outputs()
        shutil.rmtree(self.out)

    def start_and_signal(self, number, finished):
        """Sends the signal once so many rows have left outputs; stderr and exit status."""
        with subprocess.Popen([cli.PROGRAM, *map(str, self.call())], stdin=subprocess.DEVNULL, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            end = time.monotonic() + cli.TIME_LIMIT_S
            while process.poll() is None and len(list(self.out.glob("*.csv"))) < finished and time.monotonic() < end:
                time.sleep(0.0005)
            process.send_signal(number)
            _, said = process.communicate(timeout=cli.TIME_LIMIT_S)
        return said, process.returncode

    def assertWholeOrAbsent(self):
        for name, data in self.outputs().items():
            if ".part-" not in name:
                self.assertTrue(self.whole[name] == data, f"{name} is not whole")

    def recorded(self):
        return len(list(self.out.glob(".phonomime-batch/*.csv.json")))

    def test_kill_9(self):
        killed = 0
        for finished in range(1, self.ROWS, 3):
            _, status = self.start_and_signal(signal.SIGKILL, finished)
            killed += status == -signal.SIGKILL
            self.assertWholeOrAbsent()
            (self.out / "t00.csv.part-1-0").write_text("half")
        self.assertGreaterEqual(killed, 3)
        done = self.recorded()
        self.assertGreater(done, 0)
        self.batch()
        self.assertEqual(self.report["skipped"], done)
        self.assertEqual(self.report["done"], self.ROWS - done)
        self.assertTrue(self.outputs() == self.whole)
        self.assertEqual(list(self.out.rglob("*.part-*")), [])

    def test_ctrl_c(self):
        for number, finished in ((signal.SIGINT, 2), (signal.SIGTERM, 8)):
            said, status = self.start_and_signal(number, finished)
            self.assertEqual((said, status), ("phonomime: interrupted\n", cli.INTERRUPTED))
            self.assertWholeOrAbsent()
            self.assertEqual(list(self.out.rglob("*.part-*")), [])
            self.assertEqual(self.recorded(), len(list(self.out.glob("*.csv"))))
        done = self.recorded()
        self.assertLess(done, self.ROWS)
        self.batch()
        self.assertEqual(self.report["skipped"], done)
        self.assertTrue(self.outputs() == self.whole)

    def test_progress_on_a_terminal(self):
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        process = subprocess.run([cli.PROGRAM, *map(str, self.call())], stdout=subprocess.PIPE, stderr=theirs, check=False)
        os.write(theirs, b"|")
        os.close(theirs)
        shown = b""
        while not shown.endswith(b"|"):
            shown += os.read(ours, 65536)
        self.assertEqual(process.returncode, cli.DONE)
        self.assertIn(f"/{self.ROWS}".encode(), shown)
        self.assertEqual(shown.split(b"\033[K")[-1], b"|")


if __name__ == "__main__":
    cli.main()
