// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/emotion_track.h"
#include "synth/style/bilinear_model.h"

#include <span>
#include <string>

namespace phonomime {

// Weights of a model's styles that sum to 1 (T2.15 for any number of styles): each part's emotion
// by its intensity, the neutral style by what is left of 1. Intensity 1 of one emotion is that
// emotion, 0 is neutral, 1.5 goes half as far again (the neutral weight is then negative).
// Throws InputError for an emotion that the model was not trained on, with those that it was.
Eigen::VectorXd mixture_weights(std::span<const std::string> styles, const std::string& neutral,
                                std::span<const EmotionModifier> parts);

// The basis of a mixture: the weighted sum of the styles' bases, K by J. A weighted sum of style
// vectors selects the same of a symmetric model, for y is linear in e.
Eigen::MatrixXd mixture_basis(const AsymmetricModel& model,
                              const Eigen::Ref<const Eigen::VectorXd>& weights);

// Index of a style by its name. Throws InputError with the model's styles.
Eigen::Index find_style(std::span<const std::string> styles, const std::string& name);

} // namespace phonomime
