// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// A frame of the database as people name it: the key of its motion node and the time since the
// node's first frame in seconds, "speaker/emotion/sentence#order@0.04".
struct FrameName {
  std::string node;
  double time_s = 0.0;

  std::string text() const; // the time with 3 decimals
};

// The table in which a person gives a face weights for frames of motion (corpora_schema/pairs.md).
struct PairTable {
  struct Row {
    FrameName frame;
    std::string note; // for people: what the frame stands for
    long line = 0;    // of the table, 0 where it comes from none
  };
  std::vector<std::string> shapes; // that have a column, in the face's order
  std::vector<Row> rows;
  FrameMatrixD weights; // #rows by #shapes, 0 to 1
};

// `face_shapes`: the shapes that the face has; a column of another name is an error that names the
// nearest of them. Shapes without a column rest. `where` names the table in errors. Throws
// InputError: no column `frame`, a column twice or unknown, a frame twice or not of the form above,
// a weight that is no number from 0 to 1, no rows.
PairTable parse_pair_table(std::string_view text, std::string_view where,
                           std::span<const std::string> face_shapes);

// The text that parse_pair_table reads back, weights to 4 decimals.
std::string format_pair_table(const PairTable& table);

} // namespace phonomime
