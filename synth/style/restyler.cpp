// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/restyler.h"

#include "db/types/errors.h"
#include "db/types/portable_sine.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace phonomime {

Restyler::Restyler(const AsymmetricModel& model, const FrameVectors& vectors, double ridge)
    : vectors_(vectors) {
  if (model.vector_size != vectors.vector_size()) {
    throw InputError({.where = "style model",
                      .what = "the motion has another size than that which it was trained on",
                      .expected = std::to_string(model.vector_size),
                      .got = std::to_string(vectors.vector_size()),
                      .remedy = "Train it anew with this database."});
  }
  for (Eigen::Index s = 0; s < model.style_count(); ++s) {
    const ContentSolver solver(model.basis(s), model.mean_content);
    const Eigen::MatrixXd map = solver.map(ridge);
    const Translation whole =
        solver.to(Eigen::MatrixXd::Identity(model.content_size(), model.content_size()), map);
    contents_.push_back({whole.matrix, whole.shift});
    shown_.push_back(model.basis(s).middleRows(vectors.middle_row(), vectors.dimension_count()));
  }
}

FrameMatrixD Restyler::restyle(const Eigen::Ref<const FrameMatrixD>& coefficients,
                               const Eigen::Ref<const Eigen::MatrixXd>& shown,
                               const Eigen::Ref<const Eigen::MatrixXd>& wanted) const {
  const Eigen::Index count = coefficients.rows();
  if (!coefficients.allFinite() || !shown.allFinite() || !wanted.allFinite()) {
    throw InputError(
        {.where = "style model", .what = "the motion has a number that is not finite"});
  }
  if (coefficients.cols() != vectors_.dimension_count() || shown.rows() != style_count() ||
      wanted.rows() != style_count() || shown.cols() != count || wanted.cols() != count) {
    throw InternalError({.where = "style model", .what = "weights that do not fit the motion"});
  }
  FrameMatrixD restyled = coefficients;
  if (count == 0 || shown == wanted) {
    return restyled;
  }
  const Eigen::MatrixXd bundles = vectors_.bundles(coefficients);
  Eigen::MatrixXd contents = Eigen::MatrixXd::Zero(shown_.front().cols(), count);
  for (Eigen::Index s = 0; s < style_count(); ++s) {
    if (!shown.row(s).isZero(0.0)) {
      const ContentMap& map = contents_[static_cast<std::size_t>(s)];
      contents +=
          ((map.matrix * bundles).colwise() + map.shift) * shown.row(s).transpose().asDiagonal();
    }
  }
  for (Eigen::Index s = 0; s < style_count(); ++s) {
    const Eigen::VectorXd more = (wanted.row(s) - shown.row(s)).transpose();
    if (!more.isZero(0.0)) {
      restyled += (shown_[static_cast<std::size_t>(s)] * contents * more.asDiagonal()).transpose();
    }
  }
  return restyled;
}

Eigen::MatrixXd glide(const Eigen::Ref<const Eigen::MatrixXd>& weights, double rate_hz,
                      double duration_s) {
  const auto reach = static_cast<Eigen::Index>(std::floor(duration_s * rate_hz / 2.0));
  if (reach < 1 || weights.cols() == 0) {
    return weights;
  }
  Eigen::VectorXd kernel(2 * reach + 1);
  for (Eigen::Index k = 0; k <= 2 * reach; ++k) {
    const double sine = sin_pi(static_cast<double>(k + 1) / static_cast<double>(2 * reach + 2));
    kernel[k] = sine * sine;
  }
  kernel /= kernel.sum();
  // A change never moves a row that stays: differences to the frame itself are averaged.
  Eigen::MatrixXd smooth = weights;
  const Eigen::Index last = weights.cols() - 1;
  for (Eigen::Index t = 0; t <= last; ++t) {
    for (Eigen::Index k = -reach; k <= reach; ++k) {
      smooth.col(t) += kernel[k + reach] *
                       (weights.col(std::clamp<Eigen::Index>(t + k, 0, last)) - weights.col(t));
    }
  }
  return smooth;
}

} // namespace phonomime
