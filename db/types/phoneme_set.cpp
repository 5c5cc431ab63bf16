// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/phoneme_set.h"

#include "corpora_schema/embedded.h"
#include "db/types/errors.h"
#include "db/types/json_file.h"
#include "db/types/text.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

using nlohmann::json;

constexpr std::string_view kSetFolder = "phoneme_sets/";
constexpr std::string_view kSetSuffix = ".json";
constexpr double kClosedGap_s = 1e-6;

Visibility visibility_of(std::string_view name) {
  return name == "high"  ? Visibility::high
         : name == "low" ? Visibility::low
                         : Visibility::intermediate;
}

// Keys, transcripts and filters are split at white space.
bool is_word(std::string_view text) {
  return std::ranges::none_of(text, [](char c) { return static_cast<unsigned char>(c) <= 0x20; });
}

} // namespace

PhonemeSet PhonemeSet::parse(std::string_view json_text, std::string_view where) {
  const json value = parse_json_as("phoneme_set", json_text, where);
  PhonemeSet set;
  set.name_ = value.at("name").get<std::string>();
  set.case_sensitive_ = value.value("case_sensitive", false);
  set.stress_digits_ = value.value("stress_digits", false);
  const auto refuse = [&](std::string what, std::string remedy) {
    throw InputError(
        {.where = std::string(where), .what = std::move(what), .remedy = std::move(remedy)});
  };
  const auto add_symbol = [&](const std::string& symbol, std::size_t phoneme) {
    if (!is_word(symbol)) {
      refuse(fmt::format("symbol {} holds white space or a control character", quoted(symbol)),
             "Labels are read without them.");
    }
    const bool added =
        set.index_
            .emplace(set.case_sensitive_ ? symbol : to_lower(symbol), static_cast<int>(phoneme))
            .second;
    if (!added) {
      refuse(fmt::format("symbol {} stands there twice", quoted(symbol)),
             set.case_sensitive_ ? "Name each symbol once."
                                 : "Name each symbol once; the set ignores case.");
    }
    set.symbols_.push_back(symbol);
  };
  set.phonemes_.push_back({.name = std::string(kSilence), .viseme = std::string(kSilence)});
  for (const json& symbol : value.at("silence")) {
    add_symbol(symbol.get_ref<const std::string&>(), 0);
  }
  for (const json& item : value.at("phonemes")) {
    Phoneme phoneme{.name = item.at("phoneme").get<std::string>(),
                    .viseme = item.at("viseme").get<std::string>(),
                    .visibility =
                        visibility_of(item.at("visibility").get_ref<const std::string&>())};
    if (!is_word(phoneme.name) || !is_word(phoneme.viseme)) {
      refuse(fmt::format("phoneme {} or its viseme holds white space", quoted(phoneme.name)), "");
    }
    if (std::ranges::find(set.phonemes_, phoneme.name, &Phoneme::name) != set.phonemes_.end()) {
      refuse(fmt::format("phoneme {} stands there twice", quoted(phoneme.name)),
             phoneme.name == kSilence ? "Silence is given by \"silence\" alone."
                                      : "Put all its symbols into one entry.");
    }
    for (const json& symbol : item.at("symbols")) {
      add_symbol(symbol.get_ref<const std::string&>(), set.phonemes_.size());
    }
    set.phonemes_.push_back(std::move(phoneme));
  }
  return set;
}

PhonemeSet PhonemeSet::built_in(std::string_view name) {
  const std::vector<std::string> names = built_in_names();
  if (std::ranges::find(names, name) == names.end()) {
    throw InputError({.what = fmt::format("there is no built-in phoneme set {}", quoted(name)),
                      .expected = fmt::format("one of {}", fmt::join(names, ", ")),
                      .remedy = did_you_mean(name, names)});
  }
  const std::string path = fmt::format("{}{}{}", kSetFolder, name, kSetSuffix);
  return parse(corpora_schema::embedded_file(path), path);
}

std::vector<std::string> PhonemeSet::built_in_names() {
  std::vector<std::string> names;
  for (std::string_view path : corpora_schema::embedded_files(kSetFolder)) {
    path.remove_prefix(kSetFolder.size());
    path.remove_suffix(kSetSuffix.size());
    names.emplace_back(path);
  }
  return names;
}

int PhonemeSet::find(std::string_view symbol) const {
  const std::string key = case_sensitive_ ? std::string(symbol) : to_lower(symbol);
  const auto found = index_.find(key);
  if (found != index_.end()) {
    return found->second;
  }
  if (!stress_digits_ || key.empty() || key.back() < '0' || key.back() > '2') {
    return -1;
  }
  // Stress is on phonemes: "sil1" and "0" are no names of silence.
  const auto unstressed = index_.find(std::string_view(key).substr(0, key.size() - 1));
  return unstressed == index_.end() || unstressed->second == 0 ? -1 : unstressed->second;
}

std::vector<TimedPhoneme> to_phonemes(const Alignment& alignment, const PhonemeSet& set) {
  std::vector<TimedPhoneme> phonemes;
  double end_s = 0.0;
  for (const AlignedLabel& row : alignment.rows) {
    const std::string where = row.line > 0 ? at_line(alignment.source, row.line) : alignment.source;
    const int index = set.find(row.label);
    if (index < 0) {
      throw InputError(
          {.where = where,
           .what = fmt::format("phoneme {} is not in set {}", quoted(row.label), set.name()),
           .remedy = did_you_mean(row.label, set.symbols())});
    }
    if (!(row.start_s >= end_s - kClosedGap_s && row.end_s >= row.start_s)) {
      throw InputError({.where = where,
                        .what = "times run backwards",
                        .expected = fmt::format("a start of at least {} s and an end after it",
                                                format_number(end_s)),
                        .got = fmt::format("{} s to {} s", format_number(row.start_s),
                                           format_number(row.end_s))});
    }
    if (row.end_s == row.start_s) {
      if (index == 0) {
        continue; // Festival ends a sentence that already ends in silence with such a row
      }
      throw InputError({.where = where,
                        .what = fmt::format("phoneme {} has no duration", quoted(row.label)),
                        .expected = fmt::format("an end after {} s", format_number(row.start_s)),
                        .got = format_number(row.end_s) + " s"});
    }
    double start_s = row.start_s;
    if (start_s - end_s >= kClosedGap_s) {
      phonemes.push_back({.phoneme = set.phonemes()[0], .start_s = end_s, .end_s = start_s});
    } else {
      start_s = end_s;
    }
    end_s = std::max(start_s, row.end_s);
    phonemes.push_back({.phoneme = set.phonemes()[static_cast<std::size_t>(index)],
                        .start_s = start_s,
                        .end_s = end_s});
  }
  return phonemes;
}

} // namespace phonomime
