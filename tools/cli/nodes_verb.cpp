// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/verbs.h"

#include "tools/cli/terminal.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

std::vector<std::string> suspect_texts(const NodeRecord& node) {
  std::vector<std::string> texts;
  for (const SuspectMark& mark : node.suspect) {
    texts.push_back(mark.text);
  }
  return texts;
}

nlohmann::ordered_json node_to_json(const NodeRecord& node) {
  return {{"key", node.key},
          {"phoneme", node.phoneme},
          {"viseme", node.viseme},
          {"emotion", node.emotion},
          {"speaker", node.speaker},
          {"sentence", node.sentence},
          {"previous", node.previous_phoneme},
          {"next", node.next_phoneme},
          {"start", node.start_s},
          {"end", node.end_s},
          {"frames", node.frame_count},
          {"has_gap", node.has_gap},
          {"pruned", node.pruned},
          {"pruned_reason", node.pruned_reason},
          {"suspect", suspect_texts(node)}};
}

std::string node_to_text(const NodeRecord& node) {
  std::string text =
      fmt::format("{}\t{}-{}-{}\t{:.3f}\t{:.3f}\t{}", node.key, node.previous_phoneme, node.phoneme,
                  node.next_phoneme, node.start_s, node.end_s, node.frame_count);
  if (node.has_gap) {
    text += "\tgap";
  }
  if (node.pruned) {
    text += "\tpruned: " + node.pruned_reason;
  }
  if (!node.suspect.empty()) {
    text += fmt::format("\tsuspect: {}", fmt::join(suspect_texts(node), "; "));
  }
  return text + "\n";
}

} // namespace

void run_verb(const NodesArguments& arguments, const CommonArguments& common, const Progress&) {
  std::vector<NodeRecord> nodes =
      MotionDatabase::open(arguments.database, OpenMode::read_only).list_nodes(arguments.filter);
  const std::size_t found = nodes.size();
  if (arguments.limit > 0) {
    nodes.resize(std::min(found, static_cast<std::size_t>(arguments.limit)));
  }
  if (common.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const NodeRecord& node : nodes) {
      json.push_back(node_to_json(node));
    }
    print(json.dump(1) + "\n");
    return;
  }
  std::string text = "key\ttriphone\tstart\tend\tframes\n";
  for (const NodeRecord& node : nodes) {
    text += node_to_text(node);
  }
  print(text);
  if (!common.quiet) {
    print_message(nodes.size() == found ? fmt::format("{} nodes", found)
                                        : fmt::format("{} of {} nodes", nodes.size(), found));
  }
}

} // namespace phonomime
