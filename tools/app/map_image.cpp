// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/map_image.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/json_file.h"
#include "db/types/text.h"
#include "tools/app/option_checks.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

bool is_svg(const std::filesystem::path& path) {
  const std::string suffix = to_lower(path.extension().string());
  if (suffix != ".png" && suffix != ".svg") {
    throw UsageError({.where = path.string(),
                      .what = "the suffix names no kind of picture",
                      .expected = ".png or .svg",
                      .got = quoted(suffix)});
  }
  return suffix == ".svg";
}

void check_options(const MapImageOptions& options) {
  for (const std::filesystem::path& output : options.outputs) {
    is_svg(output);
  }
  check_outputs_differ(options.outputs);
  check_range("--size", options.picture.width_px, 64, 8192);
  check_range("--size", options.picture.height_px, 64, 8192);
  check_range("--sigma", options.picture.density.sigma_px, 0.5, 500);
  check_range("--time-correct", options.relative_time.value_or(0.0), 0.0, 1.0);
  check_range("--threads", options.threads, 0, 256);
}

std::int32_t require_phoneme(const MotionTable& table, const std::string& name) {
  const std::optional<std::int32_t> phoneme = table.find_phoneme(name);
  if (!phoneme) {
    std::vector<std::string> known;
    std::ranges::transform(table.phonemes, std::back_inserter(known), &Phoneme::name);
    throw InputError({.where = "--context",
                      .what = fmt::format("there is no phoneme {}", quoted(name)),
                      .remedy = did_you_mean(name, known)});
  }
  return *phoneme;
}

// Into the cluster's nodes; nothing where the node is of another phoneme.
std::optional<std::size_t> find_in(const PhonemeCluster& cluster, NodeIndex node) {
  const auto found = std::ranges::lower_bound(cluster.nodes, node, {}, &ClusterNode::node);
  return found != cluster.nodes.end() && found->node == node
             ? std::optional(static_cast<std::size_t>(found - cluster.nodes.begin()))
             : std::nullopt;
}

// The node keys of a synthesis result's path.
std::vector<std::string> path_of_result(const std::filesystem::path& file,
                                        const std::string& speaker) {
  const nlohmann::json result = parse_json_as("result", read_file(file), file.string());
  if (result["speaker"].get_ref<const std::string&>() != speaker) {
    throw InputError({.where = file.string(),
                      .what = "the result is of another speaker",
                      .expected = speaker,
                      .got = quoted(result["speaker"].get_ref<const std::string&>())});
  }
  std::vector<std::string> keys;
  for (const nlohmann::json& row : result["path"]) {
    if (row["node"].is_string()) {
      keys.push_back(row["node"].get<std::string>());
    }
  }
  return keys;
}

// Gathers the picture of a phoneme's map.
class PictureMaker {
public:
  PictureMaker(const MotionDatabase& database, const MotionTable& table, const PhonemeMaps& maps,
               const MapImageOptions& options, MapImageReport& report)
      : database_(database), table_(table), maps_(maps), options_(options), report_(report),
        places_(maps.places(options.pca)) {}

  MapPicture make() {
    add_frames();
    roles_.assign(maps_.cluster.nodes.size(), TrajectoryRole::node);
    choose_roles();
    add_trajectories();
    if (options_.relative_time) {
      add_marks(*options_.relative_time);
    }
    if (options_.pruned) {
      add_pruned();
    }
    return std::move(picture_);
  }

private:
  // Densities, and the emotions that occur.
  void add_frames() {
    const StoredMapRecord& record = maps_.record;
    picture_.title = fmt::format("/{}/ of {}, {}: {} frames of {} motion nodes", options_.phoneme,
                                 table_.speaker, options_.pca ? "PCA map" : "phoneme-Isomap",
                                 record.placed, record.nodes);
    const std::vector<Colour> palette = palette_for(table_.emotions, options_.palette);
    emotion_index_.assign(table_.emotions.size(), -1);
    for (const ClusterNode& node : maps_.cluster.nodes) {
      emotion_index_[static_cast<std::size_t>(node.emotion)] = 0;
    }
    for (std::size_t e = 0; e < emotion_index_.size(); ++e) {
      if (emotion_index_[e] == 0) {
        emotion_index_[e] = static_cast<std::int32_t>(picture_.emotions.size());
        picture_.emotions.push_back(table_.emotions[e]);
        picture_.palette.push_back(palette[e]);
      }
    }
    picture_.places = places_;
    for (const std::int32_t frame : maps_.kept) {
      picture_.emotion_of.push_back(
          index_of_emotion(maps_.cluster.emotion_of[static_cast<std::size_t>(frame)]));
    }
  }

  std::int32_t index_of_emotion(std::int32_t emotion) const {
    return emotion_index_[static_cast<std::size_t>(emotion)];
  }

  // What is highlighted later covers what was before.
  void choose_roles() {
    if (options_.suspects) {
      for (const NodeRecord& record : list_nodes({.suspect = true, .pruned = false})) {
        if (!record.has_gap) { // those are on no map
          set_role(require_node(record.key, "--suspects"), TrajectoryRole::suspect);
        }
      }
    }
    if (!options_.previous.empty()) {
      for (const std::int32_t node :
           context_correct_nodes(maps_.cluster, require_phoneme(table_, options_.previous),
                                 require_phoneme(table_, options_.next))) {
        set_role(static_cast<std::size_t>(node), TrajectoryRole::context_correct);
      }
    }
    for (const std::string& key : options_.chosen) {
      set_role(require_node(key, "--nodes"), TrajectoryRole::chosen);
    }
    if (!options_.path.empty()) {
      for (const std::string& key : path_of_result(options_.path, table_.speaker)) {
        if (const auto node =
                find_in(maps_.cluster, table_.find_node(key, options_.path.string()))) {
          set_role(*node, TrajectoryRole::chosen);
        }
      }
    }
    report_.suspect = count(TrajectoryRole::suspect);
    report_.context_correct = count(TrajectoryRole::context_correct);
    report_.chosen = count(TrajectoryRole::chosen);
  }

  std::int64_t count(TrajectoryRole role) const { return std::ranges::count(roles_, role); }
  void set_role(std::size_t node, TrajectoryRole role) { roles_[node] = role; }

  std::size_t require_node(const std::string& key, const char* where) const {
    const NodeIndex node = table_.find_node(key, where);
    const std::optional<std::size_t> found = find_in(maps_.cluster, node);
    if (!found) {
      const MotionNode& other = table_.nodes[static_cast<std::size_t>(node)];
      throw InputError(
          {.where = where,
           .what = fmt::format("{} is of another phoneme", quoted(key)),
           .expected = fmt::format("a node of /{}/", options_.phoneme),
           .got =
               fmt::format("/{}/", table_.phonemes[static_cast<std::size_t>(other.phoneme)].name)});
    }
    return *found;
  }

  std::vector<NodeRecord> list_nodes(NodeFilter filter) const {
    filter.phoneme = options_.phoneme;
    filter.speaker = table_.speaker;
    return database_.list_nodes(filter);
  }

  std::int32_t row_of(std::int32_t frame) const {
    return maps_.row_of[static_cast<std::size_t>(frame)];
  }

  void add_trajectories() {
    for (std::size_t n = 0; n < roles_.size(); ++n) {
      if (roles_[n] == TrajectoryRole::node && !options_.trajectories) {
        continue;
      }
      const ClusterNode& node = maps_.cluster.nodes[n];
      std::vector<Eigen::Index> rows;
      for (std::int32_t frame = node.first; frame < node.first + node.count; ++frame) {
        if (row_of(frame) >= 0) {
          rows.push_back(row_of(frame));
        }
      }
      if (!rows.empty()) {
        picture_.trajectories.push_back(
            {places_(rows, Eigen::all), index_of_emotion(node.emotion), roles_[n]});
      }
    }
  }

  void add_marks(double relative_time) {
    const std::vector<TimeCorrectFrame> frames = time_correct_frames(maps_.cluster, relative_time);
    for (std::size_t n = 0; n < frames.size(); ++n) {
      TimeCorrectFrame at = frames[n];
      at.a = row_of(at.a);
      at.b = row_of(at.b);
      if (at.a < 0 || at.b < 0) {
        continue;
      }
      const MarkRole role = roles_[n] == TrajectoryRole::chosen ? MarkRole::chosen
                            : roles_[n] == TrajectoryRole::context_correct
                                ? MarkRole::context_correct
                                : MarkRole::time_correct;
      const MapPlaces place = places_of(std::span(&at, 1), places_);
      picture_.marks.push_back({place(0, 0), place(0, 1), role});
    }
  }

  // Pruned nodes are on no map: they are shown where the frames are that are most like theirs.
  void add_pruned() {
    const FrameMatrix on_map = maps_.frames();
    for (const NodeRecord& record : list_nodes({.pruned = true, .has_gap = false})) {
      const FrameMatrix channels =
          database_.load_channels({record.speaker, record.emotion, record.sentence, {}});
      if (record.first_frame < 0 || record.first_frame + record.frame_count > channels.rows()) {
        throw InputError(
            {.where = options_.database.string(),
             .what = "the database is damaged: frames of " + record.key + " outside its sentence"});
      }
      FrameMatrix frames(record.frame_count, table_.pca.dimension_count());
      for (Eigen::Index i = 0; i < frames.rows(); ++i) {
        const Eigen::VectorXd frame = channels.row(record.first_frame + i).cast<double>();
        frames.row(i) = table_.pca.project(frame).cast<float>();
      }
      picture_.trajectories.push_back(
          {place_frames(on_map, places_, frames, options_.threads), 0, TrajectoryRole::pruned});
      ++report_.pruned;
    }
  }

  const MotionDatabase& database_;
  const MotionTable& table_;
  const PhonemeMaps& maps_;
  const MapImageOptions& options_;
  MapImageReport& report_;
  const MapPlaces& places_;
  MapPicture picture_;
  std::vector<std::int32_t> emotion_index_; // of the table's emotions into the picture's, or -1
  std::vector<TrajectoryRole> roles_;       // of the cluster's nodes
};

} // namespace

MapImageReport draw_map_image(const MapImageOptions& options, const Progress& progress) {
  check_options(options);
  const MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_only);
  const MotionTable table = database.load_motion_table(options.speaker);
  for (const auto& [emotion, colour] : options.palette) {
    if (!table.find_emotion(emotion)) {
      throw InputError({.where = "--palette",
                        .what = fmt::format("there is no emotion {}", quoted(emotion)),
                        .remedy = did_you_mean(emotion, table.emotions)});
    }
  }
  const std::int32_t phoneme = phonemes_with_nodes(table, {options.phoneme}).front();
  const PhonemeMaps maps = fresh_maps(database, table, phoneme, options.threads, progress);
  MapImageReport report = {.record = maps.record, .state = maps.state};
  const MapPicture picture = PictureMaker(database, table, maps, options, report).make();
  MapPictureOptions picture_options = options.picture;
  picture_options.density.threads = options.threads;
  OutputFiles files;
  for (const std::filesystem::path& output : options.outputs) {
    files.stage(output, is_svg(output) ? draw_svg(picture, picture_options)
                                       : draw_png(picture, picture_options));
  }
  files.commit();
  return report;
}

} // namespace phonomime
