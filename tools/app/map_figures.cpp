// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/map_figures.h"

#include "tools/app/option_checks.h"

#include <algorithm>
#include <set>

namespace phonomime {

namespace {

template <std::optional<double> MapQuality::*Member>
std::optional<double> quality(const MapFigures& figures, bool of_pca) {
  return (of_pca ? figures.pca : figures.isomap).*Member;
}

std::optional<double> residual_variance(const MapFigures& figures, bool of_pca) {
  return of_pca ? figures.record.pca_residual_variance : figures.record.isomap_residual_variance;
}

MapFigures measure(const PhonemeMaps& maps, int threads) {
  const FrameMatrix frames = maps.frames();
  std::vector<std::int32_t> emotions, nodes;
  for (const std::int32_t frame : maps.kept) {
    emotions.push_back(maps.cluster.emotion_of[static_cast<std::size_t>(frame)]);
    nodes.push_back(maps.cluster.node_of[static_cast<std::size_t>(frame)]);
  }
  const MapQualityOptions options = {.threads = threads};
  return {.record = maps.record,
          .state = maps.state,
          .emotions = static_cast<int>(std::set(emotions.begin(), emotions.end()).size()),
          .isomap = measure_map(frames, maps.isomap, emotions, nodes, options),
          .pca = measure_map(frames, maps.pca, emotions, nodes, options)};
}

} // namespace

std::vector<MapFigures> measure_phoneme_maps(const MapFiguresOptions& options,
                                             const Progress& progress) {
  check_range("--threads", options.threads, 0, 256);
  const MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_only);
  const MotionTable table = database.load_motion_table(options.speaker);
  const std::vector<std::int32_t> phonemes = phonemes_with_nodes(table, options.phonemes);
  std::vector<MapFigures> figures;
  for (const std::int32_t phoneme : phonemes) {
    progress.update("measuring maps", static_cast<std::int64_t>(figures.size()),
                    static_cast<std::int64_t>(phonemes.size()));
    figures.push_back(measure(fresh_maps(database, table, phoneme, options.threads,
                                         {.report = {}, .stop = progress.stop}),
                              options.threads));
  }
  return figures;
}

const std::vector<MapMeasure>& map_measures() {
  static const std::vector<MapMeasure> measures = {
      {"residual_variance", "residual", false, residual_variance},
      {"purity", "purity", true, quality<&MapQuality::purity>},
      {"silhouette", "silhouette", true, quality<&MapQuality::silhouette>},
      {"trustworthiness", "trust", true, quality<&MapQuality::trustworthiness>},
      {"continuity", "continuity", true, quality<&MapQuality::continuity>}};
  return measures;
}

MapContest compare_maps(const std::vector<MapFigures>& figures, const MapMeasure& measure) {
  MapContest contest;
  double frames = 0.0;
  for (const MapFigures& figure : figures) {
    const std::optional<double> isomap = measure.of(figure, false), pca = measure.of(figure, true);
    if (!isomap || !pca) {
      continue;
    }
    const double gain = measure.more_is_better ? *isomap - *pca : *pca - *isomap;
    (gain > 0.0 ? contest.isomap_better : gain < 0.0 ? contest.pca_better : contest.equal) += 1;
    const auto weight = static_cast<double>(figure.record.placed);
    contest.isomap_mean += weight * *isomap;
    contest.pca_mean += weight * *pca;
    frames += weight;
  }
  if (frames > 0.0) {
    contest.isomap_mean /= frames;
    contest.pca_mean /= frames;
  }
  return contest;
}

} // namespace phonomime
