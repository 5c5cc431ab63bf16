// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/corpus.h"

#include <cstdint>
#include <span>
#include <vector>

namespace phonomime {

// Lots are drawn by text, so that they depend on nothing but it and the seed: the same on every
// machine, and for a sentence whatever other sentences there are.
std::uint64_t lot_of(std::string_view text, std::uint64_t seed);

// Sentences (indices) in the order of their lots: one of a speaker and an id has the same lot in
// every emotion.
std::vector<std::size_t> in_order_of_lots(std::span<const CorpusSentence> sentences,
                                          std::uint64_t seed);

// The fold, 1 to `folds`, in which each sentence is held out: dealt in the order of their lots. A
// sentence in several emotions (same speaker and id) is in one fold. Throws InputError where there
// are fewer of them than folds.
std::vector<int> assign_folds(const Corpus& corpus, int folds, std::uint64_t seed);

} // namespace phonomime
