// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/motion_table.h"

#include "db/types/errors.h"
#include "db/types/sentence_key.h"
#include "db/types/text.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

constexpr std::size_t kShownCandidates = 3;

// A typed key: the sentence's part ("happiness/bbaf2n") and the order.
struct TypedKey {
  std::string sentence;
  std::int32_t order = 0;
};

std::optional<TypedKey> parse_key(std::string_view key) {
  const std::size_t hash = key.rfind('#');
  if (hash == std::string_view::npos || hash == 0) {
    return std::nullopt;
  }
  const std::optional<long> order = parse_integer(key.substr(hash + 1));
  if (!order || *order < 0 || *order > std::numeric_limits<std::int32_t>::max()) {
    return std::nullopt;
  }
  return TypedKey{std::string(key.substr(0, hash)), static_cast<std::int32_t>(*order)};
}

// Whether `typed` is the end of `full` and begins where a part of it begins.
bool is_short_form(std::string_view typed, std::string_view full) {
  return full.ends_with(typed) &&
         (full.size() == typed.size() || full[full.size() - typed.size() - 1] == '/');
}

std::string node_key(const SentenceInfo& sentence, std::int32_t order) {
  return fmt::format("{}#{}", sentence_key(sentence), order);
}

// Nodes of one sentence: they lie together, in order of `order`.
std::span<const MotionNode> nodes_of(const MotionTable& table, std::int32_t sentence) {
  const auto first = std::ranges::lower_bound(table.nodes, sentence, {}, &MotionNode::sentence);
  const auto last = std::ranges::upper_bound(table.nodes, sentence, {}, &MotionNode::sentence);
  return {first, last};
}

// Sentences whose key may end with `typed`. Ids are compared before any key is built.
std::vector<std::int32_t> matching_sentences(const MotionTable& table, std::string_view typed) {
  const std::size_t slash = typed.rfind('/');
  const std::string_view id = slash == std::string_view::npos ? typed : typed.substr(slash + 1);
  std::vector<std::int32_t> matches;
  for (std::size_t i = 0; i < table.sentences.size(); ++i) {
    if (table.sentences[i].id == id && is_short_form(typed, sentence_key(table.sentences[i]))) {
      matches.push_back(static_cast<std::int32_t>(i));
    }
  }
  return matches;
}

// Full keys of up to `count` nodes of a sentence, nearest to `order` first.
std::vector<std::string> near_keys_in(const MotionTable& table, std::int32_t sentence,
                                      std::int32_t order, std::size_t count) {
  std::vector<std::int32_t> orders;
  for (const MotionNode& node : nodes_of(table, sentence)) {
    orders.push_back(node.order);
  }
  std::ranges::stable_sort(orders, {}, [&](std::int32_t other) {
    return std::abs(static_cast<std::int64_t>(other) - order);
  });
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < std::min(count, orders.size()); ++i) {
    keys.push_back(node_key(table.sentences[static_cast<std::size_t>(sentence)], orders[i]));
  }
  return keys;
}

// Full keys of the nodes that `typed` may have meant, nearest first; `sentences` are those it
// names.
std::vector<std::string> near_keys(const MotionTable& table, const TypedKey& typed,
                                   const std::vector<std::int32_t>& sentences) {
  if (sentences.size() == 1) {
    return near_keys_in(table, sentences[0], typed.order, kShownCandidates);
  }
  std::vector<std::string> keys;
  const auto append_nearest = [&](std::int32_t sentence) {
    const std::vector<std::string> nearest = near_keys_in(table, sentence, typed.order, 1);
    keys.insert(keys.end(), nearest.begin(), nearest.end());
  };
  for (std::size_t i = 0; i < std::min(sentences.size(), kShownCandidates); ++i) {
    append_nearest(sentences[i]);
  }
  if (!sentences.empty()) {
    return keys;
  }
  // No such sentence: compare as many parts as were typed.
  const auto parts = std::ranges::count(typed.sentence, '/');
  std::vector<std::string> forms;
  for (const SentenceInfo& sentence : table.sentences) {
    forms.push_back(parts == 0   ? sentence.id
                    : parts == 1 ? sentence.emotion + "/" + sentence.id
                                 : sentence_key(sentence));
  }
  for (const std::string& form : nearest_candidates(typed.sentence, forms, kShownCandidates)) {
    append_nearest(static_cast<std::int32_t>(std::ranges::find(forms, form) - forms.begin()));
  }
  return keys;
}

std::string ask_for(const std::vector<std::string>& keys) {
  return keys.empty() ? "" : fmt::format("Did you mean {}?", fmt::join(keys, " or "));
}

template <typename Names>
std::optional<std::int32_t> index_of(const Names& names, std::string_view name, auto projection) {
  const auto found = std::ranges::find(names, name, projection);
  if (found == names.end()) {
    return std::nullopt;
  }
  return static_cast<std::int32_t>(found - names.begin());
}

} // namespace

std::string MotionTable::key(NodeIndex node) const {
  const MotionNode& found = nodes[static_cast<std::size_t>(node)];
  return node_key(sentences[static_cast<std::size_t>(found.sentence)], found.order);
}

NodeIndex MotionTable::find_node(std::string_view typed_text, std::string_view where) const {
  const std::optional<TypedKey> typed = parse_key(typed_text);
  if (!typed) {
    throw InputError(
        {.where = std::string(where),
         .what = fmt::format("{} is not the key of a motion node", quoted(typed_text)),
         .expected = "speaker/emotion/sentence#order, or an end of it from sentence on"});
  }
  const std::vector<std::int32_t> matches = matching_sentences(*this, typed->sentence);
  std::vector<NodeIndex> found;
  for (const std::int32_t sentence : matches) {
    const std::span<const MotionNode> in_sentence = nodes_of(*this, sentence);
    const auto node = std::ranges::lower_bound(in_sentence, typed->order, {}, &MotionNode::order);
    if (node != in_sentence.end() && node->order == typed->order) {
      found.push_back(static_cast<NodeIndex>(&*node - nodes.data()));
    }
  }
  const std::string typed_key = fmt::format("{}#{}", typed->sentence, typed->order);
  std::vector<const UnavailableNode*> barred;
  for (const UnavailableNode& node : unavailable) {
    if (is_short_form(typed_key, node.key)) {
      barred.push_back(&node);
    }
  }
  if (found.size() + barred.size() > 1) {
    // A short form must not change its meaning when one of its nodes is pruned.
    std::vector<std::string> keys;
    std::ranges::transform(found, std::back_inserter(keys), [&](NodeIndex n) { return key(n); });
    std::ranges::transform(barred, std::back_inserter(keys), &UnavailableNode::key);
    std::ranges::sort(keys);
    const std::size_t count = keys.size();
    keys.resize(std::min(count, kShownCandidates));
    throw InputError(
        {.where = std::string(where),
         .what = fmt::format("{} is ambiguous: {} motion nodes have that key", quoted(typed_text),
                             count),
         .remedy = fmt::format("Write one of them in full: {}{}", fmt::join(keys, ", "),
                               count > keys.size() ? ", ..." : "")});
  }
  if (!barred.empty()) {
    throw InputError({.where = std::string(where),
                      .what = fmt::format("motion node {} cannot be used: {}", barred[0]->key,
                                          barred[0]->reason),
                      .remedy = "Choose another node, or restore it."});
  }
  if (found.empty()) {
    throw InputError({.where = std::string(where),
                      .what = fmt::format("there is no motion node {} of speaker {}",
                                          quoted(typed_text), quoted(speaker)),
                      .remedy = ask_for(near_keys(*this, *typed, matches))});
  }
  return found[0];
}

std::optional<std::int32_t> MotionTable::find_phoneme(std::string_view name) const {
  return index_of(phonemes, name, &Phoneme::name);
}

std::optional<std::int32_t> MotionTable::find_viseme(std::string_view name) const {
  return index_of(visemes, name, std::identity{});
}

std::optional<std::int32_t> MotionTable::find_emotion(std::string_view name) const {
  return index_of(emotions, name, std::identity{});
}

} // namespace phonomime
