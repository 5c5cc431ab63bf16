# SPDX-License-Identifier: GPL-3.0-or-later
"""Running the program in tests: $PHONOMIME is its path, set by CMakeLists.txt.

A test file ends with `phonomime_cli.main()`: exit status 77 (ctest's SKIP_RETURN_CODE) where every
test was skipped, 1 where one failed or none was found.
"""
import collections
import hashlib
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import tiny_corpus

PROGRAM = os.environ.get("PHONOMIME", "phonomime")
SOURCE_DIR = pathlib.Path(__file__).resolve().parents[3]
TIME_LIMIT_S = 300

DONE, USAGE, BAD_INPUT, IO, INTERNAL, INTERRUPTED = 0, 2, 3, 4, 5, 130
# Kinds of output; .html where the program was built with the player.
KINDS = ("csv", "glb", "html", "json", "txt") if os.environ.get("PHONOMIME_PLAYER_HTML", "?") else ("csv", "glb", "json", "txt")


def _shared_data():
    folder = pathlib.Path(os.environ.get("PHONOMIME_SHARED_DATA", SOURCE_DIR.parent / "shared" / "data"))
    return folder.resolve() if folder.is_dir() else None


SHARED_DATA = _shared_data()
needs_shared_data = unittest.skipIf(
    SHARED_DATA is None, "skipped: needs the recordings in ../shared/data, which are not here")


def _is_let(*command):
    return subprocess.run([*command, "true"], stderr=subprocess.DEVNULL, check=False).returncode == 0


# In a chroot the root folder is no mount point, and its propagation cannot be changed.
MAY_MOUNT = _is_let("unshare", "--mount", "--propagation", "unchanged")
needs_mounts = unittest.skipUnless(MAY_MOUNT, "skipped: needs the right to mount")


def run(*arguments, as_user=False, **options):
    """The program's CompletedProcess; stdout and stderr are text, stdin is empty. With `as_user` the
    rights of files bind it, whoever runs the test."""
    rightless = ["setpriv", "--bounding-set=-all", "--inh-caps=-all"] if as_user and os.geteuid() == 0 else []
    return subprocess.run(
        [*rightless, PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True, timeout=TIME_LIMIT_S, check=False, **options)


def run_well(*arguments, **options):
    """Its stdout; an AssertionError where it does not succeed."""
    result = run(*arguments, **options)
    if result.returncode != DONE:
        raise AssertionError(f"phonomime {' '.join(map(str, arguments))}: status {result.returncode}\n{result.stderr}")
    return result.stdout


def prune(database, key):
    run_well("prune", database, key, "--by", "ann", "--reason", "jump")


def run_json(*arguments):
    return json.loads(run_well(*arguments, "--json"))


Signalled = collections.namedtuple("Signalled", "status said work_s")


def run_until(*arguments, number=None, after_s=0.0):
    """Runs the program, which gets the signal once it has worked (not waited) so long. Its exit
    status, its stderr and the time that it worked."""
    work_s = 0.0
    with subprocess.Popen([PROGRAM, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True) as process:
        while process.poll() is None:
            try:
                work_s = int(pathlib.Path(f"/proc/{process.pid}/schedstat").read_text().split()[0]) * 1e-9
            except (OSError, IndexError):  # it has just ended
                break
            if number and work_s >= after_s:
                process.send_signal(number)
                break
            time.sleep(0.001)
        _, said = process.communicate(timeout=TIME_LIMIT_S)
    return Signalled(process.returncode, said, work_s)


def limit_file_size(size_bytes):
    """For `preexec_fn`: writing beyond this size fails, as on a full disk."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size_bytes, size_bytes))
    return limit


def _digest(path):
    data = bytearray(path.read_bytes())
    if data.startswith(b"SQLite format 3\0"):
        data[24:28] = data[92:96] = b"\0\0\0\0"  # SQLite counts there how often the file was taken in hand
    return hashlib.sha256(data).hexdigest()


def seal(test, folder):
    """Makes a folder read-only for the rest of a test, for calls with as_user=True."""
    os.chmod(folder, 0o500)
    test.addCleanup(os.chmod, folder, 0o700)


def contents(folder):
    """What is in a folder: {relative path: SHA-256, a link's target, or None for a folder}."""
    found = {}
    for path in sorted(pathlib.Path(folder).rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_symlink():
            found[name] = os.readlink(path)
        else:
            found[name] = _digest(path) if path.is_file() else None
    return found


def without_timings(result):
    """A result without its only field that may differ from run to run."""
    copy = json.loads(json.dumps(result))
    del copy["search"]["seconds"]
    return copy


def state(database):
    """All that the program tells of a database, but its path and the hour of its imports."""
    info = run_json("info", database)
    del info["database"]
    for corpus in info["corpora"]:
        del corpus["imported_at"]
    return info, run_json("nodes", database)


def write_lab(path, rows):
    """An xlabel file of (end in seconds, label)."""
    path.write_text("#\n" + "".join(f"{end:.4f} 100 {label}\n" for end, label in rows))
    return path


def read_lab(path):
    """Rows of an xlabel file: (end in seconds, label)."""
    body = path.read_text().split("#\n", 1)[1]
    return [(float(words[0]), words[2]) for words in map(str.split, body.splitlines()) if words]


def rigid_markers(corpus):
    """Names of the markers that a corpus' layout calls rigid."""
    layout = json.loads((corpus / "layout.json").read_text())
    return [group["name"] for group in layout["groups"] if "rigid" in group.get("regions", [])]


def write_transcript(path, phonemes, each_s=0.1, rest_s=0.3):
    """An xlabel file of phonemes of the same length, with silence at both ends."""
    ends = [rest_s + each_s * (i + 1) for i in range(len(phonemes))]
    return write_lab(path, [(rest_s, "pau"), *zip(ends, phonemes), (ends[-1] + rest_s, "pau")])


def scratch_folder(add_cleanup):
    """A folder that is there until `add_cleanup` (of a test or of its class) has it removed."""
    folder = tempfile.TemporaryDirectory(prefix="phonomime_cli_", ignore_cleanup_errors=True)
    add_cleanup(folder.cleanup)
    return pathlib.Path(folder.name)


class CliTest(unittest.TestCase):
    """Each test has a folder of its own, `self.folder`."""

    def setUp(self):
        self.folder = scratch_folder(self.addCleanup)

    def assertRefused(self, status, words, *arguments, **options):
        """One line on stderr with all of the words, nothing on stdout, this status, and every file of
        self.folder as it was. Returns the line."""
        before = contents(self.folder)
        result = run(*arguments, **options)
        said = f"phonomime {' '.join(map(str, arguments))}\nstatus {result.returncode}: {result.stderr}"
        self.assertEqual(result.returncode, status, said)
        self.assertEqual(result.stdout, "", said)
        self.assertEqual(result.stderr.count("\n"), 1, said)
        self.assertTrue(result.stderr.startswith("phonomime: "), said)
        self.assertTrue(result.stderr.endswith("\n"), said)
        for word in words:
            self.assertIn(str(word), result.stderr, said)
        self.assertEqual(contents(self.folder), before, said)
        return result.stderr


class DatabaseTest(CliTest):
    """Each test has a new copy of a database, `self.database`, of the corpus that CORPUS describes."""

    CORPUS = {}  # arguments of tiny_corpus.Corpus

    @classmethod
    def setUpClass(cls):
        folder = scratch_folder(cls.addClassCleanup)
        run_well("import", tiny_corpus.Corpus(folder / "corpus", **cls.CORPUS).write(), "--db", folder / "made.db")
        cls.made = (folder / "made.db").read_bytes()

    def setUp(self):
        super().setUp()
        self.database = self.folder / "made.db"
        self.database.write_bytes(self.made)


class RecordingsTest(unittest.TestCase):
    """All tests share a folder, `self.folder`, with a database of the corpus grid_s1, `self.database`."""

    @classmethod
    def setUpClass(cls):
        cls.folder = scratch_folder(cls.addClassCleanup)
        cls.database = cls.folder / "grid_s1.db"
        run_well("import", SHARED_DATA / "grid_s1", "--db", cls.database)


def enter_namespace_to_mount():
    """Where this process may not mount: starts the script again as root of a user namespace of its own,
    which may mount what is its own. Returns where it may, or where this machine has no namespaces."""
    enter = ["unshare", "--user", "--map-root-user", "--mount"]
    if not MAY_MOUNT and _is_let(*enter):
        os.execvp(enter[0], [*enter, *sys.orig_argv])


def main():
    program = unittest.main(exit=False, verbosity=2)
    result = program.result
    if not result.wasSuccessful() or result.testsRun == 0:
        sys.exit(1)
    sys.exit(77 if len(result.skipped) == result.testsRun else 0)
