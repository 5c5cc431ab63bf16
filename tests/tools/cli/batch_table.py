# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches in tests: a manifest with transcripts beside it, and what their outputs should be."""
import json

import phonomime_cli as cli
import tiny_corpus

COLUMNS = ("id", "transcript", "outputs", "emotion", "emotions", "constraints", "weights", "face", "fps")


def some_phonemes(number, count=9):
    """Phonemes of a transcript, others for each number."""
    return [tiny_corpus.PHONEMES[(7 * number + k * (number % 5 + 2)) % len(tiny_corpus.PHONEMES)] for k in range(count)]


def write_manifest(path, rows):
    """A manifest of rows {column: text}."""
    lines = ["\t".join(COLUMNS), *("\t".join(row.get(column, "") for column in COLUMNS) for row in rows)]
    path.write_text("\n".join(lines) + "\n")
    return path


class BatchTest(cli.DatabaseTest):
    """Tests of a folder with `ROWS` transcripts t00.lab, ... and a manifest of them, `self.manifest`, whose
    outputs go to `self.out`."""

    CORPUS = {"sentences": 12, "emotions": ("neutral", "happiness")}
    ROWS = 8
    PHONEMES = 9
    KINDS = ("csv", "json")

    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        self.names = [f"t{i:02d}" for i in range(self.ROWS)]
        for i, name in enumerate(self.names):
            self.write_transcript(name, i)
        self.rows = [{"transcript": f"{name}.lab", "outputs": ";".join(f"out/{name}.{kind}" for kind in self.KINDS)}
                     for name in self.names]
        self.manifest = write_manifest(self.folder / "m.tsv", self.rows)

    def write_transcript(self, name, number):
        cli.write_transcript(self.folder / f"{name}.lab", some_phonemes(number, self.PHONEMES))

    def call(self, *options):
        return ["batch", self.manifest, "--db", self.database, *options]

    def batch(self, *options, status=cli.DONE):
        """The batch's report, {id: status of the row}."""
        result = cli.run(*self.call(*options), "--json")
        self.assertEqual(result.returncode, status, result.stderr)
        self.report = json.loads(result.stdout)
        return {row["id"]: row["status"] for row in self.report["rows"]}

    def all_are(self, status):
        return {name: status for name in self.names}

    def outputs(self):
        """{path: bytes} of every output there is; of a .json without its timings."""
        found = {}
        for path in sorted(self.out.rglob("*")):
            if path.is_file() and ".phonomime-batch" not in path.parts:
                found[str(path.relative_to(self.out))] = self.output(path)
        return found

    def output(self, path):
        data = path.read_bytes()
        return json.dumps(cli.without_timings(json.loads(data))) if path.suffix == ".json" else data
