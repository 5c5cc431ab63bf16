// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/style_path.h"

#include "db/types/row_frames.h"
#include "synth/pipeline/asked_style.h"
#include "synth/style/style_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace phonomime {

namespace {

// Of the style model, by name; one that it does not have stands for `otherwise`.
Eigen::Index style_of(const StyleModel& model, const std::string& emotion, Eigen::Index otherwise) {
  const std::vector<std::string>& styles = model.known.styles;
  const auto found = std::ranges::find(styles, emotion);
  return found == styles.end() ? otherwise : found - styles.begin();
}

// What the motion of a row shows: the emotions of its nodes, by the weights of their paths; what
// the context lets expect is of the emotion that the search was asked for.
Eigen::VectorXd shown_style(const MotionTable& table, const SynthesisInput& input,
                            const SynthesisResult& result, std::size_t row) {
  const StyleModel& model = *input.style.model;
  const Eigen::Index neutral = style_of(model, model.neutral, 0);
  const Eigen::Index asked = style_of(model, input.emotions[row].emotion, neutral);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(model.known.style_count());
  const auto add = [&](NodeIndex node, double weight) {
    const MotionNode& of = table.nodes[static_cast<std::size_t>(node)];
    weights[style_of(model, table.emotions[static_cast<std::size_t>(of.emotion)], asked)] += weight;
  };
  add(result.rows[row].node, 1.0);
  if (!result.blended.empty()) {
    weights *= result.weight;
    for (const BlendedPath& path : result.blended) {
      add(path.nodes[row], path.weight);
    }
    weights[asked] += result.expected_weight;
    weights /= weights.sum(); // but for rounding it is 1
  }
  return weights;
}

} // namespace

void style_path(const MotionTable& table, const SynthesisInput& input, SynthesisResult& result) {
  const StyleModel& model = *input.style.model;
  const double rate_hz = result.motion.rate_hz;
  const Eigen::Index frames = result.motion.coefficients.rows();
  StyleRequest request{.coefficients = result.motion.coefficients,
                       .rate_hz = rate_hz,
                       .shown = Eigen::MatrixXd::Zero(model.known.style_count(), frames),
                       .wanted = asked_weights(input.style, rate_hz, frames),
                       .shown_glide_s = 2.0 * input.concat.smoothing_half_window / rate_hz};
  std::vector<bool> is_shown(static_cast<std::size_t>(frames), false);
  const std::vector<FrameRange> ranges = row_frames(input.transcript, rate_hz);
  for (std::size_t row = 0; row < ranges.size(); ++row) {
    const bool silent = input.transcript[row].is_silence();
    const auto first = std::min<Eigen::Index>(ranges[row].first, frames);
    const auto count = std::min<Eigen::Index>(ranges[row].count, frames - first);
    if (result.rows[row].node == kNoNode || (silent && !result.rows[row].constrained)) {
      continue;
    }
    request.shown.middleCols(first, count).colwise() = shown_style(table, input, result, row);
    std::fill_n(is_shown.begin() + first, count, true);
    if (!silent) {
      request.phonemes.push_back(
          {.phoneme = input.transcript[row].phoneme.name, .first = first, .count = count});
    }
  }
  fill_silent_styles(model, is_shown, rate_hz, input.concat.silence, request.shown, request.wanted);
  StyledMotion styled = apply_style(model, table.layout, table.pca, request);
  const double change = (styled.coefficients - request.coefficients).norm();
  result.style = {.contacts = styled.contacts,
                  .contacts_moved = styled.contacts_moved,
                  .contacts_left = styled.contacts_left,
                  .change = change / std::sqrt(std::max(1.0, static_cast<double>(frames) *
                                                                 table.layout.group_count()))};
  for (PathRow& row : result.rows) {
    row.asked = asked_at(input.style, 0.5 * (row.phoneme.start_s + row.phoneme.end_s));
  }
  result.motion.coefficients = std::move(styled.coefficients);
  std::ranges::move(styled.warnings, std::back_inserter(result.warnings));
}

} // namespace phonomime
