// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/map_figures.h"
#include "tools/app/map_image.h"
#include "tools/app/map_pick.h"
#include "tools/app/phoneme_maps.h"

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace phonomime {

// What the verbs of `phonomime map` print: as JSON, and for people.
nlohmann::ordered_json built_maps_json(const std::vector<BuiltMap>& maps);
std::string built_maps_text(const std::vector<BuiltMap>& maps);

nlohmann::ordered_json shown_maps_json(const std::vector<ShownMap>& maps);
std::string shown_maps_text(const std::vector<ShownMap>& maps);

nlohmann::ordered_json map_image_json(const MapImageOptions& options, const MapImageReport& report);
std::string map_image_text(const MapImageOptions& options, const MapImageReport& report);

nlohmann::ordered_json map_pick_json(const MapPickOptions& options, const MapPickReport& report);
std::string map_pick_text(const MapPickOptions& options, const MapPickReport& report);

nlohmann::ordered_json map_figures_json(const std::vector<MapFigures>& figures);
std::string map_figures_csv(const std::vector<MapFigures>& figures);
std::string map_figures_text(const std::vector<MapFigures>& figures);

} // namespace phonomime
