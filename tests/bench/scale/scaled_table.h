// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/search/search_types.h"

namespace phonomime::bench {

// A table of exactly `nodes` motion nodes made from `source`, for measuring at sizes that no
// recording at hand has. Sentences come in a random order, again and again; from the second round
// on each copy is spoken at another pace (0.85 to 1.2 of its own) and moved by a slow random
// motion, `spread` standard deviations of each PCA coefficient in size. Same arguments, same table.
MotionTable scaled_table(const MotionTable& source, NodeIndex nodes, double spread);

// The spread at which the median cheapest join of the scaled table is that of the source within
// 20 %, by bisection; throws where there is none.
struct ScaledTable {
  MotionTable table;
  double spread = 0.0;
  double cheapest_join = 0.0; // of the table, as median_cheapest_join
  double source_cheapest_join = 0.0;
};
ScaledTable scaled_like(const MotionTable& source, NodeIndex nodes);

// The median, over a fixed sample of nodes that have a predecessor, of the cheapest ordinary join
// into them from any other node, by looking at all nodes.
double median_cheapest_join(const MotionTable& table, const CostWeights& weights);

} // namespace phonomime::bench
