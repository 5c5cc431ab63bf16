// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/map_figures.h"
#include "tools/app/map_image.h"
#include "tools/app/map_pick.h"
#include "tools/app/phoneme_maps.h"
#include "tools/app/recommend.h"

#include <filesystem>
#include <string>

namespace phonomime {

// What the words of `phonomime map ...` and `phonomime recommend` ask for.
struct MapBuildArguments {
  MapBuildOptions options;
};

struct MapShowArguments {
  std::filesystem::path database;
  std::string speaker;
  std::string phoneme; // empty: all
};

struct MapImageArguments {
  MapImageOptions options;
};

struct MapPickArguments {
  MapPickOptions options;
};

struct MapQualityArguments {
  MapFiguresOptions options;
  bool csv = false;
};

struct RecommendArguments {
  RecommendOptions options;
};

} // namespace phonomime
