# SPDX-License-Identifier: GPL-3.0-or-later
"""tools/check, with other programs in the place of those that build and test."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
STEP = re.compile(r"^\[\d+/\d+\] .*", re.MULTILINE)
REPORT = '<testsuite><testcase name="a" status="run"><system-out/></testcase></testsuite>'
CTEST = """while [ "$1" != --output-junit ]; do shift; done
printf '%s' '{}' >"$2"
"""


class Check(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root, self.bin = pathlib.Path(folder.name) / "root", pathlib.Path(folder.name) / "bin"
        shutil.copytree(ROOT / "tools", self.root / "tools", ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copytree(ROOT / ".ci", self.root / ".ci")
        shutil.copy(ROOT / ".clang-format", self.root)
        for name in ("docs", "tests"):
            (self.root / name).mkdir()
        self.bin.mkdir()
        for name in ("cmake", "node", "npm"):
            self.program(name, "")
        for name in ("apt-get", "sudo"):
            self.program(name, "echo nothing to be had; exit 100")
        self.program("dpkg-query", "printf installed")
        self.program("ctest", CTEST.format(REPORT))
        self.program(self.root / "tools/quickstart", "")

    def program(self, name, script):
        path = self.bin / name
        path.write_text(f"#!/bin/sh\n{script}\n")
        path.chmod(0o755)

    def check(self, *arguments):
        """Exit status, stdout and stderr."""
        run = subprocess.run(["tools/check", *arguments], cwd=self.root, text=True, check=False,
                             capture_output=True, stdin=subprocess.DEVNULL,
                             env={**os.environ, "PATH": f"{self.bin}:{os.environ['PATH']}"})
        return run.returncode, run.stdout, run.stderr

    def assertFails(self, *words):
        status, said, errors = self.check()
        self.assertNotEqual(status, 0, said)
        for word in words:
            self.assertIn(word, said + errors)

    def test_all_is_well_and_it_prints_what_readme_says(self):
        status, said, errors = self.check()
        self.assertEqual(status, 0, said + errors)
        steps = STEP.findall(said)
        count = f"/{len(steps)}] "
        readme = STEP.findall((ROOT / "README.md").read_text(encoding="utf-8"))
        self.assertEqual(steps, [line for line in readme if count in line])
        self.assertEqual(said.splitlines()[-1], "3 passed, 0 failed, 0 skipped")

    def test_all_presets(self):
        self.program("clang-tidy-14", "")
        status, said, errors = self.check("--all")
        self.assertEqual(status, 0, said + errors)
        steps = STEP.findall(said)
        self.assertTrue(steps[-1].startswith(f"[{len(steps)}/{len(steps)}] "), steps[-1])
        self.assertEqual(said.splitlines()[-1], "4 passed, 0 failed, 0 skipped")

    def test_no_tests(self):
        self.program("ctest", "exit 8")
        self.assertFails("no tests ran in preset release")
        self.program("ctest", CTEST.format("<testsuite/>"))
        self.assertFails("release: no test passed", "tsan: no test passed")

    def test_a_failed_test(self):
        self.program("ctest", CTEST.format(REPORT.replace("run", "fail")) + "exit 8")
        self.assertFails("asan: a failed", "0 passed, 3 failed, 0 skipped")

    def test_missing_packages(self):
        self.program("dpkg-query", "exit 1")
        self.assertFails("[1/", "check: ")

    def test_a_source_of_another_form(self):
        (self.root / "tests/x.cpp").write_text("int   x ;\n")
        self.assertFails("x.cpp:1", "clang-format")

    def test_a_script_with_a_defect(self):
        for folder in ("docs", "tools"):
            (self.root / folder / "x").write_text("#!/usr/bin/env bash\nrm $1\n")
            self.assertFails(f"In {folder}/x line 2", "SC2086")

    def test_a_failed_build(self):
        self.program("cmake", "echo no such compiler; exit 3")
        self.assertFails("no such compiler", "release-configure.log")

    def test_a_quickstart_that_fails(self):
        self.program(self.root / "tools/quickstart", "exit 5")
        self.assertFails("failed: tools/quickstart")

    def test_errors_are_short(self):
        (self.root / "tests/x.cpp").write_text("int   x ;\n")
        _, _, errors = self.check()
        self.assertLess(max(map(len, errors.splitlines())), 400)


if __name__ == "__main__":
    unittest.main()
