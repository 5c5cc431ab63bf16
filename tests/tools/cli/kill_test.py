# SPDX-License-Identifier: GPL-3.0-or-later
"""An import that is killed or stopped leaves the database as it was before, or as it is after."""
import json
import os
import shutil
import signal

import phonomime_cli as cli
import tiny_corpus

KILLS = 25  # of imports into a new database, and as many into one that holds a corpus

KILLS_OF_RECORDINGS = 6


def run_import(corpus, database, number=None, after_s=0.0):
    return cli.run_until("import", corpus, "--db", database, "--quiet", "--threads", "1", number=number, after_s=after_s)


class KillCase(cli.CliTest):
    def holds_all(self, database, before, after):
        """Of two states, is it the second? Where there was no database (None), none and an empty one
        are the same."""
        if not before and not database.exists():
            return False
        info = cli.run("info", database, "--json")
        if not before and (info.returncode != cli.DONE or not json.loads(info.stdout)["corpora"]):
            self.assertIn(info.returncode, (cli.DONE, cli.BAD_INPUT))
            self.assertEqual(info.stderr, "" if info.returncode == cli.DONE else (
                f"phonomime: {database}: this file is empty: there is no corpus in it. "
                "Fill it with `phonomime import CORPUS --db DB`.\n"))
            return False
        state = cli.state(database)
        if before and state == before:
            return False
        self.assertEqual(state, after)
        return True


class KillTest(KillCase):
    @classmethod
    def setUpClass(cls):
        folder = cli.scratch_folder(cls.addClassCleanup)
        cls.old = tiny_corpus.Corpus(folder / "old", name="old", first=500).write()
        cls.new = tiny_corpus.Corpus(folder / "new", sentences=80, phonemes=40).write()
        cls.next = tiny_corpus.Corpus(folder / "next", name="next", sentences=1, first=900).write()
        cls.before, cls.only_new, cls.both = (folder / f"{name}.db" for name in ("before", "only_new", "both"))
        cli.run_well("import", cls.old, "--db", cls.before)
        shutil.copyfile(cls.before, cls.both)
        cls.work_s = run_import(cls.new, cls.only_new).work_s
        cli.run_well("import", cls.new, "--db", cls.both)
        cls.states = {path: cli.state(path) for path in (cls.before, cls.only_new, cls.both)}

    def moments(self, count):
        """From the start of an import to its end, in seconds of work."""
        return [self.work_s * (k + 0.5) / count for k in range(count)]

    def kill_imports(self, start_from):
        """How many of the imports were killed before they were done."""
        stopped = 0
        after = self.both if start_from else self.only_new
        for k, after_s in enumerate(self.moments(KILLS)):
            with self.subTest(kill=k, after_s=round(after_s, 3)):
                folder = self.folder / f"kill{k}"
                folder.mkdir()
                database = folder / "motion.db"
                if start_from:
                    shutil.copyfile(start_from, database)
                killed = run_import(self.new, database, signal.SIGKILL, after_s)
                self.assertIn(killed.status, (cli.DONE, -signal.SIGKILL), killed.said)
                done = self.holds_all(database, self.states.get(start_from), self.states[after])
                stopped += not done
                if not done:
                    cli.run_well("import", self.new, "--db", database)
                    self.assertEqual(cli.state(database), self.states[after])
                # The next import takes what a killed one has left beside the file.
                cli.run_well("import", self.next, "--db", database)
                self.assertEqual([path.name for path in folder.iterdir()], ["motion.db"])
                self.assertEqual(cli.run_json("info", database)["nodes"], len(self.states[after][1]) + 12)
                shutil.rmtree(folder)
        return stopped

    def test_kill_9_on_a_new_database(self):
        self.assertGreaterEqual(self.kill_imports(None), KILLS // 2)

    def test_kill_9_on_a_database_that_holds_a_corpus(self):
        self.assertGreaterEqual(self.kill_imports(self.before), KILLS // 2)

    def test_interrupts_leave_all_as_it_was(self):
        """By SIGINT (Ctrl-C) and SIGTERM; a signal before the program listens ends it at once."""
        stopped = 0
        for start_from in (None, self.before):
            for k, after_s in enumerate(self.moments(8)):
                number = (signal.SIGINT, signal.SIGTERM)[k % 2]
                with self.subTest(start_from=start_from and start_from.name, signal=number.name, after_s=round(after_s, 3)):
                    folder = self.folder / "interrupted"
                    folder.mkdir()
                    self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
                    database = folder / "motion.db"
                    if start_from:
                        shutil.copyfile(start_from, database)
                    before = cli.contents(folder)
                    stop = run_import(self.new, database, number, after_s)
                    self.assertIn(stop.status, (cli.DONE, cli.INTERRUPTED, -number), stop.said)
                    if stop.status == cli.DONE:
                        self.assertIn("ann", cli.run_json("info", database)["speakers"])
                    else:
                        self.assertEqual(cli.contents(folder), before)
                    if stop.status == cli.INTERRUPTED:
                        stopped += 1
                        self.assertEqual(stop.said, "phonomime: interrupted\n")
                    shutil.rmtree(folder)
        self.assertGreaterEqual(stopped, 4)


@cli.needs_shared_data
class KillRecordingsTest(KillCase):
    """Imports of recordings, killed again and again over the same file until one is let through."""

    @classmethod
    def setUpClass(cls):
        folder = cli.scratch_folder(cls.addClassCleanup)
        recordings = cli.SHARED_DATA / "grid_s1"
        cls.few, cls.most = folder / "few", folder / "most"
        shutil.copytree(recordings, cls.few)
        shutil.copytree(cls.few, cls.most, copy_function=os.link)
        head, *sentences = (recordings / "sentences.tsv").read_text().splitlines()
        for corpus, part in ((cls.few, sentences[:20]), (cls.most, sentences[20:])):
            (corpus / "sentences.tsv").unlink()
            (corpus / "sentences.tsv").write_text("\n".join([head, *part]) + "\n")
        cls.start = folder / "few.db"
        cli.run_well("import", cls.few, "--db", cls.start)

    def kill_imports(self, start_from):
        """How many of the imports were killed before they were done."""
        whole, database = self.folder / "whole.db", self.folder / "killed/motion.db"
        database.parent.mkdir()
        for path in (whole, database):
            if start_from:
                shutil.copyfile(start_from, path)
        before = cli.state(database) if start_from else None
        work_s = run_import(self.most, whole).work_s
        after = cli.state(whole)
        stopped = 0
        for k in range(KILLS_OF_RECORDINGS):
            after_s = work_s * (k + 0.5) / KILLS_OF_RECORDINGS
            with self.subTest(kill=k, after_s=round(after_s, 3)):
                killed = run_import(self.most, database, signal.SIGKILL, after_s)
                self.assertIn(killed.status, (cli.DONE, -signal.SIGKILL), killed.said)
                if self.holds_all(database, before, after):
                    break  # the last of them may have come too late: SQLite's log may still lie beside it
                stopped += 1
        else:
            cli.run_well("import", self.most, "--db", database)
            self.assertEqual([path.name for path in database.parent.iterdir()], ["motion.db"])
        self.assertEqual(cli.state(database), after)
        return stopped

    def test_kill_9_on_a_new_database(self):
        self.assertGreaterEqual(self.kill_imports(None), KILLS_OF_RECORDINGS // 2)

    def test_kill_9_on_a_database_that_holds_a_corpus(self):
        self.assertGreaterEqual(self.kill_imports(self.start), KILLS_OF_RECORDINGS // 2)


if __name__ == "__main__":
    cli.main()
