// SPDX-License-Identifier: GPL-3.0-or-later
// A recorded sentence on three targets of other kinds than the source: a drawing, a jointed figure
// and another face's mesh, each with the poses that an artist would give it, made by rule here.
#include "db/types/lip_measures.h"
#include "synth/retarget/keyshapes/joint_figure.h"
#include "synth/retarget/keyshapes/region_basis.h"
#include "synth/retarget/keyshapes/select_keyshapes.h"
#include "synth/retarget/keyshapes/svg_drawing.h"
#include "synth/retarget/marker_face.h"
#include "tests/support/shared_data.h"
#include "tests/synth/retarget/glb_bytes.h"
#include "tests/synth/retarget/real_motion.h"

#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr double kRate_hz = 25.0;

// Keyshapes of some sentences, and the weights of another one.
class SpokenTargets : public ::testing::Test {
protected:
  void load(const std::filesystem::path& data) {
    data_ = data;
    motion_ = test::read_real_motion(data, 100);
    frames_ = read_motion(data / "grid_s1/motion/bbaf2n.c3d").frame_count(); // the first of them
    const Eigen::Index rest = motion_.channels.rows() - frames_;
    const FrameMatrixD others =
        (motion_.channels.bottomRows(rest).rowwise() - motion_.pca.mean.transpose()) *
        motion_.pca.basis;
    const FrameMatrixD points =
        part_coefficients(motion_.pca, others, part_channels(motion_.layout, "lower"));
    const KeyshapeSelection selection = select_keyshapes(points, {.count = 12});
    source_.resize(std::ssize(selection.chosen), motion_.channels.cols());
    RigSet set{"neutral", "lower", {}};
    for (const Keyshape& keyshape : selection.chosen) {
      RigKeyshape one;
      one.source = static_cast<int>(set.keyshapes.size());
      one.name = "k" + std::to_string(one.source);
      source_.row(one.source) = motion_.channels.row(frames_ + keyshape.frame);
      set.keyshapes.push_back(one);
    }
    rig_.source = "keyshapes.csv";
    rig_.sets = {set};
  }

  FrameMatrixD weights() const {
    const Eigen::RowVectorXd reference = motion_.reference.transpose();
    return rig_weights(rig_, motion_.layout, source_.rowwise() - reference,
                       motion_.channels.topRows(frames_).rowwise() - reference,
                       FrameMatrixD::Ones(frames_, 1),
                       {.upper = std::numeric_limits<double>::infinity()});
  }
  double measure(const Eigen::VectorXd& frame, bool width) const {
    const LipMeasures measures(motion_.layout);
    const std::span<const double> values(frame.data(), static_cast<std::size_t>(frame.size()));
    return width ? *measures.width_mm(values) : *measures.aperture_mm(values);
  }
  double aperture(const Eigen::VectorXd& frame) const { return measure(frame, false); }

  // Pearson's, of an opening and the source's aperture over the sentence.
  double correlation(Eigen::VectorXd opening) const {
    Eigen::VectorXd apertures(frames_);
    for (Eigen::Index t = 0; t < frames_; ++t) {
      apertures[t] = aperture(motion_.channels.row(t).transpose());
    }
    apertures.array() -= apertures.mean();
    opening.array() -= opening.mean();
    return apertures.dot(opening) / (apertures.norm() * opening.norm());
  }

  std::filesystem::path data_;
  test::RealMotion motion_;
  Eigen::Index frames_ = 0;
  FrameMatrixD source_; // #keyshapes by #channels, mm
  Rig rig_;
};

TEST_F(SpokenTargets, ADrawingOpensItsMouth) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  load(data);
  const auto drawn = [&](const Eigen::VectorXd& frame) {
    const double tall = std::max(0.0, aperture(frame));
    const double wide = measure(frame, true);
    return "<svg viewBox=\"0 0 100 100\"><circle cx=\"50\" cy=\"50\" r=\"45\" fill=\"gold\"/>"
           "<path d=\"M" +
           std::to_string(50 - wide / 2) + ",70 Q50 " + std::to_string(70 - tall) + " " +
           std::to_string(50 + wide / 2) + " 70 Q 50 " + std::to_string(70 + tall) + ' ' +
           std::to_string(50 - wide / 2) + ",70Z\"/></svg>";
  };
  const SvgDrawing rest(drawn(motion_.reference), "rest.svg");
  RigTargets targets{rest.number_names(), Eigen::MatrixXd(source_.rows(), rest.numbers().size())};
  for (Eigen::Index i = 0; i < source_.rows(); ++i) {
    const SvgDrawing key(drawn(source_.row(i).transpose()), "key.svg");
    rest.check_equal_structure(key);
    targets.values.row(i) = key.numbers() - rest.numbers();
  }
  const FrameMatrixD moved = targets.motion(weights()).rowwise() + rest.numbers();
  Eigen::VectorXd opening(frames_);
  for (Eigen::Index t = 0; t < frames_; ++t) {
    // What the frame's own file says: the lower curve's control point below the upper's.
    const Eigen::RowVectorXd numbers = SvgDrawing(rest.with(moved.row(t)), "frame").numbers();
    opening[t] = numbers[10] - numbers[6];
  }
  EXPECT_GE(correlation(opening), 0.9);
}

TEST_F(SpokenTargets, AJointedFigureTurnsItsJaw) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  load(data);
  const auto jaw = [&](const Eigen::VectorXd& frame) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(0.03 * aperture(frame), Eigen::Vector3d::UnitX()));
  };
  const JointFigure figure(
      test::glb_container(R"({"asset":{"version":"2.0"},"nodes":[{"name":"skull","children":[1]},)"
                          R"({"name":"jaw"}]})",
                          ""),
      "figure.glb");
  for (RigKeyshape& keyshape : rig_.sets[0].keyshapes) {
    keyshape.rotations.emplace("jaw", jaw(source_.row(keyshape.source).transpose()));
  }
  const RigTargets targets = figure.targets(rig_);
  const std::string csv = figure.rotations_csv(targets, targets.motion(weights()), kRate_hz);
  Eigen::VectorXd opening(frames_);
  std::size_t at = csv.find('\n') + 1;
  for (Eigen::Index t = 0; t < frames_; ++t) {
    const std::size_t comma = csv.find(',', at);
    opening[t] = std::stod(csv.substr(comma + 1)); // sine of half the angle about x
    at = csv.find('\n', at) + 1;
  }
  EXPECT_EQ(at, csv.size());
  EXPECT_GE(correlation(opening), 0.9);
}

TEST_F(SpokenTargets, AnotherMeshOpensItsMouth) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  load(data);
  const MarkerFace face(read_face(data / "faces/canonical", motion_.layout), motion_.layout,
                        motion_.reference);
  const int upper = face.landmarks().at("lip_upper_inner");
  const int lower = face.landmarks().at("lip_lower_inner");
  // An artist's exaggeration on top: the chin falls half as far again.
  const FrameMatrixD found = weights();
  const double rest = face.mesh().positions(upper, 1) - face.mesh().positions(lower, 1);
  Eigen::VectorXd opening = Eigen::VectorXd::Constant(frames_, rest);
  for (Eigen::Index i = 0; i < source_.rows(); ++i) {
    const Points pose = face.deform(source_.row(i).transpose());
    const double more = 1.5 * (pose(upper, 1) - pose(lower, 1) - rest);
    opening += more * found.col(i);
  }
  EXPECT_GE(correlation(opening), 0.9);
}

} // namespace
} // namespace phonomime
