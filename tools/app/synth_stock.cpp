// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/synth_stock.h"

#include "db/store/motion_database.h"
#include "synth/search/cost_weights.h"
#include "tools/app/style_models.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

std::string face_note(const MarkerFace& face, const PcaModel& pca) {
  std::string note =
      fmt::format("face {}: {} vertices", face.mesh().source, face.mesh().skin_vertex_count());
  if (face.report().automatic_markers) {
    note += ", markers placed by their numbers";
  }
  if (!face.report().missing_markers.empty()) {
    note += fmt::format(", without markers {}", fmt::join(face.report().missing_markers, " "));
  }
  if (const std::optional<double> share = face.aperture_share(pca)) {
    note += fmt::format(", keeps {:.0f} % of the lips' opening", 100.0 * *share);
  }
  return note;
}

} // namespace

SynthStock::SynthStock(MotionTable table, std::filesystem::path database)
    : table_(std::move(table)), database_(std::move(database)) {}

const StyleInUse* SynthStock::style(const std::vector<std::string>& emotions) {
  std::vector<std::string> names = emotions;
  std::ranges::sort(names);
  const std::scoped_lock lock(mutex_);
  auto known = styles_.find(names);
  if (known == styles_.end()) {
    StyleInUse found = find_style_model(database_, table_, names);
    known = styles_.emplace(std::move(names), std::move(found)).first;
  }
  return &known->second;
}

bool SynthStock::style_is_missing() const {
  return !MotionDatabase::open(database_, OpenMode::read_only).load_style_model(table_.speaker);
}

bool SynthStock::any_style_knows(const std::string& emotion) const {
  const MotionDatabase database = MotionDatabase::open(database_, OpenMode::read_only);
  return std::ranges::any_of(database.speakers(), [&](const std::string& speaker) {
    const std::optional<StoredStyleModel> stored = database.load_style_model(speaker);
    if (!stored) {
      return false;
    }
    const TrainedStyle trained = from_stored(*stored, database_.string());
    return std::ranges::find(trained.model.known.styles, emotion) !=
           trained.model.known.styles.end();
  });
}

const CostWeights& SynthStock::default_weights(CostModel model) {
  const std::scoped_lock lock(mutex_);
  const auto known = default_weights_.find(model);
  return known != default_weights_.end()
             ? known->second
             : default_weights_.emplace(model, default_cost_weights(table_, model)).first->second;
}

const FittedFace& SynthStock::face(const std::filesystem::path& path) {
  const std::scoped_lock lock(mutex_);
  const auto known = faces_.find(path);
  if (known != faces_.end()) {
    return known->second;
  }
  MarkerFace face(read_face(path, table_.layout), table_.layout, table_.reference_pose);
  MorphTargets morphs = face.morphs(table_.pca);
  std::string note = face_note(face, table_.pca);
  return faces_
      .emplace(
          path,
          FittedFace{.face = std::move(face), .morphs = std::move(morphs), .note = std::move(note)})
      .first->second;
}

ViterbiSearch& SearchKeeper::search(const MotionTable& table, const CostWeights& weights) {
  // Weights are the same where their files are.
  std::string file = format_cost_weights(weights);
  if (table_ != &table || weights_ != file) {
    search_.reset(); // two at a time would need twice the memory
    search_ = std::make_unique<ViterbiSearch>(table, weights);
    table_ = &table;
    weights_ = std::move(file);
  }
  return *search_;
}

} // namespace phonomime
