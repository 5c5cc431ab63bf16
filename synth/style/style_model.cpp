// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/style_model.h"

#include "db/types/errors.h"
#include "db/types/parallel_progress.h"
#include "synth/style/mixture.h"

#include <algorithm>

#include <fmt/format.h>

namespace phonomime {

namespace {

void check_range(const char* what, bool inside, const char* expected, const std::string& got) {
  if (!inside) {
    throw UsageError({.what = what, .expected = expected, .got = got});
  }
}

ChosenDimensions choose(std::span<const StackSummary> parts, const FrameVectors& vectors,
                        const StyleOptions& options, const Progress& progress) {
  ChoiceOptions tried{.first_row = vectors.middle_row(),
                      .row_count = vectors.dimension_count(),
                      .threads = options.threads};
  if (options.content_size) {
    tried.content_sizes = {*options.content_size};
  }
  if (options.ridge) {
    tried.ridges = {*options.ridge};
  }
  return choose_dimensions(parts, tried, progress);
}

ChosenUnknown choose_unknown_of(std::span<const StyleStack> parts,
                                std::span<const StackSummary> summaries,
                                const StyleOptions& options, const Progress& progress) {
  UnknownChoiceOptions tried{.threads = options.threads};
  if (options.style_size) {
    tried.style_sizes = {*options.style_size};
  }
  if (options.unknown_content_size) {
    tried.content_sizes = {*options.unknown_content_size};
  }
  return choose_unknown(parts, summaries, tried, progress);
}

void warn_of_range(const StyleModel& model, const Eigen::MatrixXd& wanted,
                   std::vector<std::string>& warnings) {
  for (const ValidRange& range : model.valid) {
    const Eigen::Index style = find_style(model.known.styles, range.emotion);
    const double most = wanted.cols() > 0 ? wanted.row(style).maxCoeff() : 0.0;
    if (most > range.largest_intensity + 1e-9) {
      warnings.push_back(fmt::format("{} at intensity {:.2f} leaves the recorded faces, which it "
                                     "does from {:.2f} on",
                                     range.emotion, most, range.largest_intensity));
    }
  }
}

} // namespace

void StyleOptions::validate() const {
  check_range("the number of frames in a bundle is out of range", bundle >= 1 && bundle % 2 == 1,
              "an odd number from 1 on", std::to_string(bundle));
  check_range("the number of content dimensions is out of range",
              !content_size || *content_size >= 1, "1 or more",
              content_size ? std::to_string(*content_size) : "");
  check_range("the number of style dimensions is out of range", !style_size || *style_size >= 1,
              "1 or more", style_size ? std::to_string(*style_size) : "");
  check_range("the number of content dimensions of unknown styles is out of range",
              !unknown_content_size || *unknown_content_size >= 1, "1 or more",
              unknown_content_size ? std::to_string(*unknown_content_size) : "");
  check_range("the ridge is out of range", !ridge || *ridge >= 0.0, "0 or more",
              ridge ? fmt::format("{}", *ridge) : "");
  check_range("the number of parts of a cross-validation is out of range", training.parts >= 2,
              "2 or more", std::to_string(training.parts));
}

TrainedStyle train_style(const MotionTable& table, const StyleOptions& options,
                         const Progress& progress) {
  options.validate();
  const FrameVectors vectors(table.pca, options.bundle, options.vectors);
  StyleTraining training = gather_styles(table, vectors, options.training);
  TrainedStyle trained{.sentences = std::move(training.sentences),
                       .nodes = training.nodes,
                       .nodes_left_out = training.nodes_left_out,
                       .not_aligned = std::move(training.not_aligned)};
  std::vector<StackSummary> parts(training.parts.size());
  parallel_for(static_cast<std::ptrdiff_t>(parts.size()), options.threads, progress,
               "aligning sentences", [&](std::ptrdiff_t i) {
                 const auto part = static_cast<std::size_t>(i);
                 parts[part] = summarise(training.parts[part]);
               });
  std::vector<const StackSummary*> all;
  for (const StackSummary& part : parts) {
    all.push_back(&part);
    trained.columns += static_cast<std::int64_t>(part.content_count);
  }
  const StackSummary whole = merge_summaries(all);
  Eigen::Index content_size = options.content_size.value_or(0);
  StyleModel& model = trained.model;
  model.neutral = options.training.reference;
  model.vectors = options.vectors;
  model.bundle = options.bundle;
  model.ridge = options.ridge.value_or(0.0);
  if (!options.content_size || !options.ridge) {
    trained.chosen = choose(parts, vectors, options, progress);
    content_size = trained.chosen->best.content_size;
    model.ridge = trained.chosen->best.ridge;
  }
  model.known = fit_asymmetric(whole, content_size);
  SymmetricOptions unknown{.style_size = options.style_size.value_or(0),
                           .content_size = options.unknown_content_size.value_or(0)};
  if (!options.style_size || !options.unknown_content_size) {
    trained.chosen_unknown = choose_unknown_of(training.parts, parts, options, progress);
    unknown.style_size = trained.chosen_unknown->best.style_size;
    unknown.content_size = trained.chosen_unknown->best.content_size;
  }
  progress.update("fitting", 0, 1);
  model.unknown = fit_symmetric(whole, unknown);
  if (const auto aperture = CoefficientAperture::of(table.layout, table.pca)) {
    model.contacts = recorded_contacts(table, *aperture);
  }
  model.valid = valid_ranges(table, Restyler(model.known, vectors, model.ridge), model.known.styles,
                             model.neutral);
  progress.update("fitting", 1, 1);
  return trained;
}

FrameMatrixD StyleModel::on_own_face(const FrameMatrixD& coefficients) const {
  FrameMatrixD own = coefficients;
  if (to_own_face.size() > 0) {
    own.rowwise() += to_own_face.transpose();
  }
  return own;
}

MotionStyler::MotionStyler(const StyleModel& model, const Layout& layout, const PcaModel& pca)
    : model_(&model), pca_(&pca),
      restyler_(model.known, FrameVectors(pca, model.bundle, model.vectors), model.ridge),
      aperture_(CoefficientAperture::of(layout, pca)) {}

StyledMotion MotionStyler::apply(const StyleRequest& request) const {
  const Eigen::MatrixXd shown =
      glide(request.shown, request.rate_hz, request.shown_glide_s.value_or(request.glide_s));
  const Eigen::MatrixXd wanted = glide(request.wanted, request.rate_hz, request.glide_s);
  StyledMotion styled;
  warn_of_range(*model_, wanted, styled.warnings);
  const FrameMatrixD own = model_->on_own_face(request.coefficients);
  // What does not change keeps its bits.
  styled.coefficients = request.coefficients + (restyler_.restyle(own, shown, wanted) - own);
  if (!aperture_ || styled.coefficients == request.coefficients) {
    return styled;
  }
  const std::vector<Contact> contacts =
      contacts_to_hold(request.phonemes, model_->contacts, *aperture_, request.coefficients);
  HeldContacts held =
      hold_contacts(styled.coefficients, request.rate_hz, contacts, *aperture_, pca_->variance);
  styled.coefficients = std::move(held.coefficients);
  styled.contacts = static_cast<int>(contacts.size());
  styled.contacts_moved = held.moved;
  styled.contacts_left = held.left;
  if (held.left > 0) {
    styled.warnings.push_back(
        fmt::format("{} of {} contacts of the lips could not be kept", held.left, contacts.size()));
  }
  return styled;
}

StyledMotion apply_style(const StyleModel& model, const Layout& layout, const PcaModel& pca,
                         const StyleRequest& request) {
  return MotionStyler(model, layout, pca).apply(request);
}

} // namespace phonomime
