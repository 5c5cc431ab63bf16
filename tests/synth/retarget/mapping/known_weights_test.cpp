// SPDX-License-Identifier: GPL-3.0-or-later
// Motion made with known weights on a real head, sampled at the markers, and taken apart again.
#include "synth/retarget/mapping/equation_solving.h"
#include "synth/retarget/mapping/shape_fit.h"
#include "tests/support/shared_data.h"
#include "tests/synth/retarget/mapping/known_keyshapes.h"
#include "tests/synth/retarget/mapping/known_weights.h"

#include <map>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

constexpr double kNoise_mm = 0.3;
constexpr double kGaps = 0.05;
// The default but for its smoothness in time, which takes long where every frame has other gaps.
constexpr ShapeFitOptions kFramesAlone = {.solve = {.ridge = 2e-4, .sparsity = 1e-4}};

struct Error {
  double weight = 0.0; // root mean square
  double vertex_mm = 0.0;
};

// Markers as they are, with noise, and with noise and gaps.
struct Recording {
  FrameMatrixD train; // with noise; its weights are known
  FrameMatrixD clean, noisy, gaps;
};

class KnownWeights : public ::testing::Test {
protected:
  void perform(const std::filesystem::path& data) {
    base = read_ict_face(data);
    own = shapes_at_markers(base.face, base.vertices, base.shapes.rest);
    const FrameMatrixD take = read_take(data / "livelink/sentien/recording.csv", base);
    std::vector<Eigen::Index> train_rows;
    std::vector<Eigen::Index> test_rows;
    for (Eigen::Index k = 0; k < take.rows(); ++k) { // two seconds each in turn
      (k / 60 % 2 == 0 ? train_rows : test_rows).push_back(k);
    }
    train = take(train_rows, Eigen::all);
    truth = take(test_rows, Eigen::all);
  }

  static Recording record(const FrameMatrixD& train_markers, const FrameMatrixD& markers) {
    Recording recording{.train = with_noise(train_markers, kNoise_mm, 1),
                        .clean = markers,
                        .noisy = with_noise(markers, kNoise_mm, 2),
                        .gaps = {}};
    recording.gaps = with_gaps(recording.noisy, kGaps, 3);
    return recording;
  }

  Error error(const FrameMatrixD& found) const {
    const FrameMatrixD difference = found - truth;
    return {.weight = std::sqrt(difference.array().square().mean()),
            .vertex_mm = base.vertex_rms(difference)};
  }

  // Errors of a method on the three, written down as "method clean" ...
  template <typename Method>
  void judge(const std::string& name, const Method& method, const Recording& recording) {
    const std::pair<const char*, const FrameMatrixD*> parts[] = {
        {"clean", &recording.clean}, {"noisy", &recording.noisy}, {"gaps", &recording.gaps}};
    for (const auto& part : parts) {
      const Error found = error(method.weights(*part.second));
      errors[name + " " + part.first] = found;
      fmt::print("{:28} weight {:.3f}  vertex {:.2f} mm\n", name + " " + part.first, found.weight,
                 found.vertex_mm);
    }
  }

  IctFace base;       // on a speaker who looks like the canonical face
  MarkerShapes own;   // on a speaker who looks like itself
  FrameMatrixD train; // weights
  FrameMatrixD truth;
  std::map<std::string, Error> errors;
};

} // namespace

TEST_F(KnownWeights, ComeBackFromTheMarkersOfTheSameFace) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  perform(data);
  const Recording recording = record(performed(own, train), performed(own, truth));
  judge("fit", ShapeFit(own, base.layout, kFramesAlone), recording);
  judge("equations", EquationSolver(own), recording);
  judge("cross 4", cross_mapping_of(own, recording.train, train, 100, {}), recording);
  judge("cross 12", cross_mapping_of(own, recording.train, train, 100, {.dimensions = 12}),
        recording);
  judge("keyshapes 20", KnownKeyshapes(base, own, recording.train, train, {"face"}, 20), recording);
  judge("keyshapes 20 + 20",
        KnownKeyshapes(base, own, recording.train, train, {"lower", "upper"}, 20), recording);
  EXPECT_NEAR(base.vertex_rms(truth), 4.2, 0.2) << "what errors are to be held against";
  EXPECT_LT(errors["fit clean"].vertex_mm, 0.16);
  EXPECT_LT(errors["fit noisy"].vertex_mm, 0.23);
  EXPECT_LT(errors["fit noisy"].weight, 0.09);
  EXPECT_LT(errors["fit gaps"].vertex_mm, 0.27);
  EXPECT_LT(errors["equations clean"].vertex_mm, 1e-6) << "the equations hold exactly here";
  EXPECT_GT(errors["equations noisy"].vertex_mm, errors["fit noisy"].vertex_mm);
  EXPECT_LT(errors["cross 12 noisy"].weight, 0.07);
  EXPECT_LT(errors["cross 12 gaps"].vertex_mm, 1.0);
  for (const char* part : {"clean", "noisy", "gaps"}) {
    const std::string name = part;
    EXPECT_LT(errors["keyshapes 20 " + name].vertex_mm, 0.55);
    EXPECT_LT(errors["keyshapes 20 + 20 " + name].vertex_mm, 0.41);
    EXPECT_LT(errors["keyshapes 20 + 20 " + name].weight, 0.08);
  }
}

TEST_F(KnownWeights, ComeBackFromASpeakerOfOtherProportions) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  perform(data);
  const auto markers = static_cast<Eigen::Index>(base.vertices.size());
  const Warp warp(Eigen::Map<const Points>(own.rest.data(), markers, 3),
                  Eigen::Map<const Points>(base.shapes.reference.data(), markers, 3));
  const Recording recording =
      record(warp.apply(performed(own, train)), warp.apply(performed(own, truth)));
  judge("fit", ShapeFit(base.shapes, base.layout, kFramesAlone), recording);
  judge("equations", EquationSolver(base.shapes), recording);
  judge("cross 4", cross_mapping_of(own, recording.train, train, 100, {}), recording);
  judge("cross 12", cross_mapping_of(own, recording.train, train, 100, {.dimensions = 12}),
        recording);
  MarkerShapes warped = own; // the speaker at rest
  warped.rest = warp.apply(own.rest.transpose()).row(0).transpose();
  judge("keyshapes 20", KnownKeyshapes(base, warped, recording.train, train, {"face"}, 20),
        recording);
  judge("keyshapes 20 + 20",
        KnownKeyshapes(base, warped, recording.train, train, {"lower", "upper"}, 20), recording);
  for (const char* part : {"clean", "noisy", "gaps"}) {
    const std::string name = part;
    EXPECT_LT(errors["cross 4 " + name].vertex_mm, 0.6 * errors["equations " + name].vertex_mm);
    EXPECT_LT(errors["cross 4 " + name].weight, 0.5 * errors["equations " + name].weight);
    EXPECT_LT(errors["cross 12 " + name].vertex_mm, errors["fit " + name].vertex_mm);
    EXPECT_LT(errors["keyshapes 20 + 20 " + name].vertex_mm, 0.6 * errors["fit " + name].vertex_mm);
  }
}

} // namespace phonomime::test
