// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/page_data.h"

#include "db/types/html_text.h"
#include "tools/evaluate/measured_motion.h"
#include "tools/evaluate/report_json.h"
#include "tools/evaluate/shown_face.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kPlayer_hz = 50.0;

// Of packed motion: 65 mm to either side of the mean pose, or weights to either side of 3.
double step_of(const Layout& layout) {
  return layout.kind == LayoutKind::markers ? 0.002 : 0.0001;
}

// As a page needs it: so many decimals, which keeps the text short.
Json rounded(double value, double decimals) {
  const double unit = std::pow(10.0, decimals);
  return std::round(value * unit) / unit;
}

// The first digits of a value.
Json shortened(const std::optional<double>& value) {
  if (!value) {
    return nullptr;
  }
  constexpr double kDigits = 5.0;
  const double size = *value == 0.0 ? 0.0 : std::floor(std::log10(std::abs(*value)));
  return rounded(*value, std::max(0.0, kDigits - 1.0 - size));
}

Json sentence_values(const Evaluation& evaluation) {
  Json json;
  json["columns"] = Json::array();
  for (const Measure measure : all_measures()) {
    json["columns"].push_back(info(measure).id);
  }
  json["keys"] = Json::array();
  for (const SentenceMeasures& sentence : evaluation.methods.front().sentences) {
    json["keys"].push_back(sentence.key);
  }
  for (std::size_t m = 0; m < evaluation.methods.size(); ++m) {
    Json& rows = json["values"][evaluation.methods[m].id] = Json::array();
    for (const MeasureValues& values : evaluation.tables.at(m).sentences) {
      Json row = Json::array();
      for (const Measure measure : all_measures()) {
        row.push_back(shortened(values[measure]));
      }
      rows.push_back(std::move(row));
    }
  }
  return json;
}

Json face_to_json(const Layout& layout, const ShownFace& face) {
  Json json;
  json["channels"] = layout.channels_per_group();
  json["step"] = step_of(layout);
  json["edges"] = face.edges;
  json["groups"] = Json::array();
  json["pose"] = Json::array();
  for (int g = 0; g < layout.group_count(); ++g) {
    const ChannelGroup& group = layout.groups[static_cast<std::size_t>(g)];
    Json row = {{"name", group.name},
                {"region", kRegionNames.at(static_cast<std::size_t>(drawn_region(group)))}};
    for (const auto& [landmark, name] : layout.landmarks) {
      if (name == group.name) {
        row["landmark"] = landmark;
      }
    }
    json["groups"].push_back(std::move(row));
    Json place = Json::array();
    for (int c = 0; c < layout.channels_per_group(); ++c) {
      place.push_back(rounded(face.pose[g * layout.channels_per_group() + c], 4));
    }
    json["pose"].push_back(std::move(place));
  }
  return json;
}

// Turns motion into what the page shows of it.
class Packer {
public:
  Packer(const Layout& layout, double rate_hz, const ShownFace& face)
      : layout_(layout), rate_hz_(rate_hz), face_(face), all_(GroupSets(layout).all) {}

  Json packed(const FrameMatrix& frames, const std::vector<int>& groups, Eigen::Index every) const {
    const Eigen::Index width = layout_.channels_per_group();
    std::string bytes;
    Eigen::Index count = 0;
    for (Eigen::Index k = 0; k < frames.rows(); k += every, ++count) {
      for (const int group : groups) {
        for (Eigen::Index c = group * width; c < (group + 1) * width; ++c) {
          append(bytes, static_cast<double>(frames(k, c)) - face_.pose[c]);
        }
      }
    }
    return {{"rate", rate_hz_ / static_cast<double>(every)},
            {"frames", count},
            {"groups", groups},
            {"data", base64(bytes)}};
  }

  // Motion for the player and for traces, and the curves of the lips.
  Json motion(const FrameMatrix& frames) const {
    Json json;
    if (layout_.kind == LayoutKind::markers) {
      const auto every = static_cast<Eigen::Index>(std::ceil(rate_hz_ / kPlayer_hz - 1e-9));
      json["motion"] = packed(frames, all_, std::max<Eigen::Index>(1, every));
    }
    json["trace"] = packed(frames, face_.traced, 1);
    const MeasuredMotion measured(layout_, rate_hz_, frames);
    add_curve(json, "aperture", measured.curve(LipCurve::aperture));
    add_curve(json, "width", measured.curve(LipCurve::width));
    return json;
  }

private:
  void append(std::string& bytes, double offset) const {
    const double steps = std::clamp(std::round(offset / step_of(layout_)), -32768.0, 32767.0);
    const auto word = static_cast<std::uint16_t>(static_cast<std::int16_t>(steps));
    bytes += static_cast<char>(word & 0xffu);
    bytes += static_cast<char>(word >> 8);
  }

  static void add_curve(Json& json, const char* name, const std::vector<double>& curve) {
    if (curve.empty()) {
      return;
    }
    for (const double value : curve) {
      json[name].push_back(rounded(value, 3));
    }
  }

  const Layout& layout_;
  double rate_hz_;
  const ShownFace& face_;
  std::vector<int> all_;
};

const SentenceMeasures* find_sentence(const MethodResult& method, const std::string& key) {
  const auto found = std::ranges::lower_bound(method.sentences, key, {}, &SentenceMeasures::key);
  return found == method.sentences.end() || found->key != key ? nullptr : &*found;
}

std::string_view demand_name(const Phoneme& phoneme) {
  const LipDemand demand = lip_demand(phoneme);
  return demand == LipDemand::closure   ? "closure"
         : demand == LipDemand::contact ? "contact"
                                        : "none";
}

Json shown_to_json(const Evaluation& evaluation, const ShownSentence& sentence,
                   const ShownFace& face) {
  const Packer packer(evaluation.layout, sentence.rate_hz, face);
  Json json = {{"key", sentence.key},
               {"text", sentence.text},
               {"worst", sentence.worst},
               {"error", rounded(sentence.error, 4)},
               {"frames", sentence.recorded.rows()}};
  json["rows"] = Json::array();
  for (const TimedPhoneme& row : sentence.rows) {
    json["rows"].push_back({row.phoneme.name, row.start_s, row.end_s, demand_name(row.phoneme)});
  }
  json["speech"] = {0, sentence.recorded.rows()};
  json["recorded"] = packer.motion(sentence.recorded);
  json["methods"] = Json::array();
  for (const MethodResult& method : evaluation.methods) {
    const auto made = std::ranges::find(sentence.methods, method.id, &SynthesisedSentence::method);
    const SentenceMeasures* measures = find_sentence(method, sentence.key);
    if (made == sentence.methods.end() || measures == nullptr) {
      continue;
    }
    json["speech"] = {measures->first_speech_frame, measures->end_speech_frame};
    Json one = packer.motion(made->channels);
    one["id"] = method.id;
    one["error"] = Json::array();
    for (const float error : measures->frame_error) {
      one["error"].push_back(rounded(error, 4));
    }
    one["joins"] = Json::array();
    for (const JoinPlace& join : made->joins) {
      one["joins"].push_back({join.frame, join.captured});
    }
    json["methods"].push_back(std::move(one));
  }
  return json;
}

} // namespace

Json page_data(const Evaluation& evaluation, const std::vector<ShownSentence>& shown,
               const std::optional<Comparison>& comparison) {
  Json json = report_json(evaluation, comparison, false);
  for (const Headline& headline : headlines()) {
    json["headlines"].push_back({{"id", info(headline.measure).id}, {"label", headline.label}});
  }
  json["closed_aperture"] = kClosedAperture_mm;
  json["sentence_values"] = sentence_values(evaluation);
  json["shown"] = Json::array();
  if (shown.empty()) {
    ShownFace none;
    none.pose = Eigen::VectorXd::Zero(evaluation.layout.channel_count());
    json["face"] = face_to_json(evaluation.layout, none);
    return json;
  }
  const ShownFace face = shown_face(evaluation.layout, shown);
  json["face"] = face_to_json(evaluation.layout, face);
  for (const ShownSentence& sentence : shown) {
    Json one = shown_to_json(evaluation, sentence, face);
    if (!one["methods"].empty()) {
      json["shown"].push_back(std::move(one));
    }
  }
  return json;
}

} // namespace phonomime
