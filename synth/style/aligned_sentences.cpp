// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/aligned_sentences.h"

#include "db/types/errors.h"
#include "synth/style/align_phonemes.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

constexpr const char* kWhere = "training data of styles";

std::string list_of(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<std::string> chosen_styles(const MotionTable& table, const TrainingOptions& options) {
  std::vector<std::string> styles = options.styles;
  if (styles.empty()) {
    for (std::size_t e = 0; e < table.emotions.size(); ++e) {
      if (std::ranges::any_of(table.nodes, [&](const MotionNode& node) {
            return node.emotion == static_cast<std::int32_t>(e);
          })) {
        styles.push_back(table.emotions[e]);
      }
    }
  }
  for (const std::string& style : styles) {
    if (std::ranges::find(table.emotions, style) == table.emotions.end()) {
      throw InputError({.where = kWhere,
                        .what = "there is no recording of the emotion " + style,
                        .expected = list_of(table.emotions)});
    }
  }
  if (std::ranges::find(styles, options.reference) == styles.end()) {
    throw InputError({.where = kWhere,
                      .what = "the neutral style is none of the styles",
                      .expected = list_of(styles),
                      .got = options.reference});
  }
  if (std::set<std::string>(styles.begin(), styles.end()).size() != styles.size()) {
    throw InputError({.where = kWhere, .what = "a style is named twice", .got = list_of(styles)});
  }
  if (styles.size() < 2) {
    throw InputError({.where = kWhere,
                      .what = "a style model needs the same speech in several styles",
                      .expected = "at least 2",
                      .got = list_of(styles)});
  }
  const auto reference = std::ranges::find(styles, options.reference);
  std::rotate(styles.begin(), reference, reference + 1);
  return styles;
}

// The readings of each sentence id: one a style, empty where there is none.
std::map<std::string, std::vector<Reading>> readings(const MotionTable& table,
                                                     const std::vector<std::string>& styles) {
  std::map<std::string, std::vector<Reading>> found;
  for (const MotionNode& node : table.nodes) {
    const std::string& emotion = table.emotions[static_cast<std::size_t>(node.emotion)];
    const auto style = std::ranges::find(styles, emotion);
    if (style != styles.end()) {
      std::vector<Reading>& all =
          found[table.sentences[static_cast<std::size_t>(node.sentence)].id];
      all.resize(styles.size());
      all[static_cast<std::size_t>(style - styles.begin())].push_back(&node);
    }
  }
  return found;
}

std::vector<std::int32_t> phonemes_of(const Reading& reading) {
  std::vector<std::int32_t> phonemes;
  for (const MotionNode* node : reading) {
    phonemes.push_back(node->phoneme);
  }
  return phonemes;
}

// For each node of the first reading, the node of every style that speaks it; empty where some
// style has none.
std::vector<Reading> aligned_nodes(const std::vector<Reading>& readings_of_sentence) {
  const Reading& reference = readings_of_sentence.front();
  std::vector<Reading> aligned(reference.size());
  for (std::size_t n = 0; n < reference.size(); ++n) {
    aligned[n] = {reference[n]};
  }
  const std::vector<std::int32_t> phonemes = phonemes_of(reference);
  for (std::size_t s = 1; s < readings_of_sentence.size(); ++s) {
    for (const auto& [n, other] : align_phonemes(phonemes, phonemes_of(readings_of_sentence[s]))) {
      if (aligned[n].size() == s) {
        aligned[n].push_back(readings_of_sentence[s][other]);
      }
    }
  }
  for (Reading& nodes : aligned) {
    if (nodes.size() < readings_of_sentence.size()) {
      nodes.clear();
    }
  }
  return aligned;
}

// Why a sentence is not in every style; empty where it is.
std::string missing_styles(const std::vector<Reading>& readings_of_sentence,
                           const std::vector<std::string>& styles) {
  std::string missing;
  for (std::size_t s = 0; s < styles.size(); ++s) {
    if (readings_of_sentence[s].empty()) {
      missing += (missing.empty() ? "there is no recording of it in " : ", ") + styles[s];
    }
  }
  return missing;
}

} // namespace

AlignedSentences align_sentences(const MotionTable& table, const TrainingOptions& options) {
  AlignedSentences found{.styles = chosen_styles(table, options)};
  for (auto& [id, of_sentence] : readings(table, found.styles)) {
    if (const std::string missing = missing_styles(of_sentence, found.styles); !missing.empty()) {
      found.not_aligned.push_back({id, missing});
      continue;
    }
    AlignedSentence sentence{.id = id, .readings = of_sentence};
    for (Reading& nodes : aligned_nodes(of_sentence)) {
      if (!nodes.empty()) {
        sentence.nodes.push_back(std::move(nodes));
      }
    }
    const auto spoken = static_cast<std::int64_t>(of_sentence.front().size());
    const auto aligned = static_cast<std::int64_t>(sentence.nodes.size());
    if (aligned < spoken) {
      found.not_aligned.push_back(
          {id, fmt::format("{} of its {} phonemes are not said in every style", spoken - aligned,
                           spoken)});
    }
    if (aligned > 0) {
      found.nodes += aligned;
      found.nodes_left_out += spoken - aligned;
      found.sentences.push_back(std::move(sentence));
    }
  }
  if (found.sentences.empty()) {
    throw InputError({.where = kWhere,
                      .what = "there is no speech that was recorded in every style",
                      .expected = fmt::format("the same sentences in {}", list_of(found.styles)),
                      .remedy = "Record the same sentences in each, or name fewer styles."});
  }
  return found;
}

} // namespace phonomime
