// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/synth_outputs.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"
#include "synth/export/audio.h"
#include "synth/export/glb.h"
#include "synth/export/motion_csv.h"
#include "synth/export/player_document.h"
#include "synth/pipeline/closures.h"
#include "synth/pipeline/explain.h"
#include "tools/app/option_checks.h"
#include "tools/app/retime.h"

#include <algorithm>
#include <array>
#include <map>
#include <system_error>

#include <fmt/format.h>

namespace phonomime {

namespace {

enum class OutputKind { csv, glb, html, json, transcript, text };

OutputKind output_kind(const std::filesystem::path& path) {
  const std::string suffix = to_lower(path.extension().string());
  if (suffix == ".csv") {
    return OutputKind::csv;
  }
  if (suffix == ".glb") {
    return OutputKind::glb;
  }
  if (suffix == ".html") {
    return OutputKind::html;
  }
  if (suffix == ".json") {
    return OutputKind::json;
  }
  if (suffix == ".lab") {
    return OutputKind::transcript;
  }
  if (suffix == ".txt") {
    return OutputKind::text;
  }
  throw UsageError({.where = path.string(),
                    .what = "the suffix names no kind of output",
                    .expected = ".csv, .glb, .html, .json, .lab or .txt",
                    .got = quoted(suffix)});
}

bool shows_face(const std::filesystem::path& path) {
  const OutputKind kind = output_kind(path);
  return kind == OutputKind::glb || kind == OutputKind::html;
}

// A .lab output must not be the transcript that is read.
void check_transcript_stays(const SynthOptions& options) {
  for (const std::filesystem::path& path : options.outputs) {
    std::error_code error;
    if (std::filesystem::equivalent(path, options.transcript, error)) {
      throw UsageError({.where = path.string(),
                        .what = "the output is the transcript itself",
                        .remedy = "Give it another name."});
    }
  }
}

void make_folder_of(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  if (error && path.has_parent_path()) {
    throw IoError({.where = path.parent_path().string(),
                   .what = "the folder cannot be made",
                   .got = error.message()});
  }
}

// E figure 5 colours the four emotions; black is for neutral there, grey on a dark page here.
std::string emotion_color(const std::string& emotion, std::int32_t index) {
  if (emotion == "neutral") {
    return "#8a8f98";
  }
  if (emotion == "anger") {
    return "#d64545";
  }
  if (emotion == "sadness") {
    return "#3f9d5f";
  }
  if (emotion == "happiness") {
    return "#4a7fe0";
  }
  constexpr std::array<const char*, 6> kOthers = {"#c98a2b", "#8e5bd0", "#2ba3a3",
                                                  "#b84f93", "#7d9a2e", "#a0693e"};
  return kOthers[static_cast<std::size_t>(index) % kOthers.size()];
}

std::vector<PlayerDocument::Emotion> emotion_spans(const MotionTable& table,
                                                   const std::vector<PathRow>& rows) {
  std::vector<PlayerDocument::Emotion> spans;
  for (const PathRow& row : rows) {
    const std::string text = row.asked ? format_emotions(*row.asked) : row.emotion;
    if (!spans.empty() && spans.back().emotion == text) {
      spans.back().end_s = row.phoneme.end_s;
      continue;
    }
    const std::string& heaviest = row.asked ? row.asked->heaviest.emotion : row.emotion;
    const std::string color = emotion_color(heaviest, table.find_emotion(heaviest).value_or(0));
    spans.push_back({row.phoneme.start_s, row.phoneme.end_s, text, color});
  }
  return spans;
}

} // namespace

bool needs_face(const SynthOptions& options) {
  return std::ranges::any_of(options.outputs, shows_face);
}

bool tells_runners_up(const SynthOptions& options) {
  return options.tells_result || std::ranges::any_of(options.outputs, [](const auto& path) {
           const OutputKind kind = output_kind(path);
           return kind == OutputKind::json || kind == OutputKind::text;
         });
}

void check_synth_options(const SynthOptions& options) {
  check_range("--fps", options.fps, 1.0, 1000.0);
  check_motion_options(options);
  check_range("--runners-up", options.runners_up, 0, 100);
  check_outputs_differ(options.outputs);
  check_transcript_stays(options);
  if (options.retime && !options.audio.empty() && !options.retime_with_audio) {
    throw UsageError({.where = "--retime",
                      .what = "does not go with --audio: the sound fixes the times",
                      .remedy = "Leave out the sound, or say --retime-with-audio."});
  }
  if (needs_face(options) && options.face.empty()) {
    throw UsageError({.what = "a .glb or .html output needs a face",
                      .remedy = "Name a mesh with --face: an .obj or .glb file, or the folder "
                                "that holds it."});
  }
}

SynthOutputs::SynthOutputs(const SynthOptions& options, SynthStock& stock,
                           std::vector<std::string>& notes)
    : options_(options), table_(stock.table()) {
  if (needs_face(options)) {
    if (table_.layout.kind != LayoutKind::markers) {
      throw InputError({.where = options.database.string(),
                        .what = "a database of blendshape weights cannot drive a mesh yet",
                        .remedy = "Write a .csv and apply it to the face's own shapes."});
    }
    face_ = &stock.face(options.face);
    notes.push_back(face_->note);
  }
  if (!options.audio.empty()) {
    wav_ = read_audio(options.audio).bytes;
  }
}

std::vector<std::filesystem::path> SynthOutputs::write(const SynthesisResult& result,
                                                       const std::string& result_json,
                                                       const std::string* csv) {
  OutputFiles files;
  for (const std::filesystem::path& path : options_.outputs) {
    if (options_.make_folders) {
      make_folder_of(path);
    }
    switch (output_kind(path)) {
    case OutputKind::csv:
      files.stage(path, csv != nullptr ? *csv : motion_text(result));
      break;
    case OutputKind::glb:
      files.stage(path, glb(result));
      break;
    case OutputKind::html:
      files.stage(path, html(result));
      break;
    case OutputKind::json:
      files.stage(path, result_json);
      break;
    case OutputKind::transcript:
      files.stage(path, xlabel_text(result.rows));
      break;
    case OutputKind::text:
      files.stage(path, explain_result(result_json, "result"));
      break;
    }
  }
  files.commit();
  return options_.outputs;
}

std::string SynthOutputs::motion_text(const SynthesisResult& result) const {
  return motion_csv_header(table_.layout) +
         motion_csv_rows(table_.layout, table_.pca, result.output, options_.head.has_value(), 0);
}

const std::string& SynthOutputs::glb(const SynthesisResult& result) {
  if (glb_.empty()) {
    glb_ = marker_face_glb(face_->face.mesh(), face_->morphs, result.output,
                           {.title = options_.transcript.stem().string(),
                            .credits = {"Motion of " + table_.speaker},
                            .synthetic = table_.synthetic});
  }
  return glb_;
}

std::string SynthOutputs::html(const SynthesisResult& result) {
  PlayerDocument document;
  document.title = options_.transcript.stem().string();
  document.duration_s = result.end_s;
  document.fps = result.output.rate_hz;
  document.glb = glb(result);
  document.wav = wav_;
  for (const PathRow& row : result.rows) {
    document.phonemes.push_back({.phoneme = row.phoneme.phoneme.name,
                                 .start_s = row.phoneme.start_s,
                                 .end_s = row.phoneme.end_s,
                                 .node = row.node == kNoNode ? "" : table_.key(row.node),
                                 .captured = row.captured,
                                 .observation_cost = row.cost.observation,
                                 .emotion_cost = row.cost.emotion,
                                 .transition_cost = row.cost.transition,
                                 .closure = asks_for_closure(row.phoneme.phoneme)});
  }
  document.emotions = emotion_spans(table_, result.rows);
  for (const auto& [name, vertex] : face_->face.landmarks()) {
    document.landmarks[name] = {.mesh = 0, .primitive = 0, .vertex = vertex};
  }
  document.credits = {"Motion of " + table_.speaker};
  document.synthetic = table_.synthetic;
  return player_html(document);
}

} // namespace phonomime
