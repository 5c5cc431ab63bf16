# SPDX-License-Identifier: GPL-3.0-or-later
"""A build of maps that is stopped or killed keeps what was made, and the next goes on there."""
import signal

import map_database
import phonomime_cli as cli

KILLS = 8


def run_build(database, number=None, after_s=0.0):
    return cli.run_until("map", "build", database, "--quiet", "--threads", "2", number=number, after_s=after_s)


class MapKillTest(cli.DatabaseTest):
    CORPUS = {"sentences": 30, "phonemes": 40}

    def stopped_builds(self, signals):
        """How many maps there were after each build that was stopped before its end."""
        status, said, work_s = run_build(self.database)
        self.assertEqual(status, cli.DONE, said)
        whole = map_database.maps(self.database)
        counts = []
        for k in range(KILLS):
            self.database.write_bytes(self.made)
            status, said, _ = run_build(self.database, signals[k % len(signals)], work_s * (k + 0.5) / KILLS)
            with self.subTest(kill=k, status=status):
                self.assertIn(status, (cli.DONE, cli.INTERRUPTED, -signals[k % len(signals)]), said)
                states = {entry["phoneme"]: entry["state"] for entry in cli.run_json("map", "show", self.database)}
                kept = map_database.maps(self.database)
                self.assertEqual({name for name, state in states.items() if state == "fresh"}, set(kept))
                self.assertEqual(kept, {name: whole[name] for name in kept})
                if status != cli.DONE:
                    counts.append(len(kept))
                built = cli.run_json("map", "build", self.database)
                self.assertEqual({entry["phoneme"] for entry in built if not entry["built"]}, set(kept))
                self.assertEqual(map_database.maps(self.database), whole)
                with map_database.opened(self.database) as connection:
                    self.assertEqual(connection.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
        return counts, len(whole)

    def test_kill_9(self):
        counts, whole = self.stopped_builds([signal.SIGKILL])
        self.assertGreater(len(counts), KILLS // 3)
        self.assertTrue(any(0 < count < whole for count in counts), counts)

    def test_interrupts(self):
        counts, whole = self.stopped_builds([signal.SIGINT, signal.SIGTERM])
        self.assertGreater(len(counts), KILLS // 3)
        self.assertTrue(any(0 < count < whole for count in counts), counts)


if __name__ == "__main__":
    cli.main()
