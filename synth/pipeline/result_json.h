// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synth/pipeline/synthesize.h"

#include <nlohmann/json_fwd.hpp>

namespace phonomime {

// What `synth --json` prints (DESIGN 10, corpora_schema/result.md): `cost`, `path`, `search`,
// `warnings`. All of it but search.seconds is the same for the same input.
nlohmann::ordered_json result_to_json(const MotionTable& table, const SynthesisResult& result);

} // namespace phonomime
