// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/words.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numbers>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

// The member of an enumeration that has this name; `names` in its order.
template <typename Choice>
Choice parse_choice(const char* option, const char* fault, const std::string& text,
                    std::span<const std::string_view> names) {
  const auto found = std::ranges::find(names, text);
  if (found == names.end()) {
    throw UsageError(
        {.where = option,
         .what = fault,
         .expected = fmt::format("one of {}", fmt::join(names, ", ")),
         .got = quoted(text),
         .remedy = did_you_mean(text, std::vector<std::string>(names.begin(), names.end()))});
  }
  return static_cast<Choice>(found - names.begin());
}

} // namespace

HeadPose parse_head(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string_view field : split_fields(text, ',')) {
    const std::optional<double> number = parse_number(trim(field));
    if (!number) {
      break;
    }
    numbers.push_back(*number);
  }
  if ((numbers.size() != 3 && numbers.size() != 6) ||
      numbers.size() != split_fields(text, ',').size()) {
    throw UsageError({.where = "--head",
                      .what = "is not a head pose",
                      .expected = "YAW,PITCH,ROLL or YAW,PITCH,ROLL,X,Y,Z (degrees, mm)",
                      .got = quoted(text)});
  }
  const auto about = [&](std::size_t i, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(numbers[i] * std::numbers::pi / 180.0, axis);
  };
  HeadPose pose;
  pose.rotation = about(0, Eigen::Vector3d::UnitY()) * about(1, Eigen::Vector3d::UnitX()) *
                  about(2, Eigen::Vector3d::UnitZ());
  if (numbers.size() == 6) {
    pose.translation_mm = {numbers[3], numbers[4], numbers[5]};
  }
  return pose;
}

SilenceFill parse_silence(const std::string& text) {
  return parse_choice<SilenceFill>("--silence", "there is no such way to fill silence", text,
                                   kSilenceFillNames);
}

std::optional<CostModel> parse_cost(const std::string& text) {
  if (text.empty()) {
    return std::nullopt;
  }
  return parse_choice<CostModel>("--cost", "there is no such cost", text, kCostModelNames);
}

std::optional<Scale> parse_scale(const std::string& text) {
  if (text.empty()) {
    return std::nullopt;
  }
  return parse_choice<Scale>("--scale", "there is no such scale", text, kScaleNames);
}

DisconnectedParts parse_components(const std::string& text) {
  constexpr std::array<std::string_view, 2> kNames = {"join", "largest"};
  return parse_choice<DisconnectedParts>("--components", "there is no such way with parts", text,
                                         kNames);
}

bool parse_map_kind(const std::string& text) {
  constexpr std::array<std::string_view, 2> kNames = {"isomap", "pca"};
  return parse_choice<bool>("--map", "there is no such map", text, kNames);
}

std::pair<int, int> parse_size(const std::string& text) {
  const std::vector<std::string_view> sides = split_fields(text, 'x');
  const std::optional<long> width = parse_integer(sides.front());
  const std::optional<long> height = parse_integer(sides.back());
  constexpr long kMost = 1'000'000; // the picture itself says what it takes
  if (sides.size() != 2 || !width || !height || std::abs(*width) > kMost ||
      std::abs(*height) > kMost) {
    throw UsageError({.where = "--size",
                      .what = "is not the size of a picture",
                      .expected = "WIDTHxHEIGHT in pixels, as 1000x800",
                      .got = quoted(text)});
  }
  return {static_cast<int>(*width), static_cast<int>(*height)};
}

std::map<std::string, Colour> parse_palette(const std::vector<std::string>& texts) {
  std::map<std::string, Colour> palette;
  for (const std::string& text : texts) {
    const std::size_t sign = text.find('=');
    try {
      if (sign == std::string::npos || sign == 0) {
        throw UsageError({.where = "--palette",
                          .what = "names no emotion and its colour",
                          .expected = "EMOTION=#rrggbb",
                          .got = quoted(text)});
      }
      palette[text.substr(0, sign)] = parse_colour(text.substr(sign + 1), "--palette");
    } catch (const InputError& error) {
      throw UsageError(error.details()); // a word of the call, not of a file
    }
  }
  return palette;
}

void check_verb(std::span<const char* const> call, const std::vector<std::string>& verbs,
                const std::string& program) {
  const std::string expected = fmt::format("one of {}", fmt::join(verbs, ", "));
  const std::string see = "See `" + program + " --help`.";
  if (call.empty()) {
    throw UsageError({.what = "the call names no verb", .expected = expected, .remedy = see});
  }
  const auto word =
      std::ranges::find_if(call, [](std::string_view text) { return !text.starts_with('-'); });
  if (word != call.end() && std::ranges::find(verbs, *word) == verbs.end()) {
    const std::string question = did_you_mean(*word, verbs);
    throw UsageError({.what = fmt::format("there is no verb {}", quoted(*word)),
                      .expected = expected,
                      .remedy = question.empty() ? see : question + " " + see});
  }
}

void check_limit(long limit) {
  if (limit < 0) {
    throw UsageError({.where = "--limit",
                      .what = "is out of range",
                      .expected = "0 (all) or more",
                      .got = fmt::format("{}", limit)});
  }
}

} // namespace phonomime
