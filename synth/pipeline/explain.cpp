// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/pipeline/explain.h"

#include "db/types/json_file.h"
#include "db/types/phoneme_set.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

std::string join_word(const nlohmann::json& row, bool first) {
  if (row["node"].is_null()) {
    return "rest";
  }
  if (row["phoneme"].get_ref<const std::string&>() == kSilence && !row["constrained"].get<bool>()) {
    return "pause";
  }
  if (row["captured"].get<bool>()) {
    return "captured";
  }
  return first ? "start" : "joined";
}

// The terms beyond the paper's; a result of an earlier version has none.
double fit_cost(const nlohmann::json& cost) {
  double sum = 0.0;
  for (const char* term : {"target", "context", "duration", "position"}) {
    sum += cost.value(term, 0.0);
  }
  return sum;
}

std::string runners_up_text(const nlohmann::json& row) {
  std::string text;
  for (const nlohmann::json& other : row["runners_up"]) {
    text += fmt::format("{}{} (+{:.0f})", text.empty() ? "" : ", ",
                        other["node"].get<std::string>(), other["delta"].get<double>());
  }
  return text;
}

// What is shown: by the style model, else as the search was asked.
std::string emotion_text(const nlohmann::json& row) {
  return row.value("asked", row["emotion"].get<std::string>());
}

std::size_t longest_key(const nlohmann::json& path) {
  std::size_t longest = 4;
  for (const nlohmann::json& row : path) {
    if (row["node"].is_string()) {
      longest = std::max(longest, row["node"].get_ref<const std::string&>().size());
    }
  }
  return longest;
}

std::string totals(const nlohmann::json& result) {
  double observation = 0.0, emotion = 0.0, fit = 0.0, transition = 0.0;
  int phonemes = 0, joins = 0, captured = 0;
  bool first = true;
  for (const nlohmann::json& row : result["path"]) {
    observation += row["cost"]["observation"].get<double>();
    emotion += row["cost"]["emotion"].get<double>();
    fit += fit_cost(row["cost"]);
    transition += row["cost"]["transition"].get<double>();
    phonemes += row["phoneme"].get_ref<const std::string&>() == kSilence ? 0 : 1;
    if (!row["node"].is_null()) {
      joins += first ? 0 : 1;
      captured += row["captured"].get<bool>() ? 1 : 0;
      first = false;
    }
  }
  const std::size_t others = result.value("blend", nlohmann::json::array()).size();
  const std::string blended =
      others == 0 ? "" : fmt::format("; {} more paths are blended with this one", others);
  return fmt::format("{} sounding phonemes: cost {:.1f} = observation {:.1f} + emotion {:.1f} + "
                     "fit {:.1f} + transition {:.1f}, {} of {} joins between chosen nodes as "
                     "recorded{}\n",
                     phonemes, result["cost"].get<double>(), observation, emotion, fit, transition,
                     captured, joins, blended);
}

} // namespace

std::string explain_result(std::string_view json_text, std::string_view where) {
  const nlohmann::json result = parse_json_as("result", json_text, where);
  const nlohmann::json& path = result["path"];
  const std::size_t width = longest_key(path);
  std::string text = totals(result);
  text += fmt::format(
      "{:>3}  {:>7}  {:>7}  {:<4}  {:<10}  {:<{}}  {:<8}  {:>8}  {:>8}  {:>7}  {:>10}  {}\n", "row",
      "start", "end", "ph", "emotion", "node", width, "join", "phoneme", "emotion", "fit",
      "transition", "runners-up (what they would cost more)");
  bool first = true;
  for (const nlohmann::json& row : path) {
    const bool has_node = row["node"].is_string();
    const std::string node = has_node ? row["node"].get<std::string>() : "-";
    text += fmt::format(
        "{:>3}  {:>7.3f}  {:>7.3f}  {:<4}  {:<10}  {:<{}}  {:<8}  {:>8.1f}  {:>8.1f}  "
        "{:>7.1f}  {:>10.1f}  {}",
        row["index"].get<long>(), row["start"].get<double>(), row["end"].get<double>(),
        row["phoneme"].get<std::string>(), emotion_text(row), node, width, join_word(row, first),
        row["cost"]["observation"].get<double>(), row["cost"]["emotion"].get<double>(),
        fit_cost(row["cost"]), row["cost"]["transition"].get<double>(), runners_up_text(row));
    text.erase(text.find_last_not_of(' ') + 1);
    text += row["constrained"].get<bool>() ? "  [use]\n" : "\n";
    first = first && !has_node;
  }
  if (result.contains("style")) {
    const nlohmann::json& style = result["style"];
    text += style_to_text({.contacts = style["contacts"].get<int>(),
                           .contacts_moved = style["contacts_moved"].get<int>(),
                           .contacts_left = style["contacts_left"].get<int>(),
                           .change = style["change"].get<double>()}) +
            "\n";
  }
  for (const nlohmann::json& warning : result["warnings"]) {
    text += "warning: " + warning.get<std::string>() + "\n";
  }
  return text;
}

std::string style_to_text(const StyleOutcome& style) {
  return fmt::format(
      "style: changed by {:.2f} (root mean square, mm a marker or weight); contacts of "
      "the lips: {}, of which {} had to be mended, {} could not be",
      style.change, style.contacts, style.contacts_moved, style.contacts_left);
}

} // namespace phonomime
