// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/style_plan.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "synth/pipeline/transcript_steps.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

// One request and its place.
struct Request {
  EmotionMixture mixture;
  std::string where;
};

std::vector<Request> requests_of(const AskedEmotions& asked) {
  std::vector<Request> requests;
  for (const EmotionSpan& span : asked.track.spans) {
    requests.push_back({mixture_of(span), at_line(asked.track.source, span.line)});
  }
  if (asked.fallback_given) {
    requests.push_back({asked.fallback, "--emotion"});
  }
  return requests;
}

bool is_plain(const EmotionMixture& mixture) {
  return mixture.others.empty() && mixture.heaviest.intensity == 1.0;
}

std::vector<EmotionModifier> parts_of(const EmotionMixture& mixture) {
  std::vector<EmotionModifier> parts = {mixture.heaviest};
  parts.insert(parts.end(), mixture.others.begin(), mixture.others.end());
  return parts;
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::find(names, name) == names.end()) {
    names.push_back(name);
  }
}

// Whether the emotion changes from one phoneme to another.
bool changes(const SynthesisInput& input) {
  const std::string* last = nullptr;
  for (std::size_t row = 0; row < input.transcript.size(); ++row) {
    if (!input.transcript[row].is_silence()) {
      if (last != nullptr && *last != input.emotions[row].emotion) {
        return true;
      }
      last = &input.emotions[row].emotion;
    }
  }
  return false;
}

// The stored model, where a request needs one for these emotions, or there is one that can lend a
// glide.
const StyleInUse* model_for(const std::vector<std::string>& emotions, const Request* needs,
                            SynthStock& stock, std::vector<std::string>& notes) {
  try {
    return stock.style(emotions);
  } catch (const InputError& error) {
    if (needs != nullptr) {
      throw InputError(
          {.where = needs->where,
           .what = fmt::format("{} needs a style model: {}",
                               quoted(format_emotions(needs->mixture)), error.what())});
    }
    if (!stock.style_is_missing()) {
      notes.push_back(fmt::format("changes of emotion do not glide: {}", error.what()));
    }
    return nullptr;
  }
}

} // namespace

bool is_recorded(const MotionTable& table, const std::string& emotion) {
  const std::optional<std::int32_t> index = table.find_emotion(emotion);
  return index && std::ranges::find(table.nodes, *index, &MotionNode::emotion) != table.nodes.end();
}

bool needs_style(const EmotionMixture& asked, const MotionTable& table) {
  return !is_plain(asked) || !table.find_emotion(asked.heaviest.emotion);
}

void check_recorded(const EmotionMixture& asked, const MotionTable& table, const std::string& where,
                    const std::string& who) {
  for (const EmotionModifier& part : parts_of(asked)) {
    find_asked_emotion(table, part, where);
  }
  if (!is_plain(asked)) {
    throw InputError(
        {.where = where,
         .what =
             fmt::format("{} asks for more than recordings show", quoted(format_emotions(asked))),
         .expected = "one emotion at intensity 1",
         .got = format_emotions(asked),
         .remedy = fmt::format("Intensities and mixtures act after a whole search: `synth` and "
                               "`style apply` have them, {} does not.",
                               who)});
  }
}

void check_names(const AskedEmotions& asked, const MotionTable& table) {
  for (const Request& request : requests_of(asked)) {
    for (const EmotionModifier& part : parts_of(request.mixture)) {
      find_asked_emotion(table, part, request.where);
    }
  }
}

void check_recorded(const AskedEmotions& asked, const MotionTable& table, const std::string& who) {
  for (const Request& request : requests_of(asked)) {
    check_recorded(request.mixture, table, request.where, who);
  }
}

void plan_style(const AskedEmotions& asked, SynthStock& stock, SynthesisInput& input,
                std::vector<std::string>& notes) {
  const MotionTable& table = stock.table();
  const std::vector<Request> requests = requests_of(asked);
  const Request* needs = nullptr;
  std::vector<std::string> emotions;
  std::vector<std::string> unrecorded;
  for (const Request& request : requests) {
    if (needs == nullptr && needs_style(request.mixture, table)) {
      needs = &request;
    }
    for (const EmotionModifier& part : parts_of(request.mixture)) {
      add_once(emotions, part.emotion);
      if (!is_recorded(table, part.emotion)) {
        add_once(unrecorded, part.emotion);
      }
      if (!table.find_emotion(part.emotion) && !stock.any_style_knows(part.emotion)) {
        find_asked_emotion(table, part, request.where); // throws
      }
    }
  }
  if (needs == nullptr && unrecorded.empty() && !changes(input)) {
    return;
  }
  for (const EmotionModifier& emotion : input.emotions) {
    add_once(emotions, emotion.emotion);
  }
  const StyleInUse* style = model_for(emotions, needs, stock, notes);
  if (style == nullptr) {
    if (!unrecorded.empty()) {
      notes.push_back(fmt::format("{} never recorded {}: other motion stands in, unless a style "
                                  "model of another speaker knows it (`phonomime style train`)",
                                  table.speaker, fmt::join(unrecorded, ", ")));
    }
    return;
  }
  input.style = {.model = &style->model, .track = asked.track, .fallback = asked.fallback};
  for (EmotionModifier& emotion : input.emotions) {
    if (!is_recorded(table, emotion.emotion)) {
      emotion = {.emotion = style->model.neutral};
    }
  }
  if (!unrecorded.empty()) {
    notes.push_back(fmt::format("{} never recorded {}: it is borrowed from the style model of {}, "
                                "over motion that is {}",
                                table.speaker, fmt::join(unrecorded, ", "), style->speaker,
                                style->model.neutral));
  } else if (style->speaker != table.speaker) {
    notes.push_back(fmt::format("emotions are changed by the style model of {}", style->speaker));
  }
}

} // namespace phonomime
