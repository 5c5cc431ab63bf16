# SPDX-License-Identifier: GPL-3.0-or-later
"""`synth --stream`: lines in as they come, frames out as they become final."""
import os
import re
import select
import signal
import subprocess
import time

import phonomime_cli as cli

SPOKEN = "b aa m eh s ow pau l f t uw k iy p n ow m".split()
WAIT_S = 60


def rows_of(phonemes, each_s=0.1, rest_s=0.3):
    """(start, end, label), with silence at both ends."""
    ends = [rest_s + each_s * (i + 1) for i in range(len(phonemes))]
    rows = [(0.0, rest_s, "pau")]
    for end, label in [*zip(ends, phonemes), (ends[-1] + rest_s, "pau")]:
        rows.append((rows[-1][1], end, label))
    return rows


def lines_of(rows):
    return [f"{start:.4f} {end:.4f} {label}\n" for start, end, label in rows]


class Stream:
    """A running `synth --stream`."""

    def __init__(self, test, *arguments, stdout=subprocess.PIPE):
        self.process = subprocess.Popen(
            [cli.PROGRAM, "synth", "--stream", "--db", str(test.database), *map(str, arguments)],
            stdin=subprocess.PIPE, stdout=stdout, stderr=subprocess.PIPE)
        self.out = b""
        test.addCleanup(self.close)

    def close(self):
        self.process.kill()
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
            if pipe:
                pipe.close()

    def say(self, text):
        self.process.stdin.write(text.encode())
        self.process.stdin.flush()

    def read_until(self, enough):
        """Reads stdout until `enough` of it holds; an AssertionError where that does not come."""
        until = time.monotonic() + WAIT_S
        while not enough(self.out):
            if not select.select([self.process.stdout], [], [], max(0, until - time.monotonic()))[0]:
                raise AssertionError(f"only {len(self.out)} bytes came")
            more = os.read(self.process.stdout.fileno(), 65536)
            if not more:
                raise AssertionError("the output ended")
            self.out += more

    def end(self):
        """Status, stdout and stderr once all is said."""
        out, err = self.process.communicate(timeout=WAIT_S)
        return self.process.returncode, self.out + out, err.decode()


class StreamTest(cli.DatabaseTest):
    CORPUS = {"emotions": ("neutral", "happiness"), "sentences": 8}

    def run_stream(self, text, *arguments):
        stream = Stream(self, *arguments)
        stream.say(text)
        return stream.end()

    def run_well(self, text, *arguments):
        status, out, err = self.run_stream(text, *arguments)
        self.assertEqual(status, cli.DONE, err)
        return out, err

    def synth(self, rows, *arguments):
        """The .csv of an ordinary synthesis."""
        transcript = cli.write_lab(self.folder / "hello.lab", [(end, label) for _, end, label in rows])
        cli.run_well("synth", "--db", self.database, transcript, "--cost", "paper", "--blend", "1",
                     "-o", self.folder / "hello.csv", *arguments)
        return (self.folder / "hello.csv").read_bytes()

    def test_frames_are_those_of_synth(self):
        """With all of the transcript in sight both take the same nodes."""
        rows = rows_of(SPOKEN)
        for arguments in ([], ["--fps", 60], ["--fps", 25, "--silence", "cubic", "--smoothing", 5], ["--no-rest"],
                          ["--emotion", "happiness"], ["--head", "10,5,0,1,2,3"], ["--threads", 1]):
            with self.subTest(arguments):
                out, err = self.run_well("".join(lines_of(rows)), "--look-ahead", 1000, "--compare", *arguments)
                self.assertEqual(out, self.synth(rows, *arguments))
                self.assertIn("above it by 0.0", err)

    def test_frames_come_before_the_end(self):
        """Line by line, each followed by what it makes final; all at once gives the same bytes."""
        lines = lines_of(rows_of(3 * SPOKEN))
        stream = Stream(self)
        stream.read_until(lambda out: out.endswith(b"\n"))
        self.assertTrue(stream.out.startswith(b"time,brow_top_x,"))
        counts = []
        for i, line in enumerate(lines):
            stream.say(line)
            said_s = float(line.split()[1])
            # Look-ahead of 3, a pause that waits for its phoneme and one that waits for its border, a row
            # for the frames and one for its join, 0.2 s of the kernel.
            behind_s = 7 * 0.1 + 0.2 + 2 / 30
            if said_s > behind_s + 0.3:
                stream.read_until(lambda out: out.count(b"\n") - 1 >= 30 * (said_s - behind_s))
            counts.append(stream.out.count(b"\n") - 1)
        self.assertGreater(counts[-1], 30)
        self.assertGreater(len(set(counts)), 10)
        self.assertRegex(stream.out[-40:].decode(), r"\d\n$")  # whole lines
        status, out, _ = stream.end()
        self.assertEqual(status, cli.DONE)
        at_once, _ = self.run_well("".join(lines))
        self.assertEqual(out, at_once)
        last_s = float(lines[-1].split()[1])
        self.assertEqual(out.count(b"\n") - 1, int(last_s * 30 + 1e-6) + 1)

    def test_broken_up_in_any_way(self):
        text = "# hello\n\n" + "".join(lines_of(rows_of(SPOKEN))).replace("\n", "\r\n").rstrip()
        expected, _ = self.run_well("".join(lines_of(rows_of(SPOKEN))))
        stream = Stream(self)
        for i in range(0, len(text), 5):
            stream.say(text[i:i + 5])
        self.assertEqual(stream.end()[:2], (cli.DONE, expected))

    def test_holes_emotions_and_constraints(self):
        rows = rows_of(SPOKEN)
        key = next(node["key"] for node in cli.run_json("nodes", self.database, "--phoneme", "aa"))
        (self.folder / "constraints").write_text(f"2 use {key}\nat 0.75 use {key}\n")
        (self.folder / "track").write_text("0.5 0.9 happiness\n")
        arguments = ["--constraints", self.folder / "constraints", "--emotions", self.folder / "track"]
        with_holes = [line for line in lines_of(rows) if " pau" not in line]
        with_holes.append(lines_of(rows)[-1])
        out, _ = self.run_well("".join(with_holes), "--look-ahead", 1000, *arguments)
        self.assertEqual(out, self.synth(rows, *arguments))
        said = [line.replace("\n", " happiness\n") if 0.45 < float(line.split()[0]) < 0.85 else line
                for line in lines_of(rows)]
        out, _ = self.run_well("".join(said), "--look-ahead", 1000, *arguments[:2])
        self.assertEqual(out, self.synth(rows, *arguments))

    def test_summary(self):
        text = "".join(lines_of(rows_of(SPOKEN)))
        _, err = self.run_well(text, "--look-ahead", 0, "--compare")
        said = re.fullmatch(r"(\d+) sounding phonemes, ([\d.]+) s, (\d+) frames: cost ([\d.]+), above the optimum by at most "
                            r"([\d.]+)( \([\d.]+ %\))?; the optimum costs ([\d.]+): above it by ([\d.]+)( \([\d.]+ %\))?\n", err)
        self.assertTrue(said, err)
        self.assertEqual(said[1], "16")
        self.assertEqual(said[3], "70")
        cost, most, optimum, lost = (float(said[i]) for i in (4, 5, 7, 8))
        self.assertAlmostEqual(lost, cost - optimum, delta=0.11)
        self.assertLessEqual(lost, most + 0.11)
        for quiet in (["--quiet"], ["--quiet", "--compare"]):
            self.assertEqual(self.run_well(text, *quiet)[1], "")

    def test_bad_lines(self):
        good = lines_of(rows_of(SPOKEN))
        cases = {
            "1.2 1.3\n": ("words", "start end label [emotion]"),
            "1.2 x aa\n": ('"x"',),
            "1.1 1.3 aa\n": ("overlaps",),
            "1.2 1.3 axx\n": ('"axx"', "Did you mean"),
            "1.2 1.2 aa\n": ("no duration",),
            "1.2 1.3 aa hapiness\n": ('"hapiness"', '"happiness"'),
            "1.2 1.3 aa happiness:0.5\n": ("a stream does not",),
            "1200 13000 aa\n": ("too long",),
            "x" * 70000: ("too long",),
        }
        for text, words in cases.items():
            with self.subTest(text[:40]):
                stream = Stream(self, "--look-ahead", 1)
                stream.say("".join(good[:10]))
                stream.read_until(lambda out: out.count(b"\n") > 12)
                try:
                    stream.say(text)
                except BrokenPipeError:
                    pass
                stream.process.stdin.close()
                stream.process.stdin = None
                status, out, err = stream.end()
                self.assertEqual((status, err.count("\n")), (cli.BAD_INPUT, 1), err)
                self.assertTrue(err.startswith("phonomime: standard input:11: "), err)
                for word in words:
                    self.assertIn(word, err)
                whole, _ = self.run_well("".join(good), "--look-ahead", 1)
                self.assertTrue(whole.startswith(out) and out.endswith(b"\n"))

    def test_the_example_of_the_format_page(self):
        page = (cli.SOURCE_DIR / "corpora_schema/transcript.md").read_text().split("## A transcript as a stream")[1]
        text = "".join(re.findall(r"^    (.*\n)", page, re.MULTILINE))
        self.assertEqual(text.count("\n"), 5)
        self.assertEqual(self.run_well(text)[0].count(b"\n"), 1 + 25)

    def test_nothing_said(self):
        for text in ("", "# nothing\n\n"):
            status, out, err = self.run_stream(text)
            self.assertEqual((status, out.count(b"\n")), (cli.BAD_INPUT, 1))
            self.assertIn("empty", err)
        status, out, _ = self.run_stream("0 1 pau\n")
        self.assertEqual((status, out.count(b"\n")), (cli.DONE, 32))

    def test_constraints_that_do_not_come_to_pass(self):
        for text, word in (("99 avoid ann/neutral/u000#1\n", "99"), ("at 99 avoid ann/neutral/u000#1\n", "99 s")):
            (self.folder / "constraints").write_text(text)
            status, _, err = self.run_stream("".join(lines_of(rows_of(SPOKEN))), "--constraints", self.folder / "constraints")
            self.assertEqual(status, cli.BAD_INPUT)
            self.assertIn(f"{self.folder / 'constraints'}:1", err)
            self.assertIn(word, err)
        (self.folder / "constraints").write_text("99 avoid nobody#1\n")
        self.assertRefused(cli.BAD_INPUT, ["nobody#1"], "synth", "--stream", "--db", self.database,
                           "--constraints", self.folder / "constraints")

    def test_options_that_do_not_go_with_it(self):
        call = ["synth", "--stream", "--db", self.database]
        for words in (["hello.lab"], ["-o", "x.csv"], ["--face", "x.obj"], ["--audio", "x.wav"], ["--json"],
                      ["--runners-up", "3"], ["--tier", "phones"]):
            self.assertRefused(cli.USAGE, ["--stream"], *call, *words)
        for words in (["--look-ahead", "-1"], ["--look-ahead", "1001"], ["--fps", "0"]):
            self.assertRefused(cli.USAGE, words[:1], *call, *words)
        for words in (["--look-ahead", "3"], ["--compare"]):
            self.assertRefused(cli.USAGE, ["--stream"], "synth", "--db", self.database, "hello.lab", *words)

    def test_a_reader_that_leaves(self):
        """Noticed at once, also while it waits for the next line."""
        reading, writing = os.pipe()
        stream = Stream(self, stdout=writing)
        os.close(writing)
        self.assertTrue(os.read(reading, 1))
        os.close(reading)
        self.assertEqual(stream.process.wait(timeout=WAIT_S), cli.IO)
        self.assertRegex(stream.process.stderr.read().decode(), r"^phonomime: standard output: .*\n$")

    def test_a_signal_stops_it(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                stream = Stream(self, "--look-ahead", 1)
                stream.say("".join(lines_of(rows_of(SPOKEN))[:10]))
                stream.read_until(lambda out: out.count(b"\n") > 12)
                stream.process.send_signal(number)
                self.assertEqual(stream.process.wait(timeout=WAIT_S), cli.INTERRUPTED)
                self.assertEqual(stream.process.stderr.read().decode(), "phonomime: interrupted\n")

    def test_memory_does_not_grow(self):
        """Two minutes of speech need about as much memory as ten seconds."""
        def peak_kb(repeats):
            stream = Stream(self, "--look-ahead", 1, "--quiet", "--fps", 10, stdout=subprocess.DEVNULL)
            for i in range(repeats):
                start = 2.0 * i
                stream.say("".join(lines_of((start + a, start + b, label) for a, b, label in rows_of(SPOKEN, 0.08))))
            stream.process.stdin.close()
            stream.process.stdin = None
            _, status, usage = os.wait4(stream.process.pid, 0)
            stream.process.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(stream.process.returncode, cli.DONE)
            return usage.ru_maxrss
        self.assertLess(peak_kb(60), peak_kb(5) + 10_000)


if __name__ == "__main__":
    cli.main()
