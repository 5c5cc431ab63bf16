// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/concat/concatenate.h"
#include "tools/evaluate/measures.h"
#include "tools/evaluate/method.h"

#include <span>
#include <vector>

namespace phonomime {

// Motion in PCA coefficients (#frames by #dimensions) as channels by E11: `frame_count` by
// #channels. A frame at the very end of a transcript, which recordings do not have, is dropped; one
// frame too few is the last one held. Throws InternalError where more than one frame is missing or
// over.
FrameMatrix to_channels(const PcaModel& pca, const Eigen::Ref<const FrameMatrixD>& coefficients,
                        Eigen::Index frame_count);

// Where the nodes of a transcript's rows follow on one another: at every row that is not silence,
// nor follows on silence. `nodes`: one for each row, kNoNode where there is none.
std::vector<JoinPlace> join_places(const MotionTable& table, std::span<const TimedPhoneme> rows,
                                   std::span<const NodeIndex> nodes);

// Nodes that were chosen, one for each row (kNoNode for silence), joined as every synthesis is.
SynthesisedSentence say_nodes(const MotionTable& table, const SentenceRequest& request,
                              std::span<const NodeIndex> nodes, const ConcatOptions& options);

} // namespace phonomime
