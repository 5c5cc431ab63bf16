// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/report_json.h"

#include "tools/evaluate/report.h"

#include <array>

#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 5> kAimNames = {"small", "large", "near 1", "near 0",
                                                       "none"};

Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json to_json(const MeasureValues& values) {
  Json json = Json::object();
  for (const Measure measure : all_measures()) {
    json[std::string(info(measure).id)] = number(values[measure]);
  }
  return json;
}

Json to_json(const std::array<Summary, kMeasureCount>& summaries) {
  Json json = Json::object();
  for (const Measure measure : all_measures()) {
    const Summary& summary = summaries[static_cast<std::size_t>(measure)];
    json[std::string(info(measure).id)] = {{"mean", number(summary.mean)},
                                           {"standard_error", number(summary.standard_error)},
                                           {"sentences", summary.sentences},
                                           {"pooled", number(summary.pooled)}};
  }
  return json;
}

Json measures_to_json(LayoutKind kind) {
  Json json = Json::array();
  for (const Measure measure : all_measures()) {
    const MeasureInfo& row = info(measure);
    json.push_back({{"id", row.id},
                    {"label", row.label},
                    {"unit", unit_of(measure, kind)},
                    {"aim", kAimNames.at(static_cast<std::size_t>(row.aim))},
                    {"decimals", row.decimals},
                    {"formula", row.formula},
                    {"mask", row.mask}});
  }
  return json;
}

Json sentences_to_json(const MethodResult& method, const MethodTables& tables) {
  Json json = Json::array();
  for (std::size_t i = 0; i < method.sentences.size(); ++i) {
    const SentenceMeasures& sentence = method.sentences[i];
    json.push_back({{"key", sentence.key},
                    {"emotion", sentence.emotion},
                    {"fold", method.folds.empty() ? Json(nullptr) : Json(method.folds[i])},
                    {"frames", sentence.frame_count},
                    {"measured_frames", sentence.sums.frames},
                    {"values", to_json(tables.sentences.at(i))}});
  }
  return json;
}

Json method_to_json(const Layout& layout, const MethodResult& method, const MethodTables& tables,
                    bool with_sentences) {
  Json json;
  json["id"] = method.id;
  json["description"] = method.description;
  json["sees_recording"] = method.sees_recording;
  json["total_error"] = tables.total_error;
  json["measures"] = to_json(tables.all);
  json["emotions"] = Json::object();
  for (const auto& [emotion, summaries] : tables.by_emotion) {
    json["emotions"][emotion] = to_json(summaries);
  }
  json["folds"] = Json::object();
  for (const auto& [fold, summaries] : tables.by_fold) {
    json["folds"][std::to_string(fold)] = to_json(summaries);
  }
  json["phonemes"] = Json::object();
  for (const auto& [phoneme, values] : tables.by_phoneme) {
    json["phonemes"][phoneme] = {{"frames", tables.phoneme_frames.at(phoneme)},
                                 {"values", to_json(values)}};
  }
  json["regions"] = Json::object();
  for (std::size_t r = 0; r < kRegionNames.size(); ++r) {
    json["regions"][std::string(kRegionNames[r])] = number(tables.region_rmse[r]);
  }
  json["groups"] = Json::object();
  for (std::size_t g = 0; g < layout.groups.size(); ++g) {
    json["groups"][layout.groups[g].name] = number(tables.marker_rmse.at(g));
  }
  if (with_sentences) {
    json["sentences"] = sentences_to_json(method, tables);
  }
  return json;
}

Json sizes_to_json(const std::vector<SizePoint>& sizes) {
  Json json = Json::array();
  for (const SizePoint& size : sizes) {
    json.push_back({{"sentences", size.sentences},
                    {"nodes", size.nodes},
                    {"diphone_coverage", size.diphone_coverage},
                    {"triphone_coverage", size.triphone_coverage},
                    {"search_seconds", size.search_s},
                    {"measures", to_json(size.quality)}});
  }
  return json;
}

Json emotions_to_json(const EmotionFindings& findings) {
  Json json;
  json["trials"] = Json::array();
  for (const EmotionTrial& trial : findings.trials) {
    json["trials"].push_back({{"id", trial.id},
                              {"description", trial.description},
                              {"sentences", trial.sentences},
                              {"recognised", trial.recognised},
                              {"share", number(trial.share())},
                              {"share_by_movement_too", number(trial.share_moving())},
                              {"closure_recall", number(trial.closures)},
                              {"taken_for", trial.taken_for}});
  }
  json["closures"] = {{"pairs", findings.closure_pairs},
                      {"change", number(findings.closure_change)},
                      {"standard_error", number(findings.closure_change_error)},
                      {"p", findings.closure_p}};
  return json;
}

Json comparison_to_json(const Comparison& comparison) {
  Json json;
  json["against"] = comparison.source;
  json["held_out_by"] = comparison.earlier_held_out_by;
  json["notes"] = comparison.notes;
  json["methods"] = Json::array();
  for (const MethodComparison& method : comparison.methods) {
    Json measures = Json::object();
    for (const MeasureComparison& one : method.measures) {
      Json& measure = measures[std::string(info(one.measure).id)];
      measure = {{"sentences", one.sentences},
                 {"mean", one.mean},
                 {"earlier_mean", one.earlier_mean},
                 {"difference", one.difference}};
      if (one.verdict != Verdict::not_compared) {
        measure["better"] = one.better;
        measure["worse"] = one.worse;
        measure["p"] = one.p_value;
        measure["adjusted_p"] = one.adjusted_p;
        measure["verdict"] = verdict_name(one.verdict);
      }
    }
    json["methods"].push_back({{"method", method.method},
                               {"earlier_method", method.earlier_method},
                               {"sentences", method.sentences},
                               {"measures", std::move(measures)}});
  }
  return json;
}

} // namespace

Json report_json(const Evaluation& evaluation, const std::optional<Comparison>& comparison,
                 bool with_sentences) {
  const RunInfo& run = evaluation.run;
  Json json;
  json["format"] = "phonomime-evaluation";
  json["version"] = 1;
  json["corpus"] = run.corpus;
  json["held_out_by"] = run.held_out_by;
  json["folds"] = run.folds;
  json["seed"] = run.seed;
  json["rate"] = run.rate_hz;
  json["sentences"] = evaluation.methods.front().sentences.size();
  json["left_out"] = run.left_out;
  json["options"] = run.options;
  json["notes"] = run.notes;
  json["layout"] = {{"kind", evaluation.layout.kind == LayoutKind::markers ? "markers" : "weights"},
                    {"groups", evaluation.layout.group_count()}};
  json["main_method"] = evaluation.methods[main_method_index(evaluation)].id;
  json["measures"] = measures_to_json(evaluation.layout.kind);
  json["contact_ranges"] = Json::object();
  for (const auto& [phoneme, range] : evaluation.contact_ranges) {
    json["contact_ranges"][phoneme] = {
        {"low", range.low_mm}, {"high", range.high_mm}, {"rows", range.rows}};
  }
  json["methods"] = Json::array();
  for (std::size_t m = 0; m < evaluation.methods.size(); ++m) {
    json["methods"].push_back(method_to_json(evaluation.layout, evaluation.methods[m],
                                             evaluation.tables.at(m), with_sentences));
  }
  json["sizes"] = sizes_to_json(evaluation.sizes);
  json["emotion_recognition"] =
      evaluation.emotions ? emotions_to_json(*evaluation.emotions) : Json(nullptr);
  json["comparison"] = comparison ? comparison_to_json(*comparison) : Json(nullptr);
  return json;
}

Json evaluation_json(const Evaluation& evaluation, const std::optional<Comparison>& comparison) {
  return report_json(evaluation, comparison, true);
}

} // namespace phonomime
