// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/report.h"

#include "db/types/sentence_key.h"

#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

using nlohmann::json;

constexpr std::size_t kGapLines = 20;

std::string_view action_name(GapAction action) {
  return action == GapAction::filled ? "filled" : action == GapAction::held ? "held" : "marked";
}

} // namespace

ImportReport begin_report(const Corpus& corpus, const Survey& survey, double rate_hz) {
  ImportReport report;
  report.corpus = corpus.name;
  report.phoneme_set = corpus.phoneme_set.name();
  report.synthetic = corpus.synthetic;
  report.rate_hz = rate_hz;
  report.sentences_listed = static_cast<std::int64_t>(corpus.sentences.size());
  report.files = survey.files;
  report.file_frames = survey.file_frames;
  report.frames_outside = survey.frames_outside;
  report.frames_shared = survey.frames_shared;
  report.extra_groups = survey.extra_groups;
  for (const std::string_view reason : kSuspectReasons) {
    report.suspects[std::string(reason)] = 0;
  }
  for (const auto& [speaker, reference] : survey.references) {
    report.references.push_back(
        {.speaker = speaker,
         .origin = reference.origin,
         .sentence = reference.sentence ? sentence_key(corpus.sentences[*reference.sentence]) : "",
         .time_s = reference.time_s});
  }
  if (!survey.scale_origin.empty()) {
    report.head_scale = {.scale = std::string(kScaleNames[static_cast<std::size_t>(survey.scale)]),
                         .origin = survey.scale_origin,
                         .size_variation = survey.size_variation};
  }
  add_rejections(report, corpus, survey.rejections, 0);
  return report;
}

void add_rejections(ImportReport& report, const Corpus& corpus,
                    const std::vector<Rejection>& rejections, std::int64_t recorded_frames) {
  for (const Rejection& rejection : rejections) {
    const CorpusSentence& sentence = corpus.sentences[rejection.sentence];
    report.rejected.push_back({.speaker = sentence.speaker,
                               .emotion = sentence.emotion,
                               .id = sentence.id,
                               .where = sentence.where,
                               .reason = rejection.reason});
  }
  report.rejected_recorded_frames += recorded_frames;
}

void add_to_report(ImportReport& report, const Corpus& corpus, const SentenceAccount& account) {
  const CorpusSentence& sentence = corpus.sentences[account.sentence];
  report.sentences_imported += 1;
  report.imported_recorded_frames += account.recorded_frames;
  report.frames += account.frames;
  report.in_nodes += account.in_nodes;
  report.in_silence += account.in_silence;
  report.held_frames += account.held_frames;
  report.gap_frames += account.gap_frames;
  report.nodes += account.nodes;
  report.nodes_with_gap += account.nodes_with_gap;
  report.interpolated_poses += account.interpolated_poses;
  report.missing += account.missing;
  std::map<std::tuple<Eigen::Index, Eigen::Index, GapAction>, std::vector<std::string>> together;
  for (const Gap& gap : account.gaps) {
    std::int64_t& total = gap.action == GapAction::filled ? report.filled
                          : gap.action == GapAction::held ? report.held
                                                          : report.marked;
    total += gap.frame_count;
    together[{gap.first_frame, gap.frame_count, gap.action}].push_back(
        corpus.layout.groups[static_cast<std::size_t>(gap.group)].name);
  }
  for (auto& [frames, groups] : together) {
    const auto& [first, count, action] = frames;
    report.gaps.push_back(
        {.file = sentence.motion_name,
         .sentence = sentence_key(sentence),
         .start_s = account.clock.start_s + static_cast<double>(first) / account.clock.rate_hz,
         .frames = count,
         .action = action,
         .groups = std::move(groups)});
  }
}

json report_to_json(const ImportReport& report) {
  json rejected = json::array();
  for (const ImportReport::RejectedSentence& sentence : report.rejected) {
    rejected.push_back({{"speaker", sentence.speaker},
                        {"emotion", sentence.emotion},
                        {"id", sentence.id},
                        {"where", sentence.where},
                        {"reason", sentence.reason}});
  }
  json gaps = json::array();
  for (const ImportReport::GapEntry& gap : report.gaps) {
    gaps.push_back({{"file", gap.file},
                    {"sentence", gap.sentence},
                    {"start", gap.start_s},
                    {"frames", gap.frames},
                    {"action", action_name(gap.action)},
                    {"groups", gap.groups}});
  }
  json references = json::array();
  for (const ImportReport::Reference& reference : report.references) {
    references.push_back({{"speaker", reference.speaker},
                          {"origin", reference.origin},
                          {"sentence", reference.sentence},
                          {"time", reference.time_s}});
  }
  json head_scale = nullptr;
  if (!report.head_scale.scale.empty()) {
    head_scale = {{"scale", report.head_scale.scale},
                  {"origin", report.head_scale.origin},
                  {"size_variation", report.head_scale.size_variation}};
  }
  return {{"corpus", report.corpus},
          {"phoneme_set", report.phoneme_set},
          {"synthetic", report.synthetic},
          {"rate_hz", report.rate_hz},
          {"sentences",
           {{"listed", report.sentences_listed},
            {"imported", report.sentences_imported},
            {"rejected", rejected}}},
          {"recorded",
           {{"files", report.files},
            {"in_files", report.file_frames},
            {"outside_sentences", report.frames_outside},
            {"in_several_sentences", report.frames_shared},
            {"in_imported", report.imported_recorded_frames},
            {"in_rejected", report.rejected_recorded_frames},
            {"interpolated_head_poses", report.interpolated_poses}}},
          {"frames",
           {{"stored", report.frames},
            {"in_nodes", report.in_nodes},
            {"in_silence", report.in_silence},
            {"held", report.held_frames},
            {"in_pca", report.frames - report.gap_frames},
            {"out_of_pca", report.gap_frames}}},
          {"nodes", {{"stored", report.nodes}, {"with_gap", report.nodes_with_gap}}},
          {"gaps",
           {{"missing", report.missing},
            {"filled", report.filled},
            {"held", report.held},
            {"marked", report.marked},
            {"list", gaps}}},
          {"suspects", report.suspects},
          {"extra_groups", report.extra_groups},
          {"references", references},
          {"head_scale", head_scale},
          {"pca",
           {{"frames", report.pca_frames},
            {"left_out", report.pca_left_out},
            {"dimensions", report.pca_dimensions},
            {"share", report.pca_share}}}};
}

std::string report_to_text(const ImportReport& report) {
  std::string text;
  const auto line = [&]<typename... Args>(fmt::format_string<Args...> format, Args&&... args) {
    text += fmt::format(format, std::forward<Args>(args)...) + '\n';
  };
  line("corpus      {}{}, phoneme set {}, {} Hz", report.corpus,
       report.synthetic ? " (synthetic)" : "", report.phoneme_set, report.rate_hz);
  line("sentences   {} of {} imported, {} rejected", report.sentences_imported,
       report.sentences_listed, report.rejected.size());
  for (const ImportReport::RejectedSentence& sentence : report.rejected) {
    line("  rejected  {}/{}/{}: {}", sentence.speaker, sentence.emotion, sentence.id,
         sentence.reason);
  }
  line("recorded    {} frames in {} files, {} outside the imported sentences", report.file_frames,
       report.files, report.frames_outside + report.rejected_recorded_frames);
  line("stored      {} frames: {} in {} nodes, {} of silence; {} held", report.frames,
       report.in_nodes, report.nodes, report.in_silence, report.held_frames);
  line("gaps        {} missing values: {} filled, {} held at ends, {} in gaps too long ({} nodes)",
       report.missing, report.filled, report.held, report.marked, report.nodes_with_gap);
  std::size_t shown = 0;
  std::size_t marked = 0;
  for (const ImportReport::GapEntry& gap : report.gaps) {
    if (gap.action == GapAction::marked && ++marked <= kGapLines) {
      ++shown;
      line("  marked    {} at {:.2f} s: {} frames of {}", gap.file, gap.start_s, gap.frames,
           fmt::join(gap.groups, " "));
    }
  }
  if (marked > shown) {
    line("  marked    {} more (see --json)", marked - shown);
  }
  for (const ImportReport::Reference& reference : report.references) {
    line("reference   {}: {}{}", reference.speaker, reference.origin,
         reference.sentence.empty()
             ? ""
             : fmt::format(", {} at {:.2f} s", reference.sentence, reference.time_s));
  }
  if (!report.head_scale.scale.empty()) {
    line("scale       {} ({}): the head's size varies by {:.2f} %{}", report.head_scale.scale,
         report.head_scale.origin, 100.0 * report.head_scale.size_variation,
         report.head_scale.scale == kScaleNames[static_cast<std::size_t>(Scale::nominal)]
             ? ", which is taken off"
             : "");
  }
  std::vector<std::string> suspects;
  for (const auto& [reason, nodes] : report.suspects) {
    suspects.push_back(fmt::format("{} {}", nodes, reason));
  }
  line("suspect     {} (nodes)", fmt::join(suspects, ", "));
  if (!report.extra_groups.empty()) {
    std::vector<std::string> extras;
    for (const auto& [group, files] : report.extra_groups) {
      extras.push_back(group);
    }
    line("left out    {} groups that the layout does not have: {}", extras.size(),
         fmt::join(extras, " "));
  }
  line("PCA         {} dimensions explain {:.2f} % of {} frames ({} left out)",
       report.pca_dimensions, 100.0 * report.pca_share, report.pca_frames, report.pca_left_out);
  return text;
}

} // namespace phonomime
