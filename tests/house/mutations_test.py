# SPDX-License-Identifier: GPL-3.0-or-later
"""Each lint must be seen to fail: a copy of the repository's text is spoilt in one place."""

import json
import os
import pathlib
import shutil
import tempfile
import unittest

import architecture
import build_files
import documents
import files
from tree import NOT_OURS, Tree

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Mutations(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.copy = pathlib.Path(cls.folder.name) / "copy"
        shutil.copytree(ROOT, cls.copy, ignore=shutil.ignore_patterns(*NOT_OURS))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def expect(self, lint, path, change, said, *arguments):
        """The lint says something new, `said`, once `change` (bytes to bytes) has been made."""
        file = self.copy / path
        before = file.read_bytes() if file.exists() else None
        known = set(lint(Tree(self.copy), *arguments).problems)
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(change(before or b""))
            new = set(lint(Tree(self.copy), *arguments).problems) - known
            self.assertIn(said, "\n".join(new))
        finally:
            if before is None:
                file.unlink()
            else:
                file.write_bytes(before)

    def expect_line(self, lint, path, line, said, *arguments):
        self.expect(lint, path, lambda text: (text + b"\n" if text else b"") + line.encode() + b"\n",
                    said, *arguments)

    def test_includes(self):
        for path, header, said in (
                ("synth/search/x.cpp", "db/store/motion_database.h",
                 "synth/search may not know db/store"),
                ("synth/concat/x.h", "db/import/readers.h", "synth/concat may not know db/import"),
                ("isomap/x.cpp", "db/store/motion_database.h", "isomap may not know db/store"),
                ("db/types/x.h", "synth/search/search_types.h", "db/types may not know synth/search"),
                ("db/import/x.cpp", "db/store/motion_database.h",
                 "db/import may not know db/store"),
                ("synth/new/x.cpp", "db/types/errors.h", "has no place in the architecture"),
                ("db/types/x.cpp", "errors.h", "is no path from the root"),
                ("tests/db/types/x.cpp", "../x.h", "is no path from the root"),
        ):
            with self.subTest(path=path, header=header):
                self.expect_line(architecture.check_includes, path, f'#include "{header}"', said)

    def test_fences(self):
        for path, header, said in (
                ("db/import/x.cpp", "sqlite3.h", "SQLite belongs in db/store alone"),
                ("tools/app/x.h", "SQLiteCpp/Database.h", "SQLite belongs in db/store alone"),
                ("db/types/x.h", "valijson/schema.hpp", "valijson belongs in 1 .cpp alone"),
                ("synth/head/x.cpp", "tiny_gltf.h", "tinygltf belongs in 3 .cpp alone"),
                ("isomap/x.h", "CGAL/Triangulation.h", "CGAL belongs in 2 .cpp alone"),
        ):
            with self.subTest(path=path):
                self.expect_line(architecture.check_fences, path, f"#  include <{header}>", said)

    def test_links(self):
        for path, line, said in (
                ("synth/search/CMakeLists.txt", "target_link_libraries(phonomime_search PUBLIC "
                 "phonomime_store)", "synth/search may not link phonomime_store of db/store"),
                ("db/import/x.cmake", "set(links SQLite::SQLite3)",
                 "SQLite belongs in db/store alone"),
                ("db/types/x.cmake", "phonomime_library(phonomime_more SOURCES x.cpp)",
                 "db/types: more than one library"),
        ):
            with self.subTest(path=path):
                self.expect_line(architecture.check_links, path, line, said)
        self.expect(architecture.check_links, "cmake/Phonomime.cmake",
                    lambda text: text.replace(b"GLOBAL_DEPENDS_NO_CYCLES", b"SOMETHING"),
                    "GLOBAL_DEPENDS_NO_CYCLES is not set")

    def test_types(self):
        lint = architecture.check_types
        source = "namespace phonomime {\n%s\n} // namespace phonomime"
        said = "phonomime::Layout is in db/types/layout.h too"
        for line in ("struct Layout {", "class Layout final : public X {", "enum class Layout { a };",
                     "struct Layout"):
            with self.subTest(line):
                self.expect_line(lint, "synth/x.cpp", source % line, said)
        for line in ("struct Layout;", "  struct Layout {", "struct Layouts {",
                     "namespace {\nstruct Layout {};\n} // namespace",
                     "namespace other {\nstruct Layout {};\n} // namespace other"):
            with self.subTest(line), self.assertRaises(AssertionError):
                self.expect_line(lint, "synth/x.cpp", source % line, " is in ")

    def test_files(self):
        self.expect_line(files.check_licences, "db/types/x.cpp", "int x;", "x.cpp: no line")
        self.expect_line(files.check_licences, "tools/x", "#!/bin/sh", "tools/x: no line")
        self.expect(files.check_sizes, "docs/x.bin", lambda _: bytes((1 << 20) + 1), "at most")
        self.expect(files.check_sizes, "db/x.h", lambda _: b"\n" * 1000, "db/x.h: more than")
        for line in ("see /" + "work/main", 'path = "/' + 'tmp/x"', "cd /" + "home/ann"):
            self.expect_line(files.check_contents, "README.md", line, "a path of this machine")
        for path, line in (
                ("x/package-lock.json", '"resolved": "x"'),
                ("x/.npmrc", "@scope:registry=x"),
                ("README.md", "https://registry." + "npmjs.org/three"),
        ):
            self.expect_line(files.check_contents, path, line, "a registry's address")

    def test_build_files(self):
        lint = build_files.check_tests_are_registered
        self.expect(lint, "tests/db/types/x_test.cpp", lambda _: b"", "no CMake file names it")
        self.expect(lint, "tests/x/CMakeLists.txt", lambda _: b"", "no CMake file adds its folder")
        self.expect(build_files.check_presets, "CMakePresets.json",
                    lambda text: text.replace(b'"error"', b'"ignore"', 1), "accepts no tests")
        self.expect(build_files.check_presets, "CMakePresets.json",
                    lambda text: text.replace(b'"name": "asan"', b'"name": "usan"', 1), "expected")
        self.expect_line(build_files.check_package_lists, "tools/packages/check.txt", "cmake",
                         "cmake is in another list too")
        with self.assertRaises(json.JSONDecodeError):
            self.expect(build_files.check_presets, "CMakePresets.json", lambda text: text[:-3], "")

    def test_documents(self):
        phonomime = os.environ["PHONOMIME"]
        self.expect_line(documents.check_links, "README.md", "[x](no/such/file.md)",
                         "there is no no/such/file.md")
        for command, said in (
                ("./tools/no_such_script", "there is no script ./tools/no_such_script"),
                ("phonomime synthesize x", "there is no verb synthesize"),
                ("phonomime map draw x", "there is no verb map draw"),
                ("phonomime map image x --aloud", "phonomime map image has no option --aloud"),
                ("phonomime synth x \\\n  --no-such-option", "has no option --no-such-option"),
                ("cmake --preset fast", "there is no preset fast"),
                ("curl x", "curl is a command that this test does not know"),
        ):
            with self.subTest(command=command):
                self.expect_line(documents.check_commands, "README.md", f"```sh\n{command}\n```",
                                 said, phonomime)
        self.expect_line(documents.check_verbs, "README.md", "| `dance` | x |",
                         "no verb dance in the program", phonomime)

    def test_nothing_to_look_at(self):
        with tempfile.TemporaryDirectory() as folder:
            empty = Tree(folder)
            for lint in (*architecture.LINTS, *files.LINTS, *documents.LINTS,
                         build_files.check_tests_are_registered, build_files.check_package_lists):
                with self.subTest(lint.__doc__):
                    self.assertEqual(lint(empty).looked_at, 0)


if __name__ == "__main__":
    unittest.main()
