# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps against scikit-learn's Isomap on the same points, and how long both take.

usage: isomap_peer_test.py ISOMAP_PEER CLASS, one of AgainstScikitLearn and Speed
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

try:
    import numpy as np
    from sklearn.decomposition import PCA
    from sklearn.manifold import Isomap, trustworthiness
    from sklearn.metrics import silhouette_score
except ImportError as error:
    print(f"skipped: needs python3-sklearn: {error}")
    sys.exit(77)

PEER, TESTS = sys.argv[1:3]
K = 12


def swiss_roll(count):
    random = np.random.default_rng(1)
    t = 4.7 + 9.4 * random.random(count)
    return np.column_stack((t * np.cos(t), 20 * random.random(count), t * np.sin(t)))


def patch(count):
    random = np.random.default_rng(2)
    turn, _ = np.linalg.qr(random.standard_normal((25, 25)))
    return random.random((count, 2)) * (3, 1) @ turn[:2]


def trajectories(count):
    """Short smooth paths through a curved sheet in 25 dimensions, as motion nodes are; of fewer
    frames than K, lest they fall apart."""
    random = np.random.default_rng(3)
    nodes, frames = (count + 8) // 9, np.arange(9) / 9
    u, v = (random.standard_normal((nodes, 1)) * scale + 2 * random.standard_normal((nodes, 1)) * frames
            for scale in (6, 2.5))
    v = v + np.sin(3 * frames)
    sheet = np.stack((u, v, 0.08 * u * u, 2 * np.sin(0.4 * v)), -1).reshape(-1, 4)
    points = sheet @ random.standard_normal((4, 25))
    return (points + 0.1 * random.standard_normal(points.shape))[:count]


def ours(points, largest_exact=5000, landmarks=500):
    """Figures and places, and the distances where they are written, for float32 points."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        file = pathlib.Path(folder) / "points.f32"
        file.write_bytes(points.astype("<f4").tobytes())
        subprocess.run([PEER, file, str(points.shape[1]), str(K), str(largest_exact),
                        str(landmarks), "0", out], check=True)
        figures = json.loads(out.with_suffix(".json").read_text(encoding="utf-8"))
        places = [np.fromfile(out.with_suffix(kind), "<f8").reshape(-1, 2) for kind in (".map", ".pca")]
        geodesics = out.with_suffix(".geodesics")
        distances = np.fromfile(geodesics, "<f8").reshape(len(points), -1) if geodesics.exists() else None
    return figures, *places, distances


def misfit(a, b):
    """Largest distance between points after the best rigid motion or reflection, over b's spread."""
    a, b = a - a.mean(0), b - b.mean(0)
    u, _, v = np.linalg.svd(a.T @ b)
    return np.linalg.norm(a @ u @ v - b, axis=1).max() / np.sqrt((b ** 2).sum(1).mean())


def residual_variance(distances, places):
    shown = np.sqrt(((places[:, None] - places[None]) ** 2).sum(-1))
    return 1 - np.corrcoef(shown.ravel(), distances.ravel())[0, 1] ** 2


class AgainstScikitLearn(unittest.TestCase):
    def compare(self, points):
        points = points.astype(np.float32).astype(float)
        peer = Isomap(n_neighbors=K, n_components=2)
        theirs = peer.fit_transform(points)
        figures, places, pca, distances = ours(points)
        self.assertEqual(figures["components"], 1)
        self.assertLess(np.abs(distances - peer.dist_matrix_).max(), 1e-9 * distances.max())
        self.assertLess(misfit(places, theirs), 1e-3)
        self.assertLess(misfit(pca, PCA(2).fit_transform(points)), 1e-5)
        self.assertAlmostEqual(figures["isomap_residual_variance"],
                               residual_variance(peer.dist_matrix_, theirs), delta=1e-3)
        self.assertAlmostEqual(figures["pca_residual_variance"],
                               residual_variance(peer.dist_matrix_, pca), delta=1e-6)
        labels = np.arange(len(points)) % 3
        self.assertAlmostEqual(figures["silhouette"], silhouette_score(places, labels), delta=1e-9)
        self.assertAlmostEqual(figures["trustworthiness"],
                               trustworthiness(points, places, n_neighbors=K), delta=1e-9)

    def test_swiss_roll(self):
        self.compare(swiss_roll(1500))

    def test_planar_patch(self):
        self.compare(patch(1200))

    def test_trajectories(self):
        self.compare(trajectories(2000))

    def test_few_points(self):
        self.compare(patch(30))

    def test_landmarks_against_the_exact_map(self):
        points = trajectories(4500)
        exact, places, _, _ = ours(points)
        figures, by_landmarks, _, _ = ours(points, largest_exact=1000)
        self.assertEqual((exact["landmarks"], figures["landmarks"]), (0, 500))
        self.assertAlmostEqual(figures["isomap_residual_variance"],
                               exact["isomap_residual_variance"], delta=0.02)
        peer = Isomap(n_neighbors=K, n_components=2).fit(points[::3])
        self.assertAlmostEqual(residual_variance(peer.dist_matrix_, by_landmarks[::3]),
                               residual_variance(peer.dist_matrix_, places[::3]), delta=0.02)


class Speed(unittest.TestCase):
    """Of an optimised build, with two cores to itself."""

    def test_ten_times_as_fast(self):
        points = trajectories(5000)
        mine = min(ours(points)[0]["seconds"] for _ in range(3))
        start = time.perf_counter()
        peer = Isomap(n_neighbors=K, n_components=2, n_jobs=-1).fit(points)
        theirs = time.perf_counter() - start
        print(f"5,000 points: {mine:.2f} s, scikit-learn {theirs:.1f} s, {theirs / mine:.1f} times",
              file=sys.stderr)
        self.assertEqual(peer.embedding_.shape, (5000, 2))
        self.assertGreater(theirs / mine, 10)

    def test_many_points(self):
        figures, places, _, _ = ours(trajectories(50000))
        print(f"50,000 points: {figures['seconds']:.2f} s, {figures['largest_memory_mib']} MiB",
              file=sys.stderr)
        self.assertTrue(np.isfinite(places).all())
        self.assertLess(figures["seconds"], 10)
        self.assertLess(figures["largest_memory_mib"], 1024)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], defaultTest=TESTS)
