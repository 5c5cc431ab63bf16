# SPDX-License-Identifier: GPL-3.0-or-later
"""phonomime recommend, against whole syntheses with each node as a constraint."""
import random

import map_database
import phonomime_cli as cli
import tiny_corpus

SPOKEN = "b aa m eh p iy s ow l f".split()


class RecommendTest(cli.DatabaseTest):
    CORPUS = {"emotions": ("neutral", "happiness"), "sentences": 10}

    def setUp(self):
        super().setUp()
        # Rows 2 and 3 are spoken as in a recording.
        self.node = next(node for node in cli.run_json("nodes", self.database, "--phoneme", "aa")
                         if "pau" not in (node["previous"], node["next"]))
        self.spoken = [self.node["previous"], "aa", self.node["next"], *SPOKEN]
        self.transcript = cli.write_transcript(self.folder / "hello.lab", self.spoken)

    def recommend(self, *arguments):
        return cli.run_json("recommend", self.database, self.transcript, *arguments)

    def cost(self, *lines, asked=()):
        """Of the best path under constraints."""
        constraints = self.folder / "constraints"
        constraints.write_text("\n".join(lines) + "\n")
        return cli.run_json("synth", "--db", self.database, self.transcript, "--constraints", constraints,
                            "--blend", 1, *asked)["cost"]

    def nodes(self, *filters):
        return [node["key"] for node in cli.run_json("nodes", self.database, *filters)]

    def check(self, asked, row=2, elsewhere=()):
        """Everything that is said of one row, by syntheses."""
        given = list(asked)
        if elsewhere:
            (self.folder / "elsewhere").write_text("\n".join(elsewhere) + "\n")
            given += ["--constraints", self.folder / "elsewhere"]
        report = self.recommend("--row", row, "--limit", 8, *given)
        in_context = self.nodes("--phoneme", report["phoneme"], "--previous", report["previous"], "--next", report["next"])
        found = report["recommended"]
        self.assertEqual(len(found), 8)
        self.assertEqual(report["context_correct"], len(in_context))
        best = self.cost(*elsewhere, asked=asked)
        self.assertEqual(report["cost"], best)
        for one in found:
            cost = self.cost(*elsewhere, one["line"], asked=asked)
            self.assertAlmostEqual(one["delta"], cost - best, delta=1e-9 * best, msg=one)
        listed = [one["node"] for one in found]
        count = min(len(in_context), 8)
        self.assertEqual([one["context_correct"] for one in found], [True] * count + [False] * (8 - count))
        self.assertLessEqual(set(listed[:count]), set(in_context))
        for part in (found[:count], found[count:]):
            self.assertEqual([one["delta"] for one in part], sorted(one["delta"] for one in part))
        others = [key for key in self.nodes() if key not in listed and key not in in_context]
        for key in random.Random(1).sample(others, 12):
            self.assertGreaterEqual(self.cost(*elsewhere, f"{row} use {key}", asked=asked) - best,
                                    found[-1]["delta"] - 1e-9 * best)
        return found

    def test_exact_costs(self):
        found = self.check([])
        self.assertIn(self.node["key"], [one["node"] for one in found if one["context_correct"]])

    def test_exact_costs_by_the_paper(self):
        self.check(["--cost", "paper", "--emotion", "happiness"])

    def test_other_constraints_hold(self):
        self.check([], row=5, elsewhere=[f"4 use {self.nodes('--phoneme', 'm')[0]}", f"5 avoid {self.nodes('--phoneme', 'm')[-1]}"])

    def test_a_use_on_the_row_itself_is_left_out_of_account(self):
        free = self.recommend("--row", 2)
        constraints = self.folder / "own"
        constraints.write_text(f"2 use {self.nodes('--phoneme', 'b')[0]}\n")
        result = cli.run("recommend", self.database, self.transcript, "--row", 2, "--constraints", constraints)
        self.assertIn("use constraint of row 2", result.stderr)
        self.assertEqual(self.recommend("--row", 2, "--constraints", constraints)["recommended"], free["recommended"])

    def test_what_is_avoided_or_pruned_is_not_recommended(self):
        first = self.recommend("--row", 2)["recommended"][0]["node"]
        constraints = self.folder / "avoid"
        constraints.write_text(f"2 avoid {first}\n")
        self.assertNotIn(first, [one["node"] for one in self.recommend("--row", 2, "--limit", 1000, "--constraints", constraints)["recommended"]])
        cli.prune(self.database, first)
        self.assertNotIn(first, [one["node"] for one in self.recommend("--row", 2, "--limit", 1000)["recommended"]])

    def test_every_line_is_one_of_a_constraint_file(self):
        for line in cli.run_well("recommend", self.database, self.transcript, "--row", 2).splitlines():
            self.cost(line)

    def test_a_time_gives_row_and_moment(self):
        start, end = 0.3 + 0.1, 0.3 + 0.2  # of row 2: see write_transcript
        by_row = self.recommend("--row", 2, "--at-time", 0.25)
        by_time = self.recommend("--time", start + 0.25 * (end - start))
        self.assertAlmostEqual(by_time["relative_time"], 0.25)
        self.assertEqual([one["node"] for one in by_time["recommended"]], [one["node"] for one in by_row["recommended"]])
        for one in by_row["recommended"]:
            self.assertAlmostEqual(one["frame"], 0.25 * (one["frames"] - 1))

    def test_places_on_a_fresh_map(self):
        self.assertIsNone(self.recommend("--row", 2)["recommended"][0]["place"])
        cli.run_well("map", "build", self.database)
        first = self.recommend("--row", 2, "--at-time", 1)["recommended"][0]
        frames = map_database.frames(self.database, "aa")
        places = map_database.places(map_database.maps(self.database)["aa"])
        last = max(i for i, (key, _, _) in enumerate(frames) if key == first["node"])
        for axis in (0, 1):
            self.assertAlmostEqual(first["place"][axis], places[last][axis])
        channels = map_database.reconstruct(self.database, frames[last][2])
        markers = list(tiny_corpus.MARKERS)
        aperture = channels[3 * markers.index("lip_up") + 1] - channels[3 * markers.index("lip_lo") + 1]
        self.assertAlmostEqual(first["aperture"], aperture, places=5)
        cli.prune(self.database, self.nodes("--phoneme", "aa")[-1])
        self.assertIsNone(self.recommend("--row", 2)["recommended"][0]["place"])  # stale

    def test_threads_change_no_byte(self):
        one = cli.run_well("recommend", self.database, self.transcript, "--row", 2, "--threads", 1)
        self.assertEqual(cli.run_well("recommend", self.database, self.transcript, "--row", 2, "--threads", 3), one)

    def test_bad_calls(self):
        call = ["recommend", self.database, self.transcript]
        last = len(self.spoken) + 1
        for status, words, arguments in (
                (cli.USAGE, ["--row or --time"], []),
                (cli.USAGE, ["--time"], ["--row", 2, "--time", 0.5]),
                (cli.USAGE, ["--at-time", "0 to 1"], ["--row", 2, "--at-time", 2]),
                (cli.USAGE, ["--row"], ["--time", 0.5, "--at-time", 0.5]),
                (cli.USAGE, ["--limit", "1 to 1000"], ["--row", 2, "--limit", 0]),
                (cli.USAGE, ["--row"], ["--row", "two"]),
                (cli.BAD_INPUT, ["--row", f"0 to {last}", "99"], ["--row", 99]),
                (cli.BAD_INPUT, ["--row", "-1"], ["--row", "-1"]),
                (cli.BAD_INPUT, ["--row", "row 0 is silence"], ["--row", 0]),
                (cli.BAD_INPUT, ["--row", "silence"], ["--row", last]),
                (cli.BAD_INPUT, ["--time", "outside"], ["--time", 99]),
                (cli.BAD_INPUT, ["--time", "outside"], ["--time", "-0.1"]),
                (cli.BAD_INPUT, ["--time", "silence"], ["--time", 0.1]),
                (cli.BAD_INPUT, ['"sad"'], ["--row", 2, "--emotion", "sad"])):
            with self.subTest(" ".join(map(str, arguments))):
                self.assertRefused(status, words, *call, *arguments)
        self.assertRefused(cli.IO, ["nowhere.db"], "recommend", self.folder / "nowhere.db", self.transcript, "--row", 2)


if __name__ == "__main__":
    cli.main()
