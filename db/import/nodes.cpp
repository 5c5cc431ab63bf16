// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/nodes.h"

#include "db/types/errors.h"
#include "db/types/row_frames.h"
#include "db/types/text.h"

#include <string>

#include <fmt/format.h>

namespace phonomime {

std::vector<ImportedNode> cut_into_nodes(const std::vector<TimedPhoneme>& rows, double rate_hz,
                                         std::string_view where) {
  const std::vector<FrameRange> ranges = row_frames(rows, rate_hz);
  std::vector<ImportedNode> nodes;
  bool all_have_frames = true;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].is_silence()) {
      continue;
    }
    ImportedNode node;
    node.row = static_cast<std::int32_t>(i);
    node.first_frame = static_cast<std::int32_t>(ranges[i].first);
    node.frame_count = static_cast<std::int32_t>(ranges[i].count);
    all_have_frames = all_have_frames && node.frame_count > 0;
    nodes.push_back(node);
  }
  if (!all_have_frames) {
    throw InputError({.where = std::string(where),
                      .what = "alignment has more phonemes than there are frames",
                      .expected = "at least one frame a phoneme",
                      .got = fmt::format("{} phonemes in {} frames at {} Hz", nodes.size(),
                                         ranges.back().end(), format_number(rate_hz)),
                      .remedy = "Check the alignment's times, or import at a higher rate."});
  }
  return nodes;
}

} // namespace phonomime
