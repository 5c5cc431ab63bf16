// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/choose_dimensions.h"

#include "db/types/errors.h"
#include "db/types/parallel_progress.h"
#include "synth/style/bilinear_model.h"
#include "synth/style/content_solver.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

// Sums of squared errors over a part's frames.
struct PartErrors {
  std::vector<double> tried; // in order of J, then ridge
  double unchanged = 0.0, mean_difference = 0.0;
};

// Sum over a part's columns of |wanted - (matrix * known + shift)|^2, from the summary alone: the
// linear part by the factor, the shift by the mean column.
double squared_error(const StackSummary& part, Eigen::Index from, Eigen::Index to,
                     const Translation& step, Eigen::Index first_row) {
  const Eigen::Index rows = step.matrix.rows();
  const Eigen::MatrixXd off =
      part.style_rows(to).middleRows(first_row, rows) - step.matrix * part.style_rows(from);
  const Eigen::VectorXd mean_off =
      part.style_mean(to).segment(first_row, rows) - step.matrix * part.style_mean(from);
  return off.squaredNorm() +
         part.content_count * (step.shift.squaredNorm() - 2.0 * step.shift.dot(mean_off));
}

PartErrors leave_out(std::span<const StackSummary> parts, std::size_t left_out,
                     const ChoiceOptions& options, Eigen::Index rows) {
  std::vector<const StackSummary*> others;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i != left_out) {
      others.push_back(&parts[i]);
    }
  }
  const StackSummary training = merge_summaries(others);
  const StackSummary& part = parts[left_out];
  const AsymmetricModel largest = fit_asymmetric(
      training, *std::max_element(options.content_sizes.begin(), options.content_sizes.end()));
  PartErrors errors;
  for (const Eigen::Index content_size : options.content_sizes) {
    const std::size_t first = errors.tried.size();
    errors.tried.resize(first + options.ridges.size());
    for (Eigen::Index from = 0; from < part.style_count(); ++from) {
      const ContentSolver solver(largest.basis(from).leftCols(content_size),
                                 largest.mean_content.head(content_size));
      for (std::size_t k = 0; k < options.ridges.size(); ++k) {
        const Eigen::MatrixXd map = solver.map(options.ridges[k]);
        for (Eigen::Index to = 0; to < part.style_count(); ++to) {
          if (to != from) {
            const auto wanted =
                largest.basis(to).middleRows(options.first_row, rows).leftCols(content_size);
            errors.tried[first + k] +=
                squared_error(part, from, to, solver.to(wanted, map), options.first_row);
          }
        }
      }
    }
  }
  for (Eigen::Index pair = 0; pair < part.style_count() * part.style_count(); ++pair) {
    const Eigen::Index from = pair / part.style_count(), to = pair % part.style_count();
    if (from == to) {
      continue;
    }
    Translation step{Eigen::MatrixXd::Zero(rows, part.vector_size), Eigen::VectorXd::Zero(rows)};
    step.matrix.middleCols(options.first_row, rows).setIdentity();
    errors.unchanged += squared_error(part, from, to, step, options.first_row);
    step.shift =
        (training.style_mean(to) - training.style_mean(from)).segment(options.first_row, rows);
    errors.mean_difference += squared_error(part, from, to, step, options.first_row);
  }
  return errors;
}

// J in steps of about a third; ridges in steps of ten below the variance that the data's last
// dimensions have together.
ChoiceOptions with_defaults(std::span<const StackSummary> parts, const ChoiceOptions& given) {
  ChoiceOptions options = given;
  std::vector<const StackSummary*> all;
  for (const StackSummary& part : parts) {
    all.push_back(&part);
  }
  const StackSummary whole = merge_summaries(all);
  Eigen::Index most = whole.vector_size;
  for (const StackSummary& part : parts) {
    // What is left without the part has at least so many columns.
    most = std::min(most, static_cast<Eigen::Index>(whole.content_count - part.content_count));
  }
  if (options.content_sizes.empty()) {
    for (Eigen::Index size = 2; size < most; size += std::max<Eigen::Index>(1, size / 3)) {
      options.content_sizes.push_back(size);
    }
    options.content_sizes.push_back(most);
  }
  if (options.ridges.empty()) {
    const double variance = whole.factor.squaredNorm() /
                            (whole.content_count * static_cast<double>(whole.factor.rows()));
    options.ridges.push_back(0.0);
    for (double share = 1e-9; share < 1e-2; share *= 10.0) {
      options.ridges.push_back(share * variance);
    }
  }
  return options;
}

} // namespace

ChosenDimensions choose_dimensions(std::span<const StackSummary> parts, const ChoiceOptions& given,
                                   const Progress& progress) {
  if (parts.size() < 2) {
    throw InputError({.where = "training data of styles",
                      .what = "a cross-validation needs parts to leave out",
                      .expected = "at least 2",
                      .got = std::to_string(parts.size())});
  }
  const ChoiceOptions options = with_defaults(parts, given);
  const Eigen::Index rows =
      options.row_count > 0 ? options.row_count : parts.front().vector_size - options.first_row;
  std::vector<PartErrors> errors(parts.size());
  parallel_for(static_cast<std::ptrdiff_t>(parts.size()), options.threads, progress,
               "choosing dimensions", [&](std::ptrdiff_t i) {
                 const auto part = static_cast<std::size_t>(i);
                 errors[part] = leave_out(parts, part, options, rows);
               });
  double numbers = 0.0;
  for (const StackSummary& part : parts) {
    const auto styles = static_cast<double>(part.style_count());
    numbers += part.content_count * styles * (styles - 1.0) * static_cast<double>(rows);
  }
  const auto mean_of = [&](auto&& of_part) {
    double sum = 0.0;
    for (const PartErrors& part : errors) {
      sum += of_part(part);
    }
    return std::sqrt(std::max(sum, 0.0) / numbers);
  };
  ChosenDimensions chosen;
  std::size_t index = 0;
  for (const Eigen::Index content_size : options.content_sizes) {
    for (const double ridge : options.ridges) {
      const Choice choice{content_size, ridge,
                          mean_of([&](const PartErrors& part) { return part.tried[index]; })};
      const bool first = chosen.tried.empty();
      if (first || choice.error < chosen.best.error ||
          (choice.error == chosen.best.error && choice.content_size == chosen.best.content_size &&
           choice.ridge > chosen.best.ridge)) {
        chosen.best = choice;
      }
      chosen.tried.push_back(choice);
      ++index;
    }
  }
  chosen.unchanged_error = mean_of([](const PartErrors& part) { return part.unchanged; });
  chosen.mean_difference_error =
      mean_of([](const PartErrors& part) { return part.mean_difference; });
  return chosen;
}

} // namespace phonomime
