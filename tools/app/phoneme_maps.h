// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/motion_database.h"
#include "db/types/progress.h"
#include "isomap/isomap.h"
#include "isomap/phoneme_cluster.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

// Whether a phoneme's maps are stored, and belong to its frames as they are now.
enum class MapState { fresh, stale, missing };
const char* map_state_name(MapState state);

// What maps are made of: the frames, their nodes and the options. A pruned or restored node, an
// import, another PCA or other options give another fingerprint, what was before the same again.
std::string map_fingerprint(const MotionTable& table, const PhonemeCluster& cluster,
                            const IsomapOptions& options);

// The phonemes that have nodes and are named (all of them where none is), in order of the table.
// Throws InputError for a name without nodes.
std::vector<std::int32_t> phonemes_with_nodes(const MotionTable& table,
                                              const std::vector<std::string>& names);

// A phoneme's maps as they are used: never stale ones.
struct PhonemeMaps {
  PhonemeCluster cluster;
  std::vector<std::int32_t> kept;   // into the cluster's frames, ascending: those on the maps
  std::vector<std::int32_t> row_of; // #frames of the cluster: its row on the maps, or -1
  MapPlaces isomap, pca;            // #kept by 2
  StoredMapRecord record;
  MapState state = MapState::missing; // of what was stored; unless fresh, they were made now

  const MapPlaces& places(bool of_pca) const { return of_pca ? pca : isomap; }
  FrameMatrix frames() const; // those on the maps: #kept by #dimensions
};

// The stored maps where they are fresh; else they are made now, with the options of the stale ones,
// or the usual ones, and not stored. `threads`: 0 as many as there are. Throws Interrupted.
PhonemeMaps fresh_maps(const MotionDatabase& database, const MotionTable& table,
                       std::int32_t phoneme, int threads, const Progress& progress);

// The stored maps, or nothing unless they are fresh.
std::optional<PhonemeMaps> maps_if_fresh(const MotionDatabase& database, const MotionTable& table,
                                         std::int32_t phoneme);

struct MapBuildOptions {
  std::filesystem::path database;
  std::string speaker;               // may be empty where there is only one
  std::vector<std::string> phonemes; // empty: all that have nodes
  IsomapOptions isomap;
};

// What became of a phoneme's maps.
struct BuiltMap {
  StoredMapRecord record;
  MapState before = MapState::missing; // fresh: nothing was to be done
};

// Makes and stores the maps that are missing, stale, or made with other options, each as soon as it
// is made: a build that was stopped goes on where it was. In order of phonemes. Throws UsageError,
// InputError, IoError and Interrupted.
std::vector<BuiltMap> build_phoneme_maps(const MapBuildOptions& options, const Progress& progress);

// What a database has of maps.
struct ShownMap {
  std::string phoneme;
  std::int64_t nodes = 0, frames = 0; // now
  MapState state = MapState::missing;
  StoredMapRecord record; // unless missing
};

// The phonemes that are named and have nodes or maps; all of those where none is named. Throws
// InputError and IoError.
std::vector<ShownMap> show_phoneme_maps(const std::filesystem::path& database,
                                        const std::string& speaker, const std::string& phoneme);

} // namespace phonomime
