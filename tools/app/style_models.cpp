// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/style_models.h"

#include "db/types/errors.h"
#include "tools/app/fingerprint.h"
#include "tools/app/option_checks.h"
#include "tools/app/sha256.h"

#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

using Json = nlohmann::ordered_json;

// Changes whenever the same recordings would give other models.
constexpr std::string_view kMethod = "style models 1";

constexpr const char* kChannels = "channels";
constexpr const char* kCoefficients = "coefficients";
constexpr const char* kKnownBases = "known_bases";
constexpr const char* kKnownContent = "known_mean_content";
constexpr const char* kSpectrum = "known_spectrum";
constexpr const char* kUnknownBases = "unknown_bases";
constexpr const char* kUnknownContent = "unknown_mean_content";
constexpr const char* kExpressions = "unknown_expressions";

Json choice_to_json(const Choice& choice) {
  const auto& [content_size, ridge, error] = choice;
  return {{"content_size", content_size}, {"ridge", ridge}, {"error", error}};
}

Choice choice_from_json(const Json& json) {
  return {.content_size = json.at("content_size"),
          .ridge = json.at("ridge"),
          .error = json.at("error")};
}

Json chosen_to_json(const ChosenDimensions& chosen) {
  const auto& [best, tried, unchanged, mean_difference] = chosen;
  Json json{{"best", choice_to_json(best)},
            {"unchanged_error", unchanged},
            {"mean_difference_error", mean_difference},
            {"tried", Json::array()}};
  for (const Choice& choice : tried) {
    json["tried"].push_back(choice_to_json(choice));
  }
  return json;
}

ChosenDimensions chosen_from_json(const Json& json) {
  ChosenDimensions chosen{.best = choice_from_json(json.at("best")),
                          .unchanged_error = json.at("unchanged_error"),
                          .mean_difference_error = json.at("mean_difference_error")};
  for (const Json& choice : json.at("tried")) {
    chosen.tried.push_back(choice_from_json(choice));
  }
  return chosen;
}

Json choice_to_json(const UnknownChoice& choice) {
  const auto& [style_size, content_size, found, windows, error] = choice;
  return {{"style_size", style_size},
          {"content_size", content_size},
          {"found", found},
          {"windows", windows},
          {"error", error}};
}

UnknownChoice unknown_choice_from_json(const Json& json) {
  return {.style_size = json.at("style_size"),
          .content_size = json.at("content_size"),
          .found = json.at("found"),
          .windows = json.at("windows"),
          .error = json.at("error")};
}

Json chosen_to_json(const ChosenUnknown& chosen) {
  const auto& [best, tried] = chosen;
  Json json{{"best", choice_to_json(best)}, {"tried", Json::array()}};
  for (const UnknownChoice& choice : tried) {
    json["tried"].push_back(choice_to_json(choice));
  }
  return json;
}

ChosenUnknown chosen_unknown_from_json(const Json& json) {
  ChosenUnknown chosen{.best = unknown_choice_from_json(json.at("best"))};
  for (const Json& choice : json.at("tried")) {
    chosen.tried.push_back(unknown_choice_from_json(choice));
  }
  return chosen;
}

// Members are named one by one, so that one that is added is not forgotten here.
Json model_to_json(const StyleModel& model) {
  const auto& [neutral, vectors, bundle, ridge, known, unknown, contacts, valid, lent] = model;
  Json json{{"neutral", neutral},
            {"styles", known.styles},
            {"vectors", vectors == StyleVectors::channels ? kChannels : kCoefficients},
            {"bundle", bundle},
            {"ridge", ridge},
            {"vector_size", known.vector_size},
            {"content_size", known.content_size()},
            {"residual", known.residual},
            {"unknown",
             {{"style_size", unknown.style_size()},
              {"content_size", unknown.content_size()},
              {"convergence", unknown.convergence},
              {"converged", unknown.converged}}},
            {"contacts", Json::object()},
            {"valid", Json::object()}};
  for (const auto& [phoneme, range] : contacts) {
    json["contacts"][phoneme] = {range.least_mm, range.most_mm};
  }
  for (const ValidRange& range : valid) {
    json["valid"][range.emotion] = range.largest_intensity;
  }
  return json;
}

StyleModel model_from_json(const Json& json) {
  StyleModel model{.neutral = json.at("neutral"),
                   .vectors = json.at("vectors") == kCoefficients ? StyleVectors::coefficients
                                                                  : StyleVectors::channels,
                   .bundle = json.at("bundle"),
                   .ridge = json.at("ridge")};
  model.known.styles = model.unknown.styles = json.at("styles").get<std::vector<std::string>>();
  model.known.vector_size = model.unknown.vector_size = json.at("vector_size");
  model.known.residual = json.at("residual");
  model.unknown.convergence = json.at("unknown").at("convergence").get<std::vector<double>>();
  model.unknown.converged = json.at("unknown").at("converged");
  for (const auto& [phoneme, range] : json.at("contacts").items()) {
    model.contacts[phoneme] = {.least_mm = range.at(0), .most_mm = range.at(1)};
  }
  for (const auto& [emotion, intensity] : json.at("valid").items()) {
    model.valid.push_back({.emotion = emotion, .largest_intensity = intensity});
  }
  return model;
}

Json trained_to_json(const TrainedStyle& trained) {
  const auto& [model, chosen, chosen_unknown, sentences, nodes, nodes_left_out, columns,
               not_aligned] = trained;
  Json json{{"format", "phonomime-style"},
            {"version", 1},
            {"model", model_to_json(model)},
            {"chosen", chosen ? chosen_to_json(*chosen) : Json()},
            {"chosen_unknown", chosen_unknown ? chosen_to_json(*chosen_unknown) : Json()},
            {"sentences", sentences},
            {"nodes", nodes},
            {"nodes_left_out", nodes_left_out},
            {"columns", columns},
            {"not_aligned", Json::array()}};
  for (const NotAligned& one : not_aligned) {
    json["not_aligned"].push_back({{"sentence", one.sentence}, {"reason", one.reason}});
  }
  return json;
}

TrainedStyle trained_from_json(const Json& json) {
  TrainedStyle trained{.model = model_from_json(json.at("model")),
                       .sentences = json.at("sentences").get<std::vector<std::string>>(),
                       .nodes = json.at("nodes"),
                       .nodes_left_out = json.at("nodes_left_out"),
                       .columns = json.at("columns")};
  if (!json.at("chosen").is_null()) {
    trained.chosen = chosen_from_json(json.at("chosen"));
  }
  if (!json.at("chosen_unknown").is_null()) {
    trained.chosen_unknown = chosen_unknown_from_json(json.at("chosen_unknown"));
  }
  for (const Json& one : json.at("not_aligned")) {
    trained.not_aligned.push_back({.sentence = one.at("sentence"), .reason = one.at("reason")});
  }
  return trained;
}

// The matrices of a model, each of the size that the others give it.
bool fits(const StyleModel& model) {
  const AsymmetricModel& known = model.known;
  const SymmetricModel& unknown = model.unknown;
  const Eigen::Index styles = known.style_count();
  const bool has_neutral =
      std::ranges::find(known.styles, model.neutral) != known.styles.end() && styles >= 2;
  return has_neutral && model.bundle >= 1 && model.bundle % 2 == 1 && model.ridge >= 0.0 &&
         known.vector_size >= 1 && known.bases.rows() == styles * known.vector_size &&
         known.mean_content.size() == known.bases.cols() && unknown.expressions.cols() == styles &&
         unknown.bases.rows() == unknown.expressions.rows() * known.vector_size &&
         unknown.mean_content.size() == unknown.bases.cols();
}

[[noreturn]] void throw_damaged(const std::string& where, const std::string& speaker,
                                const std::string& got) {
  throw InputError({.where = where,
                    .what = fmt::format("the style model of {} is damaged", speaker),
                    .got = got,
                    .remedy = "`phonomime style train` makes a new one."});
}

const Eigen::MatrixXd& matrix(const StoredStyleModel& stored, const char* name) {
  return stored.matrices.at(name); // throws std::out_of_range
}

// Root mean squares of numbers of a frame's vector as that of a marker or weight.
class Unit {
public:
  explicit Unit(const MotionTable& table)
      : groups_(table.layout.group_count()),
        name_(table.layout.kind == LayoutKind::markers ? "mm a marker" : "a weight") {}
  double of(double error, Eigen::Index numbers) const {
    return error * std::sqrt(static_cast<double>(numbers) / groups_);
  }
  const std::string& name() const { return name_; }

private:
  double groups_;
  std::string name_;
};

StyleReport report_of(const MotionTable& table, StyleState state, TrainedStyle trained) {
  const Unit unit(table);
  const Eigen::Index dimensions = table.pca.dimension_count();
  StyleReport report{.speaker = table.speaker,
                     .state = state,
                     .trained_json = trained_to_json(trained).dump(),
                     .unit = unit.name(),
                     .reconstruction = unit.of(trained.model.known.residual, dimensions + 1)};
  if (trained.chosen) {
    report.translation = unit.of(trained.chosen->best.error, dimensions);
    report.mean_difference = unit.of(trained.chosen->mean_difference_error, dimensions);
    report.unchanged = unit.of(trained.chosen->unchanged_error, dimensions);
  }
  report.trained = std::move(trained);
  return report;
}

std::string train_call(const std::string& where, const std::string& speaker) {
  return fmt::format("`phonomime style train {} --speaker {}`", where, speaker);
}

} // namespace

const char* style_state_name(StyleState state) {
  switch (state) {
  case StyleState::fresh:
    return "fresh";
  case StyleState::stale:
    return "stale";
  case StyleState::missing:
    break;
  }
  return "missing";
}

std::string style_fingerprint(const MotionTable& table) {
  return sha256(fmt::format("{}\n{}", kMethod, fingerprint(table)));
}

StoredStyleModel to_stored(const MotionTable& table, const TrainedStyle& trained) {
  const StyleModel& model = trained.model;
  return {.speaker = table.speaker,
          .made_of = style_fingerprint(table),
          .trained_json = trained_to_json(trained).dump(),
          .matrices = {{kKnownBases, model.known.bases},
                       {kKnownContent, model.known.mean_content},
                       {kSpectrum, model.known.spectrum},
                       {kUnknownBases, model.unknown.bases},
                       {kUnknownContent, model.unknown.mean_content},
                       {kExpressions, model.unknown.expressions}}};
}

TrainedStyle from_stored(const StoredStyleModel& stored, const std::string& where) {
  TrainedStyle trained;
  try {
    trained = trained_from_json(Json::parse(stored.trained_json));
    StyleModel& model = trained.model;
    model.known.bases = matrix(stored, kKnownBases);
    model.known.mean_content = matrix(stored, kKnownContent).reshaped();
    model.known.spectrum = matrix(stored, kSpectrum).reshaped();
    model.unknown.bases = matrix(stored, kUnknownBases);
    model.unknown.mean_content = matrix(stored, kUnknownContent).reshaped();
    model.unknown.expressions = matrix(stored, kExpressions);
  } catch (const nlohmann::json::exception& error) {
    throw_damaged(where, stored.speaker, error.what());
  } catch (const std::out_of_range&) {
    throw_damaged(where, stored.speaker, "a matrix is missing");
  }
  if (!fits(trained.model)) {
    throw_damaged(where, stored.speaker, "matrices that do not fit each other");
  }
  return trained;
}

KeptStyle load_style(const MotionDatabase& database, const MotionTable& table,
                     const std::string& where) {
  const std::optional<StoredStyleModel> stored = database.load_style_model(table.speaker);
  KeptStyle kept;
  if (stored) {
    kept.state =
        stored->made_of == style_fingerprint(table) ? StyleState::fresh : StyleState::stale;
    kept.trained = from_stored(*stored, where);
  }
  return kept;
}

StyleModel require_style(const MotionDatabase& database, const MotionTable& table,
                         const std::string& where) {
  KeptStyle kept = load_style(database, table, where);
  if (kept.state == StyleState::missing) {
    throw InputError({.where = where,
                      .what = "there is no style model of speaker " + table.speaker,
                      .remedy = "Train one: " + train_call(where, table.speaker) + "."});
  }
  if (kept.state == StyleState::stale) {
    throw InputError({.where = where,
                      .what = fmt::format("the style model of speaker {} is stale: it was trained "
                                          "on other recordings than the database has now",
                                          table.speaker),
                      .remedy = "Train it anew: " + train_call(where, table.speaker) + "."});
  }
  return std::move(kept.trained->model);
}

StyleReport train_style_models(const StyleTrainOptions& options, const Progress& progress) {
  options.style.validate();
  check_range("--threads", options.style.threads, 0, 256);
  // Read first: what is opened for writing is made where it is not there.
  const MotionTable table = MotionDatabase::open(options.database, OpenMode::read_only)
                                .load_motion_table(options.speaker);
  TrainedStyle trained = train_style(table, options.style, progress);
  MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_write);
  database.save_style_model(to_stored(table, trained));
  return report_of(table, StyleState::fresh, std::move(trained));
}

StyleReport show_style_models(const std::filesystem::path& path, const std::string& speaker) {
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  const MotionTable table = database.load_motion_table(speaker);
  KeptStyle kept = load_style(database, table, path.string());
  if (!kept.trained) {
    throw InputError({.where = path.string(),
                      .what = "there is no style model of speaker " + table.speaker,
                      .remedy = "Train one: " + train_call(path.string(), table.speaker) + "."});
  }
  return report_of(table, kept.state, *std::move(kept.trained));
}

} // namespace phonomime
