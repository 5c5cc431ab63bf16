// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "tools/cli/print_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

double share_explained(const PcaModel& pca) {
  return pca.total_variance > 0.0 ? pca.variance.sum() / pca.total_variance : 1.0;
}

nlohmann::ordered_json counts_to_json(const std::vector<DatabaseInfo::Count>& counts) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const DatabaseInfo::Count& count : counts) {
    json[count.name] = count.count;
  }
  return json;
}

nlohmann::ordered_json info_to_json(const DatabaseInfo& info) {
  nlohmann::ordered_json json;
  json["database"] = info.path.string();
  json["schema_version"] = info.schema_version;
  json["rate"] = info.rate_hz;
  json["layout"] = info.layout.kind == LayoutKind::markers ? "markers" : "weights";
  json["groups"] = info.layout.group_count();
  json["dimensions"] = info.pca.dimension_count();
  json["share_explained"] = share_explained(info.pca);
  json["corpora"] = nlohmann::ordered_json::array();
  for (const CorpusRecord& corpus : info.corpora) {
    json["corpora"].push_back({{"name", corpus.name},
                               {"phoneme_set", corpus.phoneme_set},
                               {"synthetic", corpus.synthetic},
                               {"imported_at", corpus.imported_at},
                               {"sentences", corpus.sentences}});
  }
  json["speakers"] = info.speakers;
  json["emotions"] = info.emotions;
  json["sentences"] = info.sentences;
  json["frames"] = info.frames;
  json["nodes"] = info.nodes;
  json["pruned"] = info.pruned;
  json["suspect"] = info.suspect;
  json["with_gaps"] = info.with_gaps;
  json["triphones"] = info.triphones;
  json["nodes_per_emotion"] = counts_to_json(info.nodes_per_emotion);
  json["nodes_per_phoneme"] = counts_to_json(info.nodes_per_phoneme);
  return json;
}

std::string counts_to_text(const std::vector<DatabaseInfo::Count>& counts) {
  std::string text;
  for (const DatabaseInfo::Count& count : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count.name, count.count);
  }
  return text;
}

std::string info_to_text(const DatabaseInfo& info) {
  std::string text = fmt::format("{} (format {})\n", info.path.string(), info.schema_version);
  for (const CorpusRecord& corpus : info.corpora) {
    text += fmt::format("corpus     {}: {} sentences, phoneme set {}, imported {}{}\n", corpus.name,
                        corpus.sentences, corpus.phoneme_set, corpus.imported_at,
                        corpus.synthetic ? "; SYNTHETIC: made by rule, not recorded" : "");
  }
  text += fmt::format("speakers   {}\n", fmt::join(info.speakers, ", "));
  text += fmt::format("channels   {} {} at {} Hz; {} dimensions explain {:.2f} %\n",
                      info.layout.group_count(),
                      info.layout.kind == LayoutKind::markers ? "markers" : "weights", info.rate_hz,
                      info.pca.dimension_count(), 100.0 * share_explained(info.pca));
  text += fmt::format("sentences  {}\nframes     {}\n", info.sentences, info.frames);
  text += fmt::format("nodes      {} ({} pruned, {} suspect, {} with gaps), {} triphones\n",
                      info.nodes, info.pruned, info.suspect, info.with_gaps, info.triphones);
  text += fmt::format("emotions   {}\n", counts_to_text(info.nodes_per_emotion));
  text += fmt::format("phonemes   {}\n", counts_to_text(info.nodes_per_phoneme));
  return text;
}

} // namespace

void run_verb(const InfoArguments& arguments, const CommonArguments& common, const Progress&) {
  const DatabaseInfo info = MotionDatabase::open(arguments.database, OpenMode::read_only).info();
  print_answer(common, info_to_json(info), info_to_text(info));
}

} // namespace phonomime
