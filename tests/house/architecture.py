# SPDX-License-Identifier: GPL-3.0-or-later
"""Who may know whom: the #include lines and the link graph, by the architecture's one table."""

import posixpath
import re

from tree import SOURCE_FOLDERS, Findings, folder_of

# Folder: the other folders whose headers it may include and whose library it may link. Data flows
# down: corpus -> db/import -> db/store -> (tools/app gathers) -> isomap, synth -> files.
STAGES = ("search", "concat", "style", "retarget", "head", "export")
MAY_KNOW = {
    "corpora_schema": set(),
    "db/types": {"corpora_schema"},
    "db/store": {"db/types", "corpora_schema"},
    "db/curation": {"db/types"},
    "db/import": {"db/types", "corpora_schema", "db/curation"},
    "isomap": {"db/types"},
    **{f"synth/{stage}": {"db/types"} for stage in STAGES},
    "synth/retarget/mapping": {"db/types", "synth/retarget"},
    "synth/retarget/keyshapes": {"db/types", "synth/retarget"},
    "synth/export": {"db/types", "synth/retarget"},
    "synth/pipeline": {"db/types", *(f"synth/{stage}" for stage in STAGES)},
    "tools/demo": {"db/types"},
    "tools/evaluate": {"db/types", "synth/search", "synth/concat", "synth/pipeline"},
    "tools/tune": {"db/types", "synth/search", "tools/evaluate"},
    "tools/app": {"db/types", "db/curation", "db/store", "db/import", "isomap", "synth/pipeline",
                  "synth/retarget/mapping", "synth/retarget/keyshapes", "tools/evaluate", "tools/tune",
                  *(f"synth/{stage}" for stage in STAGES)},
    "tools/cli": {"db/types", "db/store", "db/import", "synth/pipeline", "tools/evaluate",
                  "tools/app"},
    "tools/studio": {"db/types", "tools/app"},
}

# Headers that only one folder may include (outside tests), and headers that one .cpp alone may; more
# for what is both read and written, and for the words of calls, which are many.
ONE_FOLDER = {"SQLite": (re.compile(r"^(sqlite3\.h|SQLiteCpp/)"), "db/store")}
FEW_FILES = {
    "CGAL": (re.compile(r"^CGAL/"), 2),
    "Spectra": (re.compile(r"^Spectra/"), 1),
    "cairo": (re.compile(r"^cairo"), 1),
    "cpp-httplib": (re.compile(r"^httplib\.h"), 1),
    "tinygltf": (re.compile(r"^tiny_gltf\.h"), 3),
    "valijson": (re.compile(r"^valijson/"), 1),
    "libsndfile": (re.compile(r"^sndfile\.h"), 1),
    "OpenSSL": (re.compile(r"^openssl/"), 1),
    "NLopt": (re.compile(r"^nlopt"), 1),
    "CLI11": (re.compile(r"^CLI/"), 9),
}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]*)"|<([^>]*)>)')
TARGET = re.compile(r"(phonomime_library|add_library)\(\s*(\w+)")
WORD = re.compile(r"[\w:.+-]+")
# As clang-format leaves them: what stands in a namespace is not indented.
NAMESPACE = re.compile(r"^(inline )?namespace( [\w:]+)? \{$")
TYPE = re.compile(r"^(?:struct|class|union|enum(?: class)?) (\w+(?:::\w+)*)\b(?! *;)")


def includes(tree, folders):
    """(path, line number, quoted header or None, system header or None) of each #include."""
    for path in tree.with_suffix(".h", ".cpp", folders=folders):
        for number, line in tree.lines(path):
            if match := INCLUDE.match(line):
                yield path, number, match[1], match[2]


def known_folder(path):
    """The folder of MAY_KNOW that a path lies in, or None."""
    folder = folder_of(path)
    while folder and folder not in MAY_KNOW:
        folder = folder_of(folder)
    return folder or None


def check_includes(tree):
    """Includes go from the root, and only where the table says."""
    looked_at, problems = 0, []
    paths = set(tree.paths)
    for path, number, quoted, _ in includes(tree, (*SOURCE_FOLDERS, "tests")):
        if quoted is None:
            continue
        looked_at += 1
        where = f"{path}:{number}"
        if quoted != posixpath.normpath(quoted) or quoted not in paths:
            problems.append(f'{where}: "{quoted}" is no path from the root')
        if path.startswith("tests/"):
            continue
        folder, other = known_folder(path), known_folder(quoted)
        if folder is None:
            problems.append(f"{where}: the folder has no place in the architecture")
        elif other is None:
            problems.append(f'{where}: "{quoted}" is in no library')
        elif other != folder and other not in MAY_KNOW[folder]:
            problems.append(f"{where}: {folder} may not know {other}")
    return Findings(looked_at, problems)


def check_fences(tree):
    """SQLite is named in one folder alone, heavy dependencies in one .cpp."""
    looked_at, problems, users = 0, [], {name: set() for name in FEW_FILES}
    for path, number, _, system in includes(tree, SOURCE_FOLDERS):
        if system is None:
            continue
        looked_at += 1
        for name, (pattern, folder) in ONE_FOLDER.items():
            if pattern.match(system) and known_folder(path) != folder:
                problems.append(f"{path}:{number}: {name} belongs in {folder} alone")
        for name, (pattern, _) in FEW_FILES.items():
            if pattern.match(system):
                users[name].add(path)
    for name, paths in users.items():
        allowed = FEW_FILES[name][1]
        if len(paths) > allowed or any(not path.endswith(".cpp") for path in paths):
            problems.append(f"{name} belongs in {allowed} .cpp alone: {', '.join(sorted(paths))}")
    return Findings(looked_at, problems)


def cmake_words(tree, path):
    """The words of a CMake file, without its comments."""
    return [word for _, line in tree.lines(path) for word in WORD.findall(line.split("#")[0])]


def check_links(tree):
    """One library a folder, and no folder's CMake file names one that the folder may not know."""
    files = tree.with_suffix("CMakeLists.txt", ".cmake", folders=SOURCE_FOLDERS)
    owner, libraries, problems = {}, {}, []
    for path in files:
        for match in TARGET.finditer(tree.text(path)):
            owner[match[2]] = known_folder(path)
            if match[1] == "phonomime_library":
                libraries.setdefault(known_folder(path), []).append(match[2])
    problems += [f"{folder}: more than one library: {', '.join(names)}"
                 for folder, names in libraries.items() if len(names) > 1]
    for path in files:
        folder = known_folder(path)
        for word in cmake_words(tree, path):
            other = owner.get(word, folder)
            if folder and other != folder and other not in MAY_KNOW[folder]:
                problems.append(f"{path}: {folder} may not link {word} of {other}")
            if word.startswith("SQLite") and folder != "db/store":
                problems.append(f"{path}: SQLite belongs in db/store alone")
    if not any("GLOBAL_DEPENDS_NO_CYCLES" in cmake_words(tree, path)
               for path in tree.with_suffix(".cmake", folders=("cmake",))):
        problems.append("cmake/: GLOBAL_DEPENDS_NO_CYCLES is not set")
    return Findings(len(libraries), problems)


def types_of(tree, path):
    """(line number, name with its namespaces) of each type that other files could see."""
    open_namespaces = []
    for number, line in tree.lines(path):
        if NAMESPACE.match(line):
            open_namespaces.append(line.removesuffix("{").split()[-1])
        elif line.startswith("} // namespace") and open_namespaces:
            open_namespaces.pop()
        elif (found := TYPE.match(line)) and "namespace" not in open_namespaces:
            yield number, "::".join((*open_namespaces, found[1]))


def check_types(tree):
    """No two types of one name: a program that holds both is broken, and no compiler says so."""
    first, problems = {}, []
    for path in tree.with_suffix(".cpp", ".h", folders=SOURCE_FOLDERS):
        for number, name in types_of(tree, path):
            if first.setdefault(name, path) != path:
                problems.append(f"{path}:{number}: {name} is in {first[name]} too")
    return Findings(len(first), problems)


LINTS = (check_includes, check_fences, check_links, check_types)
