// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/dominance_model.h"

#include "db/types/parallel_for.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

constexpr int kMostSteps = 40;
constexpr double kEnough = 1e-5;      // share of the error that a step has to take off
constexpr double kTargetRidge = 1.0;  // frames' worth of pull towards the mean pose
constexpr double kShapeRidge = 1e-4;  // of a parameter, in shares of the variance of all samples
constexpr double kLargestShape = 6.0; // of |log height| and |log rate|

// Segments that a sampled frame feels: every one of its sentence.
struct Pull {
  Eigen::Index viseme = 0;
  double time_s = 0.0; // of the frame, counted from the anchor
};

struct Samples {
  std::vector<Pull> pulls;
  std::vector<std::size_t> first_pull; // #samples + 1, into pulls
  std::vector<Eigen::Index> frames;    // #samples, rows of MotionTable::coefficients
  std::size_t count() const { return frames.size(); }
};

Samples take_samples(const MotionTable& table, const std::vector<TrainingSentence>& sentences,
                     const std::vector<bool>& known) {
  std::int64_t total = 0;
  for (const TrainingSentence& sentence : sentences) {
    total += sentence.speech.count;
  }
  const std::int64_t stride = (total + kDominanceFrames - 1) / kDominanceFrames;
  Samples samples{.pulls = {}, .first_pull = {0}, .frames = {}};
  std::int64_t skip = 0; // frames until the next sample
  for (const TrainingSentence& sentence : sentences) {
    for (; skip < sentence.speech.count; skip += stride) {
      const std::int64_t frame = sentence.speech.first + skip;
      for (const Anchor& anchor : sentence.anchors) {
        if (known[static_cast<std::size_t>(anchor.viseme)]) {
          samples.pulls.push_back(
              {anchor.viseme, (static_cast<double>(frame) - anchor.frame) / table.rate_hz});
        }
      }
      samples.first_pull.push_back(samples.pulls.size());
      samples.frames.push_back(frame);
    }
    skip -= sentence.speech.count;
  }
  return samples;
}

// Heights and rates of one control parameter: log height, log rate before, log rate after, each
// #visemes.
using Shape = Eigen::VectorXd;

// Share of each viseme in each sample, and the derivatives that shares have through their segments.
struct Shares {
  Eigen::MatrixXd share;    // #samples by #visemes
  Eigen::MatrixXd reach[2]; // share times rate |t|, before and after the anchor
};

Shares shares_of(const Samples& samples, const Shape& shape, Eigen::Index visemes) {
  const auto count = static_cast<Eigen::Index>(samples.count());
  const Shape rates = shape.tail(2 * visemes).array().exp();
  Shares shares;
  shares.share.setZero(count, visemes);
  shares.reach[0].setZero(count, visemes);
  shares.reach[1].setZero(count, visemes);
  std::vector<double> logs;
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t first = samples.first_pull[static_cast<std::size_t>(i)];
    const std::size_t end = samples.first_pull[static_cast<std::size_t>(i) + 1];
    logs.clear();
    for (std::size_t p = first; p < end; ++p) {
      const Pull& pull = samples.pulls[p];
      const Eigen::Index rate = (pull.time_s < 0.0 ? 0 : visemes) + pull.viseme;
      logs.push_back(shape(pull.viseme) - rates(rate) * std::abs(pull.time_s));
    }
    // Relative to the strongest, so that none underflows to a sum of 0.
    const double strongest = *std::ranges::max_element(logs);
    double sum = 0.0;
    for (double& value : logs) {
      value = std::exp(value - strongest);
      sum += value;
    }
    for (std::size_t p = first; p < end; ++p) {
      const Pull& pull = samples.pulls[p];
      const int side = pull.time_s < 0.0 ? 0 : 1;
      const double share = logs[p - first] / sum;
      shares.share(i, pull.viseme) += share;
      shares.reach[side](i, pull.viseme) +=
          share * rates(side * visemes + pull.viseme) * std::abs(pull.time_s);
    }
  }
  return shares;
}

// One control parameter's problem.
class ParameterFit {
public:
  // `values`: #samples; `start_targets`: #visemes.
  ParameterFit(const Samples& samples, Eigen::VectorXd values, Eigen::VectorXd start_targets)
      : samples_(samples), values_(std::move(values)), start_targets_(std::move(start_targets)) {
    const double mean = values_.mean();
    shape_ridge_ = kShapeRidge * (values_.array() - mean).square().sum();
    const Eigen::Index visemes = start_targets_.size();
    start_ = Shape::Zero(3 * visemes);
    start_.tail(2 * visemes).setConstant(std::log(kFirstDominanceRate_hz));
    shape_ = start_;
  }

  void run(const Progress& progress) {
    State now = look_at(shape_);
    double damping = 1e-2;
    for (int step = 0; step < kMostSteps && damping < 1e8; ++step) {
      if (progress.stop_requested()) {
        throw Interrupted();
      }
      const Shape candidate = shape_ + step_from(now, damping);
      State next = look_at(candidate.cwiseMax(-kLargestShape).cwiseMin(kLargestShape));
      if (!(next.error < now.error)) {
        damping *= 4.0;
        continue;
      }
      const bool enough = now.error - next.error < kEnough * now.error;
      now = std::move(next);
      shape_ = now.shape;
      damping = std::max(1e-6, damping / 3.0);
      if (enough) {
        break;
      }
    }
    targets_ = now.targets;
  }

  const Shape& shape() const { return shape_; }
  const Eigen::VectorXd& targets() const { return targets_; }

private:
  struct State {
    Shape shape;
    Shares shares;
    Eigen::VectorXd targets, fitted;    // #visemes, #samples
    Eigen::LLT<Eigen::MatrixXd> normal; // of the targets' problem
    double error = 0.0;
  };

  State look_at(const Shape& shape) const {
    const Eigen::Index visemes = start_targets_.size();
    State state;
    state.shape = shape;
    state.shares = shares_of(samples_, shape, visemes);
    const Eigen::MatrixXd& share = state.shares.share;
    Eigen::MatrixXd normal = share.transpose() * share;
    normal.diagonal().array() += kTargetRidge;
    state.normal.compute(normal);
    state.targets = state.normal.solve(share.transpose() * values_ + kTargetRidge * start_targets_);
    state.fitted = share * state.targets;
    state.error = (values_ - state.fitted).squaredNorm() +
                  kTargetRidge * (state.targets - start_targets_).squaredNorm() +
                  shape_ridge_ * (shape - start_).squaredNorm();
    return state;
  }

  // Levenberg-Marquardt with Kaufman's approximation of the projected Jacobian.
  Shape step_from(const State& state, double damping) const {
    const Eigen::Index visemes = start_targets_.size();
    const Eigen::MatrixXd lead =
        (-state.fitted).replicate(1, visemes).rowwise() + state.targets.transpose();
    Eigen::MatrixXd jacobian(values_.size(), 3 * visemes);
    jacobian.leftCols(visemes) = state.shares.share.cwiseProduct(lead);
    jacobian.middleCols(visemes, visemes) = -state.shares.reach[0].cwiseProduct(lead);
    jacobian.rightCols(visemes) = -state.shares.reach[1].cwiseProduct(lead);
    const Eigen::MatrixXd mixed = state.shares.share.transpose() * jacobian;
    Eigen::MatrixXd hessian =
        jacobian.transpose() * jacobian - mixed.transpose() * state.normal.solve(mixed);
    hessian.diagonal().array() += shape_ridge_;
    hessian.diagonal() *= 1.0 + damping;
    const Eigen::VectorXd downhill =
        jacobian.transpose() * (values_ - state.fitted) - shape_ridge_ * (state.shape - start_);
    return hessian.ldlt().solve(downhill);
  }

  const Samples& samples_;
  Eigen::VectorXd values_;
  Eigen::VectorXd start_targets_;
  Shape start_, shape_;
  Eigen::VectorXd targets_;
  double shape_ridge_ = 0.0;
};

} // namespace

FrameMatrixD DominanceModel::evaluate(const std::vector<Anchor>& anchors,
                                      Eigen::Index frame_count) const {
  const Eigen::Index visemes = target.rows();
  Samples samples{.pulls = {}, .first_pull = {0}, .frames = {}};
  for (Eigen::Index frame = 0; frame < frame_count; ++frame) {
    for (const Anchor& anchor : anchors) {
      if (known[static_cast<std::size_t>(anchor.viseme)]) {
        samples.pulls.push_back(
            {anchor.viseme, (static_cast<double>(frame) - anchor.frame) / rate_hz});
      }
    }
    samples.first_pull.push_back(samples.pulls.size());
    samples.frames.push_back(frame);
  }
  FrameMatrixD frames(frame_count, target.cols());
  if (samples.pulls.empty()) {
    return target.row(0).replicate(frame_count, 1); // nothing but rest
  }
  Shape shape(3 * visemes);
  for (Eigen::Index dimension = 0; dimension < target.cols(); ++dimension) {
    shape << log_height.col(dimension), log_rate[0].col(dimension), log_rate[1].col(dimension);
    frames.col(dimension) = shares_of(samples, shape, visemes).share * target.col(dimension);
  }
  return frames;
}

DominanceModel fit_dominance(const MotionTable& table,
                             const std::vector<TrainingSentence>& sentences, int threads,
                             const Progress& progress) {
  const VisemePoses poses = mean_viseme_poses(table, sentences);
  const Samples samples = take_samples(table, sentences, poses.recorded);
  const Eigen::Index visemes = poses.poses.rows();
  const Eigen::Index dimensions = poses.poses.cols();
  DominanceModel model;
  model.rate_hz = table.rate_hz;
  model.known = poses.recorded;
  for (FrameMatrixD* part :
       {&model.target, &model.log_height, &model.log_rate[0], &model.log_rate[1]}) {
    part->resize(visemes, dimensions);
  }
  parallel_for(dimensions, threads, [&](std::ptrdiff_t dimension) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(samples.count()));
    for (std::size_t i = 0; i < samples.count(); ++i) {
      values(static_cast<Eigen::Index>(i)) =
          static_cast<double>(table.coefficients(samples.frames[i], dimension));
    }
    ParameterFit fit(samples, std::move(values), poses.poses.col(dimension));
    fit.run(progress);
    model.target.col(dimension) = fit.targets();
    model.log_height.col(dimension) = fit.shape().head(visemes);
    model.log_rate[0].col(dimension) = fit.shape().segment(visemes, visemes);
    model.log_rate[1].col(dimension) = fit.shape().tail(visemes);
  });
  return model;
}

} // namespace phonomime
