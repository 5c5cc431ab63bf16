// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "db/types/motion.h"
#include "db/types/phoneme_set.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// Into MotionTable::nodes. Nodes are in order of their keys.
using NodeIndex = std::int32_t;
inline constexpr NodeIndex kNoNode = -1;

// A motion node: the frames of one phoneme in one sentence.
struct MotionNode {
  std::int32_t phoneme = 0;          // into MotionTable::phonemes
  std::int32_t viseme = 0;           // into MotionTable::visemes
  std::int32_t emotion = 0;          // into MotionTable::emotions
  std::int32_t sentence = 0;         // into MotionTable::sentences
  std::int32_t order = 0;            // row of the sentence's alignment, counted from 0
  std::int32_t previous_phoneme = 0; // triphone context, into phonemes; /pau/ at the edges
  std::int32_t next_phoneme = 0;
  NodeIndex predecessor = kNoNode; // pre(o): captured neighbours that are themselves in the table
  NodeIndex successor = kNoNode;
  std::int64_t first_frame = 0; // into the rows of MotionTable::coefficients
  std::int32_t frame_count = 0; // at least 1
};

struct SentenceInfo {
  std::string speaker;
  std::string emotion;
  std::string id;
  std::string text;
};

// A node that a key names but no search may use.
struct UnavailableNode {
  std::string key;
  std::string reason; // "pruned by ann on 2026-01-02: jump", "has unfilled gaps"
};

// All that a search and a map need of one speaker's database, immutable and free of SQLite.
struct MotionTable {
  Layout layout;
  PcaModel pca;
  double rate_hz = 0.0;
  std::vector<Phoneme> phonemes;    // [0] is /pau/
  std::vector<std::string> visemes; // [0] is that of /pau/
  std::vector<std::string> emotions;
  std::string speaker;
  std::vector<SentenceInfo> sentences; // in order of (speaker, emotion, id)
  std::vector<MotionNode> nodes;       // in order of (sentence, order)
  FrameMatrix coefficients;            // #frames by #dimensions, frames of one sentence together
  Eigen::VectorXd reference_pose;      // #channels: the speaker's reference pose (DESIGN 2)
  std::vector<UnavailableNode> unavailable; // in order of key
  std::vector<std::string> phoneme_sets;    // names of the built-in or stored sets of its corpora
  bool synthetic = false;                   // some corpus in it says that it was made, not recorded

  NodeIndex node_count() const { return static_cast<NodeIndex>(nodes.size()); }

  // "speaker/emotion/sentence#order"
  std::string key(NodeIndex node) const;

  // The node of a key, or of a shorter form while that is unique: leading parts of the key may be
  // left out ("bbaf2n#5", "happiness/bbaf2n#5"). Throws InputError (unknown, ambiguous, pruned)
  // with the nearest candidates; `where` names the place in the message.
  NodeIndex find_node(std::string_view key, std::string_view where) const;

  std::optional<std::int32_t> find_phoneme(std::string_view name) const;
  std::optional<std::int32_t> find_viseme(std::string_view name) const;
  std::optional<std::int32_t> find_emotion(std::string_view name) const;

  // Rows of a node in `coefficients`: #frames by #dimensions.
  auto node_frames(NodeIndex node) const {
    return coefficients.middleRows(nodes[static_cast<std::size_t>(node)].first_frame,
                                   nodes[static_cast<std::size_t>(node)].frame_count);
  }
};

} // namespace phonomime
