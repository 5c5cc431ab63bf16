// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/align_phonemes.h"

#include <algorithm>

namespace phonomime {

std::vector<std::pair<std::size_t, std::size_t>>
align_phonemes(std::span<const std::int32_t> first, std::span<const std::int32_t> second) {
  const std::size_t width = second.size() + 1;
  // distances[i * width + j]: of the first i phonemes and the first j.
  std::vector<std::size_t> distances((first.size() + 1) * width);
  for (std::size_t i = 0; i <= first.size(); ++i) {
    for (std::size_t j = 0; j <= second.size(); ++j) {
      std::size_t& least = distances[i * width + j];
      if (i == 0 || j == 0) {
        least = i + j;
        continue;
      }
      const std::size_t exchange = first[i - 1] == second[j - 1] ? 0 : 1;
      least = std::min({distances[(i - 1) * width + j - 1] + exchange,
                        distances[(i - 1) * width + j] + 1, distances[i * width + j - 1] + 1});
    }
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = first.size(), j = second.size(); i > 0 && j > 0;) {
    const std::size_t here = distances[i * width + j];
    const bool same = first[i - 1] == second[j - 1];
    if (here == distances[(i - 1) * width + j - 1] + (same ? 0 : 1)) {
      --i, --j;
      if (same) {
        pairs.emplace_back(i, j);
      }
    } else if (here == distances[(i - 1) * width + j] + 1) {
      --i;
    } else {
      --j;
    }
  }
  std::reverse(pairs.begin(), pairs.end());
  return pairs;
}

} // namespace phonomime
