# SPDX-License-Identifier: GPL-3.0-or-later
"""Shards do everything together, at the same time too, and so do the example scripts of docs/."""
import json
import os
import pathlib
import shutil
import subprocess

import batch_table
import phonomime_cli as cli

EXAMPLES = cli.SOURCE_DIR / "docs" / "examples"


class ShardsTest(batch_table.BatchTest):
    ROWS = 11

    def start(self, *command, **variables):
        environment = {**os.environ, "PHONOMIME": cli.PROGRAM, **variables}
        return subprocess.Popen([*map(str, command)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, env=environment)

    def finish(self, process):
        """Its stdout; it must succeed."""
        out, said = process.communicate(timeout=cli.TIME_LIMIT_S)
        self.assertEqual((process.returncode, said), (cli.DONE, ""))
        return out

    def assertAllDoneOnce(self, reports):
        """By processes that ran at the same time: each row by one of them."""
        rows = [row for report in reports for row in json.loads(report)["rows"]]
        self.assertEqual(sorted(row["id"] for row in rows), self.names)
        self.assertEqual({row["status"] for row in rows}, {"done"})
        self.assertEqual(self.batch(), self.all_are("skipped"))
        self.assertEqual(len(self.outputs()), self.ROWS * len(self.KINDS))

    def test_at_the_same_time(self):
        for count in (1, 3, 13):
            with self.subTest(count):
                shutil.rmtree(self.out, ignore_errors=True)
                started = [self.start(cli.PROGRAM, *self.call("--json", "--threads", 1, "--shard", f"{i + 1}/{count}"))
                           for i in range(count)]
                self.assertAllDoneOnce([self.finish(process) for process in started])

    def test_rows_are_dealt_out_in_turn(self):
        self.assertEqual(self.batch("--shard", "2/4"), {name: "done" for name in self.names[1::4]})
        self.assertEqual(self.report["shard"], "2/4")

    def test_the_farm_example(self):
        started = [self.start(EXAMPLES / "batch_farm.sh", i + 1, 2, self.manifest, self.database, "--json")
                   for i in range(2)]
        self.assertAllDoneOnce([self.finish(process) for process in started])

    def test_the_farm_example_tries_again_where_files_fail(self):
        (self.folder / "t01.lab").unlink()
        process = self.start(EXAMPLES / "batch_farm.sh", 1, 1, self.manifest, self.database, TRIES="3", PAUSE="0.01")
        _, said = process.communicate(timeout=cli.TIME_LIMIT_S)
        self.assertEqual(process.returncode, cli.IO)
        self.assertEqual(said.count("1 of 11 rows failed"), 3)
        self.assertIn("try 2 of 3 failed", said)
        (self.folder / "t01.lab").write_text("#\n0.3 100 axx\n")
        process = self.start(EXAMPLES / "batch_farm.sh", 1, 1, self.manifest, self.database, PAUSE="0.01")
        _, said = process.communicate(timeout=cli.TIME_LIMIT_S)
        self.assertEqual(process.returncode, cli.BAD_INPUT)
        self.assertEqual(said.count("1 of 11 rows failed"), 1)

    def test_the_farm_example_stops_cleanly(self):
        """SIGTERM goes on to the program, whose status the script returns."""
        program = self.folder / "program"
        program.write_text(f"#!/bin/sh\ntrap 'exit 130' TERM\ntouch {self.folder}/started\nwhile :; do sleep 0.01; done\n")
        program.chmod(0o700)
        process = self.start(EXAMPLES / "batch_farm.sh", 1, 1, self.manifest, self.database, PHONOMIME=str(program))
        while not (self.folder / "started").exists() and process.poll() is None:
            pass
        process.terminate()
        process.communicate(timeout=cli.TIME_LIMIT_S)
        self.assertEqual(process.returncode, cli.INTERRUPTED)

    def test_the_slurm_example(self):
        def tasks(numbers, **variables):
            return [self.start(EXAMPLES / "batch_slurm.sh", self.manifest, self.database, "--json",
                               SLURM_ARRAY_TASK_ID=str(i), SLURM_CPUS_PER_TASK="1", **variables) for i in numbers]

        started = tasks((1, 2, 3), SLURM_ARRAY_TASK_MAX="3")
        self.assertAllDoneOnce([self.finish(process) for process in started])
        shutil.rmtree(self.out)
        (again,) = tasks((2,), SLURM_ARRAY_TASK_MAX="2", SHARDS="3")  # sbatch --array=2
        self.assertEqual([row["id"] for row in json.loads(self.finish(again))["rows"]], self.names[1::3])

    def test_an_example_that_is_called_wrongly_says_how(self):
        for script in sorted(pathlib.Path(EXAMPLES).glob("batch_*.sh")):
            process = self.start(script, self.manifest)
            out, said = process.communicate(timeout=cli.TIME_LIMIT_S)
            self.assertEqual((process.returncode, out), (cli.USAGE, ""))
            self.assertIn("usage:", said)


if __name__ == "__main__":
    cli.main()
