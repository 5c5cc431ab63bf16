// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "tools/evaluate/showcase.h"

#include <utility>
#include <vector>

namespace phonomime {

// What a picture of the markers needs beside their motion.
struct ShownFace {
  Eigen::VectorXd pose;                   // #channels: mean of the recordings shown
  std::vector<std::pair<int, int>> edges; // lines between groups, each group with the two of its
                                          // region that are never far from it; smaller index
                                          // first, sorted; none between weights
  std::vector<int> traced;                // groups whose motion is plotted: those of the lips'
                                          // landmarks, then of each region the one that moves most
};

// `shown` is not empty.
ShownFace shown_face(const Layout& layout, const std::vector<ShownSentence>& shown);

// The region that a group is drawn as: its first, `rigid` where it has none.
Region drawn_region(const ChannelGroup& group);

} // namespace phonomime
