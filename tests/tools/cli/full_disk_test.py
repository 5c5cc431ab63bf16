# SPDX-License-Identifier: GPL-3.0-or-later
"""A disk that fills up, wherever it ends: an error, and everything as it was."""
import contextlib
import os
import pathlib
import shutil
import subprocess
import tempfile

import phonomime_cli as cli
import tiny_corpus


PAGE_SIZE = 32768


class FullDiskTest(cli.CliTest):
    """A database of speaker ann, and a corpus of bob to add to it."""

    @classmethod
    def setUpClass(cls):
        folder = cli.scratch_folder(cls.addClassCleanup)
        cls.ann, cls.both = folder / "ann.db", folder / "both.db"
        cls.bob = tiny_corpus.Corpus(folder / "bob", name="bob", first=20).write()
        cli.run_well("import", tiny_corpus.Corpus(folder / "ann").write(), "--db", cls.ann)
        shutil.copyfile(cls.ann, cls.both)
        cli.run_well("import", cls.bob, "--db", cls.both)

    @contextlib.contextmanager
    def disk(self, size_bytes):
        """A file system of this size as self.folder / "disk"."""
        place = self.folder / "disk"
        place.mkdir(exist_ok=True)
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size_bytes}", "none", place], check=True)
        try:
            yield place
        finally:
            subprocess.run(["umount", place], check=True)

    def assertImportRefusedOrWhole(self, database, **options):
        """Refused, with every file as it was, or done, with everything in."""
        result = cli.run("import", self.bob, "--db", database, **options)
        if result.returncode == cli.DONE:
            self.assertEqual([path.name for path in database.parent.iterdir()], [database.name])
            self.assertIn("bob", cli.run_json("info", database)["speakers"])
            return False
        self.assertEqual(result.returncode, cli.IO, result.stderr)
        self.assertRegex(result.stderr, r"^phonomime: .*\n$")
        self.assertIn(str(database), result.stderr)
        self.assertNotIn("no more rows", result.stderr)
        return True

    def refused_imports(self, starts_with, sizes, limited):
        """How many of the imports were refused. `limited(size)` is a context that gives a folder and
        the options of the call."""
        refused = 0
        for size in sizes:
            with self.subTest(size=size), limited(size) as (place, options):
                database = place / "motion.db"
                if starts_with:
                    shutil.copyfile(starts_with, database)
                before = cli.contents(place)
                if self.assertImportRefusedOrWhole(database, **options):
                    refused += 1
                    self.assertEqual(cli.contents(place), before)
        return refused

    @contextlib.contextmanager
    def small_disk(self, size):
        with self.disk(size) as place:
            yield place, {}

    @contextlib.contextmanager
    def small_files(self, size):
        with tempfile.TemporaryDirectory(dir=self.folder) as place:
            yield pathlib.Path(place), {"preexec_fn": cli.limit_file_size(size)}

    def check_new_database(self, limited):
        whole = self.ann.stat().st_size
        sizes = [4096, 40960, *(whole * k // 6 for k in range(1, 14))]
        self.assertGreaterEqual(self.refused_imports(None, sizes, limited), 5)

    def test_importing_into_a_new_database_that_may_not_grow(self):
        self.check_new_database(self.small_files)

    @cli.needs_mounts
    def test_importing_into_a_new_database_on_a_small_disk(self):
        self.check_new_database(self.small_disk)

    def test_importing_into_a_database_that_may_not_grow(self):
        have = self.ann.stat().st_size
        sizes = [0, 4096, have // 2, *(have * k // 4 for k in range(1, 6))]
        self.assertGreaterEqual(self.refused_imports(self.ann, sizes, self.small_files), 3)

    @cli.needs_mounts
    def test_importing_into_a_database_on_a_small_disk(self):
        have, whole = self.ann.stat().st_size, self.both.stat().st_size
        sizes = [-(-have // 4096) * 4096, *(have + whole * k // 6 for k in range(1, 10))]
        self.assertGreaterEqual(self.refused_imports(self.ann, sizes, self.small_disk), 4)

    def synth(self, place):
        transcript = cli.write_transcript(self.folder / "hello.lab", ["b", "aa", "m", "eh", "p", "iy", "s"])
        outputs = [place / f"out.{kind}" for kind in cli.KINDS]
        face = tiny_corpus.write_face(self.folder / "face")
        return ["synth", "--db", self.ann, transcript, "--face", face,
                *(word for path in outputs for word in ("-o", path))], outputs

    def test_outputs_that_may_not_grow(self):
        """Of an earlier call none is lost, and of a new one none appears."""
        call, outputs = self.synth(self.folder)
        cli.run_well(*call)
        sizes = [path.stat().st_size for path in outputs]
        for earlier in (True, False):
            for path in outputs:
                path.write_text("of an earlier call")
                if not earlier:
                    path.unlink()
            for limit in (0, 100, *(size - 1 for size in sizes)):
                with self.subTest(earlier=earlier, limit=limit):
                    line = self.assertRefused(cli.IO, ["out."], *call, preexec_fn=cli.limit_file_size(limit))
                    self.assertTrue(any(str(path) in line for path in outputs), line)

    @cli.needs_mounts
    def test_outputs_on_a_small_disk(self):
        call, outputs = self.synth(self.folder)
        cli.run_well(*call)
        sizes = [path.stat().st_size for path in outputs]
        for total in (8192, sum(sizes) // 3, sum(sizes) - max(sizes) // 2):
            with self.subTest(size=total), self.disk(total) as place:
                call, _ = self.synth(place)
                self.assertRefused(cli.IO, ["disk/out."], *call)

    def test_standard_output(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("skipped: /dev/full is missing")
        for arguments in (["info", self.ann], ["nodes", self.ann, "--json"], ["--help"]):
            with self.subTest(arguments[0]), open("/dev/full", "wb") as full:
                result = subprocess.run([cli.PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE,
                                        text=True, check=False)
                self.assertEqual(result.returncode, cli.IO)
                self.assertRegex(result.stderr, r"^phonomime: standard output: .*\n$")


if __name__ == "__main__":
    cli.enter_namespace_to_mount()
    cli.main()
