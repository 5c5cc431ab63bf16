// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "tools/app/synth.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace phonomime {

// A synthesis of a transcript that is still being written. Of `synth`, what a stream has no place
// for is not given: transcript, tier, outputs, audio, face, runners-up.
struct StreamOptions {
  SynthOptions synth;
  int look_ahead = 3;     // phonemes known beyond one before its node is final, 0 to 1000
  bool bound_loss = true; // StreamReport::lower_bound, which takes a while for a long stream
  bool compare = false;   // StreamReport::optimum: keeps the transcript and solves it at the end
};

// Where lines come from and what becomes of frames.
struct StreamEnds {
  std::function<std::optional<std::string>()> next_line; // waits; nothing at the end
  std::function<void(std::string_view)> write;           // CSV, whole lines, to be seen at once
  std::function<void(const std::string&)> warn;
};

struct StreamReport {
  std::size_t phonemes = 0; // without /pau/
  std::int64_t frames = 0;
  double duration_s = 0.0;
  double cost = 0.0;                 // E4
  std::optional<double> lower_bound; // of the cost that any choice of nodes could have
  std::optional<double> optimum;     // the least cost
};

// Reads rows, chooses nodes and writes frames as they become final, in the columns of a `.csv`
// output. Throws UsageError, InputError (with the line's number), IoError and Interrupted; the
// frames that have been written stay good.
StreamReport run_stream(const StreamOptions& options, const StreamEnds& ends,
                        const Progress& progress);

} // namespace phonomime
