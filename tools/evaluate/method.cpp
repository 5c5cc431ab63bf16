// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/method.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "tools/evaluate/methods.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

constexpr std::array kMethods = {
    MethodEntry{"default", "blended paths of least cost, as `synth` makes motion", false,
                make_default},
    MethodEntry{"one_path", "the best of them alone", false, make_one_path},
    MethodEntry{"paper", "the path of least cost as Deng and Neumann print it", false, make_paper},
    MethodEntry{"mean_pose", "the mean frame of the recordings, held", false, make_mean_pose},
    MethodEntry{"viseme_keyframes", "each viseme's mean pose, straight lines between them", false,
                make_viseme_keyframes},
    MethodEntry{"dominance", "Cohen and Massaro's dominance functions, fitted", false,
                make_dominance},
    MethodEntry{"triphone", "for each phoneme the node of the best context, without a search",
                false, make_triphone},
    MethodEntry{"oracle",
                "for each phoneme the node nearest to the recording: what any choice "
                "of nodes can reach",
                true, make_oracle}};

} // namespace

std::span<const MethodEntry> method_table() {
  return kMethods;
}

std::vector<MethodEntry> find_methods(std::span<const std::string> names) {
  if (names.empty()) {
    return {kMethods.begin(), kMethods.end()};
  }
  std::vector<MethodEntry> found;
  for (const std::string& name : names) {
    const auto entry = std::ranges::find(kMethods, std::string_view(name), &MethodEntry::name);
    if (entry == kMethods.end()) {
      std::vector<std::string> known;
      for (const MethodEntry& method : kMethods) {
        known.emplace_back(method.name);
      }
      throw UsageError({.where = "--methods",
                        .what = fmt::format("there is no method {}", quoted(name)),
                        .expected = fmt::format("some of {}", fmt::join(known, ", ")),
                        .remedy = did_you_mean(name, known)});
    }
    if (std::ranges::find(found, entry->name, &MethodEntry::name) != found.end()) {
      throw UsageError({.where = "--methods", .what = quoted(name) + " is named twice"});
    }
    found.push_back(*entry);
  }
  return found;
}

} // namespace phonomime
