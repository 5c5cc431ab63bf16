// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/borrowed_style.h"

#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "synth/style/contacts.h"
#include "tools/app/sha256.h"
#include "tools/app/style_models.h"

#include <algorithm>
#include <iterator>
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

// The mean of what a speaker says in an emotion: #dimensions; nothing where nothing is said in it.
std::optional<Eigen::VectorXd> mean_face(const MotionTable& table, const std::string& emotion) {
  const std::optional<std::int32_t> index = table.find_emotion(emotion);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(table.pca.dimension_count());
  double frames = 0.0;
  for (const MotionNode& node : table.nodes) {
    if (index && node.emotion == *index) {
      sum += table.coefficients.middleRows(node.first_frame, node.frame_count)
                 .cast<double>()
                 .colwise()
                 .sum()
                 .transpose();
      frames += node.frame_count;
    }
  }
  return frames > 0.0 ? std::optional<Eigen::VectorXd>(sum / frames) : std::nullopt;
}

// From the face of one speaker to that of another: as they speak neutrally, else as they rest.
Eigen::VectorXd between_faces(const MotionTable& from, const MotionTable& to,
                              const std::string& neutral) {
  const std::optional<Eigen::VectorXd> first = mean_face(from, neutral);
  const std::optional<Eigen::VectorXd> second = mean_face(to, neutral);
  return first && second
             ? Eigen::VectorXd(*second - *first)
             : to.pca.project(to.reference_pose) - from.pca.project(from.reference_pose);
}

// Of the other speakers' fresh models the first that knows the emotions.
std::optional<StyleInUse> borrow(const MotionDatabase& database, const MotionTable& table,
                                 const std::vector<std::string>& emotions,
                                 const std::string& where) {
  for (const std::string& speaker : database.speakers()) {
    if (speaker == table.speaker || !database.load_style_model(speaker)) {
      continue;
    }
    const MotionTable lender = database.load_motion_table(speaker);
    KeptStyle kept = load_style(database, lender, where);
    if (kept.state == StyleState::fresh && knows(kept.trained->model, emotions)) {
      StyleInUse lent{.model = std::move(kept.trained->model), .speaker = speaker};
      lent.model.to_own_face = between_faces(table, lender, lent.model.neutral);
      return lent;
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
    const StyleModel model = require_style(database, table, path.string());
    std::vector<std::string> unknown;
    std::ranges::copy_if(emotions, std::back_inserter(unknown),
                         [&](const std::string& emotion) { return !knows(model, {emotion}); });
    throw InputError(
        {.where = path.string(),
         .what = fmt::format("the style model of {} does not know {}, and no other does that could "
                             "lend it",
                             table.speaker, fmt::join(unknown, ", ")),
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
