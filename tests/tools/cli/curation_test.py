# SPDX-License-Identifier: GPL-3.0-or-later
"""`prune`, `restore`, `undo`, `journal`: nodes out of use and back again, and what is told of it."""
import os
import pwd
import signal
import sqlite3
import subprocess
import time

import phonomime_cli
import tiny_corpus
from phonomime_cli import BAD_INPUT, IO, PROGRAM, USAGE, run, run_json, run_well

WHY = ("--reason", "lip marker lost")


class CurationTest(phonomime_cli.DatabaseTest):
    CORPUS = {"sentences": 8, "emotions": ("neutral", "happiness")}

    def setUp(self):
        super().setUp()
        os.environ["SOURCE_DATE_EPOCH"] = "1767312000"  # 2026-01-02
        self.addCleanup(os.environ.pop, "SOURCE_DATE_EPOCH")
        self.keys = [node["key"] for node in run_json("nodes", self.database)]

    def pruned(self):
        return [node["key"] for node in run_json("nodes", self.database, "--pruned")]

    def path(self, transcript):
        """Keys of the nodes and captured joins of a synthesis of one path."""
        rows = run_json("synth", "--db", self.database, transcript, "--blend", 1)["path"]
        return [row["node"] for row in rows], [row["captured"] for row in rows]

    def test_pruned_nodes_leave_the_search_at_once_and_come_back(self):
        rows = [(end, label) for end, label in tiny_corpus.some_rows(3)]
        transcript = phonomime_cli.write_lab(self.folder / "said.lab", rows)
        nodes, captured = self.path(transcript)
        used = [node for node in nodes if node]
        victim = used[len(used) // 2]
        run_well("prune", self.database, victim, *WHY)
        later, _ = self.path(transcript)
        self.assertNotIn(victim, later)
        # A row cannot be captured from a neighbour across what is pruned.
        constraints = self.folder / "c.txt"
        sentence, order = victim.rsplit("#", 1)
        before, after = f"{sentence}#{int(order) - 1}", f"{sentence}#{int(order) + 1}"
        self.assertIn(before, self.keys)
        constraints.write_text(f"1 use {victim}\n")
        refused = run("synth", "--db", self.database, transcript, "--constraints", constraints)
        self.assertEqual(refused.returncode, BAD_INPUT)
        self.assertIn("pruned by", refused.stderr)
        self.assertIn("lip marker lost", refused.stderr)
        run_well("undo", self.database)
        self.assertEqual(self.path(transcript), (nodes, captured))
        self.assertIn(after, self.keys)

    def test_links_across_a_pruned_node_are_gone(self):
        """A sentence said again is captured throughout, until a node in its middle is pruned."""
        recorded = tiny_corpus.some_rows(3)
        transcript = phonomime_cli.write_lab(self.folder / "said.lab", recorded)
        everything_else = [k for k in self.keys if "/u003#" not in k or "/happiness/" in k]
        listing = self.folder / "others.txt"
        listing.write_text("\n".join(everything_else) + "\n")
        run_well("prune", self.database, "--from", listing, "--reason", "only one is left")
        twice = phonomime_cli.write_lab(self.folder / "said2.lab", recorded)
        nodes, captured = self.path(twice)
        self.assertEqual(captured[2:-1], [True] * (len(captured) - 3))
        self.assertEqual(self.path(transcript), (nodes, captured))
        run_well("prune", self.database, nodes[6], *WHY)
        again = run("synth", "--db", self.database, transcript, "--blend", 1, "--json")
        if again.returncode == 0:
            import json
            path = json.loads(again.stdout)["path"]
            self.assertNotIn(nodes[6], [row["node"] for row in path])
            self.assertFalse(path[7]["captured"])

    def test_what_is_told_of_a_prune(self):
        key = self.keys[5]
        told = run_json("prune", self.database, key, *WHY, "--by", "bea", "--thin", 1000)
        self.assertEqual(told["entry"]["nodes"], [key])
        self.assertEqual((told["entry"]["entry"], told["entry"]["by"]), (1, "bea"))
        self.assertEqual(told["entry"]["at"], "2026-01-02T00:00:00Z")
        self.assertEqual(told["in_use"]["before"] - told["in_use"]["after"], 1)
        node = next(n for n in run_json("nodes", self.database) if n["key"] == key)
        thin = {(part["kind"], part["name"]): part for part in told["thin"]}
        self.assertEqual(set(thin), {
            ("phoneme", node["phoneme"]), ("emotion", f"{node['phoneme']} {node['emotion']}"),
            ("triphone", f"{node['previous']}-{node['phoneme']}-{node['next']}")})
        for part in told["thin"]:
            self.assertEqual(part["before"] - part["after"], 1)
        in_use = [n for n in run_json("nodes", self.database) if not n["pruned"] and not n["has_gap"]]
        self.assertEqual(thin["phoneme", node["phoneme"]]["after"],
                         sum(n["phoneme"] == node["phoneme"] for n in in_use))
        self.assertEqual(told["in_use"]["after"], len(in_use))
        self.assertEqual(run_json("prune", self.database, self.keys[9], *WHY, "--thin", 0)["thin"], [])
        text = run_well("prune", self.database, self.keys[12], *WHY)
        self.assertIn("pruned 1 node (journal entry 3, by ", text)
        self.assertEqual(run_well("prune", self.database, self.keys[13], *WHY, "--quiet"), "")

    def test_by_filter_from_a_file_and_from_a_pipe(self):
        phoneme = run_json("nodes", self.database)[0]["phoneme"]
        wanted = [n["key"] for n in run_json("nodes", self.database, "--phoneme", phoneme, "--emotion", "happiness")]
        run_well("prune", self.database, "--phoneme", phoneme, "--emotion", "happiness", *WHY)
        self.assertEqual(self.pruned(), wanted)
        run_well("restore", self.database, "--emotion", "happiness", *WHY)
        self.assertEqual(self.pruned(), [])
        table = run_well("nodes", self.database, "--phoneme", phoneme, "--quiet")
        listing = self.folder / "list.txt"
        listing.write_text(table)
        run_well("prune", self.database, "--from", listing, *WHY)
        every = [n["key"] for n in run_json("nodes", self.database, "--phoneme", phoneme)]
        self.assertEqual(self.pruned(), every)
        piped = subprocess.run([PROGRAM, "restore", str(self.database), "--from", "-", *WHY], text=True,
                               input="# the first two\n\n" + "\r\n".join(every[:2]) + "\r\n", capture_output=True,
                               check=False)
        self.assertEqual(piped.returncode, 0, piped.stderr)
        self.assertEqual(self.pruned(), every[2:])
        nothing = run_json("prune", self.database, "--phoneme", phoneme, "--sentence", every[2].split("/")[2].split("#")[0], *WHY)
        self.assertIsNone(nothing["entry"])

    def test_a_dry_run_changes_nothing(self):
        before = phonomime_cli.contents(self.folder)
        dry = run_json("prune", self.database, *self.keys[:3], *WHY, "--dry-run")
        self.assertEqual(phonomime_cli.contents(self.folder), before)
        wet = run_json("prune", self.database, *self.keys[:3], *WHY)
        for field in ("in_use", "thin", "unchanged"):
            self.assertEqual(dry[field], wet[field])
        self.assertEqual(dry["entry"]["nodes"], wet["entry"]["nodes"])
        self.assertIn("would have", run_well("undo", self.database, "--dry-run"))
        self.assertEqual(self.pruned(), sorted(wet["entry"]["nodes"], key=self.keys.index))

    def test_the_journal_and_undo(self):
        run_well("prune", self.database, *self.keys[:2], *WHY, "--by", "ann")
        run_well("restore", self.database, self.keys[0], "--reason", "fine", "--by", "bea")
        run_well("undo", self.database)
        entries = run_json("journal", self.database)
        self.assertEqual([e["action"] for e in entries], ["prune", "restore", "undo"])
        self.assertEqual([e["by"] for e in entries], ["ann", "bea", pwd.getpwuid(os.geteuid()).pw_name])
        self.assertEqual([e["undone"] for e in entries], [False, True, False])
        self.assertEqual(entries[2]["undoes"], 2)
        self.assertEqual(entries[0]["nodes"], self.keys[:2])
        lines = run_well("journal", self.database).splitlines()
        self.assertEqual(lines[0], "entry\tat\tby\taction\tnodes\treason")
        self.assertEqual(lines[2], "2\t2026-01-02T00:00:00Z\tbea\trestore (undone)\t1\tfine")
        self.assertEqual(self.pruned(), self.keys[:2])
        run_well("undo", self.database)
        self.assertEqual(self.pruned(), [])
        self.assertRefused(BAD_INPUT, ["nothing to undo"], "undo", self.database)

    def test_bad_calls_are_refused_and_change_nothing(self):
        key = self.keys[0]
        self.assertRefused(USAGE, ["--reason"], "prune", self.database, key)
        self.assertRefused(USAGE, ["--reason", "missing"], "prune", self.database, key, "--reason", "  ")
        self.assertRefused(USAGE, ["--reason", "plain text"], "prune", self.database, key, "--reason", "a\nb")
        self.assertRefused(USAGE, ["--by", "plain text"], "prune", self.database, key, *WHY, "--by", "a\x1b[2J")
        self.assertRefused(USAGE, ["no motion node is named"], "prune", self.database, *WHY)
        self.assertRefused(USAGE, ["--thin"], "prune", self.database, key, *WHY, "--thin", -1)
        self.assertRefused(BAD_INPUT, ["u999#1", "no motion node"], "prune", self.database, key, "u999#1", *WHY)
        self.assertRefused(BAD_INPUT, ["u003#1", "ambiguous"], "prune", self.database, "u003#1", *WHY)
        self.assertRefused(BAD_INPUT, ["phoneme", "zz"], "prune", self.database, "--phoneme", "zz", *WHY)
        listing = self.folder / "list.txt"
        listing.write_bytes(f"{key}\nnonsense\xff\x00\n".encode("latin-1"))
        self.assertRefused(BAD_INPUT, ["list.txt:2", "not the key"], "prune", self.database, "--from", listing, *WHY)
        self.assertRefused(IO, ["none.txt"], "prune", self.database, "--from", self.folder / "none.txt", *WHY)
        self.assertRefused(IO, ["no such database"], "prune", self.folder / "none.db", key, *WHY)
        self.assertRefused(IO, ["no such database"], "journal", self.folder / "none.db")
        self.assertRefused(BAD_INPUT, ["nothing to undo"], "undo", self.database)
        self.assertEqual(run_json("journal", self.database), [])

    def test_a_read_only_database_is_read_and_not_written(self):
        self.database.chmod(0o400)
        phonomime_cli.seal(self, self.folder)
        self.assertRefused(IO, ["read-only"], "prune", self.database, self.keys[0], *WHY, as_user=True)
        self.assertEqual(run("journal", self.database, "--json", as_user=True).stdout.strip(), "[]")
        self.assertEqual(run("suspects", self.database, as_user=True).returncode, 0)

    def test_a_locked_database_says_so(self):
        other = sqlite3.connect(self.database, isolation_level=None)
        other.execute("BEGIN IMMEDIATE")
        result = run("prune", self.database, self.keys[0], *WHY)
        self.assertEqual(result.returncode, IO)
        self.assertIn("another program is writing to this database", result.stderr)
        other.execute("ROLLBACK")
        other.close()
        run_well("prune", self.database, self.keys[0], *WHY)

    def test_two_at_a_time_both_get_what_they_ask_for_or_are_told(self):
        """Of many calls that prune at once each is done whole or refused as locked; the journal holds those done."""
        running = [subprocess.Popen([PROGRAM, "prune", str(self.database), key, *WHY, "--by", f"user{i}"],
                                    stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                   for i, key in enumerate(self.keys[:12])]
        outcomes = [(process.communicate()[1], process.returncode) for process in running]
        done = [key for key, (_, status) in zip(self.keys, outcomes) if status == 0]
        for message, status in outcomes:
            self.assertIn(status, (0, IO), message)
            if status == IO:
                self.assertIn("another program is writing", message)
        self.assertGreaterEqual(len(done), 2)
        self.assertEqual(self.pruned(), done)
        self.assertEqual(sorted(key for entry in run_json("journal", self.database) for key in entry["nodes"]),
                         sorted(done))

    def test_killed_at_any_moment_it_is_as_before_or_as_after(self):
        listing = self.folder / "all.txt"
        listing.write_text("\n".join(self.keys) + "\n")
        call = [PROGRAM, "prune", str(self.database), "--from", str(listing), *WHY]
        began = time.monotonic()
        subprocess.run(call, check=True, stdout=subprocess.DEVNULL)
        whole_s = time.monotonic() - began
        befores = afters = 0
        for i in range(30):
            self.database.write_bytes(self.made)
            for suffix in ("-journal", "-wal", "-shm"):
                (self.folder / ("made.db" + suffix)).unlink(missing_ok=True)
            with subprocess.Popen(call, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                time.sleep(whole_s * i / 29)
                process.send_signal(signal.SIGKILL)
            pruned = self.pruned()
            self.assertIn(len(pruned), (0, len(self.keys)))
            self.assertEqual(len(run_json("journal", self.database)), 1 if pruned else 0)
            befores, afters = befores + (not pruned), afters + bool(pruned)
        self.assertGreater(befores, 0)


if __name__ == "__main__":
    phonomime_cli.main()
