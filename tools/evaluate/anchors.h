// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/frame_times.h"
#include "db/types/motion_table.h"
#include "tools/evaluate/method.h"

#include <cstdint>
#include <vector>

namespace phonomime {

// How far a pose of rest keeps from the speech beside it: within this the face gets there.
inline constexpr double kRestReach_s = 0.2;

// A moment at which a viseme is at its strongest: the middle of a phoneme. Silence has one in its
// middle or, where that is farther than kRestReach_s from the speech beside it, one that far from
// each.
struct Anchor {
  std::int32_t viseme = 0; // into MotionTable::visemes
  double frame = 0.0;
};

// A recorded sentence of the table as baselines learn from it.
struct TrainingSentence {
  std::vector<Anchor> anchors; // in order of time; frames are rows of MotionTable::coefficients
  FrameRange speech;           // from its first node to its last, inner silence included
};

// The sentences in an emotion (index into MotionTable::emotions), or in any where the table has no
// node in it. Sentences of which a node is not available are left out, unless there are no others.
std::vector<TrainingSentence> training_sentences(const MotionTable& table, std::int32_t emotion);

// The anchors of a transcript, in frames of its motion. A viseme that the table does not know has
// none.
std::vector<Anchor> request_anchors(const MotionTable& table, const SentenceRequest& request);

// Mean pose of each viseme in coefficients (#visemes by #dimensions), taken from the frames nearest
// to the sentences' anchors; silence is the reference pose.
struct VisemePoses {
  FrameMatrixD poses;
  std::vector<bool> recorded; // #visemes; false: no such node, the pose is the mean of the others
};
VisemePoses mean_viseme_poses(const MotionTable& table,
                              const std::vector<TrainingSentence>& sentences);

} // namespace phonomime
