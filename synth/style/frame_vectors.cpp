// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/frame_vectors.h"

#include "db/types/errors.h"

#include <algorithm>
#include <string>

namespace phonomime {

FrameVectors::FrameVectors(const PcaModel& pca, int bundle, StyleVectors holds)
    : origin_(Eigen::VectorXd::Zero(pca.dimension_count())), bundle_(bundle) {
  if (holds == StyleVectors::channels) {
    origin_ = pca.basis.transpose() * pca.mean;
  }
  constant_ = (pca.mean - pca.basis * origin_).norm();
  if (bundle < 1 || bundle % 2 == 0) {
    throw InputError({.where = "style model",
                      .what = "a bundle of frames has no middle",
                      .expected = "an odd number from 1 on",
                      .got = std::to_string(bundle)});
  }
}

void FrameVectors::write_frame(const Eigen::Ref<const Eigen::VectorXd>& coefficients,
                               Eigen::Ref<Eigen::VectorXd> vector) const {
  vector.head(dimension_count()) = origin_ + coefficients;
  vector[dimension_count()] = constant_;
}

Eigen::MatrixXd FrameVectors::bundles(const Eigen::Ref<const FrameMatrixD>& coefficients) const {
  const Eigen::Index count = coefficients.rows();
  Eigen::MatrixXd made(vector_size(), count);
  for (Eigen::Index t = 0; t < count; ++t) {
    for (Eigen::Index k = 0; k < bundle_; ++k) {
      const Eigen::Index frame = std::clamp<Eigen::Index>(t + k - bundle_ / 2, 0, count - 1);
      write_frame(coefficients.row(frame).transpose(),
                  made.col(t).segment(k * frame_size(), frame_size()));
    }
  }
  return made;
}

FrameMatrixD FrameVectors::coefficients(const Eigen::Ref<const Eigen::MatrixXd>& middles) const {
  return (middles.topRows(dimension_count()).colwise() - origin_).transpose();
}

} // namespace phonomime
