# SPDX-License-Identifier: GPL-3.0-or-later
"""The main job on real recordings: words that nobody recorded, on two faces, measured in a browser."""
import json
import os
import pathlib
import re
import subprocess
import unittest
import wave

import phonomime_cli as cli

CLOSED_MM = 1.5
LEAST_SHARE = 0.9
LEAST_CLOSURES = 30
LIPS_TOGETHER = ("p", "b", "m")
HERE = pathlib.Path(__file__).resolve().parent
BROWSER_DIR = pathlib.Path(os.environ.get("PHONOMIME_BROWSER_DIR") or "nowhere")

# No sentences of GRID: other words, in the phonemes that its speaker has.
SPEECH = {
    "mama": ("m aa m ah m ey b ay ah b ih g m ae p f r ah m b aa b z p ah b "
             "s ah m p iy p l p ey b ih g b ih l z b ay b aa n d z"),
    "plum": ("b l uw b iy z b ay t p l ah m z b ay p aa m z b iy ch b ih n "
             "p ay p s b ey b iy z b aw l z p iy z p ey p l z b ow t s"),
    "brown": ("b r aw n b eh r z b r iy dh b ih l ow b r iy z b r ih n "
              "ow p ah n p ae t s b aa k s b ay b eh n z b eh d ae n d b l ow"),
}
LENGTH_S = {"b": 0.08, "p": 0.09, "m": 0.08, "d": 0.06, "t": 0.07, "k": 0.08, "g": 0.06, "n": 0.06, "l": 0.07,
            "r": 0.06, "dh": 0.05, "v": 0.06, "z": 0.09, "s": 0.11, "f": 0.1, "ch": 0.1, "ah": 0.07, "ih": 0.08}
VOWEL_S = 0.12


def write_speech(folder, name):
    """The transcript, and sound of its length cut from the recordings'. Returns paths and the end."""
    t, rows = 0.25, [(0.25, "sil")]
    for phoneme in SPEECH[name].split():
        t += LENGTH_S.get(phoneme, VOWEL_S)
        rows.append((t, phoneme))
    rows.append((t + 0.25, "sil"))
    end_s = rows[-1][0]
    sounds = sorted((cli.SHARED_DATA / "grid_s1/audio").glob("*.wav"))[:4]
    samples = b""
    for sound in sounds:
        with wave.open(str(sound)) as recorded:
            form = recorded.getparams()
            samples += recorded.readframes(recorded.getnframes())
    audio = folder / f"{name}.wav"
    with wave.open(str(audio), "wb") as written:
        written.setparams(form)
        written.writeframes(samples[: round(end_s * form.framerate) * form.sampwidth * form.nchannels])
    return cli.write_lab(folder / f"{name}.lab", rows), audio, end_s


def measure(page):
    """What main_job.mjs finds in it; an AssertionError for errors in its console and requests."""
    driver = BROWSER_DIR / "drive.mjs"
    if not driver.is_file():
        raise unittest.SkipTest("skipped: the browser driver is missing (target phonomime_browser)")
    pictures = os.environ.get("PHONOMIME_SCREENSHOTS")
    result = subprocess.run(
        ["node", driver, page, HERE / "main_job.mjs",
         *(["--screenshot-dir", f"{pictures}/{page.stem}"] if pictures else []), "--", "5"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=cli.TIME_LIMIT_S, check=False)
    if result.returncode == 77:
        raise unittest.SkipTest(result.stderr.strip())
    if result.returncode != 0:
        raise AssertionError(f"{page.name}: {result.stderr}")
    return json.loads(result.stdout)


def smallest_aperture(curve_mm, rate_hz, start_s, end_s):
    """Over the frames in [start, end); of the nearest frame where there is none."""
    inside = [mm for k, mm in enumerate(curve_mm) if start_s - 1e-6 <= k / rate_hz < end_s - 1e-6]
    middle = round((start_s + end_s) / 2 * rate_hz)
    return min(inside) if inside else curve_mm[min(middle, len(curve_mm) - 1)]


@cli.needs_shared_data
@unittest.skipUnless("html" in cli.KINDS, "skipped: the program was built without the player")
class MainJobTest(cli.RecordingsTest):
    def synthesise(self, name, face, fps=30):
        """The paths of the outputs by kind, and the end of the transcript."""
        transcript, audio, end_s = write_speech(self.folder, name)
        outputs = {kind: self.folder / f"{name}-{face}-{fps}.{kind}" for kind in cli.KINDS}
        self.summary = cli.run_well(
            "synth", "--db", self.database, transcript, "--audio", audio, "--fps", fps, "--face",
            cli.SHARED_DATA / "faces" / face, *(word for path in outputs.values() for word in ("-o", path)))
        return outputs, end_s

    def check_counts(self, name, outputs, measured):
        """The summary, the explanation and the page count alike."""
        phonemes = len(SPEECH[name].split())
        counts = [re.search(r"(\d+) sounding phonemes.* (\d+) of (\d+) joins between chosen nodes as recorded", text).groups()
                  for text in (self.summary, outputs["txt"].read_text(), measured["facts"])]
        self.assertEqual(len(set(counts)), 1, counts)
        self.assertEqual((int(counts[0][0]), int(counts[0][2])), (phonemes, phonemes - 1))

    def check_page(self, measured, end_s):
        self.assertAlmostEqual(measured["duration"], end_s, places=4)
        self.assertEqual(measured["fps"], 30)
        self.assertEqual(len(measured["aperture_mm"]), int(end_s * 30 + 1e-6) + 1)
        self.assertTrue(measured["has_audio"])
        self.assertAlmostEqual(measured["audio_duration"], end_s, places=2)
        for look in measured["looks"]:
            self.assertAlmostEqual(look["aperture_mm"], measured["aperture_mm"][look["frame"]], places=3)
        moved_mm = [max(abs(a - b) for p, q in zip(one["vertices"], two["vertices"]) for a, b in zip(p, q))
                    for one, two in zip(measured["looks"], measured["looks"][1:])]
        self.assertGreater(max(moved_mm), 2.0)
        self.assertGreater(max(measured["aperture_mm"]) - min(measured["aperture_mm"]), 4.0)

    def closures(self, face):
        """(transcript, row, smallest aperture in mm) of each /p b m/ whose node was recorded closed."""
        found = []
        for name in SPEECH:
            outputs, end_s = self.synthesise(name, face)
            for path in outputs.values():
                self.assertGreater(path.stat().st_size, 1000, path)
            measured = measure(outputs["html"])
            self.check_page(measured, end_s)
            self.check_counts(name, outputs, measured)
            for row in json.loads(outputs["json"].read_text())["path"]:
                if row["phoneme"] in LIPS_TOGETHER and row["recorded"]["closed"]:
                    found.append((name, row["index"], smallest_aperture(
                        measured["aperture_mm"], measured["rate"], row["start"], row["end"])))
        return found

    def check_closures(self, face):
        found = self.closures(face)
        open_lips = [(name, row, round(mm, 2)) for name, row, mm in found if mm >= CLOSED_MM]
        share = 1 - len(open_lips) / len(found)
        print(f"\n{face}: lips closed in {share:.3f} of {len(found)} closures; open: {open_lips}")
        self.assertGreaterEqual(len(found), LEAST_CLOSURES)
        self.assertGreaterEqual(share, LEAST_SHARE, open_lips)

    def test_lips_close_on_the_canonical_face(self):
        self.check_closures("canonical")

    def test_lips_close_on_a_real_head(self):
        self.check_closures("ict")


if __name__ == "__main__":
    cli.main()
