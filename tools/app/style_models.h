// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/motion_database.h"
#include "db/types/progress.h"
#include "synth/style/style_model.h"

#include <filesystem>
#include <optional>
#include <string>

namespace phonomime {

// Whether a speaker's style models are stored, and belong to the recordings as they are now.
enum class StyleState { fresh, stale, missing };
const char* style_state_name(StyleState state);

// What style models are made of: the speaker's recordings in use, the layout and the PCA. A pruned
// or restored node, an import or another PCA give another fingerprint.
std::string style_fingerprint(const MotionTable& table);

// Style models as the database keeps them, and back. A model that cannot be one (its parts do not
// fit each other) is an InputError, with `where`.
StoredStyleModel to_stored(const MotionTable& table, const TrainedStyle& trained);
TrainedStyle from_stored(const StoredStyleModel& stored, const std::string& where);

// What a database has for a speaker.
struct KeptStyle {
  StyleState state = StyleState::missing;
  std::optional<TrainedStyle> trained; // unless missing
};
KeptStyle load_style(const MotionDatabase& database, const MotionTable& table,
                     const std::string& where);

// The model alone, for use. Throws InputError, which says what to do, unless there is a fresh one.
StyleModel require_style(const MotionDatabase& database, const MotionTable& table,
                         const std::string& where);

struct StyleTrainOptions {
  std::filesystem::path database;
  std::string speaker; // may be empty where there is only one
  StyleOptions style;
};

// A speaker's style models, for people.
struct StyleReport {
  std::string speaker;
  StyleState state = StyleState::missing;
  TrainedStyle trained;
  std::string trained_json;              // as the database keeps it
  std::string unit;                      // "mm a marker" or "a weight"
  double reconstruction = 0.0;           // root mean square of what the model leaves, in that unit
  std::optional<double> translation;     // likewise, of sentences left out, between all styles
  std::optional<double> mean_difference; // the same by adding the styles' mean difference
  std::optional<double> unchanged;       // and by changing nothing
};

// Trains and stores, in the place of what there was. Throws UsageError, InputError (fewer than two
// emotions, no sentence in all of them), IoError and Interrupted; then the database is as it was.
StyleReport train_style_models(const StyleTrainOptions& options, const Progress& progress);

// Throws InputError where there are none.
StyleReport show_style_models(const std::filesystem::path& database, const std::string& speaker);

} // namespace phonomime
