// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/check_sentence.h"

#include "db/types/errors.h"

#include <fmt/format.h>

namespace phonomime::store {
namespace {

void require(bool holds, const ImportedSentence& sentence, const char* what) {
  if (!holds) {
    throw InternalError(
        {.where = fmt::format("{}/{}/{}", sentence.speaker, sentence.emotion, sentence.id),
         .what = fmt::format("a sentence that cannot be stored: {}", what)});
  }
}

void check_nodes(const ImportedSentence& sentence) {
  std::int64_t next_row = 0, next_frame = 0;
  for (const ImportedNode& node : sentence.nodes) {
    require(node.row >= next_row && node.row < static_cast<std::int64_t>(sentence.rows.size()),
            sentence, "nodes are not in order of the alignment's rows");
    require(!sentence.rows[static_cast<std::size_t>(node.row)].is_silence(), sentence,
            "a node is silence");
    require(node.frame_count >= 1 && node.first_frame >= next_frame &&
                node.first_frame <= sentence.channels.rows() - node.frame_count,
            sentence, "nodes overlap or leave the frames");
    next_row = node.row + 1;
    next_frame = std::int64_t{node.first_frame} + node.frame_count;
  }
}

} // namespace

void check_sentence(const ImportedSentence& sentence, const Layout& layout) {
  const Eigen::Index frames = sentence.channels.rows();
  require(!sentence.speaker.empty() && !sentence.emotion.empty() && !sentence.id.empty(), sentence,
          "its key has an empty part");
  require(frames > 0 && sentence.channels.cols() == layout.channel_count(), sentence,
          "its frames do not have the layout's channels");
  require(sentence.channels.allFinite(), sentence, "a channel is not finite");
  require(static_cast<Eigen::Index>(sentence.frame_has_gap.size()) == frames, sentence,
          "frame_has_gap is not one a frame");
  require(static_cast<Eigen::Index>(sentence.head.size()) ==
              (layout.kind == LayoutKind::markers ? frames : 0),
          sentence, "head poses are not one a frame of markers");
  double previous_s = 0.0;
  for (const TimedPhoneme& row : sentence.rows) {
    require(row.start_s >= previous_s && row.end_s >= row.start_s, sentence,
            "its alignment runs backwards");
    previous_s = row.start_s;
  }
  check_nodes(sentence);
}

} // namespace phonomime::store
