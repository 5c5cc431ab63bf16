// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/showcase.h"

#include "db/types/sentence_key.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string_view>

namespace phonomime {

namespace {

// FNV-1a, 64 bits: a lot that is the same on every machine.
std::uint64_t lot(std::string_view key) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : key) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  }
  return hash;
}

bool worse(const ShownSentence& a, const ShownSentence& b) {
  return a.error != b.error ? a.error > b.error : a.key < b.key;
}

bool drawn_before(const ShownSentence& a, const ShownSentence& b) {
  return lot(a.key) != lot(b.key) ? lot(a.key) < lot(b.key) : a.key < b.key;
}

using Order = std::function<bool(const ShownSentence&, const ShownSentence&)>;

// Whether a sentence with this key and error has a place among the first `count`.
bool has_place(const std::vector<ShownSentence>& kept, std::size_t count,
               const ShownSentence& sentence, const Order& before) {
  return count > 0 && (kept.size() < count || before(sentence, kept.back()));
}

void keep(std::vector<ShownSentence>& kept, std::size_t count, ShownSentence sentence,
          const Order& before) {
  kept.insert(std::ranges::upper_bound(kept, sentence, before), std::move(sentence));
  kept.resize(std::min(kept.size(), count));
}

} // namespace

Showcase::Showcase(std::string main_method, int worst_count, int sample_count)
    : main_method_(std::move(main_method)),
      worst_count_(static_cast<std::size_t>(std::max(worst_count, 0))),
      sample_count_(static_cast<std::size_t>(std::max(sample_count, 0))) {}

void Showcase::offer(const MeasureSetup& setup, const ImportedSentence& recorded,
                     const std::vector<SynthesisedSentence>& methods, std::optional<double> error) {
  ShownSentence sentence;
  sentence.key = sentence_key(recorded);
  sentence.error = error.value_or(0.0);
  const bool among_worst = error && has_place(worst_, worst_count_, sentence, worse);
  const bool in_sample = has_place(sample_, sample_count_, sentence, drawn_before);
  if (!among_worst && !in_sample) {
    return;
  }
  sentence.text = recorded.text;
  sentence.rows = recorded.rows;
  sentence.rate_hz = setup.rate_hz;
  sentence.recorded = recorded.channels;
  sentence.methods = methods;
  if (among_worst) {
    sentence.worst = true;
    keep(worst_, worst_count_, sentence, worse);
    sentence.worst = false;
  }
  if (in_sample) {
    keep(sample_, sample_count_, std::move(sentence), drawn_before);
  }
}

std::vector<ShownSentence> Showcase::shown() const {
  std::vector<ShownSentence> shown = worst_;
  std::vector<ShownSentence> sample;
  for (const ShownSentence& sentence : sample_) {
    if (std::ranges::find(worst_, sentence.key, &ShownSentence::key) == worst_.end()) {
      sample.push_back(sentence);
    }
  }
  std::ranges::sort(sample, {}, &ShownSentence::key);
  shown.insert(shown.end(), sample.begin(), sample.end());
  return shown;
}

} // namespace phonomime
