// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/style_apply.h"

#include "db/import/readers.h"
#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/row_frames.h"
#include "db/types/text.h"
#include "synth/concat/resample.h"
#include "synth/export/motion_csv.h"
#include "synth/pipeline/asked_style.h"
#include "synth/style/infer_style.h"
#include "synth/style/mixture.h"
#include "tools/app/option_checks.h"
#include "tools/app/synth_inputs.h"
#include "tools/app/synth_outputs.h"
#include "tools/app/synth_stock.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

// Frames by which an unknown emotion is found, evenly over the motion.
constexpr Eigen::Index kFramesLookedAt = 300;

SynthOptions output_options(const StyleApplyOptions& options) {
  SynthOptions output{.database = options.database,
                      .transcript = options.motion,
                      .outputs = options.outputs,
                      .face = options.face,
                      .threads = options.threads};
  output.audio = options.audio;
  output.fps = options.fps.value_or(output.fps);
  if (options.head) {
    output.head = HeadPose{};
  }
  return output;
}

void check_options(const StyleApplyOptions& options) {
  check_synth_options(output_options(options));
  for (const std::filesystem::path& path : options.outputs) {
    const std::string suffix = to_lower(path.extension().string());
    if (suffix == ".txt" || suffix == ".lab") {
      throw UsageError({.where = path.string(),
                        .what = "a change of style has no such output",
                        .expected = ".csv, .glb, .html or .json",
                        .got = quoted(suffix)});
    }
  }
  if (options.to.empty() && options.emotions.empty()) {
    throw UsageError({.what = "nothing says which emotion the motion is to show",
                      .remedy = "Name it with --to, or give an emotion track with --emotions."});
  }
}

void add_names(const EmotionMixture& mixture, std::vector<std::string>& names) {
  names.push_back(mixture.heaviest.emotion);
  for (const EmotionModifier& part : mixture.others) {
    names.push_back(part.emotion);
  }
}

// What is asked for, but what the motion shows itself.
StyleInput read_wanted(const StyleApplyOptions& options) {
  StyleInput wanted;
  if (!options.to.empty()) {
    wanted.fallback = parse_emotion_mixture(options.to, "--to");
  }
  if (!options.emotions.empty()) {
    wanted.track = parse_emotion_track(read_file(options.emotions), options.emotions.string());
  }
  return wanted;
}

std::vector<TimedPhoneme> read_rows(const StyleApplyOptions& options, const MotionTable& table,
                                    const MotionFile& motion) {
  if (options.transcript.empty()) {
    return {};
  }
  SynthOptions synth;
  synth.transcript = options.transcript;
  synth.phoneme_set = options.phoneme_set;
  synth.tier = options.tier;
  std::vector<TimedPhoneme> rows = read_transcript(synth, table).rows;
  const double end_s = rows.empty() ? 0.0 : rows.back().end_s;
  if (end_s > motion.duration_s + kTranscriptTolerance_s) {
    throw InputError(
        {.where = options.transcript.string(),
         .what = "the transcript is longer than the motion",
         .expected = fmt::format("an end at {} s at the latest", format_number(motion.duration_s)),
         .got = format_number(end_s) + " s",
         .remedy = "Check that both are of the same recording."});
  }
  return rows;
}

// The trained style that the motion shows, by what its spoken frames share (T2.12, T2.13).
EmotionMixture find_emotion(const StyleModel& model, const PcaModel& pca,
                            const FrameMatrixD& coefficients,
                            const std::vector<PhonemeFrames>& phonemes, StyleApplyReport& report) {
  std::vector<Eigen::Index> frames;
  for (const PhonemeFrames& phoneme : phonemes) {
    for (Eigen::Index k = 0; k < phoneme.count; ++k) {
      frames.push_back(phoneme.first + k);
    }
  }
  for (Eigen::Index k = 0; phonemes.empty() && k < coefficients.rows(); ++k) {
    frames.push_back(k);
  }
  const Eigen::MatrixXd bundles =
      FrameVectors(pca, model.bundle, model.vectors).bundles(model.on_own_face(coefficients));
  const auto count = std::min(kFramesLookedAt, static_cast<Eigen::Index>(frames.size()));
  Eigen::MatrixXd looked_at(bundles.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i) * frames.size() / static_cast<std::size_t>(count);
    looked_at.col(i) = bundles.col(frames[at]);
  }
  const InferredStyle found = infer_style(model.unknown, looked_at, {});
  const std::vector<std::string>& styles = model.unknown.styles;
  for (std::size_t s = 0; s < styles.size(); ++s) {
    const double distance =
        (model.unknown.expressions.col(static_cast<Eigen::Index>(s)) - found.expression).norm();
    report.distances.emplace_back(styles[s], distance);
  }
  std::ranges::stable_sort(report.distances, {}, &std::pair<std::string, double>::second);
  report.from_found = true;
  if (!found.converged) {
    report.warnings.push_back("the search for the motion's emotion has not converged");
  }
  const Eigen::Index nearest = nearest_style(model.unknown, found.expression);
  return {.heaviest = {.emotion = styles[static_cast<std::size_t>(nearest)]}};
}

std::vector<PhonemeFrames> phoneme_frames(const std::vector<TimedPhoneme>& rows, double rate_hz,
                                          Eigen::Index frames) {
  std::vector<PhonemeFrames> phonemes;
  const std::vector<FrameRange> ranges = row_frames(rows, rate_hz);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto first = std::min<Eigen::Index>(ranges[i].first, frames);
    const auto count = std::min<Eigen::Index>(ranges[i].count, frames - first);
    if (!rows[i].is_silence() && count > 0) {
      phonemes.push_back({.phoneme = rows[i].phoneme.name, .first = first, .count = count});
    }
  }
  return phonemes;
}

// E11 of channels that are their own coefficients.
PcaModel no_pca(const Layout& layout) {
  const Eigen::Index channels = layout.channel_count();
  return {.mean = Eigen::VectorXd::Zero(channels),
          .basis = Eigen::MatrixXd::Identity(channels, channels)};
}

// The motion at its output rate, with the change that it undergoes at the database's.
struct StyledFile {
  SynthesisResult result; // rows and output
  std::string csv;
};

StyledFile at_output_rate(const StyleApplyOptions& options, const MotionTable& table,
                          const MotionFile& motion, const FrameMatrixD& change,
                          const std::vector<TimedPhoneme>& rows, const StyleInput& wanted) {
  const double fps = options.fps.value_or(motion.recorded_hz);
  MotionFile own = read_motion_file(options.motion, table, options.reading, fps);
  const double end_s = static_cast<double>(own.frame_count() - 1) / fps;
  const FrameMatrixD more =
      resample_motion({.rate_hz = motion.rate_hz, .coefficients = change}, fps, end_s).coefficients;
  StyledFile file;
  file.result.end_s = motion.duration_s;
  file.result.output = {.rate_hz = fps,
                        .coefficients = project_motion(own, table.pca).coefficients + more};
  if (options.head) {
    file.result.output.head = own.head;
  }
  for (const TimedPhoneme& phoneme : rows) {
    const EmotionMixture asked = asked_at(wanted, 0.5 * (phoneme.start_s + phoneme.end_s));
    file.result.rows.push_back(
        {.phoneme = phoneme, .emotion = asked.heaviest.emotion, .asked = asked});
  }
  const CoefficientMotion channels{.rate_hz = fps,
                                   .coefficients =
                                       own.channels + more * table.pca.basis.transpose(),
                                   .head = file.result.output.head};
  file.csv = motion_csv_header(table.layout) +
             motion_csv_rows(table.layout, no_pca(table.layout), channels, options.head, 0);
  return file;
}

} // namespace

std::string style_apply_json(const StyleApplyReport& report) {
  nlohmann::ordered_json json{{"speaker", report.speaker},
                              {"model_of", report.model_of},
                              {"from", report.from},
                              {"from_found", report.from_found},
                              {"distances", nlohmann::ordered_json::object()},
                              {"frames", report.frames},
                              {"fps", report.fps},
                              {"duration", report.duration_s},
                              {"unit", report.unit},
                              {"residual", report.residual},
                              {"change", report.change},
                              {"contacts", report.contacts},
                              {"contacts_moved", report.contacts_moved},
                              {"contacts_left", report.contacts_left},
                              {"warnings", report.warnings},
                              {"notes", report.notes}};
  for (const auto& [emotion, distance] : report.distances) {
    json["distances"][emotion] = distance;
  }
  return json.dump(1) + "\n";
}

StyleApplyReport apply_style_to_file(const StyleApplyOptions& options) {
  check_options(options);
  SynthStock stock(MotionDatabase::open(options.database, OpenMode::read_only)
                       .load_motion_table(options.speaker),
                   options.database);
  const MotionTable& table = stock.table();
  const bool markers = table.layout.kind == LayoutKind::markers;
  StyleApplyReport report{.speaker = table.speaker, .unit = markers ? "mm a marker" : "a weight"};
  StyleInput wanted = read_wanted(options);
  std::optional<EmotionMixture> from;
  std::vector<std::string> names;
  for (const EmotionSpan& span : wanted.track.spans) {
    add_names(mixture_of(span), names);
  }
  if (!options.to.empty()) {
    add_names(wanted.fallback, names);
  }
  if (options.from != kUnknownEmotion) {
    from = parse_emotion_mixture(options.from, "--from");
    add_names(*from, names);
  }
  const StyleInUse* style = stock.style(names);
  report.model_of = style->speaker;
  wanted.model = &style->model;

  const SynthOptions output = output_options(options);
  SynthOutputs outputs(output, stock, report.notes);
  const MotionFile motion = read_motion_file(options.motion, table, options.reading);
  report.notes.insert(report.notes.end(), motion.notes.begin(), motion.notes.end());
  const ProjectedMotion projected = project_motion(motion, table.pca);
  const std::vector<TimedPhoneme> rows = read_rows(options, table, motion);
  const Eigen::Index frames = motion.frame_count();
  StyleRequest request{.coefficients = projected.coefficients,
                       .rate_hz = motion.rate_hz,
                       .phonemes = phoneme_frames(rows, motion.rate_hz, frames)};
  if (!from) {
    from = find_emotion(style->model, table.pca, projected.coefficients, request.phonemes, report);
  }
  if (options.to.empty()) {
    wanted.fallback = *from;
  }
  report.from = format_emotions(*from);
  request.shown =
      asked_weights({.model = &style->model, .fallback = *from}, motion.rate_hz, frames);
  request.wanted = asked_weights(wanted, motion.rate_hz, frames);
  const StyledMotion styled = apply_style(style->model, table.layout, table.pca, request);
  const FrameMatrixD change = styled.coefficients - projected.coefficients;
  const StyledFile file = at_output_rate(options, table, motion, change, rows, wanted);
  const double groups = table.layout.group_count();
  report.frames = file.result.output.coefficients.rows();
  report.fps = file.result.output.rate_hz;
  report.duration_s = motion.duration_s;
  report.residual = projected.residual * std::sqrt(table.layout.channels_per_group());
  report.change = change.norm() / std::sqrt(static_cast<double>(frames) * groups);
  report.contacts = styled.contacts;
  report.contacts_moved = styled.contacts_moved;
  report.contacts_left = styled.contacts_left;
  report.warnings.insert(report.warnings.end(), styled.warnings.begin(), styled.warnings.end());
  if (rows.empty()) {
    report.notes.push_back("without --transcript nothing keeps the lips' contacts");
  }
  report.written = outputs.write(file.result, style_apply_json(report), &file.csv);
  return report;
}

} // namespace phonomime
