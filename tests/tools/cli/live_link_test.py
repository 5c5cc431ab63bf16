# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes of Live Link Face in, a Live Link Face CSV out, and in again."""
import csv
import json
import re

import phonomime_cli as cli

TAKES = {"alexdjulin/alex_rom_3.csv": 60, "sentien/recording.csv": 30}
SENTENCE_S = 2.0
SENTENCES = 8
PHONEMES = "b aa m iy s ow p eh l uw".split()
TRANSCRIPT = "m aa p iy b ow s eh".split()
TICKS_HZ = 60
NOT_WEIGHTS = 9  # angles of head and eyes, at the end of a row


def read_take(path):
    """The header and the rows of a CSV file."""
    with open(path, newline="", encoding="utf-8-sig") as file:
        rows = [row for row in csv.reader(file) if row]
    return rows[0], rows[1:]


def ticks(timecode):
    """60ths of a second since midnight."""
    hours, minutes, seconds, frames = timecode.split(":")
    return ((int(hours) * 60 + int(minutes)) * 60 + int(seconds)) * TICKS_HZ + float(frames)


def made_up_rows(number):
    """A sentence of the phonemes in an order of its own, (end in seconds, label)."""
    rows, t = [(0.2, "pau")], 0.2
    for i in range(len(PHONEMES)):
        t += 0.16
        rows.append((round(t, 4), PHONEMES[(3 * i + number) % len(PHONEMES)]))
    return [*rows, (SENTENCE_S, "pau")]


@cli.needs_shared_data
class LiveLinkTest(cli.CliTest):
    def write_corpus(self, take, speaker, name):
        """The take, cut into sentences by start and end; one alignment on the take's own clock."""
        folder = self.folder / name
        folder.mkdir()
        (folder / "take.csv").write_bytes(take.read_bytes())
        header, _ = read_take(take)
        (folder / "layout.json").write_text(json.dumps(
            {"format": "phonomime-layout", "version": 1, "kind": "weights",
             "groups": [{"name": weight} for weight in header[2:-NOT_WEIGHTS]]}))
        (folder / "corpus.json").write_text(json.dumps(
            {"format": "phonomime-corpus", "version": 1, "name": speaker, "phoneme_set": "arpabet",
             "layout": "layout.json", "sentences": "sentences.tsv"}))
        lines, rows = ["id\tmotion\talignment\tstart\tend"], []
        for i in range(SENTENCES):
            start = i * SENTENCE_S
            rows += [(start + end, label) for end, label in made_up_rows(i)]
            lines.append(f"u{i}\ttake.csv\ttake.lab\t{start}\t{start + SENTENCE_S}")
        cli.write_lab(folder / "take.lab", rows)
        (folder / "sentences.tsv").write_text("\n".join(lines) + "\n")
        return folder

    def check_csv(self, path, take_header, fps, end_s):
        header, rows = read_take(path)
        self.assertEqual(len(header), 63)
        self.assertEqual([name.lower() for name in header], [name.lower() for name in take_header])
        self.assertEqual(len(rows), int(end_s * fps + 1e-6) + 1)
        for k, row in enumerate(rows):
            self.assertEqual(len(row), 63)
            self.assertRegex(row[0], re.compile(r"^\d\d:\d\d:\d\d:\d\d(\.\d+)?$"))
            self.assertAlmostEqual(ticks(row[0]) - ticks(rows[0][0]), k * TICKS_HZ / fps, delta=0.01)
            self.assertEqual(int(row[1]), 61)
            weights = [float(value) for value in row[2:-NOT_WEIGHTS]]
            self.assertTrue(all(0 <= weight <= 1 for weight in weights), (k, min(weights), max(weights)))
        columns = list(zip(*(map(float, row[2:-NOT_WEIGHTS]) for row in rows)))
        self.assertGreater(max(max(column) - min(column) for column in columns), 0.05, "nothing moves")
        return columns

    def check_take(self, name, rate_hz):
        take = cli.SHARED_DATA / "livelink" / name
        speaker = name.split("/")[0]
        database = self.folder / f"{speaker}.db"
        report = cli.run_json("import", self.write_corpus(take, speaker, speaker), "--db", database)
        info = cli.run_json("info", database)
        self.assertEqual((info["layout"], info["groups"], info["rate"]), ("weights", 52, 100))
        self.assertEqual((info["sentences"], info["nodes"]), (SENTENCES, SENTENCES * len(PHONEMES)), report)
        transcript = cli.write_transcript(self.folder / f"{speaker}.lab", TRANSCRIPT, each_s=0.15, rest_s=0.2)
        end_s = 0.4 + 0.15 * len(TRANSCRIPT)
        take_header, _ = read_take(take)
        for fps in (30, 60):
            out = self.folder / f"{speaker}-{fps}.csv"
            cli.run_well("synth", "--db", database, transcript, "--fps", fps, "-o", out)
            self.check_csv(out, take_header, fps, end_s)
        self.check_round_trip(self.folder / f"{speaker}-60.csv", speaker, end_s)

    def check_round_trip(self, made, speaker, end_s):
        """What was written goes in again, and its own timing brings the same weights back."""
        folder = self.folder / f"{speaker}-again"
        header, _ = read_take(made)
        folder = self.write_corpus(made, speaker, f"{speaker}-again")
        transcript = self.folder / f"{speaker}.lab"
        (folder / "take.lab").write_bytes(transcript.read_bytes())
        (folder / "sentences.tsv").write_text("id\tmotion\talignment\nagain\ttake.csv\ttake.lab\n")
        database = self.folder / f"{speaker}-again.db"
        cli.run_well("import", folder, "--db", database)
        self.assertEqual(cli.run_json("info", database)["nodes"], len(TRANSCRIPT))
        out = self.folder / f"{speaker}-again.csv"
        cli.run_well("synth", "--db", database, transcript, "--fps", 60, "-o", out)
        first = self.check_csv(made, header, 60, end_s)
        second = self.check_csv(out, header, 60, end_s)
        spoken = range(round(0.25 * 60), round((end_s - 0.25) * 60))
        worst = max(abs(a[k] - b[k]) for a, b in zip(first, second) for k in spoken)
        self.assertLess(worst, 0.05)

    def test_a_take_of_60_frames_a_second(self):
        self.check_take("alexdjulin/alex_rom_3.csv", 60)

    def test_a_take_of_30_frames_a_second(self):
        self.check_take("sentien/recording.csv", 30)


if __name__ == "__main__":
    cli.main()
