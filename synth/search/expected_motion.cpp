// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/search/expected_motion.h"

namespace phonomime {

namespace {

// Durations by steps of 1.42 from 20 ms on.
std::int32_t duration_class(double duration_s) {
  std::int32_t steps = 0;
  for (double edge_s = 0.02; duration_s >= edge_s && steps < 40; edge_s *= 1.42) {
    ++steps;
  }
  return steps;
}

} // namespace

ExpectedMotion::Key ExpectedMotion::key_of(const PhonemeContext& context, std::size_t stage) {
  const Surroundings& around = context.surroundings;
  switch (stage) {
  case 0:
    return {};
  case 1:
    return {context.emotion};
  case 2:
    return {around.previous};
  case 3:
    return {around.next};
  case 4:
    return {duration_class(around.duration_s)};
  case 5:
    return {context.emotion, around.previous, around.next};
  case 6:
    return {around.second_previous, around.previous};
  case 7:
    return {around.next, around.second_next};
  default:
    return {context.emotion, around.second_previous, around.previous, around.next,
            around.second_next};
  }
}

ExpectedMotion::ExpectedMotion(std::span<const float* const> records, std::size_t size,
                               std::span<const PhonemeContext> contexts)
    : size_(size) {
  std::vector<std::vector<double>> residuals;
  residuals.reserve(records.size());
  for (const float* record : records) {
    residuals.emplace_back(record, record + size);
  }
  for (std::size_t stage = 0; stage < kStages; ++stage) {
    std::map<Key, std::vector<std::size_t>> parts;
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      parts[key_of(contexts[i], stage)].push_back(i);
    }
    for (const auto& [key, members] : parts) {
      std::vector<double> mean(size, 0.0);
      for (const std::size_t i : members) {
        for (std::size_t k = 0; k < size; ++k) {
          mean[k] += residuals[i][k];
        }
      }
      for (double& value : mean) {
        value /= static_cast<double>(members.size()) + kPrior;
      }
      for (const std::size_t i : members) {
        for (std::size_t k = 0; k < size; ++k) {
          residuals[i][k] -= mean[k];
        }
      }
      stages_[stage].emplace(key, std::move(mean));
    }
  }
}

std::vector<double> ExpectedMotion::in(const PhonemeContext& context) const {
  std::vector<double> sum(size_, 0.0);
  for (std::size_t stage = 0; stage < kStages; ++stage) {
    const auto found = stages_[stage].find(key_of(context, stage));
    if (found != stages_[stage].end()) {
      for (std::size_t k = 0; k < size_; ++k) {
        sum[k] += found->second[k];
      }
    }
  }
  return sum;
}

} // namespace phonomime
