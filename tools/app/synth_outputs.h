// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/pipeline/synthesize.h"
#include "tools/app/synth.h"
#include "tools/app/synth_stock.h"

#include <filesystem>
#include <string>
#include <vector>

namespace phonomime {

// What can be said of a request without opening anything: ranges, output kinds, a face where one is
// needed. Throws UsageError.
void check_synth_options(const SynthOptions& options);

// Whether some output shows the face.
bool needs_face(const SynthOptions& options);

// Whether anybody is told of runners-up.
bool tells_runners_up(const SynthOptions& options);

// The outputs of one synthesis. Everything that they need is read first, so that a missing face or
// sound is known before the search.
class SynthOutputs {
public:
  // `notes` gets a line for each choice made for the user. Throws InputError and IoError.
  SynthOutputs(const SynthOptions& options, SynthStock& stock, std::vector<std::string>& notes);

  // Writes all outputs or none, and returns their paths. `csv`: what a .csv holds, where that is
  // not `result` itself. Throws IoError.
  std::vector<std::filesystem::path> write(const SynthesisResult& result,
                                           const std::string& result_json,
                                           const std::string* csv = nullptr);

private:
  std::string motion_text(const SynthesisResult& result) const;
  const std::string& glb(const SynthesisResult& result);
  std::string html(const SynthesisResult& result);

  const SynthOptions& options_;
  const MotionTable& table_;
  const FittedFace* face_ = nullptr; // of the stock
  std::string wav_;
  std::string glb_; // made once for all outputs that hold it
};

} // namespace phonomime
