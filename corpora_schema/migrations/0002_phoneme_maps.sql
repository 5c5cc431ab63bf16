-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 2: phoneme-Isomaps.

-- Both maps of all frames of one phoneme of one speaker. The frames are those of the phoneme's nodes
-- that are neither pruned nor with gaps, node after node in the order of their keys. Maps belong to
-- the frames and options that `made_of` tells: where those have become others, they are stale.
CREATE TABLE phoneme_maps (
  id INTEGER PRIMARY KEY,
  speaker_id INTEGER NOT NULL REFERENCES speakers (id),
  phoneme_id INTEGER NOT NULL REFERENCES phonemes (id),
  made_of TEXT NOT NULL,  -- fingerprint of the frames, their nodes and the options

  -- The options.
  neighbours INTEGER NOT NULL CHECK (neighbours > 0),        -- k, each frame is joined to so many
  keep_largest INTEGER NOT NULL CHECK (keep_largest IN (0, 1)),  -- 1: of parts only the largest
  largest_exact INTEGER NOT NULL CHECK (largest_exact > 0),  -- frames; more of them use landmarks
  landmark_count INTEGER NOT NULL CHECK (landmark_count > 0),
  seed INTEGER NOT NULL,                                     -- of the choice of landmarks

  -- What was found.
  nodes INTEGER NOT NULL CHECK (nodes > 0),
  frames INTEGER NOT NULL CHECK (frames > 0),                -- of the nodes, on the maps or not
  components INTEGER NOT NULL CHECK (components > 0),        -- of the neighbour graph
  landmarks INTEGER NOT NULL CHECK (landmarks >= 0),         -- 0: every frame is one
  far_frames INTEGER NOT NULL CHECK (far_frames >= 0),       -- much farther from all than is usual
  isomap_residual_variance REAL NOT NULL,                    -- 0 to 1, what the map leaves unexplained
  pca_residual_variance REAL NOT NULL,

  placed INTEGER NOT NULL CHECK (placed > 0 AND placed <= frames),  -- frames on the maps
  kept BLOB NOT NULL,    -- int32[placed]: which of the frames, ascending
  isomap BLOB NOT NULL,  -- float64[placed][2]: x, y in the unit of the PCA coefficients
  pca BLOB NOT NULL,     -- float64[placed][2]
  UNIQUE (speaker_id, phoneme_id)
) STRICT;
CREATE INDEX phoneme_maps_by_phoneme ON phoneme_maps (phoneme_id);
