# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds for each file: its licence line, its size, and what it must not contain."""

import re
import stat

from tree import Findings

LICENCE = "SPDX-License-Identifier: GPL-3.0-or-later"
COMMENTED = (".cpp", ".h", ".cmake", "CMakeLists.txt", ".py", ".sh", ".mjs", ".js", ".css", ".html",
             ".sql", ".clang-format", ".clang-tidy", ".gitignore")
LARGEST_BYTES = 1 << 20
LONGEST_SOURCE_LINES = 400

# The names are split so that this file does not find itself.
MACHINE_PATH = re.compile(r"(?<![\w.$}/~-])/(?:wo" r"rk|tm" r"p|ro" r"ot|ho" r"me)/[\w.]")
REGISTRY = re.compile(r"registry\.np" r"mjs|deb\.deb" r"ian\.org|py" r"pi\.org|pythonhos" r"ted")
RECORDED_ADDRESS = re.compile(r'"resolved"\s*:|^\s*(?:\S*:)?registry\s*=')
LOCK_FILES = ("package-lock.json", ".npmrc", "npm-shrinkwrap.json")


def is_script(tree, path):
    return bool((tree.root / path).stat().st_mode & stat.S_IXUSR) or tree.bytes(path)[:2] == b"#!"


def check_licences(tree):
    """Every source and script says its licence in its first two lines."""
    paths = [path for path in tree.paths if path.endswith(COMMENTED) or is_script(tree, path)]
    problems = []
    for path in paths:
        head = [line for number, line in tree.lines(path) if number <= 2]
        if not any(LICENCE in line for line in head):
            problems.append(f"{path}: no line {LICENCE!r} at its top")
    return Findings(len(paths), problems)


def check_sizes(tree):
    """No file is large, no source is long."""
    problems = []
    for path in tree.paths:
        size = len(tree.bytes(path))
        if size > LARGEST_BYTES:
            problems.append(f"{path}: {size} bytes, at most {LARGEST_BYTES}")
        if path.endswith((".cpp", ".h")) and len(tree.text(path).splitlines()) > LONGEST_SOURCE_LINES:
            problems.append(f"{path}: more than {LONGEST_SOURCE_LINES} lines")
    return Findings(len(tree.paths), problems)


def check_contents(tree):
    """No path of some machine, no registry's host, no recorded download address."""
    looked_at, problems = 0, []
    for path in tree.paths:
        if b"\0" in tree.bytes(path):
            continue
        looked_at += 1
        is_lock = path.endswith(LOCK_FILES)
        for number, line in tree.lines(path):
            if MACHINE_PATH.search(line):
                problems.append(f"{path}:{number}: a path of this machine: {line.strip()}")
            if REGISTRY.search(line) or (is_lock and RECORDED_ADDRESS.search(line)):
                problems.append(f"{path}:{number}: a registry's address: {line.strip()}")
    return Findings(looked_at, problems)


LINTS = (check_licences, check_sizes, check_contents)
