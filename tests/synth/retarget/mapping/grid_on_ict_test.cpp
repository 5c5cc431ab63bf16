// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded sentences on a head with shapes of its own, by direct fitting.
#include "db/import/resample.h"
#include "synth/retarget/mapping/shape_fit.h"
#include "tests/support/shared_data.h"
#include "tests/synth/retarget/mapping/known_weights.h"
#include "tests/synth/retarget/real_motion.h"

#include <complex>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace phonomime::test {
namespace {

constexpr double kRate_hz = 100.0;
constexpr double kClosed_mm = 1.5;

// Markers of grid_s1 on the upper and the lower inner lip that lie on each other when it is closed.
const std::vector<std::pair<const char*, const char*>> kLips = {
    {"lm191", "lm95"},  {"lm80", "lm88"},   {"lm81", "lm178"},  {"lm82", "lm87"},  {"lm13", "lm14"},
    {"lm312", "lm317"}, {"lm311", "lm402"}, {"lm310", "lm318"}, {"lm415", "lm324"}};

struct Spoken {
  FrameMatrixD recorded; // #frames by #channels at kRate_hz, head motion off
  FrameMatrixD face;     // the vertices under the markers
  FrameMatrixD weights;  // of the shapes
  Alignment alignment;
};

double opening(const Layout& layout, const Eigen::RowVectorXd& frame, std::size_t pair) {
  return frame(3 * *layout.find_group(kLips[pair].first) + 1) -
         frame(3 * *layout.find_group(kLips[pair].second) + 1);
}

// Energy above a frequency, of all columns about their lines from first to last frame.
double energy_above(const FrameMatrixD& frames, double frequency_hz) {
  const Eigen::Index n = frames.rows();
  const Eigen::VectorXd ramp = Eigen::VectorXd::LinSpaced(n, 0.0, 1.0);
  const FrameMatrixD flat =
      frames - (Eigen::VectorXd::Ones(n) - ramp) * frames.row(0) - ramp * frames.row(n - 1);
  double energy = 0.0;
  for (Eigen::Index bin = 0; 2 * bin <= n; ++bin) {
    if (static_cast<double>(bin) * kRate_hz / static_cast<double>(n) <= frequency_hz) {
      continue;
    }
    Eigen::RowVectorXcd sum = Eigen::RowVectorXcd::Zero(flat.cols());
    for (Eigen::Index k = 0; k < n; ++k) {
      const double angle =
          -2.0 * M_PI * static_cast<double>((bin * k) % n) / static_cast<double>(n);
      sum += flat.row(k) * std::complex<double>(std::cos(angle), std::sin(angle));
    }
    energy += sum.squaredNorm();
  }
  return energy;
}

class GridOnIct : public ::testing::Test {
protected:
  void speak(const std::filesystem::path& data) {
    const RealMotion motion = read_real_motion(data, 40);
    ict = read_ict_face(data, motion.reference);
    const ShapeFit fit(ict.shapes, ict.layout);
    const HeadAnchor anchor = head_anchor(ict.layout);
    std::set<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(data / "grid_s1/motion")) {
      files.insert(entry.path());
    }
    std::size_t index = 0;
    for (const std::filesystem::path& file : files) {
      if (index++ % 130 != 1) {
        continue;
      }
      const MotionClip clip = read_motion(file);
      if (!clip.frames.allFinite()) {
        continue;
      }
      const FrameMatrixD local =
          remove_head(clip.frames.cast<double>(), anchor, motion.reference, Scale::nominal).local;
      const auto count = static_cast<Eigen::Index>(static_cast<double>(local.rows() - 1) /
                                                   clip.rate_hz * kRate_hz);
      Spoken spoken;
      spoken.recorded = resample(local, {.rate_hz = clip.rate_hz, .start_s = 0.0}, kRate_hz, count);
      spoken.weights = fit.weights(spoken.recorded);
      spoken.face = performed(ict.shapes, spoken.weights);
      spoken.alignment =
          read_alignment(data / "grid_s1/alignment" / (file.stem().string() + ".lab"));
      sentences.push_back(std::move(spoken));
    }
    ASSERT_GE(sentences.size(), 4U);
  }

  void closures() const;
  void lips_apart() const;
  void trembling() const;
  void openings() const;

  IctFace ict;
  std::vector<Spoken> sentences;
};

// One test, because the sentences take their time.
TEST_F(GridOnIct, SpeaksAsTheSpeakerDoes) {
  PHONOMIME_NEEDS_SHARED_DATA(data);
  ASSERT_NO_FATAL_FAILURE(speak(data));
  {
    SCOPED_TRACE("lips close on /p b m/ where the speaker's do");
    closures();
  }
  {
    SCOPED_TRACE("lips do not pass through each other");
    lips_apart();
  }
  {
    SCOPED_TRACE("the face trembles no more than the recording");
    trembling();
  }
  {
    SCOPED_TRACE("the opening follows");
    openings();
  }
}

void GridOnIct::closures() const {
  constexpr std::size_t kMiddle = 4;
  int closed = 0;
  double widest = 0.0;
  for (const Spoken& spoken : sentences) {
    for (const AlignedLabel& label : spoken.alignment.rows) {
      if (label.label != "p" && label.label != "b" && label.label != "m") {
        continue;
      }
      double recorded = 1e9;
      double face = 1e9;
      for (auto k = static_cast<Eigen::Index>(label.start_s * kRate_hz);
           k < std::min<Eigen::Index>(spoken.face.rows(),
                                      static_cast<Eigen::Index>(label.end_s * kRate_hz));
           ++k) {
        recorded = std::min(recorded, opening(ict.layout, spoken.recorded.row(k), kMiddle));
        face = std::min(face, opening(ict.layout, spoken.face.row(k), kMiddle));
      }
      if (recorded < kClosed_mm) {
        ++closed;
        widest = std::max(widest, face);
        EXPECT_LT(face, kClosed_mm) << label.label << " at " << label.start_s;
      }
    }
  }
  EXPECT_GE(closed, 5);
  RecordProperty("closed", closed);
  RecordProperty("widest_mm", fmt::format("{:.3f}", widest));
}

void GridOnIct::lips_apart() const {
  double deepest = 0.0;
  for (const Spoken& spoken : sentences) {
    for (Eigen::Index k = 0; k < spoken.face.rows(); ++k) {
      for (std::size_t pair = 0; pair < kLips.size(); ++pair) {
        deepest = std::max(deepest, -opening(ict.layout, spoken.face.row(k), pair));
      }
    }
  }
  RecordProperty("deepest_mm", fmt::format("{:.3f}", deepest));
  EXPECT_LT(deepest, 1.0);
}

void GridOnIct::trembling() const {
  double recorded = 0.0;
  double face = 0.0;
  for (const Spoken& spoken : sentences) {
    recorded += energy_above(spoken.recorded, 12.0);
    face += energy_above(spoken.face, 12.0);
  }
  RecordProperty("share", fmt::format("{:.3f}", face / recorded));
  EXPECT_LE(face, recorded);
}

void GridOnIct::openings() const {
  double squares = 0.0;
  double frames = 0.0;
  for (const Spoken& spoken : sentences) {
    for (Eigen::Index k = 0; k < spoken.face.rows(); ++k) {
      const double recorded = std::max(opening(ict.layout, spoken.recorded.row(k), 4), 0.0);
      squares += std::pow(recorded - opening(ict.layout, spoken.face.row(k), 4), 2);
      frames += 1.0;
    }
  }
  RecordProperty("opening_rms_mm", fmt::format("{:.3f}", std::sqrt(squares / frames)));
  EXPECT_LT(std::sqrt(squares / frames), 0.5);
}

} // namespace
} // namespace phonomime::test
