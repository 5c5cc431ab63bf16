#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of a report, computed again from the motion: check_figures.py FOLDER.

FOLDER is what report_test leaves: report.json and motion.json of the made layout. Nothing here is
shared with Phonomime but the definitions that the report prints.
"""

import json
import math
import pathlib
import statistics
import sys

UPPER, LOWER, RIGHT, LEFT, CHIN, BROW, LID, SKULL = range(8)
LIPS, UPPER_FACE, ALL = (UPPER, LOWER, RIGHT, LEFT), (BROW, LID), range(8)
CLOSED_MM, BAND_S, REACH_S = 1.5, 0.15, 0.05


def group(frame, g):
    return frame[3 * g:3 * g + 3]


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else None


def rms(values):
    return math.sqrt(mean(v * v for v in values))


def percentile(values, share):
    values = sorted(values)
    place = share * (len(values) - 1)
    low = math.floor(place)
    high = min(low + 1, len(values) - 1)
    return values[low] + (place - low) * (values[high] - values[low])


def warp(wanted, moved, band):
    """The moved curve on the times of the wanted one; consecutive samples."""
    size = len(wanted)
    standard = [[(v - statistics.fmean(c)) / statistics.pstdev(c) for v in c] for c in (wanted, moved)]
    best = {}
    for i in range(size):
        for j in range(max(0, i - band), min(size, i + band + 1)):
            ways = [best[p][0:1] + (p,) for p in ((i - 1, j - 1), (i - 1, j), (i, j - 1)) if p in best]
            cost, origin = min(ways, key=lambda way: way[0]) if ways else (0.0, None)
            best[i, j] = (cost + (standard[0][i] - standard[1][j]) ** 2, origin)
    matched = [[] for _ in range(size)]
    place = (size - 1, size - 1)
    while place is not None:
        matched[place[0]].append(moved[place[1]])
        place = best[place][1]
    return [mean(values) for values in matched]


class Sentence:
    def __init__(self, data, method, rate, reference):
        self.rate, self.reference = rate, reference
        self.o, self.s = data["recorded"], data["methods"][method]["channels"]
        self.joins = data["methods"][method]["joins"]
        self.rows = [(phoneme, round(start * rate), round(end * rate)) for phoneme, start, end in data["rows"]]
        spoken = [row for row in self.rows if row[0] != "pau"]
        self.usable = [gap == 0 for gap in data["gaps"]]
        self.frames = [k for k in range(spoken[0][1], spoken[-1][2]) if self.usable[k]]
        self.with_velocity = [k for k in self.frames if k - 1 in set(self.frames)]

    def errors(self, groups):
        return [[math.dist(group(self.s[k], g), group(self.o[k], g)) for g in groups] for k in self.frames]

    def curve(self, motion, kind):
        if kind == "aperture":
            return [f[3 * UPPER + 1] - f[3 * LOWER + 1] for f in motion]
        if kind == "width":
            return [math.dist(group(f, RIGHT), group(f, LEFT)) for f in motion]
        return [mean(f[3 * g + 2] for g in LIPS) for f in motion]

    def velocity(self, motion, k, g):
        return [(a - b) * self.rate for a, b in zip(group(motion[k], g), group(motion[k - 1], g))]

    def dynamics(self):
        differences = []
        for g in UPPER_FACE:
            rest = self.reference[3 * g:3 * g + 3]
            spread = [statistics.pstdev(math.dist(group(m[k], g), rest) ** 2 for k in self.frames)
                      for m in (self.o, self.s)]
            differences.append(spread[0] - spread[1])
        return differences

    def jerk(self, motion, k):
        norms = []
        for g in ALL:
            a, b, c, d = (group(motion[i], g) for i in range(k - 1, k + 3))
            norms.append(math.hypot(*(w - 3 * z + 3 * y - x for x, y, z, w in zip(a, b, c, d))))
        return rms(norms) * self.rate ** 3

    def jerks(self):
        spoken = {k for phoneme, start, end in self.rows if phoneme != "pau" for k in range(start, end)}
        at_joins, inside, recorded = [], [], []
        for k in range(len(self.o) - 3):
            if all(i in self.frames and i in spoken for i in range(k - 1, k + 3)):
                near = any(not captured and abs(k + 0.5 - (frame - 0.5)) <= 3 for frame, captured in self.joins)
                (at_joins if near else inside).append(self.jerk(self.s, k))
                recorded.append(self.jerk(self.o, k))
        return mean(at_joins), mean(inside), mean(recorded)

    def minima(self, phonemes):
        """(recorded, synthesised, delay) of each row of the phonemes with a usable frame."""
        reach, found = round(REACH_S * self.rate), []
        curves = [self.curve(m, "aperture") for m in (self.o, self.s)]
        for phoneme, start, end in self.rows:
            frames = [k for k in range(start, end) if self.usable[k]]
            wide = [k for k in range(max(0, start - reach), min(len(self.o), end + reach)) if self.usable[k]]
            if phoneme in phonemes and frames:
                times = [min(wide, key=lambda k, c=curve: c[k]) for curve in curves]
                least = [min(curve[k] for k in frames) for curve in curves]
                found.append((phoneme, *least, (times[1] - times[0]) / self.rate))
        return found

    def figures(self, ranges):
        errors, lips = self.errors(ALL), self.errors(LIPS)
        dynamics = self.dynamics()
        at_joins, inside, recorded_jerk = self.jerks()
        found = {
            "squared_error": mean(e * e for row in errors for e in row),
            "rmse": rms(e for row in errors for e in row),
            "lip_rmse": rms(e for row in lips for e in row),
            "lip_vertex_error": mean(max(row) ** 2 for row in lips),
            "lip_vertex_error_root": math.sqrt(mean(max(row) ** 2 for row in lips)),
            "upper_face_dynamics": mean(dynamics),
            "upper_face_dynamics_absolute": mean(map(abs, dynamics)),
            "jerk_at_joins": at_joins, "jerk_inside_nodes": inside, "jerk_ratio": at_joins / inside,
            "jerk_recorded": recorded_jerk,
            "captured_joins": mean(1.0 if captured else 0.0 for _, captured in self.joins),
        }
        for name, groups in (("velocity_error", ALL), ("lip_velocity_error", LIPS)):
            found[name] = mean(math.dist(self.velocity(self.s, k, g), self.velocity(self.o, k, g))
                               for k in self.with_velocity for g in groups)
        for kind in ("aperture", "width", "protrusion"):
            o, s = ([self.curve(m, kind)[k] for k in self.frames] for m in (self.o, self.s))
            found[f"{kind}_correlation"] = statistics.correlation(o, s)
            if len(self.frames) == self.frames[-1] - self.frames[0] + 1:
                warped = warp(o, s, round(BAND_S * self.rate))
                found[f"{kind}_correlation_warped"] = statistics.correlation(o, warped)
            if kind != "protrusion":
                found[f"{kind}_deviation_ratio"] = statistics.pstdev(s) / statistics.pstdev(o)
        speeds = [[abs(c[k] - c[k - 1]) for k in self.with_velocity]
                  for c in (self.curve(self.s, "aperture"), self.curve(self.o, "aperture"))]
        found["aperture_speed_ratio"] = percentile(speeds[0], 0.95) / percentile(speeds[1], 0.95)
        speeds = [[rms(math.hypot(*self.velocity(m, k, g)) for g in LIPS) for k in self.with_velocity]
                  for m in (self.s, self.o)]
        found["lip_speed_ratio"] = percentile(speeds[0], 0.95) / percentile(speeds[1], 0.95)
        closures, contacts = self.minima("pbm"), self.minima("fv")
        found["closure_recall"] = mean(s < CLOSED_MM for _, _, s, _ in closures)
        found["closure_recall_recorded"] = mean(o < CLOSED_MM for _, o, _, _ in closures)
        found["closure_kept"] = mean(s < CLOSED_MM for _, o, s, _ in closures if o < CLOSED_MM)
        found["contact_error"] = mean(abs(s - o) for _, o, s, _ in contacts)
        within = [[low <= value <= high for value in (s, o)] for p, o, s, _ in contacts for low, high in [ranges[p]]]
        found["contact_share"] = mean(s for s, _ in within)
        found["contact_share_recorded"] = mean(o for _, o in within)
        found["minimum_timing_bias"] = mean(late for *_, late in closures + contacts)
        found["minimum_timing_error"] = mean(abs(late) for *_, late in closures + contacts)
        return found


def contact_ranges(motion):
    least = {}
    for data in motion["sentences"].values():
        method = next(iter(data["methods"]))
        for phoneme, o, _, _ in Sentence(data, method, motion["rate"], motion["reference_pose"]).minima("fv"):
            least.setdefault(phoneme, []).append(o)
    return {p: (percentile(v, 0.1), percentile(v, 0.9)) for p, v in least.items() if len(v) >= 10}


def same(a, b):
    if a is None or b is None:
        return a is None and b is None
    return math.isclose(a, b, rel_tol=1e-7, abs_tol=1e-9)


def main():
    folder = pathlib.Path(sys.argv[1])
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    motion = json.loads((folder / "motion.json").read_text(encoding="utf-8"))
    ranges = contact_ranges(motion)
    checked, problems = 0, []
    for method in report["methods"]:
        own = []
        for row in method["sentences"]:
            sentence = Sentence(motion["sentences"][row["key"]], method["id"], motion["rate"], motion["reference_pose"])
            own.append(sentence.figures(ranges))
            for measure, value in own[-1].items():
                checked += 1
                if not same(value, row["values"][measure]):
                    problems.append(f"{method['id']} {row['key']} {measure}: {row['values'][measure]}, here {value}")
        for measure in ("squared_error", "lip_rmse", "closure_recall"):
            values = [figures[measure] for figures in own if figures[measure] is not None]
            summary = method["measures"][measure]
            error = statistics.stdev(values) / math.sqrt(len(values))
            for name, value in (("mean", statistics.fmean(values)), ("standard_error", error)):
                checked += 1
                if not same(value, summary[name]):
                    problems.append(f"{method['id']} {measure} {name}: {summary[name]}, here {value}")
        checked += 1
        if not same(sum(figures["squared_error"] for figures in own), method["total_error"]):
            problems.append(f"{method['id']}: total error {method['total_error']}")
    print("\n".join(problems))
    print(f"{checked} figures checked, {len(problems)} differ")
    return 1 if problems or checked < 500 else 0


if __name__ == "__main__":
    sys.exit(main())
