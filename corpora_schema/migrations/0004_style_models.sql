-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 4: style models.

-- The bilinear models of a speaker's emotions. They belong to the recordings that `made_of` tells:
-- where those have become others, the models are stale.
CREATE TABLE style_models (
  speaker_id INTEGER PRIMARY KEY REFERENCES speakers (id),
  made_of TEXT NOT NULL,      -- fingerprint of the speaker's sentences, the layout and the PCA
  trained_json TEXT NOT NULL  -- options, styles, what was trained on, what came of it
) STRICT;

-- Their numbers.
CREATE TABLE style_matrices (
  speaker_id INTEGER NOT NULL REFERENCES style_models (speaker_id),
  name TEXT NOT NULL,  -- "known_bases" ...
  row_count INTEGER NOT NULL CHECK (row_count > 0),
  column_count INTEGER NOT NULL CHECK (column_count > 0),
  numbers BLOB NOT NULL,  -- float64[column_count][row_count]
  PRIMARY KEY (speaker_id, name)
) STRICT, WITHOUT ROWID;
