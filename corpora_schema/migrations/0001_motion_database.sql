-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 1: recordings, cut into motion nodes. Ids are private to a file; what people name is the
-- key speaker/emotion/sentence#row. Blobs are little-endian. Times are seconds from the sentence's
-- start, frame k is at k / rate_hz.

-- What the whole database has in common: one row.
CREATE TABLE settings (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  rate_hz REAL NOT NULL CHECK (rate_hz > 0),  -- of every stored frame
  layout_json TEXT NOT NULL                   -- a layout.json in mm and our axes
) STRICT;

-- Every import that was committed.
CREATE TABLE corpora (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  phoneme_set TEXT NOT NULL,
  synthetic INTEGER NOT NULL CHECK (synthetic IN (0, 1)),  -- 1: made, not recorded
  imported_at TEXT NOT NULL,                               -- UTC, ISO 8601
  report_json TEXT NOT NULL                                -- the import report
) STRICT;

-- Phonemes of the corpora's sets, silence ("pau") among them, whether recorded or not.
CREATE TABLE phonemes (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  viseme TEXT NOT NULL,
  visibility TEXT NOT NULL CHECK (visibility IN ('high', 'intermediate', 'low'))
) STRICT;

CREATE TABLE emotions (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE
) STRICT;

CREATE TABLE speakers (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  reference_pose BLOB  -- float64[channels]; NULL only while its first corpus is going in
) STRICT;

CREATE TABLE sentences (
  id INTEGER PRIMARY KEY,
  corpus_id INTEGER NOT NULL REFERENCES corpora (id) DEFERRABLE INITIALLY DEFERRED,
  speaker_id INTEGER NOT NULL REFERENCES speakers (id),
  emotion_id INTEGER NOT NULL REFERENCES emotions (id),
  name TEXT NOT NULL,     -- the corpus' id of the sentence
  text TEXT NOT NULL,     -- may be empty
  audio TEXT NOT NULL,    -- path of the recording, may be empty
  frame_count INTEGER NOT NULL CHECK (frame_count > 0),
  UNIQUE (speaker_id, emotion_id, name)
) STRICT;
CREATE INDEX sentences_by_corpus ON sentences (corpus_id);
CREATE INDEX sentences_by_emotion ON sentences (emotion_id);

-- Every row of a sentence's alignment, silence too, counted from 0.
CREATE TABLE alignment_rows (
  sentence_id INTEGER NOT NULL REFERENCES sentences (id),
  row INTEGER NOT NULL CHECK (row >= 0),
  phoneme_id INTEGER NOT NULL REFERENCES phonemes (id),
  start_s REAL NOT NULL,
  end_s REAL NOT NULL CHECK (end_s >= start_s),
  PRIMARY KEY (sentence_id, row)
) STRICT, WITHOUT ROWID;

-- Motion nodes: the frames of one row that is not silence. Phonemes and emotion repeat what the
-- rows and the sentence say, for the indexes.
CREATE TABLE nodes (
  sentence_id INTEGER NOT NULL,
  row INTEGER NOT NULL,
  first_frame INTEGER NOT NULL CHECK (first_frame >= 0),  -- into the sentence's frames
  frame_count INTEGER NOT NULL CHECK (frame_count > 0),
  phoneme_id INTEGER NOT NULL REFERENCES phonemes (id),
  previous_phoneme_id INTEGER NOT NULL REFERENCES phonemes (id),  -- silence at the edges
  next_phoneme_id INTEGER NOT NULL REFERENCES phonemes (id),
  emotion_id INTEGER NOT NULL REFERENCES emotions (id),
  has_gap INTEGER NOT NULL CHECK (has_gap IN (0, 1)),  -- 1: holds frames with unfilled gaps
  PRIMARY KEY (sentence_id, row),
  FOREIGN KEY (sentence_id, row) REFERENCES alignment_rows (sentence_id, row)
) STRICT, WITHOUT ROWID;
CREATE INDEX nodes_by_phoneme_and_emotion ON nodes (phoneme_id, emotion_id);
CREATE INDEX nodes_by_triphone ON nodes (previous_phoneme_id, phoneme_id, next_phoneme_id);

-- Why a node may be bad; marked nodes are still used.
CREATE TABLE suspect_marks (
  sentence_id INTEGER NOT NULL,
  row INTEGER NOT NULL,
  reason TEXT NOT NULL,
  PRIMARY KEY (sentence_id, row, reason),
  FOREIGN KEY (sentence_id, row) REFERENCES nodes (sentence_id, row)
) STRICT, WITHOUT ROWID;

-- Nodes that a person has taken out of use.
CREATE TABLE prunings (
  sentence_id INTEGER NOT NULL,
  row INTEGER NOT NULL,
  pruned_by TEXT NOT NULL,
  pruned_at TEXT NOT NULL,  -- UTC, ISO 8601
  reason TEXT NOT NULL,
  PRIMARY KEY (sentence_id, row),
  FOREIGN KEY (sentence_id, row) REFERENCES nodes (sentence_id, row)
) STRICT, WITHOUT ROWID;

-- Normalised channels of a sentence, head motion off.
CREATE TABLE channels (
  sentence_id INTEGER PRIMARY KEY REFERENCES sentences (id),
  frames BLOB NOT NULL,        -- float32[frame_count][channels], mm or weights
  frame_has_gap BLOB NOT NULL  -- uint8[frame_count], 1: some channel was missing and not filled
) STRICT;

-- The head motion that was taken off; markers only.
CREATE TABLE head_poses (
  sentence_id INTEGER PRIMARY KEY REFERENCES sentences (id),
  poses BLOB NOT NULL  -- float64[frame_count][7]: translation x y z in mm, rotation w x y z
) STRICT;

-- PCA coefficients, apart from the channels, so that a search reads no more than it needs.
CREATE TABLE coefficients (
  sentence_id INTEGER PRIMARY KEY REFERENCES sentences (id),
  frames BLOB NOT NULL  -- float32[frame_count][dimensions]
) STRICT;

-- The PCA of all frames without gaps: one row. channels = mean + basis * coefficients.
CREATE TABLE pca (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  dimensions INTEGER NOT NULL CHECK (dimensions > 0),
  mean BLOB NOT NULL,      -- float64[channels]
  basis BLOB NOT NULL,     -- float64[dimensions][channels], orthonormal rows
  variance BLOB NOT NULL,  -- float64[dimensions], largest first
  total_variance REAL NOT NULL
) STRICT;
