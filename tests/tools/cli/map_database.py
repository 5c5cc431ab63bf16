# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps as they lie in a database, read with SQLite alone."""
import contextlib
import sqlite3
import struct


@contextlib.contextmanager
def opened(database):
    connection = sqlite3.connect(database)
    try:
        with connection:
            yield connection
    finally:
        connection.close()


def maps(database):
    """{phoneme: every column of its maps} of a database with one speaker."""
    with opened(database) as connection:
        rows = connection.execute("SELECT p.name, m.* FROM phoneme_maps m JOIN phonemes p ON p.id = m.phoneme_id")
        names = [column[0] for column in rows.description]
        return {row[0]: {name: value for name, value in zip(names[1:], row[1:]) if name != "id"} for row in rows}


def places(stored, kind="isomap"):
    """[(x, y), ...] of one phoneme's entry of `maps`."""
    numbers = struct.unpack(f"<{2 * stored['placed']}d", stored[kind])
    return list(zip(numbers[::2], numbers[1::2]))


def frames(database, phoneme):
    """(key, frame, coefficients) of every frame of a phoneme in use, in order of keys."""
    found = []
    with opened(database) as connection:
        dimensions = connection.execute("SELECT dimensions FROM pca").fetchone()[0]
        for speaker, emotion, sentence, row, first, count, blob in connection.execute(
                "SELECT k.name, e.name, s.name, n.row, n.first_frame, n.frame_count, c.frames FROM nodes n "
                "JOIN sentences s ON s.id = n.sentence_id JOIN speakers k ON k.id = s.speaker_id "
                "JOIN emotions e ON e.id = n.emotion_id JOIN phonemes p ON p.id = n.phoneme_id "
                "JOIN coefficients c ON c.sentence_id = s.id LEFT JOIN prunings g "
                "ON g.sentence_id = n.sentence_id AND g.row = n.row "
                "WHERE p.name = ? AND g.row IS NULL AND n.has_gap = 0 ORDER BY k.name, e.name, s.name, n.row",
                (phoneme,)):
            for i in range(count):
                found.append((f"{speaker}/{emotion}/{sentence}#{row}", i,
                              struct.unpack_from(f"<{dimensions}f", blob, 4 * dimensions * (first + i))))
    return found


def reconstruct(database, coefficients):
    """E11: the channels of PCA coefficients."""
    with opened(database) as connection:
        dimensions, mean, basis = connection.execute("SELECT dimensions, mean, basis FROM pca").fetchone()
    mean = struct.unpack(f"<{len(mean) // 8}d", mean)
    basis = struct.unpack(f"<{len(basis) // 8}d", basis)
    return [m + sum(coefficients[d] * basis[d * len(mean) + c] for d in range(dimensions)) for c, m in enumerate(mean)]
