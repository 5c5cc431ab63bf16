// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/phoneme_maps.h"

#include "db/types/errors.h"
#include "db/types/text.h"
#include "isomap/build_all_maps.h"
#include "tools/app/option_checks.h"
#include "tools/app/sha256.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

// Changes whenever the same frames and options would give other maps.
constexpr std::string_view kMethod = "phoneme maps 1";

const std::string& name_of(const MotionTable& table, std::int32_t phoneme) {
  return table.phonemes[static_cast<std::size_t>(phoneme)].name;
}

IsomapOptions options_of(const StoredMapRecord& record) {
  return {.neighbours = record.neighbours,
          .disconnected =
              record.keep_largest ? DisconnectedParts::keep_largest : DisconnectedParts::join,
          .largest_exact = record.largest_exact,
          .landmarks = record.landmark_count,
          .seed = record.seed};
}

StoredMap to_stored(const MotionTable& table, const PhonemeCluster& cluster,
                    const IsomapOptions& options, ClusterMaps maps) {
  return {.record = {.speaker = table.speaker,
                     .phoneme = name_of(table, cluster.phoneme),
                     .made_of = map_fingerprint(table, cluster, options),
                     .neighbours = options.neighbours,
                     .keep_largest = options.disconnected == DisconnectedParts::keep_largest,
                     .largest_exact = options.largest_exact,
                     .landmark_count = options.landmarks,
                     .seed = options.seed,
                     .nodes = static_cast<std::int64_t>(cluster.nodes.size()),
                     .frames = cluster.frame_count(),
                     .components = static_cast<std::int64_t>(maps.component_sizes.size()),
                     .landmarks = maps.landmarks,
                     .far_frames = static_cast<std::int64_t>(maps.far_points.size()),
                     .isomap_residual_variance = maps.isomap_residual_variance,
                     .pca_residual_variance = maps.pca_residual_variance,
                     .placed = static_cast<std::int64_t>(maps.kept.size())},
          .kept = std::move(maps.kept),
          .isomap = std::move(maps.isomap),
          .pca = std::move(maps.pca)};
}

// By the maps' own options. The counts are looked at as well, for a file may come from anywhere.
bool is_fresh(const MotionTable& table, const PhonemeCluster& cluster,
              const StoredMapRecord& record) {
  return record.frames == cluster.frame_count() &&
         record.made_of == map_fingerprint(table, cluster, options_of(record));
}

void take_places(StoredMap stored, PhonemeMaps& maps) {
  maps.record = std::move(stored.record);
  maps.kept = std::move(stored.kept);
  maps.isomap = std::move(stored.isomap);
  maps.pca = std::move(stored.pca);
  maps.row_of.assign(static_cast<std::size_t>(maps.cluster.frame_count()), -1);
  for (std::size_t row = 0; row < maps.kept.size(); ++row) {
    maps.row_of[static_cast<std::size_t>(maps.kept[row])] = static_cast<std::int32_t>(row);
  }
}

std::map<std::string, StoredMapRecord> records_by_phoneme(const MotionDatabase& database,
                                                          const std::string& speaker) {
  std::map<std::string, StoredMapRecord> records;
  for (StoredMapRecord& record : database.list_maps(speaker)) {
    std::string phoneme = record.phoneme;
    records.emplace(std::move(phoneme), std::move(record));
  }
  return records;
}

} // namespace

const char* map_state_name(MapState state) {
  switch (state) {
  case MapState::fresh:
    return "fresh";
  case MapState::stale:
    return "stale";
  case MapState::missing:
    break;
  }
  return "missing";
}

std::string map_fingerprint(const MotionTable& table, const PhonemeCluster& cluster,
                            const IsomapOptions& options) {
  Sha256 hash;
  hash.add(fmt::format("{}\n{} {} {} {} {}\n{}\n", kMethod, options.neighbours,
                       static_cast<int>(options.disconnected), options.largest_exact,
                       options.landmarks, options.seed, cluster.frames.cols()));
  for (const ClusterNode& node : cluster.nodes) {
    hash.add(fmt::format("{} {}\n", table.key(node.node), node.count));
  }
  hash.add({reinterpret_cast<const char*>(cluster.frames.data()),
            static_cast<std::size_t>(cluster.frames.size()) * sizeof(float)});
  return hash.hex();
}

std::vector<std::int32_t> phonemes_with_nodes(const MotionTable& table,
                                              const std::vector<std::string>& names) {
  std::set<std::int32_t> recorded;
  for (const MotionNode& node : table.nodes) {
    recorded.insert(node.phoneme);
  }
  if (names.empty()) {
    return {recorded.begin(), recorded.end()};
  }
  std::set<std::int32_t> wanted;
  for (const std::string& name : names) {
    const std::optional<std::int32_t> phoneme = table.find_phoneme(name);
    if (!phoneme || !recorded.contains(*phoneme)) {
      std::vector<std::string> known;
      for (const std::int32_t other : recorded) {
        known.push_back(name_of(table, other));
      }
      throw InputError(
          {.where = "speaker " + table.speaker,
           .what = fmt::format("there are no motion nodes of phoneme {}", quoted(name)),
           .expected = known.empty() ? "" : fmt::format("one of {}", fmt::join(known, ", ")),
           .remedy = did_you_mean(name, known)});
    }
    wanted.insert(*phoneme);
  }
  return {wanted.begin(), wanted.end()};
}

FrameMatrix PhonemeMaps::frames() const {
  FrameMatrix frames(static_cast<Eigen::Index>(kept.size()), cluster.frames.cols());
  for (std::size_t row = 0; row < kept.size(); ++row) {
    frames.row(static_cast<Eigen::Index>(row)) = cluster.frames.row(kept[row]);
  }
  return frames;
}

PhonemeMaps fresh_maps(const MotionDatabase& database, const MotionTable& table,
                       std::int32_t phoneme, int threads, const Progress& progress) {
  PhonemeMaps maps;
  maps.cluster = gather_cluster(table, phoneme);
  std::optional<StoredMap> stored = database.load_map(table.speaker, name_of(table, phoneme));
  if (stored) {
    maps.state = is_fresh(table, maps.cluster, stored->record) ? MapState::fresh : MapState::stale;
  }
  if (maps.state != MapState::fresh) {
    IsomapOptions options = stored ? options_of(stored->record) : IsomapOptions{};
    options.threads = threads;
    stored =
        to_stored(table, maps.cluster, options, build_maps(maps.cluster.frames, options, progress));
  }
  take_places(*std::move(stored), maps);
  return maps;
}

std::optional<PhonemeMaps> maps_if_fresh(const MotionDatabase& database, const MotionTable& table,
                                         std::int32_t phoneme) {
  std::optional<StoredMap> stored = database.load_map(table.speaker, name_of(table, phoneme));
  std::optional<PhonemeMaps> maps;
  if (stored) {
    PhonemeCluster cluster = gather_cluster(table, phoneme);
    if (is_fresh(table, cluster, stored->record)) {
      maps.emplace().cluster = std::move(cluster);
      maps->state = MapState::fresh;
      take_places(*std::move(stored), *maps);
    }
  }
  return maps;
}

std::vector<BuiltMap> build_phoneme_maps(const MapBuildOptions& options, const Progress& progress) {
  check_range("--threads", options.isomap.threads, 0, 256);
  check_range("--neighbours", options.isomap.neighbours, 1, 1000);
  check_range("--largest-exact", options.isomap.largest_exact, 1, 100'000);
  check_range("--landmarks", options.isomap.landmarks, 3, 100'000);
  // Read first: what is opened for writing is made where it is not there.
  const MotionTable table = MotionDatabase::open(options.database, OpenMode::read_only)
                                .load_motion_table(options.speaker);
  const std::vector<std::int32_t> phonemes = phonemes_with_nodes(table, options.phonemes);
  MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_write);
  const std::map<std::string, StoredMapRecord> records =
      records_by_phoneme(database, table.speaker);

  std::vector<BuiltMap> built;
  std::vector<PhonemeCluster> clusters;
  std::vector<std::size_t> built_of; // of each cluster its place in `built`
  for (const std::int32_t phoneme : phonemes) {
    PhonemeCluster cluster = gather_cluster(table, phoneme);
    BuiltMap& map = built.emplace_back();
    const auto record = records.find(name_of(table, phoneme));
    if (record != records.end()) {
      map.record = record->second;
      map.before = record->second.made_of == map_fingerprint(table, cluster, options.isomap) &&
                           is_fresh(table, cluster, record->second)
                       ? MapState::fresh
                       : MapState::stale;
    }
    if (map.before != MapState::fresh) {
      clusters.push_back(std::move(cluster));
      built_of.push_back(built.size() - 1);
    }
  }
  build_all_maps(clusters, options.isomap, progress, [&](std::size_t i, ClusterMaps&& maps) {
    StoredMap stored = to_stored(table, clusters[i], options.isomap, std::move(maps));
    database.save_map(stored);
    built[built_of[i]].record = std::move(stored.record);
  });
  return built;
}

std::vector<ShownMap> show_phoneme_maps(const std::filesystem::path& path,
                                        const std::string& speaker, const std::string& phoneme) {
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  const MotionTable table = database.load_motion_table(speaker);
  std::map<std::string, StoredMapRecord> records = records_by_phoneme(database, table.speaker);
  std::map<std::string, ShownMap> shown;
  for (auto& [name, record] : records) { // of nodes that are all pruned now, too
    shown[name] = {.phoneme = name, .state = MapState::stale, .record = std::move(record)};
  }
  for (const std::int32_t index : phonemes_with_nodes(table, {})) {
    const PhonemeCluster cluster = gather_cluster(table, index);
    ShownMap& map = shown[name_of(table, index)];
    map.phoneme = name_of(table, index);
    map.nodes = static_cast<std::int64_t>(cluster.nodes.size());
    map.frames = cluster.frame_count();
    if (map.state == MapState::stale && is_fresh(table, cluster, map.record)) {
      map.state = MapState::fresh;
    }
  }
  std::vector<ShownMap> maps;
  for (auto& [name, map] : shown) {
    if (phoneme.empty() || phoneme == name) {
      maps.push_back(std::move(map));
    }
  }
  if (maps.empty() && !phoneme.empty()) {
    phonemes_with_nodes(table, {phoneme}); // says that there is none
  }
  return maps;
}

} // namespace phonomime
