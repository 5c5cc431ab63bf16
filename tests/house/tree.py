# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of a repository, for the lints beside this file.

A lint is a function of a Tree that returns a Findings: how many things it looked at, and what is
wrong, one line each. A lint that looked at nothing has failed.
"""

import dataclasses
import pathlib
import posixpath

NOT_OURS = {".git", "build", "out", "node_modules", "__pycache__"}
SOURCE_FOLDERS = ("corpora_schema", "db", "isomap", "synth", "tools")


@dataclasses.dataclass
class Findings:
    looked_at: int
    problems: list


class Tree:
    """The repository's files, by path relative to its root, with forward slashes."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.paths = sorted(self._walk(self.root))

    def _walk(self, folder):
        for entry in folder.iterdir():
            if entry.is_dir() and not entry.is_symlink():
                if entry.name not in NOT_OURS:
                    yield from self._walk(entry)
            elif entry.name != ".git":
                yield entry.relative_to(self.root).as_posix()

    def with_suffix(self, *suffixes, folders=("",)):
        """Paths that end in one of the suffixes and lie in one of the folders."""
        places = tuple(folder + "/" if folder else "" for folder in folders)
        return [path for path in self.paths if path.endswith(suffixes) and path.startswith(places)]

    def named(self, *names):
        return [path for path in self.paths if posixpath.basename(path) in names]

    def bytes(self, path):
        return (self.root / path).read_bytes()

    def text(self, path):
        return self.bytes(path).decode("utf-8", errors="replace")

    def lines(self, path):
        """(number, line) of each line, counted from 1."""
        return enumerate(self.text(path).splitlines(), start=1)


def folder_of(path):
    return posixpath.dirname(path)
