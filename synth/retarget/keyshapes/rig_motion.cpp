// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/rig_motion.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "synth/retarget/keyshapes/region_basis.h"
#include "synth/retarget/weight_filter.h"

#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {
namespace {

constexpr std::string_view kNeutral = "neutral";

Eigen::Index expression_index(const std::vector<std::string>& expressions,
                              const std::string& emotion, const std::string& where) {
  const auto found = std::ranges::find(expressions, emotion);
  if (found == expressions.end()) {
    throw InputError({.where = where,
                      .what = "the rig has no keyshapes of the expression " + quoted(emotion),
                      .expected = fmt::format("{}", fmt::join(expressions, ", ")),
                      .remedy = did_you_mean(emotion, expressions)});
  }
  return found - expressions.begin();
}

// The shares of the emotions of a mixture: 1 by #expressions.
Eigen::RowVectorXd shares_of(const std::vector<std::string>& expressions,
                             const EmotionMixture& mixture, const std::string& where = {}) {
  Eigen::RowVectorXd shares =
      Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(expressions.size()));
  std::vector<EmotionModifier> parts = mixture.others;
  parts.push_back(mixture.heaviest);
  double expressive = 0.0;
  for (const EmotionModifier& part : parts) {
    shares[expression_index(expressions, part.emotion, where)] = part.intensity;
    expressive += part.emotion == kNeutral ? 0.0 : part.intensity;
  }
  if (const auto neutral = std::ranges::find(expressions, kNeutral); neutral != expressions.end()) {
    shares[neutral - expressions.begin()] = std::max(0.0, 1.0 - expressive);
  }
  return shares;
}

} // namespace

std::vector<std::string> keyshape_names(const Rig& rig) {
  std::vector<std::string> names;
  for (const RigSet& set : rig.sets) {
    for (const RigKeyshape& keyshape : set.keyshapes) {
      names.push_back(set.expression + "/" + set.part + "/" + keyshape.name);
    }
  }
  return names;
}

std::vector<std::string> rig_expressions(const Rig& rig) {
  std::vector<std::string> expressions;
  for (const RigSet& set : rig.sets) {
    if (std::ranges::find(expressions, set.expression) == expressions.end()) {
      expressions.push_back(set.expression);
    }
  }
  return expressions;
}

FrameMatrixD expression_shares(const Rig& rig, const EmotionTrack& track,
                               const EmotionMixture& fallback, double rate_hz, Eigen::Index frames,
                               double glide_s) {
  const std::vector<std::string> expressions = rig_expressions(rig);
  if (expressions.size() == 1) {
    return FrameMatrixD::Ones(frames, 1);
  }
  FrameMatrixD shares(frames, static_cast<Eigen::Index>(expressions.size()));
  const Eigen::RowVectorXd rest = shares_of(expressions, fallback);
  shares.rowwise() = rest;
  for (const EmotionSpan& span : track.spans) {
    const Eigen::RowVectorXd own =
        shares_of(expressions, mixture_of(span), at_line(track.source, span.line));
    for (Eigen::Index t = 0; t < frames; ++t) {
      const double time_s = static_cast<double>(t) / rate_hz;
      if (time_s >= span.start_s && time_s < span.end_s) {
        shares.row(t) = own;
      }
    }
  }
  return filter_weights(shares, rate_hz, glide_s);
}

FrameMatrixD rig_weights(const Rig& rig, const Layout& layout, const FrameMatrixD& source,
                         const FrameMatrixD& frames, const FrameMatrixD& shares,
                         const WeightOptions& options) {
  const std::vector<std::string> expressions = rig_expressions(rig);
  if (source.cols() != layout.channel_count() || frames.cols() != layout.channel_count() ||
      shares.rows() != frames.rows() ||
      shares.cols() != static_cast<Eigen::Index>(expressions.size())) {
    throw InternalError({.what = "rig, layout and motion do not fit each other"});
  }
  FrameMatrixD weights(frames.rows(), static_cast<Eigen::Index>(keyshape_names(rig).size()));
  Eigen::Index first = 0;
  for (const RigSet& set : rig.sets) {
    std::vector<Eigen::Index> rows;
    for (const RigKeyshape& keyshape : set.keyshapes) {
      if (keyshape.source < 0 || keyshape.source >= source.rows()) {
        throw InputError(
            {.where = rig.source,
             .what = "keyshape " + quoted(keyshape.name) + " is a row that the file has not",
             .expected = "0 to " + std::to_string(source.rows() - 1),
             .got = std::to_string(keyshape.source)});
      }
      rows.push_back(keyshape.source);
    }
    const std::vector<int> channels = part_channels(layout, set.part);
    const Eigen::MatrixXd shapes = source(rows, channels).transpose();
    const auto count = static_cast<Eigen::Index>(rows.size());
    const Eigen::Index expression = expression_index(expressions, set.expression, rig.source);
    weights.middleCols(first, count) =
        shares.col(expression).asDiagonal() *
        WeightSolver(shapes, {}, options).solve(frames(Eigen::all, channels));
    first += count;
  }
  return weights;
}

RigTargets shape_targets(const Rig& rig) {
  std::map<std::string, Eigen::Index> places;
  for (const RigSet& set : rig.sets) {
    for (const RigKeyshape& keyshape : set.keyshapes) {
      for (const auto& entry : keyshape.weights) {
        places.emplace(entry.first, 0);
      }
    }
  }
  RigTargets targets;
  for (auto& entry : places) {
    entry.second = static_cast<Eigen::Index>(targets.names.size());
    targets.names.push_back(entry.first);
  }
  targets.values = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(keyshape_names(rig).size()),
                                         static_cast<Eigen::Index>(places.size()));
  Eigen::Index row = 0;
  for (const RigSet& set : rig.sets) {
    for (const RigKeyshape& keyshape : set.keyshapes) {
      for (const auto& entry : keyshape.weights) {
        targets.values(row, places.at(entry.first)) = entry.second;
      }
      ++row;
    }
  }
  return targets;
}

} // namespace phonomime
