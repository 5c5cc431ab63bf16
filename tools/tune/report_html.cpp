// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/html_text.h"
#include "db/types/percentile.h"
#include "db/types/text.h"
#include "tools/evaluate/text_table.h"
#include "tools/tune/curve_picture.h"
#include "tools/tune/tuning.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::string_view kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:1160px;margin:2em auto;padding:0 1em;"
    "color:#222;background:#fff}h1{font-size:1.6em}h2{font-size:1.2em;margin-top:2em}"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums}.wide{overflow-x:auto}"
    "td,th{padding:.2em .7em;text-align:right;border-bottom:1px solid #ddd;white-space:nowrap}"
    "td:first-child,th:first-child,.pairs td:nth-child(2),.pairs th:nth-child(2){text-align:left}"
    ".plots{display:flex;flex-wrap:wrap;gap:1em}"
    ".verdict{font-size:1.1em;border-left:4px solid #2a6f97;padding-left:.8em}"
    "svg text{font-size:11px;fill:#444}svg .title{font-size:13px;fill:#222}"
    "svg .grid{stroke:#e4e4e4}svg path{stroke-width:1.6}.muted{color:#666}";
constexpr std::string_view kLooked = "#8d99ae", kShipped = "#e07a1f", kTuned = "#2a6f97";

class Table {
public:
  explicit Table(const std::vector<std::string>& header) { add_row(header, "th"); }
  void add(const std::vector<std::string>& cells) { add_row(cells, "td"); }
  // `kind`: a class of the style, or empty.
  std::string html(std::string_view kind = "") const {
    return fmt::format("<div class='wide'><table class='{}'>{}</table></div>\n", kind, rows_);
  }

private:
  void add_row(const std::vector<std::string>& cells, std::string_view tag) {
    rows_ += "<tr>";
    for (const std::string& cell : cells) {
      rows_ += fmt::format("<{0}>{1}</{0}>", tag, escape_html(cell));
    }
    rows_ += "</tr>\n";
  }
  std::string rows_;
};

std::string part_name(const TunedPart& part) {
  return part.fold > 0 ? fmt::format("without fold {}", part.fold) : "all sentences";
}

std::string gains(const Tuning& tuning) {
  const int decimals = info(tuning.objective).decimals + 2;
  Table table({"tuned to", "spoken", "sentences", "shipped", "tuned", "gain", "standard error",
               "better", "worse", "p"});
  const auto add = [&](std::string to, std::string spoken, const Scores& scores) {
    const Gain gain = gain_of(scores, tuning.objective);
    table.add({std::move(to), std::move(spoken), std::to_string(gain.sentences),
               shown(gain.shipped, decimals), shown(gain.tuned, decimals),
               shown(gain.gain, decimals), shown(gain.standard_error, decimals),
               std::to_string(gain.better), std::to_string(gain.worse),
               fmt::format("{:.2g}", gain.p_value)});
  };
  add("each fold's others", "sentences tuned to", inner_scores(tuning));
  add("each fold's others", "held-out sentences", held_out_scores(tuning));
  for (const TunedPart& fold : tuning.folds) {
    add(part_name(fold), "sentences tuned to", fold.inner);
    add(part_name(fold), fmt::format("fold {}", fold.fold), fold.held_out);
  }
  add(part_name(tuning.all), "sentences tuned to", tuning.all.inner);
  return table.html("pairs");
}

std::string weights(const Tuning& tuning) {
  std::vector<std::string> header = {"weight", "looked for", "shipped", "tuned"};
  for (const TunedPart& fold : tuning.folds) {
    header.push_back(part_name(fold));
  }
  Table table(header);
  for (const TunableWeight& weight : tuning.weights) {
    std::vector<std::string> row = {
        std::string(weight.name),
        fmt::format("{} to {}", format_number(weight.least), format_number(weight.most)),
        format_number(tuning.shipped.*weight.member),
        format_number(tuning.all.tuned.*weight.member)};
    for (const TunedPart& fold : tuning.folds) {
      row.push_back(format_number(fold.tuned.*weight.member));
    }
    table.add(row);
  }
  return table.html();
}

// From the best value to that which a quarter of the looks are worse than, the shipped weights
// among them: a few bad ones would press all others together.
void frame(Plot& plot, const TunedPart& part) {
  std::vector<double> values;
  for (const EvaluatedWeights& look : part.looks) {
    values.push_back(look.value);
  }
  std::ranges::sort(values);
  const double most = std::max(*percentile(values, 0.75), part.looks.front().value);
  const double margin = 0.06 * (most - values.front()) + 1e-9;
  plot.y_least = values.front() - margin;
  plot.y_most = most + margin;
}

std::string weight_plot(const Tuning& tuning, const TunableWeight& weight) {
  Plot plot{.title = std::string(weight.name),
            .x_label = std::string(weight.name),
            .y_label = "objective",
            .log_x = true};
  PlotSeries looks{.name = "evaluated", .color = std::string(kLooked)};
  PlotSeries best{.name = "tuned", .color = std::string(kTuned)};
  PlotSeries shipped{.name = "shipped", .color = std::string(kShipped)};
  const TunedPart& all = tuning.all;
  const auto at = [&](const EvaluatedWeights& look) {
    return PlotPoint{.x = look.weights.*weight.member, .y = look.value};
  };
  for (const EvaluatedWeights& look : all.looks) {
    looks.points.push_back(at(look));
  }
  shipped.points.push_back(at(all.looks.front()));
  best.points.push_back(at(*std::ranges::min_element(all.looks, {}, &EvaluatedWeights::value)));
  // Shipped weights may be 0, which a logarithmic axis does not have.
  if (tuning.shipped.*weight.member <= 0.0) {
    looks.points.erase(looks.points.begin());
    shipped.points.clear();
  }
  plot.series = {looks, shipped, best};
  frame(plot, all);
  return draw_plot(plot);
}

// The best value so far, evaluation by evaluation.
std::string course_plot(const TunedPart& part) {
  Plot plot{.title = part_name(part), .x_label = "evaluations", .y_label = "best objective"};
  PlotSeries course{.name = "best so far", .color = std::string(kTuned), .line = true};
  double best = std::numeric_limits<double>::infinity();
  double number = 0.0;
  for (const EvaluatedWeights& look : part.looks) {
    best = std::min(best, look.value);
    course.points.push_back({.x = ++number, .y = best});
  }
  PlotSeries shipped{.name = "shipped", .color = std::string(kShipped), .line = true};
  shipped.points = {{.x = 1.0, .y = part.looks.front().value},
                    {.x = number, .y = part.looks.front().value}};
  plot.series = {shipped, course};
  frame(plot, part);
  return draw_plot(plot);
}

std::string facts(const Tuning& tuning) {
  std::string html = "<ul class='muted'>\n";
  for (const auto& [name, value] : tuning.options) {
    html += fmt::format("<li>{}: {}</li>\n", escape_html(name), escape_html(value));
  }
  for (const std::string& note : tuning.notes) {
    html += fmt::format("<li>{}</li>\n", escape_html(note));
  }
  return html + "</ul>\n";
}

} // namespace

std::string tuning_html(const Tuning& tuning) {
  const MeasureInfo& measure = info(tuning.objective);
  const std::string title = escape_html("Cost weights tuned to " + tuning.corpus);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>"
      "<meta name='viewport' content='width=device-width,initial-scale=1'><title>{0}</title>"
      "<style>{1}</style></head><body>\n<h1>{0}</h1>\n<p class='verdict'>{2}</p>\n",
      title, kStyle, escape_html(verdict_sentence(verdict_of(tuning))));
  if (tuning.out_of_time) {
    html += "<p>The time limit ended the search: another run may find other weights.</p>\n";
  }
  const std::string_view unit = unit_of(tuning.objective, tuning.kind);
  html += fmt::format(
      "<p>Objective: {}, {} ({}). Gain: what the tuned weights are better by; p: Wilcoxon's "
      "signed-rank test over sentences, two-sided.</p>\n<h2>Held-out sentences and those tuned "
      "to</h2>\n{}<h2>Weights</h2>\n{}",
      escape_html(measure.label), escape_html(measure.formula),
      unit == "1" ? std::string("no unit") : escape_html(unit), gains(tuning), weights(tuning));
  html += "<h2>The objective over each weight</h2>\n<p>Evaluations of the tuning to all "
          "sentences, without the worst quarter; orange the shipped weights, blue the tuned "
          "ones.</p>\n<div class='plots'>\n";
  for (const TunableWeight& weight : tuning.weights) {
    html += weight_plot(tuning, weight);
  }
  html += "</div>\n<h2>How the search went</h2>\n<p>Blue the best found so far, orange the shipped "
          "weights; first the starts, then the descents.</p>\n<div class='plots'>\n";
  html += course_plot(tuning.all);
  for (const TunedPart& fold : tuning.folds) {
    html += course_plot(fold);
  }
  return html + "</div>\n<h2>Run</h2>\n" + facts(tuning) + "</body></html>\n";
}

} // namespace phonomime
