# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads what ctest wrote with --output-junit, lists what was skipped, and adds up.

usage: test_report.py NAME=FILE.xml...

Only a test that needs the recordings in ../shared may be skipped, and one that has to mount a disk
where neither this process nor a user namespace has the right to: any other skip is an error, as are a
disabled test and a run of no tests. The last line is the sum: "N passed, N failed, N skipped".
"""

import re
import sys
import xml.etree.ElementTree

RECORDINGS = "../shared"
MOUNT = "needs the right to mount"
CAP_SYS_ADMIN = 21
NAMED_REASON = "skipped: "

# How each kind of test says that a part of it was skipped.
GTEST_RUN = re.compile(r"^\[ RUN      \] (\S+)$")
GTEST_SKIPPED = re.compile(r"^\[  SKIPPED \] (\S+) \(\d+ ms\)$")
GTEST_DISABLED = re.compile(r"^\s*YOU HAVE \d+ DISABLED TESTS?")
UNITTEST_SKIPPED = re.compile(r"^(.*) \.\.\. skipped (['\"])(.*)\2$")
NODE_SKIPPED = re.compile(r"^(.*\S) # (?:SKIP|TODO)\b\s*(.*)$")


def skipped_parts(output):
    """Yields (name, reason) of each part that a test's own output reports as skipped."""
    said = []
    for line in output.splitlines():
        if GTEST_RUN.match(line):
            said = []
        elif match := GTEST_SKIPPED.match(line):
            yield match[1], " ".join(said)
        elif GTEST_DISABLED.match(line):
            yield "a disabled test", line.strip()
        elif match := UNITTEST_SKIPPED.match(line):
            yield match[1], match[3]
        elif match := NODE_SKIPPED.match(line):
            yield match[1].strip(), match[2]
        else:
            said.append(line.strip())


def reason_in(output):
    """The line that says why a whole test was skipped, else the last one."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    named = [line for line in lines if line.startswith(NAMED_REASON)]
    return (named or lines or ["it does not say why"])[-1]


def may_mount():
    """Whether this process, and so the tests that ctest ran beside it, has root's right to mount."""
    with open("/proc/self/status", encoding="ascii") as status:
        effective = next(line for line in status if line.startswith("CapEff:")).split()[1]
    return bool(int(effective, 16) >> CAP_SYS_ADMIN & 1)


def is_allowed(reason):
    return RECORDINGS in reason or MOUNT in reason and not may_mount()


def read_report(path):
    """Returns (passed, failed, whole, skips): names, and (test, part, reason) of each skip."""
    passed, failed, whole, skips = [], [], [], []
    for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
        name, status = case.get("name"), case.get("status")
        output = case.findtext("system-out") or ""
        if status == "run":
            passed.append(name)
            skips += [(name, part, reason) for part, reason in skipped_parts(output)]
        elif status == "notrun" and case.find("skipped") is not None:
            whole.append(name)
            skips += ([(name, part, reason) for part, reason in skipped_parts(output)]
                      or [(name, "all of it", reason_in(output))])
        elif status == "disabled":
            whole.append(name)
            skips.append((name, "all of it", "it is disabled"))
        else:
            failed.append(name)
    return passed, failed, whole, skips


def main(arguments):
    passed, failed, whole, problems = 0, 0, 0, []
    for argument in arguments:
        preset, path = argument.split("=", 1)
        run = read_report(path)
        passed, failed, whole = passed + len(run[0]), failed + len(run[1]), whole + len(run[2])
        print(f"{preset}: {len(run[0])} passed, {len(run[1])} failed, {len(run[2])} skipped")
        problems += [f"{preset}: {name} failed" for name in run[1]]
        if not run[0]:
            problems.append(f"{preset}: no test passed")
        for name, part, reason in run[3]:
            print(f"  skipped in {name}: {part}: {reason}")
            if not is_allowed(reason):
                problems.append(f"{preset}: {name}: only a test that needs {RECORDINGS}, or a right that "
                                f"this user has not, may be skipped: {part}")
    for problem in problems:
        print(f"error: {problem}")
    print(f"{passed} passed, {failed} failed, {whole} skipped")
    return 1 if problems or not arguments else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
