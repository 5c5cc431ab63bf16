# SPDX-License-Identifier: GPL-3.0-or-later
"""The same input gives the same bytes: with 1 and 2 threads, and on a second run."""
import json

import phonomime_cli as cli
import tiny_corpus

EMOTIONS = "0 0.7 neutral\n0.7 1.3 happiness\n1.3 9 neutral\n"


class SameBytes(cli.CliTest):
    """What is checked; the classes below say on what."""

    def make_databases(self, corpora):
        """One for each way of importing them; all must be told alike."""
        databases = []
        for name, threads in (("one", 1), ("two", 2), ("again", 2)):
            database = self.folder / f"{name}.db"
            for corpus in corpora:
                cli.run_well("import", corpus, "--db", database, "--threads", threads)
            databases.append(database)
        states = [cli.state(database) for database in databases]
        self.assertGreater(len(states[0][1]), 50)
        for database, state in zip(databases[1:], states[1:]):
            self.assertEqual(state, states[0], database.name)
        return databases

    def outputs(self, call, name, database, threads, kinds):
        paths = {kind: self.folder / name / f"out.{kind}" for kind in kinds}
        (self.folder / name).mkdir()
        cli.run_well(*call, "--db", database, "--threads", threads,
                     *(word for path in paths.values() for word in ("-o", path)))
        read = {kind: path.read_bytes() for kind, path in paths.items()}
        read["json"] = cli.without_timings(json.loads(read["json"]))
        return read

    def assertSameBytes(self, call, databases, kinds=cli.KINDS):
        first = self.outputs(call, "first", databases[0], 1, kinds)
        for kind in kinds:
            self.assertGreater(len(first[kind]), 5, kind)
        others = (("threads", databases[0], 2), ("again", databases[0], 1),
                  ("two", databases[1], 2), ("import_again", databases[2], 1))
        for name, database, threads in others:
            got = self.outputs(call, name, database, threads, kinds)
            for kind in kinds:
                self.assertTrue(got[kind] == first[kind], f"{kind} of {name} differs")


class TinyCorpusTest(SameBytes):
    def test_every_output(self):
        corpora = [tiny_corpus.Corpus(self.folder / "ann", sentences=12, emotions=("neutral", "happiness")).write(),
                   tiny_corpus.Corpus(self.folder / "more", name="ann", sentences=7, first=40).write()]
        transcript = cli.write_transcript(self.folder / "hello.lab", "b aa m eh pau p iy s ow l f t uw".split())
        (self.folder / "track").write_text(EMOTIONS)
        (self.folder / "constraints").write_text("at 0.75 use ann/neutral/u001#3\n")
        call = ["synth", transcript, "--face", tiny_corpus.write_face(self.folder / "face"),
                "--emotions", self.folder / "track", "--constraints", self.folder / "constraints"]
        self.assertSameBytes(call, self.make_databases(corpora))


@cli.needs_shared_data
class RecordingsTest(SameBytes):
    def test_every_output(self):
        corpus = cli.SHARED_DATA / "grid_s1_expressive"
        words = "b ih g m ae p s b l uw b iy z p l iy z eh m p iy d ey n aw".split()
        transcript = cli.write_transcript(self.folder / "hello.lab", words, each_s=0.09)
        (self.folder / "track").write_text(EMOTIONS)
        call = ["synth", transcript, "--face", cli.SHARED_DATA / "faces/ict", "--emotions", self.folder / "track"]
        self.assertSameBytes(call, self.make_databases([corpus]))


if __name__ == "__main__":
    cli.main()
