// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/region_basis.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <string>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace phonomime {
namespace {

// Of the largest variance: less than this is rounding.
constexpr double kLeastShare = 1e-12;

bool in_part(const ChannelGroup& group, std::string_view part) {
  const bool lower = group.in(Region::lips) || group.in(Region::jaw) || group.in(Region::cheeks) ||
                     group.in(Region::nose);
  if (part == "face") {
    return true;
  }
  if (part == "lower") {
    return lower;
  }
  if (part == "upper") {
    return !lower &&
           (group.in(Region::brows) || group.in(Region::eyelids) || group.in(Region::forehead));
  }
  return std::ranges::any_of(group.regions, [&](Region region) {
    return kRegionNames[static_cast<std::size_t>(region)] == part;
  });
}

} // namespace

std::vector<int> part_channels(const Layout& layout, std::string_view part) {
  std::vector<int> channels;
  for (int group = 0; group < layout.group_count(); ++group) {
    if (in_part(layout.groups[static_cast<std::size_t>(group)], part)) {
      for (int axis = 0; axis < layout.channels_per_group(); ++axis) {
        channels.push_back(group * layout.channels_per_group() + axis);
      }
    }
  }
  if (channels.empty()) {
    std::vector<std::string> names = {"face", "upper", "lower"};
    names.insert(names.end(), kRegionNames.begin(), kRegionNames.end());
    throw InputError({.what = "the layout has no groups in the part " + quoted(part),
                      .expected = "face, upper, lower or a region of the layout",
                      .remedy = did_you_mean(part, names)});
  }
  return channels;
}

FrameMatrixD part_coefficients(const PcaModel& pca, const FrameMatrixD& frames,
                               const std::vector<int>& channels) {
  if (frames.rows() == 0) {
    return FrameMatrixD(0, 0);
  }
  const Eigen::RowVectorXd mean = frames.colwise().mean();
  const FrameMatrixD centred = frames.rowwise() - mean;
  const Eigen::MatrixXd covariance =
      centred.transpose() * centred / static_cast<double>(frames.rows());
  const Eigen::MatrixXd basis = pca.basis(channels, Eigen::all);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(basis * covariance *
                                                             basis.transpose());
  const Eigen::VectorXd& variances = eigen.eigenvalues(); // ascending
  Eigen::Index count = 0;
  const Eigen::Index most = std::min<Eigen::Index>(variances.size(), pca.dimension_count());
  const double largest = variances.size() == 0 ? 0.0 : variances[variances.size() - 1];
  while (count < most && variances[variances.size() - 1 - count] > kLeastShare * largest) {
    ++count;
  }
  Eigen::MatrixXd axes = eigen.eigenvectors().rightCols(count).rowwise().reverse();
  for (Eigen::Index d = 0; d < count; ++d) {
    Eigen::Index place = 0;
    axes.col(d).cwiseAbs().maxCoeff(&place);
    if (axes(place, d) < 0.0) {
      axes.col(d) *= -1.0;
    }
  }
  return centred * (basis.transpose() * axes);
}

FrameMatrixD part_offsets(const PcaModel& pca, const FrameMatrixD& frames,
                          const std::vector<int>& channels, const Eigen::VectorXd& reference) {
  const Eigen::VectorXd rest = (pca.mean - reference)(channels);
  return (frames * pca.basis(channels, Eigen::all).transpose()).rowwise() + rest.transpose();
}

FrameMatrixD part_offset_coordinates(const PcaModel& pca, const FrameMatrixD& frames,
                                     const std::vector<int>& channels,
                                     const Eigen::VectorXd& reference) {
  // Each offset is a sum of the part's PCA axes and of the mean's own offset: [B d] = Q R.
  const Eigen::Index dimensions = frames.cols();
  Eigen::MatrixXd columns(std::ssize(channels), dimensions + 1);
  columns.leftCols(dimensions) = pca.basis(channels, Eigen::all);
  columns.rightCols(1) = (pca.mean - reference)(channels);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::Index count = std::min(columns.rows(), columns.cols());
  const Eigen::MatrixXd r =
      qr.matrixQR().topRows(count).template triangularView<Eigen::Upper>().toDenseMatrix();
  return (frames * r.leftCols(dimensions).transpose()).rowwise() +
         r.rightCols(1).transpose().row(0);
}

} // namespace phonomime
