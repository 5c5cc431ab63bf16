# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests are registered, presets and package lists can be used."""

import json
import posixpath
import re

from tree import Findings, folder_of

TEST_NAMES = ("_test.cpp", "_test.py", "_test.mjs", "_test.sh")
VARIABLE = re.compile(r"^\$\{\w+\}/")
PRESETS = {"dev", "release", "asan", "tsan"}


def words(tree, path):
    """The words of a CMake file, without its comments and without a leading ${VARIABLE}/."""
    return {VARIABLE.sub("", word.strip('"')) for _, line in tree.lines(path)
            for word in re.split(r"[\s()]+", line.split("#")[0]) if word}


def check_tests_are_registered(tree):
    """Every test is named in a CMake file beside or above it, every test folder is added."""
    tests = tree.with_suffix(*TEST_NAMES, folders=("tests",))
    cmake_files = tree.with_suffix("CMakeLists.txt", ".cmake", folders=("tests",))
    named = {path: words(tree, path) for path in cmake_files}

    def is_named(path):
        """In a CMake file beside or above it; a list may be included from further up."""
        return any(path.startswith(folder_of(cmake_file) + "/")
                   and any(f"/{path}".endswith("/" + word) for word in found)
                   or path in found
                   for cmake_file, found in named.items())

    problems = [f"{test}: no CMake file names it" for test in tests if not is_named(test)]
    problems += [f"{path}: no CMake file adds its folder" for path in cmake_files
                 if path.endswith("CMakeLists.txt") and folder_of(path) != "tests"
                 and not is_named(folder_of(path))]
    return Findings(len(tests), problems)


def check_presets(tree):
    """The presets parse, are complete, and refuse a run of no tests."""
    presets = json.loads(tree.text("CMakePresets.json"))
    problems = []
    names = {preset["name"] for preset in presets["configurePresets"] if not preset.get("hidden")}
    if names != PRESETS:
        problems.append(f"CMakePresets.json: presets {sorted(names)}, expected {sorted(PRESETS)}")
    for kind in ("buildPresets", "testPresets"):
        of_kind = {preset["name"]: preset["configurePreset"] for preset in presets[kind]}
        if of_kind != {name: name for name in PRESETS}:
            problems.append(f"CMakePresets.json: {kind} are not one for each preset")
    for preset in presets["testPresets"]:
        if preset.get("execution", {}).get("noTestsAction") != "error":
            problems.append(f"CMakePresets.json: test preset {preset['name']} accepts no tests")
    return Findings(len(names), problems)


def check_package_lists(tree):
    """Package lists are sorted, and no package stands twice."""
    packages, problems = [], []
    for path in tree.with_suffix(".txt", folders=("tools/packages",)):
        here = [line.strip() for _, line in tree.lines(path) if line.strip() and line[0] != "#"]
        if here != sorted(set(here)):
            problems.append(f"{path}: not sorted, or a package stands twice")
        problems += [f"{path}: {name} is in another list too" for name in here if name in packages]
        packages += here
    return Findings(len(packages), problems)


LINTS = (check_tests_are_registered, check_presets, check_package_lists)
