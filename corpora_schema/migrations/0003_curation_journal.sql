-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 3: suspects with their figures, and the journal of what was pruned and restored.

-- Why a node may be bad; marked nodes are still used. In the place of suspect_marks.
CREATE TABLE suspects (
  sentence_id INTEGER NOT NULL,
  row INTEGER NOT NULL,
  reason TEXT NOT NULL,  -- "jump", "frozen" ...
  origin TEXT NOT NULL CHECK (origin IN ('recording', 'channels')),  -- what showed it
  score REAL NOT NULL CHECK (score >= 1),  -- times the limit
  first_frame INTEGER NOT NULL CHECK (first_frame >= 0),  -- of the sentence: where the fault is,
  frame_count INTEGER NOT NULL CHECK (frame_count >= 0),  -- which may reach beyond the node
  groups_json TEXT NOT NULL,  -- whose fault it is: names in an array, empty for the whole face
  text TEXT NOT NULL,         -- the reason with its figures, for people
  PRIMARY KEY (sentence_id, row, reason, origin),
  FOREIGN KEY (sentence_id, row) REFERENCES nodes (sentence_id, row)
) STRICT, WITHOUT ROWID;

-- Earlier marks were texts alone, "jump: lm14 at 1.24 s, 812 mm/s".
INSERT OR IGNORE INTO suspects
  SELECT m.sentence_id, m.row,
         CASE WHEN instr(m.reason, ':') > 0 THEN substr(m.reason, 1, instr(m.reason, ':') - 1)
              ELSE m.reason END,
         CASE WHEN m.reason LIKE 'gap:%' OR m.reason LIKE 'frozen:%' THEN 'recording'
              ELSE 'channels' END,
         1, n.first_frame, n.frame_count, '[]', m.reason
  FROM suspect_marks m JOIN nodes n ON n.sentence_id = m.sentence_id AND n.row = m.row;
DROP TABLE suspect_marks;

-- Every prune, restore and undo, in their order. Entries are never changed.
CREATE TABLE curation_journal (
  id INTEGER PRIMARY KEY,  -- from 1
  action TEXT NOT NULL CHECK (action IN ('prune', 'restore', 'undo')),
  done_by TEXT NOT NULL,
  done_at TEXT NOT NULL,   -- UTC, ISO 8601
  reason TEXT NOT NULL,
  undoes INTEGER UNIQUE REFERENCES curation_journal (id),  -- the entry that an undo takes back
  CHECK ((action = 'undo') = (undoes IS NOT NULL))
) STRICT;

-- The nodes that an entry took out of use or brought back. Where it brought one back, the pruning
-- that it ended, so that an undo can put it there again.
CREATE TABLE curation_changes (
  entry_id INTEGER NOT NULL REFERENCES curation_journal (id),
  sentence_id INTEGER NOT NULL,
  row INTEGER NOT NULL,
  pruned_by TEXT,
  pruned_at TEXT,
  pruned_reason TEXT,
  PRIMARY KEY (entry_id, sentence_id, row),
  FOREIGN KEY (sentence_id, row) REFERENCES nodes (sentence_id, row)
) STRICT, WITHOUT ROWID;
CREATE INDEX curation_changes_by_node ON curation_changes (sentence_id, row);
