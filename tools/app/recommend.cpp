// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/recommend.h"

#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "db/types/lip_measures.h"
#include "synth/pipeline/transcript_steps.h"
#include "synth/search/cost_weights.h"
#include "synth/search/search_session.h"
#include "tools/app/option_checks.h"
#include "tools/app/phoneme_maps.h"
#include "tools/app/style_plan.h"
#include "tools/app/synth_inputs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

void check_options(const RecommendOptions& options) {
  check_motion_options(options.synth);
  check_range("--limit", options.limit, 1, 1000);
  check_range("--at-time", options.relative_time, 0.0, 1.0);
  if (options.row.has_value() == options.time_s.has_value()) {
    throw UsageError({.what = "the call names no row, or two",
                      .expected = "--row or --time",
                      .remedy = "Rows are counted from 0, silence too."});
  }
}

// The row that is asked for, and the relative time in it.
std::pair<std::size_t, double> find_row(const RecommendOptions& options,
                                        const std::vector<TimedPhoneme>& rows) {
  if (options.row) {
    if (*options.row < 0 || static_cast<std::size_t>(*options.row) >= rows.size()) {
      throw InputError({.where = "--row",
                        .what = "the transcript has no such row",
                        .expected = fmt::format("0 to {}", rows.size() - 1),
                        .got = fmt::format("{}", *options.row)});
    }
    return {static_cast<std::size_t>(*options.row), options.relative_time};
  }
  const double time_s = *options.time_s;
  const auto row = std::ranges::find_if(rows, [&](const TimedPhoneme& timed) {
    return timed.start_s <= time_s && time_s < timed.end_s;
  });
  if (row == rows.end()) {
    throw InputError({.where = "--time",
                      .what = "the time is outside the transcript",
                      .expected = fmt::format("0 to {} s", rows.back().end_s),
                      .got = fmt::format("{} s", time_s)});
  }
  return {static_cast<std::size_t>(row - rows.begin()),
          (time_s - row->start_s) / (row->end_s - row->start_s)};
}

// Nodes for one row of a transcript, and what paths through them cost.
class Recommender {
public:
  Recommender(const MotionTable& table, const SynthesisInput& input, TranscriptSteps steps,
              std::size_t row, const Progress& progress)
      : table_(table), input_(input), steps_(std::move(steps)), row_(row),
        at_(row - steps_.first_row), progress_(progress), search_(table, input.weights),
        session_(search_) {
    steps_.steps[at_].allowed.clear();
  }

  // By (delta, node); those of the same triphone come first.
  std::vector<Recommendation> find(int limit, RecommendReport& report) {
    const std::vector<NodeIndex> in_context = context_correct();
    report.context_correct = static_cast<std::int64_t>(in_context.size());
    const SearchResult best = session_.solve(
        steps_.steps, {.threads = input_.search.threads, .runners_up = limit}, progress_);
    report.cost = best.path.cost;
    std::map<NodeIndex, double> deltas = {{best.path.nodes[at_], 0.0}};
    for (const RunnerUp& other : best.runners_up[at_]) {
      deltas.emplace(other.node, other.delta);
    }
    std::int64_t done = 0;
    for (const NodeIndex node : in_context) {
      progress_.update("recommending", done++, report.context_correct);
      if (!deltas.contains(node)) {
        deltas.emplace(node, std::max(0.0, cost_through(node) - best.path.cost));
      }
    }
    std::vector<Recommendation> found;
    for (const auto& [node, delta] : deltas) { // in order of nodes: ties stay so
      found.push_back(describe(node, delta, node == best.path.nodes[at_],
                               std::ranges::binary_search(in_context, node)));
    }
    std::ranges::stable_sort(found, [](const Recommendation& a, const Recommendation& b) {
      return a.context_correct != b.context_correct ? a.context_correct : a.delta < b.delta;
    });
    found.resize(std::min(found.size(), static_cast<std::size_t>(limit)));
    return found;
  }

  void place_at(double relative_time, std::vector<Recommendation>& nodes) const {
    const LipMeasures lips(table_.layout);
    for (Recommendation& one : nodes) {
      one.frame = relative_time * (one.frames - 1);
      const auto before = std::min(static_cast<int>(one.frame), std::max(0, one.frames - 2));
      const int after = std::min(before + 1, one.frames - 1);
      const double share = one.frame - before;
      const auto frames = table_.node_frames(one.index);
      const Eigen::VectorXd pose = (1.0 - share) * frames.row(before).cast<double>() +
                                   share * frames.row(after).cast<double>();
      const Eigen::VectorXd channels = table_.pca.reconstruct(pose);
      one.aperture_mm =
          lips.aperture_mm({channels.data(), static_cast<std::size_t>(channels.size())});
    }
  }

private:
  std::int32_t phoneme_at(std::size_t row) const {
    return table_.find_phoneme(input_.transcript[row].phoneme.name).value_or(-1);
  }

  // Beyond the ends of the transcript is silence, as at the ends of recordings.
  std::vector<NodeIndex> context_correct() const {
    const std::int32_t before = row_ > 0 ? phoneme_at(row_ - 1) : 0;
    const std::int32_t after = row_ + 1 < input_.transcript.size() ? phoneme_at(row_ + 1) : 0;
    const SearchStep& step = steps_.steps[at_];
    std::vector<NodeIndex> nodes;
    for (NodeIndex n = 0; n < table_.node_count(); ++n) {
      const MotionNode& node = table_.nodes[static_cast<std::size_t>(n)];
      if (node.phoneme == step.phoneme && node.previous_phoneme == before &&
          node.next_phoneme == after && !std::ranges::binary_search(step.avoided, n)) {
        nodes.push_back(n);
      }
    }
    return nodes;
  }

  double cost_through(NodeIndex node) {
    steps_.steps[at_].allowed = {node};
    const double cost =
        session_.solve(steps_.steps, {.threads = input_.search.threads}, progress_).path.cost;
    steps_.steps[at_].allowed.clear();
    return cost;
  }

  Recommendation describe(NodeIndex index, double delta, bool chosen, bool context_correct) const {
    const MotionNode& node = table_.nodes[static_cast<std::size_t>(index)];
    const auto name = [&](std::int32_t phoneme) {
      return table_.phonemes[static_cast<std::size_t>(phoneme)].name;
    };
    return {.node = table_.key(index),
            .index = index,
            .context_correct = context_correct,
            .chosen = chosen,
            .delta = delta,
            .previous = name(node.previous_phoneme),
            .phoneme = name(node.phoneme),
            .next = name(node.next_phoneme),
            .emotion = table_.emotions[static_cast<std::size_t>(node.emotion)],
            .frames = node.frame_count};
  }

  const MotionTable& table_;
  const SynthesisInput& input_;
  TranscriptSteps steps_;
  std::size_t row_, at_; // of the transcript, of the steps
  const Progress& progress_;
  ViterbiSearch search_;
  SearchSession session_;
};

// Where a node is on the phoneme-Isomap; nothing where it is not.
std::optional<std::array<double, 2>> place_on(const PhonemeMaps& maps, NodeIndex node,
                                              double relative_time) {
  for (const TimeCorrectFrame& frame : time_correct_frames(maps.cluster, relative_time)) {
    const auto n = maps.cluster.node_of[static_cast<std::size_t>(frame.a)];
    if (maps.cluster.nodes[static_cast<std::size_t>(n)].node != node) {
      continue;
    }
    const std::int32_t a = maps.row_of[static_cast<std::size_t>(frame.a)];
    const std::int32_t b = maps.row_of[static_cast<std::size_t>(frame.b)];
    if (a >= 0 && b >= 0) {
      const TimeCorrectFrame at = {.a = a, .b = b, .share = frame.share};
      const MapPlaces place = places_of(std::span(&at, 1), maps.isomap);
      return std::array{place(0, 0), place(0, 1)};
    }
  }
  return std::nullopt;
}

// On the maps of the nodes' own phonemes, where fresh ones are stored.
void add_places(const MotionDatabase& database, const MotionTable& table, double relative_time,
                std::vector<Recommendation>& nodes) {
  std::map<std::string, std::optional<PhonemeMaps>> known;
  for (Recommendation& one : nodes) {
    const auto [entry, is_new] = known.try_emplace(one.phoneme);
    if (is_new) {
      entry->second = maps_if_fresh(database, table, table.find_phoneme(one.phoneme).value());
    }
    if (entry->second) {
      one.place = place_on(*entry->second, one.index, relative_time);
    }
  }
}

} // namespace

RecommendReport recommend_nodes(const RecommendOptions& options, const Progress& progress) {
  check_options(options);
  const MotionDatabase database = MotionDatabase::open(options.synth.database, OpenMode::read_only);
  const MotionTable table = database.load_motion_table(options.synth.speaker);
  RecommendReport report;
  const CostModel model = options.synth.cost.value_or(kUsualCost);
  AskedEmotions emotions;
  const SynthesisInput input = read_synthesis_input(
      options.synth, table, default_cost_weights(table, model), emotions, report.notes);
  check_names(emotions, table);
  TranscriptSteps steps =
      make_transcript_steps(table, input.transcript, input.emotions, input.constraints);
  const auto [row, relative_time] = find_row(options, input.transcript);
  const TimedPhoneme& asked = input.transcript[row];
  if (asked.is_silence()) {
    throw InputError(
        {.where = options.row ? "--row" : "--time",
         .what = fmt::format("row {} is silence, which takes no motion of its own", row),
         .remedy = "Name a row with a phoneme."});
  }
  report.warnings = steps.warnings;
  if (steps.used[row - steps.first_row]) {
    report.notes.push_back(fmt::format("the use constraint of row {} is left out of account", row));
  }
  const auto name_of = [&](std::size_t other) {
    return other < input.transcript.size() ? input.transcript[other].phoneme.name
                                           : std::string(kSilence);
  };
  report.row = static_cast<long>(row);
  report.previous = row > 0 ? name_of(row - 1) : std::string(kSilence);
  report.phoneme = asked.phoneme.name;
  report.next = name_of(row + 1);
  report.start_s = asked.start_s;
  report.end_s = asked.end_s;
  report.emotion = input.emotions[row].emotion;
  report.relative_time = relative_time;
  Recommender recommender(table, input, std::move(steps), row, progress);
  report.recommended = recommender.find(options.limit, report);
  recommender.place_at(relative_time, report.recommended);
  add_places(database, table, relative_time, report.recommended);
  return report;
}

} // namespace phonomime
