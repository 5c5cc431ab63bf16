// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/layout.h"
#include "tools/app/map_image.h"
#include "tools/app/synth.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
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

// "join" or "largest".
DisconnectedParts parse_components(const std::string& text);

// Whether it is the PCA map: "isomap" or "pca".
bool parse_map_kind(const std::string& text);

// "WIDTHxHEIGHT".
std::pair<int, int> parse_size(const std::string& text);

// Each "EMOTION=#rrggbb".
std::map<std::string, Colour> parse_palette(const std::vector<std::string>& texts);

// The first word of `call` that is no option has to be one of the verbs of `program`; a call
// without any word is refused too.
void check_verb(std::span<const char* const> call, const std::vector<std::string>& verbs,
                const std::string& program);

// Of `nodes --limit`.
void check_limit(long limit);

} // namespace phonomime
