# SPDX-License-Identifier: GPL-3.0-or-later
"""Recorded sentences on a real head with shapes of its own, by direct fitting: measured on its mesh, with a reader of
GLB and a rigid alignment that are not Phonomime's."""
import csv
import json
import struct
import sys

import numpy as np
import scipy.sparse
import scipy.sparse.csgraph
import scipy.spatial

import phonomime_cli as cli

sys.path.insert(0, str(cli.SOURCE_DIR / "tests/support"))
import read_c3d

EVERY, FIRST = 80, 11  # sentence of grid_s1, by name
CLOSED_MM = 1.5
DEEPEST_MM = 1.0
# Markers on the upper and the lower inner lip that lie on each other when the mouth is shut.
LIPS = (("lm191", "lm95"), ("lm80", "lm88"), ("lm81", "lm178"), ("lm82", "lm87"), ("lm13", "lm14"),
        ("lm312", "lm317"), ("lm311", "lm402"), ("lm310", "lm318"), ("lm415", "lm324"))


class Skin:
    """The first primitive of a GLB with morph targets, in mm."""

    def __init__(self, folder):
        data = (folder / "ict_face.glb").read_bytes()
        (length,) = struct.unpack_from("<I", data, 12)
        self.document, self.binary = json.loads(data[20:20 + length]), data[28 + length:]
        mesh = self.document["meshes"][0]
        primitive = mesh["primitives"][0]
        self.names = mesh["extras"]["targetNames"]
        self.rest = 1000 * self.values(primitive["attributes"]["POSITION"])
        self.offsets = np.stack([1000 * self.values(target["POSITION"]) for target in primitive["targets"]])
        self.triangles = self.values(primitive["indices"]).reshape(-1, 3).astype(int)
        with open(folder / "markers.tsv", newline="", encoding="utf-8") as file:
            rows = csv.DictReader((line for line in file if not line.startswith("#")), delimiter="\t")
            self.vertex_of = {row["marker"]: int(row["vertex"]) for row in rows}

    def view(self, place, kind, count, width):
        view = self.document["bufferViews"][place["bufferView"]]
        at = view.get("byteOffset", 0) + place.get("byteOffset", 0)
        kind = {5126: "<f4", 5125: "<u4", 5123: "<u2"}[kind]
        return np.frombuffer(self.binary, kind, count * width, at).reshape(count, width)

    def values(self, index):
        accessor = self.document["accessors"][index]
        width = {"VEC3": 3, "SCALAR": 1}[accessor["type"]]
        count = accessor["count"]
        values = np.zeros((count, width))
        if "bufferView" in accessor:
            values[:] = self.view(accessor, accessor["componentType"], count, width)
        if sparse := accessor.get("sparse"):
            rows = self.view(sparse["indices"], sparse["indices"]["componentType"], sparse["count"], 1)[:, 0]
            values[rows] = self.view(sparse["values"], accessor["componentType"], sparse["count"], width)
        return values

    def at(self, markers, weights):
        """#frames by #markers by 3: the vertices under markers."""
        vertices = [self.vertex_of[marker] for marker in markers]
        return self.rest[vertices] + np.einsum("fs,svc->fvc", weights, self.offsets[:, vertices])


class Lips:
    """How deep the lower lip stands in the upper one."""

    GRID_MM = 0.5
    NEAR_MM = 14.0  # along the skin, from the inner lips

    def __init__(self, skin):
        self.skin = skin
        upper, lower = (self.distances([skin.vertex_of[pair[side]] for pair in LIPS]) for side in (0, 1))
        near = np.minimum(upper, lower) < self.NEAR_MM
        self.upper = skin.triangles[(near & (upper < lower - 1))[skin.triangles].all(1)]
        self.lower = skin.triangles[(near & (lower < upper - 1))[skin.triangles].all(1)]
        steps = range(7)
        self.inside = np.array([(i, j, 6 - i - j) for i in steps for j in steps if i + j <= 6]) / 6

    def distances(self, sources):
        """Along edges; vertices in one place (seams of the texture) are joined."""
        sides = np.vstack([self.skin.triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
        lengths = np.linalg.norm(self.skin.rest[sides[:, 0]] - self.skin.rest[sides[:, 1]], axis=1)
        seams = scipy.spatial.cKDTree(self.skin.rest).query_pairs(1e-4, output_type="ndarray")
        ends = np.vstack([sides, seams])
        graph = scipy.sparse.coo_matrix((np.r_[lengths, np.full(len(seams), 1e-6)], ends.T),
                                        shape=2 * (len(self.skin.rest),)).tocsr()
        return scipy.sparse.csgraph.dijkstra(graph.maximum(graph.T), indices=sources, min_only=True)

    def heights(self, places, triangles, sign):
        """{column}, its least (sign 1) or largest (-1) y over a grid in x and z."""
        corners = places[triangles]
        first = np.ceil(corners[:, :, [0, 2]].min(1) / self.GRID_MM).astype(int)
        size = np.maximum(np.floor(corners[:, :, [0, 2]].max(1) / self.GRID_MM).astype(int) - first + 1, 0)
        count = size.prod(1)
        t = np.repeat(np.arange(len(triangles)), count)
        k = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        column = first[t] + np.stack([k % size[t, 0], k // size[t, 0]], 1)
        a, b, c = (corners[t, i] for i in range(3))
        at = column * self.GRID_MM - a[:, [0, 2]]
        area = (b - a)[:, 0] * (c - a)[:, 2] - (c - a)[:, 0] * (b - a)[:, 2]
        flat = np.where(np.abs(area) > 1e-9, area, np.inf)
        u = (at[:, 0] * (c - a)[:, 2] - (c - a)[:, 0] * at[:, 1]) / flat
        v = ((b - a)[:, 0] * at[:, 1] - at[:, 0] * (b - a)[:, 2]) / flat
        hit = np.isfinite(flat) & (u >= 0) & (v >= 0) & (u + v <= 1)
        y = (a[:, 1] + u * (b - a)[:, 1] + v * (c - a)[:, 1])[hit]
        best_last = np.argsort(-sign * y)
        return dict(zip(map(tuple, column[hit][best_last]), y[best_last]))

    def depth_mm(self, weights):
        """Of the deepest place of the lower lip that is above the upper one: to the upper lip's skin."""
        active = weights > 0
        places = self.skin.rest + np.einsum("s,svc->vc", weights[active], self.skin.offsets[active])
        upper, lower = self.heights(places, self.upper, 1), self.heights(places, self.lower, -1)
        above = [(x * self.GRID_MM, y, z * self.GRID_MM) for (x, z), y in lower.items() if y > upper.get((x, z), np.inf)]
        if not above:
            return 0.0
        skin = np.einsum("pk,tkc->tpc", self.inside, places[self.upper]).reshape(-1, 3)
        return scipy.spatial.cKDTree(skin).query(above)[0].max()


def without_head(frames, rigid):
    """Frames (#frames by #markers by 3) turned and moved so that the rigid markers rest as in the first."""
    middle = frames[:, rigid].mean(1, keepdims=True)
    goal = (frames - middle)[0, rigid]
    still = np.empty_like(frames)
    for k, frame in enumerate(frames - middle):
        u, _, v = np.linalg.svd(frame[rigid].T @ goal)
        still[k] = frame @ (u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v)
    return still


def energy_above(frames, rate_hz, frequency_hz):
    """Of all channels about their lines from first to last frame."""
    flat = frames.reshape(len(frames), -1)
    ramp = np.linspace(0, 1, len(flat))[:, None]
    spectrum = np.fft.rfft(flat - (1 - ramp) * flat[0] - ramp * flat[-1], axis=0)
    return (np.abs(spectrum[np.fft.rfftfreq(len(flat), 1 / rate_hz) > frequency_hz]) ** 2).sum()


@cli.needs_shared_data
class IctSpeech(cli.RecordingsTest):
    def fitted(self, path, skin):
        """Weights of the skin's shapes, at the recording's own frames."""
        out = self.folder / f"{path.stem}.csv"
        face = cli.SHARED_DATA / "faces/ict"
        cli.run_well("retarget", "apply", path, "--db", self.database, "--face", face, "--no-head", "-o", out)
        header, *rows = csv.reader(out.read_text().splitlines())
        self.assertEqual(header[1:], skin.names)
        return np.array(rows, float)[:, 1:]

    def test_sentences(self):
        """Lips close where the speaker's do, do not pass through each other, and nothing trembles."""
        skin = Skin(cli.SHARED_DATA / "faces/ict")
        lips = Lips(skin)
        closed, squares, deepest = 0, [], 0.0
        energy = {(band, what): 0.0 for band in (8, 12) for what in ("face", "recorded")}
        sentences = 0
        for path in sorted((cli.SHARED_DATA / "grid_s1/motion").iterdir())[FIRST::EVERY]:
            recording = read_c3d.read(path)
            points = np.array(recording.frames)
            if (points[:, :, 3] < 0).any():
                continue
            sentences += 1
            names = [name for name in recording.names if name in skin.vertex_of]
            frames = without_head(points[:, [recording.names.index(name) for name in names], :3],
                                  [names.index(name) for name in cli.rigid_markers(cli.SHARED_DATA / "grid_s1")])
            weights = self.fitted(path, skin)
            face = skin.at(names, weights)
            self.assertEqual(len(face), len(frames))

            opening = {}
            for what, motion in (("face", face), ("recorded", frames)):
                up = motion[0, names.index("lm168")] - motion[0, names.index("lm2")]
                way = motion[:, names.index("lm13")] - motion[:, names.index("lm14")]
                opening[what] = way @ (up / np.linalg.norm(up))
            squares.extend((opening["face"] - np.maximum(opening["recorded"], 0)) ** 2)
            rows = cli.read_lab(cli.SHARED_DATA / f"grid_s1/alignment/{path.stem}.lab")
            for (start, _), (end, label) in zip([(0.0, ""), *rows], rows):
                inside = slice(int(np.ceil(start * recording.rate_hz)), int(np.ceil(end * recording.rate_hz)))
                if label in ("p", "b", "m") and min(opening["recorded"][inside], default=9) < CLOSED_MM:
                    closed += 1
                    self.assertLess(min(opening["face"][inside]), CLOSED_MM, f"{path.stem} {label} at {start}")
            size = np.ptp(face[0], 0)[0] / np.ptp(frames[0], 0)[0]
            for band in (8, 12):
                energy[band, "face"] += energy_above(face, recording.rate_hz, band)
                energy[band, "recorded"] += size**2 * energy_above(frames, recording.rate_hz, band)
            deepest = max(deepest, *(lips.depth_mm(frame) for frame in weights[::4]))
        shares = {band: energy[band, "face"] / energy[band, "recorded"] for band in (8, 12)}
        root = np.sqrt(np.mean(squares))
        print(f"{sentences} sentences: {closed} closed; opening off by {root:.2f} mm; lips {deepest:.2f} mm deep; "
              f"energy above 8 Hz {shares[8]:.2f}, above 12 Hz {shares[12]:.2f} of the recorded")
        self.assertGreaterEqual(sentences, 4)
        self.assertGreaterEqual(closed, 5)
        self.assertLess(root, 0.5)
        self.assertLess(deepest, DEEPEST_MM)
        for band, share in shares.items():
            self.assertLess(share, 1.0, f"above {band} Hz")


if __name__ == "__main__":
    cli.main()
