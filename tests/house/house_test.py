# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the lints on this repository. PHONOMIME in the environment names the program."""

import os
import pathlib
import unittest

import architecture
import build_files
import documents
import files
from tree import Tree

ROOT = pathlib.Path(__file__).resolve().parents[2]


class House(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tree = Tree(ROOT)

    def run_lints(self, lints, *arguments):
        for lint in lints:
            with self.subTest(lint.__doc__):
                findings = lint(self.tree, *arguments)
                print(f"{lint.__doc__} ({findings.looked_at} looked at)")
                self.assertGreater(findings.looked_at, 0, "looked at nothing")
                if findings.problems:
                    self.fail("\n" + "\n".join(findings.problems))

    def test_architecture(self):
        self.run_lints(architecture.LINTS)

    def test_files(self):
        self.run_lints(files.LINTS)

    def test_build_files(self):
        self.run_lints(build_files.LINTS)

    def test_documents(self):
        self.run_lints(documents.LINTS)
        self.run_lints(documents.LINTS_WITH_PROGRAM, os.environ["PHONOMIME"])


if __name__ == "__main__":
    unittest.main()
