// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/text.h"
#include "tools/evaluate/text_table.h"
#include "tools/tune/tuning.h"

#include <fmt/format.h>

namespace phonomime {

namespace {

std::string share_name(const TunedPart& part) {
  return part.fold > 0 ? fmt::format("without fold {}", part.fold) : "all";
}

std::string heading(const Tuning& tuning) {
  std::string text = fmt::format("Cost weights tuned to {}\n", tuning.corpus);
  for (const auto& [name, value] : tuning.options) {
    text += fmt::format("  {}: {}\n", name, value);
  }
  for (const std::string& note : tuning.notes) {
    text += fmt::format("  {}\n", note);
  }
  return text;
}

std::string weights_table(const Tuning& tuning) {
  std::vector<std::string> header = {"weight", "least", "most", "shipped", "tuned"};
  for (const TunedPart& fold : tuning.folds) {
    header.push_back(share_name(fold));
  }
  TextTable table(header);
  for (const TunableWeight& weight : tuning.weights) {
    std::vector<std::string> row = {std::string(weight.name)};
    for (const double value : {weight.least, weight.most, tuning.shipped.*weight.member,
                               tuning.all.tuned.*weight.member}) {
      row.push_back(format_number(value));
    }
    for (const TunedPart& fold : tuning.folds) {
      row.push_back(format_number(fold.tuned.*weight.member));
    }
    table.add(row);
  }
  return "\nWeights\n" + table.text();
}

std::vector<std::string> gain_cells(const Gain& gain, int decimals) {
  return {std::to_string(gain.sentences),       shown(gain.shipped, decimals),
          shown(gain.tuned, decimals),          shown(gain.gain, decimals),
          shown(gain.standard_error, decimals), std::to_string(gain.better),
          std::to_string(gain.worse),           fmt::format("{:.2g}", gain.p_value)};
}

std::string gain_table(const Tuning& tuning) {
  const MeasureInfo& measure = info(tuning.objective);
  const int decimals = measure.decimals + 2;
  TextTable table({"tuned to", "spoken", "sentences", "shipped", "tuned", "gain", "se", "better",
                   "worse", "p"});
  const auto add = [&](std::string to, std::string spoken, const Scores& scores) {
    std::vector<std::string> row = gain_cells(gain_of(scores, tuning.objective), decimals);
    row.insert(row.begin(), {std::move(to), std::move(spoken)});
    table.add(row);
  };
  for (const TunedPart& fold : tuning.folds) {
    add(share_name(fold), "tuned to", fold.inner);
    add("", fmt::format("fold {}", fold.fold), fold.held_out);
  }
  add("all folds", "tuned to", inner_scores(tuning));
  add("", "held out", held_out_scores(tuning));
  add("all", "tuned to", tuning.all.inner);
  return fmt::format(
             "\n{} of sentences that the weights were tuned to, and of those of a fold that "
             "they have not seen\n",
             measure.label) +
         table.text();
}

std::string conclusion(const Tuning& tuning) {
  const int decimals = info(tuning.objective).decimals + 2;
  const Gain inner = gain_of(inner_scores(tuning), tuning.objective);
  const Gain outer = gain_of(held_out_scores(tuning), tuning.objective);
  std::string text =
      fmt::format("\nGain on the sentences tuned to {}, on held-out ones {} (p = {:.2g})",
                  shown(inner.gain, decimals), shown(outer.gain, decimals), outer.p_value);
  if (inner.gain && outer.gain) {
    text += fmt::format("; the gap of {} is what the tuning has learnt by heart",
                        shown(*inner.gain - *outer.gain, decimals));
  }
  text += fmt::format(".\n{}\n", verdict_sentence(verdict_of(tuning)));
  if (tuning.out_of_time) {
    text += "The time limit ended the search: another run may find other weights.\n";
  }
  return text;
}

} // namespace

std::string tuning_text(const Tuning& tuning) {
  const MeasureInfo& measure = info(tuning.objective);
  return heading(tuning) + weights_table(tuning) + gain_table(tuning) +
         fmt::format("  {}; {}\n  gain: what the tuned weights are better by, mean over sentences "
                     "with its standard error; p: Wilcoxon's signed-rank test, two-sided\n",
                     measure.formula, measure.mask) +
         conclusion(tuning);
}

} // namespace phonomime
