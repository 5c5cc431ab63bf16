// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/emotion_track.h"
#include "db/types/motion_table.h"
#include "synth/concat/silence.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

struct StyleModel;

// What a motion is to show, moment by moment.
struct StyleInput {
  const StyleModel* model = nullptr; // nullptr: emotions stay as they were recorded
  EmotionTrack track;
  EmotionMixture fallback{.heaviest = {.emotion = "neutral"}}; // where the track is silent
};

// At a time of the transcript.
EmotionMixture asked_at(const StyleInput& input, double time_s);

// Weights of a model's styles that a motion of `frames` frames is asked for: S by #frames.
Eigen::MatrixXd asked_weights(const StyleInput& input, double rate_hz, Eigen::Index frames);

// Frames of /pau/ are filled from their borders, and so are the styles that they show: in place,
// for every frame that is not `is_shown` by a node. Between two nodes the shown style changes
// evenly; at either end shown and wanted style go to neutral as the face goes to rest, so that the
// reference pose stays what it is.
void fill_silent_styles(const StyleModel& model, const std::vector<bool>& is_shown, double rate_hz,
                        const SilenceOptions& silence, Eigen::MatrixXd& shown,
                        Eigen::MatrixXd& wanted);

} // namespace phonomime
