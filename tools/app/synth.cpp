// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/synth.h"

#include "db/store/motion_database.h"
#include "synth/pipeline/explain.h"
#include "synth/pipeline/result_json.h"
#include "synth/pipeline/synthesize.h"
#include "tools/app/style_plan.h"
#include "tools/app/synth_inputs.h"
#include "tools/app/synth_outputs.h"
#include "tools/app/synth_stock.h"

#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

void count_joins(const SynthesisResult& result, SynthReport& report) {
  bool first = true;
  for (const PathRow& row : result.rows) {
    report.phonemes += row.phoneme.is_silence() ? 0 : 1;
    if (row.node != kNoNode) {
      report.joins += first ? 0 : 1;
      report.captured_joins += row.captured ? 1 : 0;
      first = false;
    }
  }
}

} // namespace

SynthReport run_synth(const SynthOptions& options, const Progress& progress) {
  check_synth_options(options);
  SynthStock stock(MotionDatabase::open(options.database, OpenMode::read_only)
                       .load_motion_table(options.speaker),
                   options.database);
  SearchKeeper keeper;
  return run_synth(options, stock, keeper, progress);
}

SynthReport run_synth(const SynthOptions& options, SynthStock& stock, SearchKeeper& keeper,
                      const Progress& progress) {
  const MotionTable& table = stock.table();
  SynthReport report;
  AskedEmotions emotions;
  SynthesisInput input =
      read_synthesis_input(options, table, stock.default_weights(options.cost.value_or(kUsualCost)),
                           emotions, report.notes);
  plan_style(emotions, stock, input, report.notes);
  SynthOutputs outputs(options, stock, report.notes);
  SynthesisResult result = synthesize(table, keeper.search(table, input.weights), input, progress);
  if (options.head) {
    result.output.head.assign(static_cast<std::size_t>(result.output.coefficients.rows()),
                              *options.head);
  }
  report.result_json = result_to_json(table, result).dump(1) + "\n";
  report.written = outputs.write(result, report.result_json);
  report.warnings = result.warnings;
  if (result.style) {
    report.notes.push_back(style_to_text(*result.style));
  }
  report.duration_s = result.end_s;
  report.cost = result.cost;
  count_joins(result, report);
  return report;
}

} // namespace phonomime
