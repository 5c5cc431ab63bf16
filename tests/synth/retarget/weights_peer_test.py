# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounded least squares against SciPy's nnls and lsq_linear on the same systems.

usage: weights_peer_test.py WEIGHTS_PEER
"""
import subprocess
import sys
import unittest

try:
    import numpy as np
    from scipy.optimize import lsq_linear, nnls
except ImportError as error:
    print(f"skipped: needs python3-scipy: {error}")
    sys.exit(77)

PEER = sys.argv[1]


def ours(systems):
    """The answers for [(A, goals, lower, upper)]: a list of arrays, #goals by #unknowns."""
    text = []
    for a, goals, lower, upper in systems:
        text.append(f"{a.shape[0]} {a.shape[1]} {lower} {upper} {len(goals)}")
        text.extend(" ".join(f"{value:.17g}" for value in row) for row in (*a, *goals))
    told = subprocess.run([PEER], input="\n".join(text), stdout=subprocess.PIPE, text=True, check=True).stdout
    lines = [np.array(line.split(), float) for line in told.splitlines()]
    answers = []
    for _, goals, _, _ in systems:
        answers.append(np.array(lines[:len(goals)]))
        del lines[:len(goals)]
    assert not lines
    return answers


def motion(random, a, frames):
    """Goals that follow one another as frames do, some of them out of reach."""
    weights = np.cumsum(random.normal(size=(frames, a.shape[1])), axis=0)
    return weights @ a.T + 0.3 * random.normal(size=(frames, a.shape[0]))


class AgainstSciPy(unittest.TestCase):
    def test_non_negative(self):
        """As large as 53 shapes on 91 markers, and smaller; each goal from the answer before it."""
        random = np.random.default_rng(3)
        systems = [(a, motion(random, a, 12), 0.0, np.inf)
                   for a in (random.normal(size=size) for size in [(273, 53)] * 3 + [(60, 30), (8, 8), (5, 1)])]
        for (a, goals, _, _), found in zip(systems, ours(systems)):
            for goal, x in zip(goals, found):
                expected, _ = nnls(a, goal)
                self.assertLess(abs(x - expected).max(), 1e-8 * max(1.0, abs(expected).max()))

    def test_between_bounds(self):
        random = np.random.default_rng(4)
        systems = [(a, motion(random, a, 6), lower, upper)
                   for a in (random.normal(size=size) for size in [(273, 53), (60, 30), (9, 6)])
                   for lower, upper in ((0.0, 1.0), (-0.5, 0.7))]
        for (a, goals, lower, upper), found in zip(systems, ours(systems)):
            for goal, x in zip(goals, found):
                expected = lsq_linear(a, goal, (lower, upper), method="bvls", tol=1e-14).x
                self.assertLess(abs(x - expected).max(), 1e-7)

    def test_dependent_columns(self):
        """Where there are many answers: one as near the goal as SciPy's, within the bounds."""
        random = np.random.default_rng(5)
        few = random.normal(size=(40, 6))
        for a in (few @ random.normal(size=(6, 20)), random.normal(size=(10, 25)), np.hstack([few, few, 0 * few])):
            goals = motion(random, a, 8)
            (free,) = ours([(a, goals, 0.0, np.inf)])
            (bound,) = ours([(a, goals, 0.0, 1.0)])
            for goal, x, y in zip(goals, free, bound):
                self.assertGreaterEqual(x.min(), 0.0)
                self.assertTrue(0.0 <= y.min() and y.max() <= 1.0)
                size = np.linalg.norm(goal)
                self.assertAlmostEqual(np.linalg.norm(a @ x - goal) / size, nnls(a, goal)[1] / size, 7)
                expected = lsq_linear(a, goal, (0.0, 1.0), method="bvls", tol=1e-14).x
                self.assertLess(np.linalg.norm(a @ y - goal), np.linalg.norm(a @ expected - goal) + 1e-6 * size)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
