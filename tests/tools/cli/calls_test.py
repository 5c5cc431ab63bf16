# SPDX-License-Identifier: GPL-3.0-or-later
"""How the program behaves on a terminal and in a pipe, and what its help says."""
import json
import os
import pty
import re
import shlex
import subprocess

import phonomime_cli as cli
import tiny_corpus

VERBS = ("import", "info", "nodes", "synth", "batch", "evaluate", "tune", "map build", "map show", "map image", "map pick",
         "map quality", "recommend", "retarget list", "retarget apply", "retarget references", "retarget keyshapes select",
         "retarget keyshapes apply",
         "style train", "style show", "style apply", "suspects", "prune", "restore", "undo", "journal", "explain")


class CallsTest(cli.CliTest):
    @classmethod
    def setUpClass(cls):
        folder = cli.scratch_folder(cls.addClassCleanup)
        cls.corpus = tiny_corpus.Corpus(folder / "ann", sentences=15, emotions=("neutral", "happiness")).write()
        cls.database = folder / "ann.db"
        cli.run_well("import", cls.corpus, "--db", cls.database)
        node = cli.run_json("nodes", cls.database)[0]["key"]
        cli.run_well("prune", cls.database, node, "--reason", "to have a journal")
        cli.run_well("undo", cls.database)
        cli.run_well("style", "train", cls.database)
        cls.transcript = cli.write_transcript(folder / "hello.lab", ["b", "aa", "m", "iy"])
        cls.manifest = folder / "lines.tsv"
        cls.manifest.write_text("transcript\nhello.lab\n")
        cls.face = tiny_corpus.write_face(folder / "face")
        cls.result = folder / "hello.json"
        cli.run_well("synth", "--db", cls.database, cls.transcript, "-o", cls.result)

    def calls(self):
        return {
            "import": ["import", self.corpus, "--db", self.folder / "new.db"],
            "info": ["info", self.database],
            "nodes": ["nodes", self.database],
            "synth": ["synth", "--db", self.database, self.transcript, "-o", self.folder / "out.csv"],
            "batch": ["batch", self.manifest, "--db", self.database, "-o", self.folder / "{id}.csv"],
            "evaluate": ["evaluate", self.corpus, "--folds", "2", "--sentences", "2"],
            "explain": ["explain", self.result],
            "map build": ["map", "build", self.database],
            "map show": ["map", "show", self.database],
            "map image": ["map", "image", self.database, "aa", "-o", self.folder / "out.png"],
            "map pick": ["map", "pick", self.database, "aa", 0, 0],
            "map quality": ["map", "quality", self.database],
            "recommend": ["recommend", self.database, self.transcript, "--row", 2],
            "retarget list": ["retarget", "list", self.face],
            "retarget keyshapes select": ["retarget", "keyshapes", "select", self.database, "-o", self.folder / "keys",
                                          "-n", 3],
            "style train": ["style", "train", self.database],
            "style show": ["style", "show", self.database],
            "style apply": ["style", "apply", self.database, self.corpus / "motion" / "neutral_u000.c3d",
                            "--to", "happiness", "-o", self.folder / "happy.csv"],
            "suspects": ["suspects", self.database],
            "journal": ["journal", self.database],
        }

    def test_help_of_every_verb_has_an_example_and_the_options(self):
        listed = re.findall(r"^  (\w+) {2,}\S", cli.run_well("--help").split("Verbs:")[1].split("Options:")[0], re.MULTILINE)
        self.assertEqual(sorted(listed), sorted({verb.split()[0] for verb in VERBS}))
        for verb in VERBS:
            with self.subTest(verb):
                text = cli.run_well(*verb.split(), "--help")
                for option in ("--help", "--json", "--quiet"):
                    self.assertIn(option, text)
                example = text.split("Example:\n")[1].split("\n\n")[0].replace("\\\n", " ")
                for line in example.strip().splitlines():
                    words = shlex.split(line)
                    self.assertEqual(words[0], "phonomime")
                    named = words[1:4] if words[1:3] == ["retarget", "keyshapes"] else (
                        words[1:3] if words[1] in ("map", "retarget", "style") else words[1:2])
                    for option in (word for word in words if re.match("-[^0-9]", word)):
                        self.assertRegex(cli.run_well(*named, "--help"), rf"(?m)^  .*{re.escape(option)}\b")
        for verb in ("import", "synth", "batch", "evaluate", "map build", "recommend", "style train"):
            self.assertIn("--threads", cli.run_well(*verb.split(), "--help"))

    def test_help_is_for_people(self):
        """Lines that fit a terminal, no inner workings, and a meaning for each option."""
        for verb in ((), ("map",), ("retarget",), ("retarget", "keyshapes"), ("style",), *(verb.split() for verb in VERBS)):
            with self.subTest(" ".join(verb)):
                text = cli.run_well(*verb, "--help")
                self.assertRegex(text, rf"\nUsage: phonomime {' '.join(verb)}")
                self.assertLessEqual(max(map(len, text.splitlines())), 80)
                for inner in ("{", "}", "->", "ENUM", "FLOAT", "INT:", "TEXT", " in [", "Excludes", "REQUIRED", "Positionals"):
                    self.assertNotIn(inner, text.replace("{id}", ""))
                options = text.split("Options:\n")[1].split("\n\n")[0]
                entries = re.findall(r"^  -\S.*?(?:  +|\n +)(\S.*)", options, re.MULTILINE)
                self.assertEqual(len(entries), len(re.findall(r"^  -", options, re.MULTILINE)))
                for meaning in entries:
                    self.assertRegex(meaning, r"^[A-Z]")

    def test_version(self):
        self.assertRegex(cli.run_well("--version"), r"^phonomime \d+\.\d+\.\d+\n$")

    def test_quiet_prints_nothing_on_success(self):
        for verb in ("import", "synth", "batch", "evaluate", "map build", "map image", "style train",
                     "style apply", "retarget keyshapes select"):
            with self.subTest(verb):
                result = cli.run(*self.calls()[verb], "--quiet")
                self.assertEqual((result.returncode, result.stdout, result.stderr), (cli.DONE, "", ""))

    def test_quiet_leaves_data_on_stdout(self):
        for verb in ("info", "nodes", "explain", "map show", "map pick", "map quality", "recommend", "retarget list",
                     "suspects", "journal", "style show"):
            with self.subTest(verb):
                result = cli.run(*self.calls()[verb], "--quiet")
                self.assertEqual((result.returncode, result.stderr), (cli.DONE, ""))
                self.assertNotEqual(result.stdout, "")

    def test_json_of_every_verb(self):
        for verb, call in self.calls().items():
            with self.subTest(verb):
                result = cli.run(*call, "--json")
                self.assertEqual((result.returncode, result.stderr), (cli.DONE, ""))
                told = json.loads(result.stdout)
                self.assertTrue(told or verb == "suspects")  # of which the corpus has none

    def test_no_progress_in_a_pipe(self):
        result = cli.run(*self.calls()["import"])
        self.assertEqual((result.returncode, result.stderr), (cli.DONE, ""))
        self.assertNotIn("\r", result.stdout)
        self.assertNotIn("\033", result.stdout)

    def test_progress_on_a_terminal(self):
        """A bar while it works, and nothing of it left at the end; none with --quiet."""
        for quiet in (False, True):
            with self.subTest(quiet=quiet):
                ours, theirs = pty.openpty()
                self.addCleanup(os.close, ours)
                call = [cli.PROGRAM, *map(str, self.calls()["import"]), *(["--quiet"] if quiet else [])]
                database = self.folder / "new.db"
                database.unlink(missing_ok=True)
                result = subprocess.run(call, stdout=subprocess.PIPE, stderr=theirs, check=False)
                os.write(theirs, b"|")
                os.close(theirs)
                shown = b""
                while not shown.endswith(b"|"):
                    shown += os.read(ours, 65536)
                self.assertEqual(result.returncode, cli.DONE)
                self.assertNotIn(b"\n", shown)
                self.assertEqual(b" [" in shown, not quiet, shown)
                self.assertEqual(shown.split(b"\033[K")[-1], b"|")

    def test_a_closed_pipe_is_an_error_and_no_crash(self):
        for arguments in (["nodes", self.database], ["nodes", self.database, "--json"], ["synth", "--help"]):
            with self.subTest(" ".join(map(str, arguments))):
                reading, writing = os.pipe()
                os.close(reading)
                result = subprocess.run([cli.PROGRAM, *map(str, arguments)], stdout=writing,
                                        stderr=subprocess.PIPE, text=True, check=False)
                os.close(writing)
                self.assertEqual(result.returncode, cli.IO)
                self.assertRegex(result.stderr, r"^phonomime: standard output: .*\n$")

    def test_a_reader_that_leaves_early(self):
        result = subprocess.run(
            f"{shlex.quote(cli.PROGRAM)} nodes {shlex.quote(str(self.database))} --json | head -1; echo ${{PIPESTATUS[0]}}",
            shell=True, executable="/bin/bash", stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(result.stdout.splitlines()[0], "[")
        self.assertIn(int(result.stdout.splitlines()[1]), (cli.DONE, cli.IO))
        self.assertIn(result.stderr.count("\n"), (0, 1), result.stderr)

    def test_errors_go_to_stderr_even_with_quiet(self):
        self.assertRefused(cli.IO, ["nowhere.db"], "info", "nowhere.db", "--quiet", "--json")


if __name__ == "__main__":
    cli.main()
