// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/reconstruction_error.h"

#include "synth/retarget/weight_solver.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include <fmt/format.h>

namespace phonomime {
namespace {

constexpr Eigen::Index kMostClustered = 20'000; // frames, for the curves

std::vector<Eigen::Index> frames_of(const KeyshapeSelection& selection, std::size_t count) {
  std::vector<Eigen::Index> frames;
  for (std::size_t i = 0; i < std::min(count, selection.chosen.size()); ++i) {
    frames.push_back(selection.chosen[i].frame);
  }
  return frames;
}

// Each so-manieth row.
FrameMatrixD thinned(const FrameMatrixD& frames, int every) {
  const Eigen::Index step = std::max(every, 1);
  return frames(Eigen::seqN(0, (frames.rows() + step - 1) / step, step), Eigen::all);
}

// A mean over frames and channel groups.
double mean_of(double sum, const FrameMatrixD& measured, const KeyshapeMeasure& measure) {
  return sum / std::max(static_cast<double>(measured.rows()) * measure.groups, 1.0);
}

double error_of(const FrameMatrixD& measured, const KeyshapeMeasure& measure,
                const std::vector<Eigen::Index>& keyshapes) {
  const Eigen::MatrixXd shapes = measure.offsets(keyshapes, Eigen::all).transpose();
  const WeightSolver solver(shapes, {}, {.upper = std::numeric_limits<double>::infinity()});
  const FrameMatrixD left = solver.solve(measured) * shapes.transpose() - measured;
  return mean_of(left.squaredNorm(), measured, measure);
}

// Numbers of keyshapes to try, up to the largest: every one where these are few.
std::vector<int> counts_up_to(int largest, int steps) {
  std::vector<int> counts;
  const int each = std::max(1, (largest + steps - 1) / std::max(steps, 1));
  for (int count = each; count < largest; count += each) {
    counts.push_back(count);
  }
  counts.push_back(largest);
  return counts;
}

} // namespace

FrameMatrixD KeyshapeMeasure::measured() const {
  return thinned(offsets, every);
}

double reconstruction_error(const KeyshapeMeasure& measure,
                            const std::vector<Eigen::Index>& keyshapes) {
  return error_of(measure.measured(), measure, keyshapes);
}

double motion_square(const KeyshapeMeasure& measure) {
  const FrameMatrixD measured = measure.measured();
  return mean_of(measured.squaredNorm(), measured, measure);
}

std::vector<ErrorCurve> error_curves(const FrameMatrixD& points, const KeyshapeMeasure& measure,
                                     const KeyshapeOptions& options, int steps) {
  const FrameMatrixD measured = measure.measured();
  const auto error = [&](const std::vector<Eigen::Index>& frames) {
    return KeyshapeError{static_cast<int>(frames.size()), error_of(measured, measure, frames)};
  };
  KeyshapeOptions trial = options;
  std::vector<ErrorCurve> curves = {{"extrema", {}},
                                    {"clusters, 2 dimensions", {}},
                                    {"clusters, 3 dimensions", {}},
                                    {"hull", {}}};
  trial.method = KeyshapeMethod::extrema;
  const KeyshapeSelection extrema = select_keyshapes(points, trial);
  for (const int count : counts_up_to(static_cast<int>(extrema.chosen.size()), steps)) {
    curves[0].errors.push_back(error(frames_of(extrema, static_cast<std::size_t>(count))));
  }
  trial.method = KeyshapeMethod::clusters;
  const auto clustered_every = static_cast<int>(1 + (points.rows() - 1) / kMostClustered);
  const FrameMatrixD clustered = thinned(points, clustered_every);
  for (const int dimensions : {2, 3}) {
    trial.cluster_dimensions = dimensions;
    std::vector<KeyshapeError>& errors = curves[static_cast<std::size_t>(dimensions - 1)].errors;
    for (const int count : counts_up_to(options.count, steps)) {
      trial.count = count;
      const KeyshapeSelection found = select_keyshapes(clustered, trial);
      std::vector<Eigen::Index> frames = frames_of(found, found.chosen.size());
      for (Eigen::Index& frame : frames) {
        frame *= clustered_every;
      }
      errors.push_back(error(frames));
    }
  }
  trial.method = KeyshapeMethod::hull;
  const KeyshapeSelection hull = select_keyshapes(points, trial);
  curves[3].errors.push_back(error(frames_of(hull, hull.chosen.size())));
  return curves;
}

std::string error_table_tsv(const std::vector<ErrorCurve>& curves) {
  std::string text = "method\tcount\tmean_square\n";
  for (const ErrorCurve& curve : curves) {
    for (const KeyshapeError& error : curve.errors) {
      text += fmt::format("{}\t{}\t{:.6g}\n", curve.name, error.count, error.mean_square);
    }
  }
  return text;
}

std::string error_plot_svg(const std::vector<ErrorCurve>& curves, const std::string& unit) {
  constexpr std::array<std::string_view, 4> kColours = {"#1f4e9c", "#2a8a3a", "#b03a9a", "#c0281c"};
  constexpr double kLeft = 70.0, kTop = 30.0, kWidth = 600.0, kHeight = 340.0;
  int most = 1;
  double largest = 0.0;
  for (const ErrorCurve& curve : curves) {
    for (const KeyshapeError& error : curve.errors) {
      most = std::max(most, error.count);
      largest = std::max(largest, error.mean_square);
    }
  }
  largest = largest > 0.0 ? largest : 1.0;
  const auto x = [&](int count) { return kLeft + kWidth * count / most; };
  const auto y = [&](double error) { return kTop + kHeight * (1.0 - error / largest); };
  std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"700\" height=\"430\" "
                     "font-family=\"sans-serif\" font-size=\"12\">\n"
                     "<rect width=\"700\" height=\"430\" fill=\"#ffffff\"/>\n";
  text += fmt::format("<path d=\"M{0} {1}V{2}H{3}\" fill=\"none\" stroke=\"#444444\"/>\n", kLeft,
                      kTop, kTop + kHeight, kLeft + kWidth);
  for (int tick = 0; tick <= 4; ++tick) {
    const double error = largest * tick / 4.0;
    text += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:.3g}</text>\n",
                        kLeft - 6.0, y(error) + 4.0, error);
    const int count = most * tick / 4;
    text += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", x(count),
                        kTop + kHeight + 18.0, count);
  }
  text += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">keyshapes</text>\n",
                      kLeft + 0.5 * kWidth, kTop + kHeight + 40.0);
  text += fmt::format("<text x=\"{}\" y=\"18\">mean squared error, {}</text>\n", kLeft, unit);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string_view colour = kColours[i % kColours.size()];
    std::string line;
    for (const KeyshapeError& error : curves[i].errors) {
      line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x(error.count),
                          y(error.mean_square));
      text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n",
                          x(error.count), y(error.mean_square), colour);
    }
    text += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>\n", line,
                        colour);
    text += fmt::format("<text x=\"{}\" y=\"{}\" fill=\"{}\">{}</text>\n", kLeft + kWidth - 150.0,
                        kTop + 16.0 * static_cast<double>(i + 1), colour, curves[i].name);
  }
  return text + "</svg>\n";
}

} // namespace phonomime
