# SPDX-License-Identifier: GPL-3.0-or-later
"""tools/lib/test_report.py, on reports as ctest writes them."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from xml.sax.saxutils import escape

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools/lib/test_report.py"

GTEST_SKIP = """[ RUN      ] Search.Real
a_test.cpp:3: Skipped
skipped: needs {}, not here
[  SKIPPED ] Search.Real (0 ms)
[ RUN      ] Search.Made
[       OK ] Search.Made (0 ms)
[  SKIPPED ] 1 test, listed below:
[  SKIPPED ] Search.Real
"""


def case(name, status, output="", inside=""):
    return (f'<testcase name="{name}" classname="{name}" status="{status}">{inside}'
            f"<system-out>{escape(output)}</system-out></testcase>")


SKIPPED = '<skipped message="SKIP_RETURN_CODE=77"/>'
# Programs that start another without root's rights, and with them.
WITHOUT_RIGHTS = ["setpriv", "--bounding-set=-all", "--inh-caps=-all"] if os.geteuid() == 0 else []
WITH_RIGHTS = (["unshare", "--mount", "--propagation", "unchanged"] if os.geteuid() == 0
               else ["unshare", "--user", "--map-root-user"])


class Report(unittest.TestCase):
    def report(self, *cases, through=()):
        """Exit status and output of the script, started through another program."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "report.xml"
            path.write_text("<testsuite>" + "".join(cases) + "</testsuite>", encoding="utf-8")
            run = subprocess.run([*through, sys.executable, SCRIPT, f"release={path}"], text=True,
                                 check=False, capture_output=True)
        return run.returncode, run.stdout

    def test_passed(self):
        status, output = self.report(case("a", "run"), case("b", "run"))
        self.assertEqual(status, 0)
        self.assertEqual(output.splitlines()[-1], "2 passed, 0 failed, 0 skipped")

    def test_failed(self):
        status, output = self.report(case("a", "run"), case("b", "fail"))
        self.assertEqual(status, 1)
        self.assertIn("error: release: b failed", output)
        self.assertEqual(output.splitlines()[-1], "1 passed, 1 failed, 0 skipped")

    def test_not_built(self):
        self.assertEqual(self.report(case("a", "run"), case("b", "notrun"))[0], 1)

    def test_no_tests(self):
        self.assertEqual(self.report()[0], 1)

    def test_skip_that_needs_recordings(self):
        status, output = self.report(
            case("a", "run", GTEST_SKIP.format("the recordings in ../shared/data")),
            case("b", "notrun", "skipped: needs ../shared/data\nbye\n", SKIPPED))
        self.assertEqual(status, 0, output)
        self.assertIn("skipped in a: Search.Real: ", output)
        self.assertEqual(output.splitlines()[-1], "1 passed, 0 failed, 1 skipped")

    def test_unittest_that_needs_recordings_throughout(self):
        skips = "test_{} (__main__.X.test_{}) ... skipped 'skipped: needs {}'\n"
        said = skips.format("x", "x", "../shared/data") + skips.format("y", "y", "{}") + "\nOK (skipped=2)\n"
        for other, expected in (("../shared/data", 0), ("numpy", 1)):
            status, output = self.report(case("a", "run"), case("b", "notrun", said.format(other), SKIPPED))
            self.assertEqual(status, expected, output)

    def test_skip_that_needs_the_right_to_mount(self):
        skip = case("a", "run", GTEST_SKIP.format("the right to mount"))
        status, output = self.report(skip, through=WITHOUT_RIGHTS)
        self.assertEqual(status, 0, output)
        if subprocess.run([*WITH_RIGHTS, "true"], capture_output=True, check=False).returncode == 0:
            status, output = self.report(skip, through=WITH_RIGHTS)
            self.assertEqual(status, 1, output)

    def test_other_skips_are_errors(self):
        for name, other in (
                ("googletest", case("a", "run", GTEST_SKIP.format("Chromium"))),
                ("whole test", case("a", "notrun", "skipped: Chromium is missing\n", SKIPPED)),
                ("silent", case("a", "notrun", "", SKIPPED)),
                ("disabled", case("a", "disabled")),
                ("googletest disabled", case("a", "run", "  YOU HAVE 1 DISABLED TEST\n")),
                ("unittest", case("a", "run", "test_x (__main__.X.test_x) ... skipped 'no numpy'\n")),
                ("node", case("a", "run", "ok 1 - page # SKIP no browser\n")),
        ):
            with self.subTest(name):
                status, output = self.report(case("b", "run"), other)
                self.assertEqual(status, 1, output)
                self.assertIn("only a test that needs ../shared, or a right that this user has not, may be skipped", output)


if __name__ == "__main__":
    unittest.main()
