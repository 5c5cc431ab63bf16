// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/mixture.h"

#include "db/types/errors.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

Eigen::Index find_style(std::span<const std::string> styles, const std::string& name) {
  const auto found = std::find(styles.begin(), styles.end(), name);
  if (found == styles.end()) {
    throw InputError({.where = "style model",
                      .what = "it was not trained on the emotion " + name,
                      .expected = fmt::format("{}", fmt::join(styles, ", ")),
                      .got = name});
  }
  return found - styles.begin();
}

Eigen::VectorXd mixture_weights(std::span<const std::string> styles, const std::string& neutral,
                                std::span<const EmotionModifier> parts) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(styles.size()));
  const Eigen::Index rest = find_style(styles, neutral);
  weights[rest] = 1.0;
  for (const EmotionModifier& part : parts) {
    weights[find_style(styles, part.emotion)] += part.intensity;
    weights[rest] -= part.intensity;
  }
  return weights;
}

Eigen::MatrixXd mixture_basis(const AsymmetricModel& model,
                              const Eigen::Ref<const Eigen::VectorXd>& weights) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(model.vector_size, model.content_size());
  for (Eigen::Index s = 0; s < model.style_count(); ++s) {
    if (weights[s] != 0.0) {
      sum += weights[s] * model.basis(s);
    }
  }
  return sum;
}

} // namespace phonomime
