// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/text.h"
#include "tools/evaluate/report.h"
#include "tools/evaluate/text_table.h"

#include <algorithm>
#include <numeric>
#include <set>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::size_t kShownMarkers = 10;

std::string named(const MeasureInfo& row, std::string_view unit) {
  return unit == "1" ? std::string(row.label) : fmt::format("{} [{}]", row.label, unit);
}

std::vector<std::string> headline_header(const Evaluation& evaluation, std::string first) {
  std::vector<std::string> header = {std::move(first)};
  for (const Headline& headline : headlines()) {
    const std::string_view unit = unit_of(headline.measure, evaluation.layout.kind);
    header.push_back(unit == "1" ? std::string(headline.label)
                                 : fmt::format("{} [{}]", headline.label, unit));
  }
  return header;
}

std::vector<std::string> headline_row(std::string name,
                                      const std::array<Summary, kMeasureCount>& summaries) {
  std::vector<std::string> row = {std::move(name)};
  for (const Headline& headline : headlines()) {
    row.push_back(shown(summaries[static_cast<std::size_t>(headline.measure)].mean,
                        info(headline.measure).decimals));
  }
  return row;
}

std::string heading(const Evaluation& evaluation) {
  const RunInfo& run = evaluation.run;
  std::string text = fmt::format("Evaluation of {}: {} sentences, {}, at {} Hz\n", run.corpus,
                                 evaluation.methods.front().sentences.size(), run.held_out_by,
                                 format_number(run.rate_hz));
  for (const auto& [name, value] : run.options) {
    text += fmt::format("  {}: {}\n", name, value);
  }
  for (const std::string& note : run.notes) {
    text += fmt::format("  {}\n", note);
  }
  return text;
}

std::string headline_table(const Evaluation& evaluation) {
  TextTable table(headline_header(evaluation, "method"));
  for (std::size_t m = 0; m < evaluation.methods.size(); ++m) {
    table.add(headline_row(evaluation.methods[m].id, evaluation.tables[m].all));
  }
  std::string text = "\nMeans over sentences\n" + table.text();
  for (const MethodResult& method : evaluation.methods) {
    text += fmt::format("  {}: {}{}\n", method.id, method.description,
                        method.sees_recording ? " (sees the recording)" : "");
  }
  return text;
}

std::string measure_table(const Evaluation& evaluation) {
  std::vector<std::string> header = {"measure"};
  for (const MethodResult& method : evaluation.methods) {
    header.push_back(method.id);
  }
  const std::size_t main = main_method_index(evaluation);
  for (const char* of_main : {" se", " pooled", " n"}) {
    header.push_back(evaluation.methods[main].id + of_main);
  }
  TextTable table(header);
  for (const Measure measure : all_measures()) {
    const MeasureInfo& row = info(measure);
    std::vector<std::string> cells = {named(row, unit_of(measure, evaluation.layout.kind))};
    for (const MethodTables& method : evaluation.tables) {
      cells.push_back(shown(method[measure].mean, row.decimals));
    }
    const Summary& summary = evaluation.tables[main][measure];
    cells.push_back(shown(summary.standard_error, row.decimals + 1));
    cells.push_back(shown(summary.pooled, row.decimals));
    cells.push_back(std::to_string(summary.sentences));
    table.add(cells);
  }
  std::vector<std::string> total = {"total error (E12)"};
  for (const MethodTables& method : evaluation.tables) {
    total.push_back(shown(method.total_error, 1));
  }
  total.resize(header.size(), "");
  table.add(total);
  return fmt::format("\nEvery measure: means over sentences; of {} the standard error of the mean, "
                     "the value pooled over all sentences, and how many have one\n",
                     evaluation.methods[main].id) +
         table.text();
}

// By emotion or fold: a table of the main method, where there is more than one part.
template <typename Parts>
std::string part_table(const Evaluation& evaluation, const char* what, const Parts& parts) {
  if (parts.size() < 2) {
    return {};
  }
  TextTable table(headline_header(evaluation, what));
  for (const auto& [name, summaries] : parts) {
    table.add(headline_row(fmt::format("{}", name), summaries));
  }
  return fmt::format("\nBy {}: {}\n", what, evaluation.methods[main_method_index(evaluation)].id) +
         table.text();
}

std::string phoneme_table(const Evaluation& evaluation) {
  using enum Measure;
  const std::size_t main = main_method_index(evaluation);
  const std::array<Measure, 8> columns = {
      squared_error,        lip_rmse,       lip_vertex_error, velocity_error,
      aperture_correlation, closure_recall, contact_share,    minimum_timing_error};
  std::vector<std::string> header = {"phoneme", "frames"};
  for (const Measure measure : columns) {
    header.push_back(named(info(measure), unit_of(measure, evaluation.layout.kind)));
  }
  TextTable table(header);
  for (const auto& [phoneme, values] : evaluation.tables[main].by_phoneme) {
    std::vector<std::string> row = {
        phoneme, std::to_string(evaluation.tables[main].phoneme_frames.at(phoneme))};
    for (const Measure measure : columns) {
      row.push_back(shown(values[measure], info(measure).decimals));
    }
    table.add(row);
  }
  return fmt::format("\nBy phoneme, pooled: {}\n", evaluation.methods[main].id) + table.text();
}

std::string region_table(const Evaluation& evaluation) {
  std::vector<std::string> header = {"RMSE by region, pooled"};
  for (const MethodResult& method : evaluation.methods) {
    header.push_back(method.id);
  }
  TextTable table(header);
  for (std::size_t r = 0; r < kRegionNames.size(); ++r) {
    std::vector<std::string> row = {std::string(kRegionNames[r])};
    for (const MethodTables& method : evaluation.tables) {
      row.push_back(shown(method.region_rmse[r], info(Measure::rmse).decimals));
    }
    if (evaluation.tables.front().region_rmse[r]) {
      table.add(row);
    }
  }
  return "\n" + table.text();
}

std::string group_table(const Evaluation& evaluation) {
  const std::size_t main = main_method_index(evaluation);
  const auto& rmse = evaluation.tables[main].marker_rmse;
  std::vector<std::size_t> order(rmse.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t g) { return rmse[g]; });
  order.resize(std::min(order.size(), kShownMarkers));
  std::string text =
      fmt::format("\nLargest RMSE by {}, pooled: {}\n",
                  evaluation.layout.kind == LayoutKind::markers ? "marker" : "weight",
                  evaluation.methods[main].id);
  for (const std::size_t g : order) {
    text += fmt::format("  {} {}\n", evaluation.layout.groups[g].name,
                        shown(rmse[g], info(Measure::rmse).decimals));
  }
  return text;
}

std::string size_table(const Evaluation& evaluation) {
  if (evaluation.sizes.empty()) {
    return {};
  }
  std::vector<std::string> header = headline_header(evaluation, "sentences");
  header.insert(header.begin() + 1, {"nodes", "diphones", "triphones", "search [s]"});
  TextTable table(header);
  for (const SizePoint& size : evaluation.sizes) {
    std::vector<std::string> row = headline_row(std::to_string(size.sentences), size.quality);
    row.insert(row.begin() + 1, {std::to_string(size.nodes), shown(size.diphone_coverage, 3),
                                 shown(size.triphone_coverage, 3), shown(size.search_s, 3)});
    table.add(row);
  }
  return "\nBy size of the database; diphones and triphones: share of those asked for that it "
         "holds\n" +
         table.text();
}

std::string emotion_table(const Evaluation& evaluation) {
  if (!evaluation.emotions) {
    return {};
  }
  const EmotionFindings& findings = *evaluation.emotions;
  std::set<std::string> emotions;
  for (const EmotionTrial& trial : findings.trials) {
    for (const auto& [asked, heard] : trial.taken_for) {
      emotions.insert(asked);
    }
  }
  std::vector<std::string> header = {"spoken", "sentences", "recognised", "by movement too",
                                     "closures"};
  header.insert(header.end(), emotions.begin(), emotions.end());
  TextTable table(header);
  for (const EmotionTrial& trial : findings.trials) {
    std::vector<std::string> row = {trial.id, std::to_string(trial.sentences),
                                    shown(trial.share(), 3), shown(trial.share_moving(), 3),
                                    shown(trial.closures, 3)};
    for (const std::string& emotion : emotions) {
      row.push_back(shown(trial.share_of(emotion), 3));
    }
    table.add(row);
  }
  std::string text = "\nEmotions recognised: share of sentences that the nearest centroid of the "
                     "training recordings takes for what was asked for: by pose, by pose and "
                     "movement, by pose in each emotion\n" +
                     table.text();
  for (const EmotionTrial& trial : findings.trials) {
    text += fmt::format("  {}: {}\n", trial.id, trial.description);
  }
  return text + fmt::format("  closure recall where another emotion is asked for, less that where "
                            "it is not: {} (standard error {}, p = {:.2g}, {} pairs)\n",
                            shown(findings.closure_change, 4),
                            shown(findings.closure_change_error, 4), findings.closure_p,
                            findings.closure_pairs);
}

std::string worst_sentences(const Evaluation& evaluation) {
  const std::size_t main = main_method_index(evaluation);
  const MethodResult& method = evaluation.methods[main];
  const MethodTables& tables = evaluation.tables[main];
  std::vector<std::size_t> order(method.sentences.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) {
    return tables.sentences[i][Measure::squared_error];
  });
  constexpr std::size_t kShown = 5;
  order.resize(std::min(order.size(), kShown));
  TextTable table(headline_header(evaluation, "sentence"));
  for (const std::size_t i : order) {
    std::vector<std::string> row = {method.sentences[i].key};
    for (const Headline& headline : headlines()) {
      row.push_back(shown(tables.sentences[i][headline.measure], info(headline.measure).decimals));
    }
    table.add(row);
  }
  return fmt::format("\nWorst sentences: {}\n", method.id) + table.text();
}

std::string comparison_table(const Evaluation& evaluation, const Comparison& comparison) {
  std::string text = fmt::format("\nAgainst {}\n", comparison.source);
  for (const std::string& note : comparison.notes) {
    text += fmt::format("  {}\n", note);
  }
  for (const MethodComparison& method : comparison.methods) {
    TextTable table({"measure", "now", "earlier", "difference", "better", "worse", "p (Holm)", ""});
    for (const MeasureComparison& one : method.measures) {
      const MeasureInfo& row = info(one.measure);
      const bool compared = one.verdict != Verdict::not_compared;
      table.add(
          {named(row, unit_of(one.measure, evaluation.layout.kind)), shown(one.mean, row.decimals),
           shown(one.earlier_mean, row.decimals), shown(one.difference, row.decimals + 1),
           compared ? std::to_string(one.better) : "-", compared ? std::to_string(one.worse) : "-",
           compared ? fmt::format("{:.2g}", one.adjusted_p) : "-",
           std::string(verdict_name(one.verdict))});
    }
    text += fmt::format("\n{} against {}: {} sentences of both\n", method.method,
                        method.earlier_method, method.sentences) +
            table.text();
  }
  return text + fmt::format("  better, worse: sentences; p: Wilcoxon's signed-rank test over "
                            "sentences, two-sided, after Holm; a difference counts under {}\n",
                            kSignificance);
}

std::string definitions(const Evaluation& evaluation) {
  std::string text = "\nHow it is measured\n"
                     "  s: synthesis, o: recording; within the speech: from the first phoneme to "
                     "the last, inner pauses too, without frames with gaps\n";
  for (const Measure measure : all_measures()) {
    const MeasureInfo& row = info(measure);
    text += fmt::format("  {}: {}; {}\n", named(row, unit_of(measure, evaluation.layout.kind)),
                        row.formula, row.mask);
  }
  for (const auto& [phoneme, range] : evaluation.contact_ranges) {
    text +=
        fmt::format("  /{}/: least aperture {:.2f} to {:.2f} mm over {} rows of the recordings\n",
                    phoneme, range.low_mm, range.high_mm, range.rows);
  }
  return text;
}

} // namespace

std::string evaluation_text(const Evaluation& evaluation,
                            const std::optional<Comparison>& comparison) {
  const MethodTables& main = evaluation.tables[main_method_index(evaluation)];
  std::string text = heading(evaluation) + headline_table(evaluation);
  if (comparison) {
    text += comparison_table(evaluation, *comparison);
  }
  return text + measure_table(evaluation) + part_table(evaluation, "emotion", main.by_emotion) +
         part_table(evaluation, "fold", main.by_fold) + phoneme_table(evaluation) +
         region_table(evaluation) + group_table(evaluation) + size_table(evaluation) +
         emotion_table(evaluation) + worst_sentences(evaluation) + definitions(evaluation);
}

} // namespace phonomime
