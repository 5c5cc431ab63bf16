// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "tools/app/synth.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace phonomime {

// What single words of a call stand for. All throw UsageError.

// "YAW,PITCH,ROLL[,X,Y,Z]": degrees about y (up), x (right of the picture), z (towards the camera),
// applied in the order roll, pitch, yaw; millimetres.
HeadPose parse_head(const std::string& text);

// "linear", "cosine" or "cubic".
SilenceFill parse_silence(const std::string& text);

// "paper" or "context"; nothing for "".
std::optional<CostModel> parse_cost(const std::string& text);

// "measured" or "nominal"; nothing for "".
std::optional<Scale> parse_scale(const std::string& text);

// The first word of `call` that is no option has to be one of the verbs; a call without any word is
// refused too.
void check_verb(std::span<const char* const> call, const std::vector<std::string>& verbs);

// Of `nodes --limit`.
void check_limit(long limit);

} // namespace phonomime
