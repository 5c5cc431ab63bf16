// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/choose_unknown.h"

#include "db/types/errors.h"
#include "db/types/parallel_progress.h"
#include "synth/style/bilinear_model.h"
#include "synth/style/infer_style.h"
#include "synth/style/singular_vectors.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

namespace phonomime {

namespace {

// Enough to tell which choice is best: a model is fitted to the kColumns directions in which the
// training has most extent, and neither fit nor inference goes on to the last digit.
constexpr Eigen::Index kColumns = 60;
constexpr int kFitRounds = 10;
constexpr int kRounds = 40;
constexpr double kTolerance = 1e-6;

struct Sums {
  std::int64_t found = 0, windows = 0;
  double squares = 0.0;
};

// Every window of a part, its style unknown.
Sums judge(const SymmetricModel& model, const StyleStack& part,
           const UnknownChoiceOptions& options) {
  Sums sums;
  const Eigen::Index window = std::min(options.window, part.columns.cols());
  const Eigen::Index room = part.columns.cols() - window;
  const Eigen::Index count = std::min(options.most_windows, room / window + 1);
  for (Eigen::Index w = 0; w < count; ++w) {
    const Eigen::Index first = count > 1 ? w * room / (count - 1) : 0;
    const auto columns = part.columns.middleCols(first, window);
    for (Eigen::Index style = 0; style < model.style_count(); ++style) {
      const InferredStyle found =
          infer_style(model, columns.middleRows(style * part.vector_size, part.vector_size),
                      {.most_iterations = kRounds, .tolerance = kTolerance});
      sums.found += nearest_style(model, found.expression) == style ? 1 : 0;
      ++sums.windows;
      for (Eigen::Index to = 0; to < model.style_count(); ++to) {
        sums.squares += (show(model, model.expressions.col(to), found.contents) -
                         columns.middleRows(to * part.vector_size, part.vector_size))
                            .squaredNorm() /
                        static_cast<double>(window * part.vector_size * model.style_count());
      }
    }
  }
  return sums;
}

StackSummary without(std::span<const StackSummary> summaries, std::size_t left_out) {
  std::vector<const StackSummary*> others;
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    if (i != left_out) {
      others.push_back(&summaries[i]);
    }
  }
  StackSummary training = merge_summaries(others);
  // Any rotation of the columns is the same training.
  const SingularVectors found = singular_vectors(training.factor);
  const Eigen::Index columns = std::min(kColumns, found.values.size());
  training.factor = found.left.leftCols(columns) * found.values.head(columns).asDiagonal();
  return training;
}

UnknownChoiceOptions with_defaults(const std::vector<StackSummary>& training,
                                   const UnknownChoiceOptions& given) {
  UnknownChoiceOptions options = given;
  const StackSummary& first = training.front();
  if (options.style_sizes.empty()) {
    for (Eigen::Index size = 2; size <= first.style_count(); ++size) {
      options.style_sizes.push_back(size);
    }
  }
  if (options.content_sizes.empty()) {
    Eigen::Index most = first.vector_size;
    for (const StackSummary& part : training) {
      most = std::min(most, part.factor.cols());
    }
    for (const Eigen::Index size : {6, 9, 12, 15, 20}) {
      if (size < most) {
        options.content_sizes.push_back(size);
      }
    }
    if (options.content_sizes.empty()) {
      options.content_sizes.push_back(most);
    }
  }
  return options;
}

} // namespace

ChosenUnknown choose_unknown(std::span<const StyleStack> parts,
                             std::span<const StackSummary> summaries,
                             const UnknownChoiceOptions& given, const Progress& progress) {
  if (parts.size() < 2 || parts.size() != summaries.size()) {
    throw InputError({.where = "training data of styles",
                      .what = "a cross-validation needs parts to leave out",
                      .expected = "at least 2",
                      .got = std::to_string(parts.size())});
  }
  std::vector<StackSummary> training;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    training.push_back(without(summaries, part));
  }
  const UnknownChoiceOptions options = with_defaults(training, given);
  std::vector<UnknownChoice> tried;
  for (const Eigen::Index style_size : options.style_sizes) {
    for (const Eigen::Index content_size : options.content_sizes) {
      tried.push_back({style_size, content_size});
    }
  }
  // One sum a choice and part.
  std::vector<Sums> sums(tried.size() * parts.size());
  const auto try_one = [&](std::ptrdiff_t i) {
    const auto index = static_cast<std::size_t>(i);
    const UnknownChoice& choice = tried[index / parts.size()];
    const std::size_t part = index % parts.size();
    sums[index] = judge(fit_symmetric(training[part], {.style_size = choice.style_size,
                                                       .content_size = choice.content_size,
                                                       .most_iterations = kFitRounds,
                                                       .tolerance = kTolerance}),
                        parts[part], options);
  };
  parallel_for(static_cast<std::ptrdiff_t>(sums.size()), options.threads, progress,
               "finding emotions", try_one);
  for (std::size_t c = 0; c < tried.size(); ++c) {
    double squares = 0.0;
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const Sums& sum = sums[c * parts.size() + part];
      tried[c].found += sum.found;
      tried[c].windows += sum.windows;
      squares += sum.squares;
    }
    tried[c].error = std::sqrt(squares / static_cast<double>(tried[c].windows));
  }
  const auto rank = [](const UnknownChoice& choice) {
    return std::tuple(-choice.found, choice.error, choice.style_size, choice.content_size);
  };
  ChosenUnknown chosen{.best = *std::ranges::min_element(tried, {}, rank)};
  chosen.tried = std::move(tried);
  return chosen;
}

} // namespace phonomime
