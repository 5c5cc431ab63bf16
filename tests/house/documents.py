# SPDX-License-Identifier: GPL-3.0-or-later
"""What the documents say exists: links, commands, verbs, options, presets."""

import json
import os
import posixpath
import re
import subprocess

from tree import Findings, folder_of

LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)\s]*)?\)")
FENCE = re.compile(r"^```(\w*)\s*$")
OPTION = re.compile(r"(?<!\S)(--?[a-zA-Z][\w-]*)")
VERB_ROW = re.compile(r"^\| `(\w+)[ `]")
CHECKED_DOCUMENTS = ("README.md", "CONTRIBUTING.md")


def check_links(tree):
    """Every relative link and picture of every document is there."""
    looked_at, problems = 0, []
    for path in tree.with_suffix(".md"):
        for number, line in tree.lines(path):
            for target in LINK.findall(line):
                if "://" in target:
                    continue
                looked_at += 1
                place = posixpath.normpath(posixpath.join(folder_of(path), target))
                if not (tree.root / place).exists():
                    problems.append(f"{path}:{number}: there is no {place}")
    return Findings(looked_at, problems)


def commands(tree, path):
    """(line number, words) of each command in the ```sh blocks of a document."""
    language, continued, start = None, "", 0
    for number, line in tree.lines(path):
        if match := FENCE.match(line):
            language = match[1] if language is None else None
        elif language == "sh":
            start = start if continued else number
            continued += line.split(" #")[0].rstrip()
            if continued.endswith("\\"):
                continued = continued[:-1] + " "
                continue
            if words := continued.split():
                yield start, words
            continued = ""


def help_text(phonomime, *verb):
    """What the program or a verb says of itself, None where it fails."""
    run = subprocess.run([phonomime, *verb, "--help"], capture_output=True, text=True, check=False,
                         stdin=subprocess.DEVNULL)
    return run.stdout if run.returncode == 0 else None


def verbs(phonomime, *verb):
    """Of the program, or of a verb that has verbs of its own."""
    text = help_text(phonomime, *verb) or ""
    return set(re.findall(r"^  (\w+) {2,}", text.partition("Verbs:")[2].partition("Options:")[0], re.MULTILINE))


def problems_of_phonomime(phonomime, words):
    verb = [] if words[0].startswith("-") else words[:1]
    if verb and verb[0] not in verbs(phonomime):
        return [f"there is no verb {verb[0]}"]
    inner = verbs(phonomime, *verb) if verb else set()
    if inner and words[1:2] and not words[1].startswith("-"):
        verb = words[:2]
        if words[1] not in inner:
            return [f"there is no verb {' '.join(verb)}"]
    text = help_text(phonomime, *verb) or ""
    known = set(OPTION.findall(text.replace(",", " ")))
    return [f"phonomime {' '.join(verb)} has no option {option}" for option in words
            if option.startswith("-") and option.split("=")[0] not in known]


def problems_of_preset(tree, words):
    presets = json.loads(tree.text("CMakePresets.json"))["configurePresets"]
    names = {preset["name"] for preset in presets}
    return [f"there is no preset {name}" for option, name in zip(words, words[1:])
            if option == "--preset" and name not in names]


def check_commands(tree, phonomime):
    """Commands of README and CONTRIBUTING name scripts, verbs, options and presets that exist."""
    looked_at, problems = 0, []
    for path in CHECKED_DOCUMENTS:
        for number, words in commands(tree, path):
            looked_at += 1
            program, found = words[0], []
            if posixpath.basename(program) == "phonomime":
                found = problems_of_phonomime(phonomime, words[1:])
            elif program.startswith((".", "tools/")):
                if not os.access(tree.root / program, os.X_OK):
                    found = [f"there is no script {program}"]
            elif program in ("cmake", "ctest"):
                found = problems_of_preset(tree, words)
            elif program not in ("git", "cd"):
                found = [f"{program} is a command that this test does not know"]
            problems += [f"{path}:{number}: {problem}" for problem in found]
    return Findings(looked_at, problems)


def check_verbs(tree, phonomime):
    """README's table of verbs is the program's."""
    in_help = verbs(phonomime)
    in_table = {match[1] for _, line in tree.lines("README.md") if (match := VERB_ROW.match(line))}
    problems = [f"README.md: no verb {verb} in the program" for verb in sorted(in_table - in_help)]
    problems += [f"README.md: verb {verb} is not in the table" for verb in sorted(in_help - in_table)]
    return Findings(len(in_table), problems)


LINTS = (check_links,)
LINTS_WITH_PROGRAM = (check_commands, check_verbs)
