# SPDX-License-Identifier: GPL-3.0-or-later
"""A database that is not one, or that cannot be written, is refused with one line and left alone."""
import sqlite3
import subprocess
import sys

import phonomime_cli as cli
import tiny_corpus

LOCKER = """
import sqlite3, sys
connection = sqlite3.connect(sys.argv[1], isolation_level=None)
connection.execute("BEGIN EXCLUSIVE")
print("locked", flush=True)
sys.stdin.read()
"""


class BadDatabaseTest(cli.DatabaseTest):
    def setUp(self):
        super().setUp()
        self.corpus = tiny_corpus.Corpus(self.folder / "bob", name="bob", first=20).write()
        self.transcript = cli.write_transcript(self.folder / "hello.lab", ["b", "aa", "m"])

    def edit(self, *statements):
        connection = sqlite3.connect(self.database)
        for statement in statements:
            connection.execute(statement)
        connection.commit()
        connection.close()

    def calls(self):
        """Every verb that opens a database."""
        return (["info", self.database], ["nodes", self.database],
                ["synth", "--db", self.database, self.transcript, "-o", self.folder / "out.csv"],
                ["import", self.corpus, "--db", self.database])

    def assertEachRefused(self, *words, status=cli.BAD_INPUT):
        for call in self.calls():
            with self.subTest(call[0]):
                self.assertRefused(status, [self.database, *words], *call)

    def test_the_database_is_good_before_it_is_spoilt(self):
        for call in self.calls():
            cli.run_well(*call)

    def test_another_program_s_database(self):
        with self.subTest("SQLite's"):
            self.database.unlink()
            self.edit("PRAGMA application_id = 252006673", "CREATE TABLE photos (name TEXT)")
            self.assertEachRefused("another program")
        with self.subTest("SQLite's, with a table and a version of ours"):
            self.database.unlink()
            self.edit("PRAGMA user_version = 1", "CREATE TABLE nodes (name TEXT)")
            self.assertEachRefused("another program")
        with self.subTest("text"):
            self.database.write_text("a shopping list\n" * 100)
            self.assertEachRefused("not a motion database")
        with self.subTest("a C3D file"):
            self.database.write_bytes(next((self.corpus / "motion").iterdir()).read_bytes())
            self.assertEachRefused("not a motion database")

    def test_a_future_version(self):
        self.edit("PRAGMA user_version = 999")
        self.assertEachRefused("999", "version")

    def test_a_truncated_database(self):
        for length in (1, 50, 100, 4096, len(self.made) // 2, len(self.made) - 4096, len(self.made) - 1):
            with self.subTest(length=length):
                self.database.write_bytes(self.made[:length])
                self.assertEachRefused()

    def test_an_empty_file_is_no_database_to_read_and_a_new_one_to_import_into(self):
        self.database.write_bytes(b"")
        for call in self.calls()[:-1]:
            with self.subTest(call[0]):
                self.assertRefused(cli.BAD_INPUT, [self.database], *call)
        cli.run_well(*self.calls()[-1])
        self.assertEqual(cli.run_json("info", self.database)["speakers"], ["bob"])

    def test_a_database_without_one_of_its_tables(self):
        self.edit("PRAGMA foreign_keys = OFF", "DROP TABLE coefficients")
        for call in self.calls()[2:]:
            with self.subTest(call[0]):
                self.assertRefused(cli.BAD_INPUT, [self.database, "damaged"], *call)

    def test_blobs_of_another_size(self):
        self.edit("UPDATE coefficients SET frames = x'00'")
        self.assertRefused(cli.BAD_INPUT, [self.database, "damaged"], *self.calls()[2])

    def test_a_database_that_is_not_there(self):
        self.database.unlink()
        for call in self.calls()[:-1]:
            with self.subTest(call[0]):
                self.assertRefused(cli.IO, [self.database, "phonomime import"], *call)

    def test_a_folder_in_its_place(self):
        self.database.unlink()
        self.database.mkdir()
        for call in self.calls():
            with self.subTest(call[0]):
                self.assertRefused(cli.BAD_INPUT, [self.database, "folder"], *call)

    def test_a_database_that_another_program_writes(self):
        # A process of its own: reading the file here would let go of this one's lock.
        with subprocess.Popen([sys.executable, "-c", LOCKER, self.database], stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE, text=True) as locker:
            self.assertEqual(locker.stdout.readline(), "locked\n")
            self.assertRefused(cli.IO, [self.database, "another program"], *self.calls()[-1])
            locker.stdin.close()
        cli.run_well(*self.calls()[-1])

    def test_places_that_cannot_be_written(self):
        for place in ("nowhere/new.db", "made.db/new.db", "/proc/new.db"):
            with self.subTest(place):
                path = self.folder / place
                self.assertRefused(cli.IO, [path], "import", self.corpus, "--db", path)

    def test_a_read_only_folder(self):
        sealed = self.folder / "sealed"
        sealed.mkdir()
        (sealed / "ann.db").write_bytes(self.made)
        self.database = sealed / "ann.db"
        cli.seal(self, sealed)
        self.assertRefused(cli.IO, [sealed / "new.db"], "import", self.corpus, "--db", sealed / "new.db", as_user=True)
        self.assertRefused(cli.IO, [self.database], *self.calls()[-1], as_user=True)
        for call in self.calls()[:-1]:  # reading is for everybody
            cli.run_well(*call, as_user=True)


if __name__ == "__main__":
    cli.main()
