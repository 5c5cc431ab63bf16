// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/borrowed_style.h"

#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "synth/style/contacts.h"
#include "tools/app/sha256.h"
#include "tools/app/style_models.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

bool knows(const StyleModel& model, const std::vector<std::string>& emotions) {
  return std::ranges::all_of(emotions, [&](const std::string& emotion) {
    return std::ranges::find(model.known.styles, emotion) != model.known.styles.end();
  });
}

// Of the other speakers' fresh models the first that knows the emotions.
std::optional<StyleInUse> borrow(const MotionDatabase& database, const MotionTable& table,
                                 const std::vector<std::string>& emotions,
                                 const std::string& where) {
  for (const std::string& speaker : database.speakers()) {
    if (speaker == table.speaker || !database.load_style_model(speaker)) {
      continue;
    }
    KeptStyle kept = load_style(database, database.load_motion_table(speaker), where);
    if (kept.state == StyleState::fresh && knows(kept.trained->model, emotions)) {
      return StyleInUse{.model = std::move(kept.trained->model), .speaker = speaker};
    }
  }
  return std::nullopt;
}

} // namespace

StyleInUse find_style_model(const std::filesystem::path& path, const MotionTable& table,
                            const std::vector<std::string>& emotions) {
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  KeptStyle own = load_style(database, table, path.string());
  if (own.state == StyleState::fresh && knows(own.trained->model, emotions)) {
    return {.model = std::move(own.trained->model), .speaker = table.speaker};
  }
  std::optional<StyleInUse> borrowed = borrow(database, table, emotions, path.string());
  if (!borrowed) {
    StyleModel model = require_style(database, table, path.string());
    throw InputError(
        {.where = path.string(),
         .what = fmt::format("no style model of its speakers knows {}", fmt::join(emotions, ", ")),
         .expected = fmt::format("some of {}", fmt::join(model.known.styles, ", ")),
         .remedy = "`phonomime style train` takes the emotions that a speaker recorded."});
  }
  if (const auto aperture = CoefficientAperture::of(table.layout, table.pca)) {
    borrowed->model.contacts = recorded_contacts(table, *aperture);
  }
  return *std::move(borrowed);
}

std::string style_models_fingerprint(const std::filesystem::path& path) {
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  Sha256 hash;
  bool any = false;
  for (const std::string& speaker : database.speakers()) {
    if (const auto stored = database.load_style_model(speaker)) {
      any = true;
      hash.add(fmt::format("{}\n{}\n{}\n", speaker, stored->made_of, stored->trained_json));
      for (const auto& [name, matrix] : stored->matrices) {
        hash.add(fmt::format("{} {} {}\n", name, matrix.rows(), matrix.cols()));
        hash.add({reinterpret_cast<const char*>(matrix.data()),
                  static_cast<std::size_t>(matrix.size()) * sizeof(double)});
      }
    }
  }
  return any ? hash.hex() : std::string();
}

} // namespace phonomime
