// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/phoneme_cluster.h"

#include "db/types/parallel_for.h"
#include "isomap/nearest_list.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

double PhonemeCluster::relative_time(std::int32_t frame) const {
  const auto node = static_cast<std::size_t>(node_of[static_cast<std::size_t>(frame)]);
  const ClusterNode& of = nodes[node];
  return of.count < 2 ? 0.5 : static_cast<double>(frame - of.first) / (of.count - 1);
}

PhonemeCluster gather_cluster(const MotionTable& table, std::int32_t phoneme) {
  PhonemeCluster cluster;
  cluster.phoneme = phoneme;
  std::int32_t frame_count = 0;
  for (NodeIndex n = 0; n < table.node_count(); ++n) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(n)];
    if (node.phoneme == phoneme) {
      cluster.nodes.push_back({.node = n,
                               .emotion = node.emotion,
                               .previous_phoneme = node.previous_phoneme,
                               .next_phoneme = node.next_phoneme,
                               .first = frame_count,
                               .count = node.frame_count});
      frame_count += node.frame_count;
    }
  }
  cluster.frames.resize(frame_count, table.coefficients.cols());
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    const ClusterNode& node = cluster.nodes[n];
    cluster.frames.middleRows(node.first, node.count) = table.node_frames(node.node);
    cluster.node_of.insert(cluster.node_of.end(), static_cast<std::size_t>(node.count),
                           static_cast<std::int32_t>(n));
    cluster.emotion_of.insert(cluster.emotion_of.end(), static_cast<std::size_t>(node.count),
                              node.emotion);
  }
  return cluster;
}

std::vector<TimeCorrectFrame> time_correct_frames(const PhonemeCluster& cluster,
                                                  double relative_time) {
  std::vector<TimeCorrectFrame> frames;
  frames.reserve(cluster.nodes.size());
  for (const ClusterNode& node : cluster.nodes) {
    const double at = std::clamp(relative_time, 0.0, 1.0) * (node.count - 1);
    const auto before = std::min(static_cast<std::int32_t>(at), std::max(0, node.count - 2));
    frames.push_back({.a = node.first + before,
                      .b = node.first + std::min(before + 1, node.count - 1),
                      .share = node.count < 2 ? 0.0 : at - before});
  }
  return frames;
}

MapPlaces places_of(std::span<const TimeCorrectFrame> frames, const MapPlaces& places) {
  MapPlaces result(static_cast<Eigen::Index>(frames.size()), 2);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) = (1.0 - frames[i].share) * places.row(frames[i].a) +
                                               frames[i].share * places.row(frames[i].b);
  }
  return result;
}

std::vector<std::int32_t> context_correct_nodes(const PhonemeCluster& cluster,
                                                std::int32_t previous_phoneme,
                                                std::int32_t next_phoneme) {
  std::vector<std::int32_t> nodes;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    if (cluster.nodes[n].previous_phoneme == previous_phoneme &&
        cluster.nodes[n].next_phoneme == next_phoneme) {
      nodes.push_back(static_cast<std::int32_t>(n));
    }
  }
  return nodes;
}

MapPlaces place_frames(const FrameMatrix& points, const MapPlaces& places,
                       const FrameMatrix& frames, int threads, int neighbours) {
  MapPlaces result = MapPlaces::Zero(frames.rows(), 2);
  parallel_for(points.rows() > 0 ? frames.rows() : 0, threads, [&](std::ptrdiff_t f) {
    NearestList nearest(neighbours);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      double distance_sq = 0.0;
      for (Eigen::Index d = 0; d < points.cols(); ++d) {
        const double difference =
            static_cast<double>(points(i, d)) - static_cast<double>(frames(f, d));
        distance_sq += difference * difference;
      }
      nearest.offer({distance_sq, static_cast<std::int32_t>(i)});
    }
    const Candidate& first = nearest.candidates().front();
    if (first.distance_sq == 0.0) {
      result.row(f) = places.row(first.index);
      return;
    }
    double sum = 0.0;
    for (const Candidate& candidate : nearest.candidates()) {
      const double weight = 1.0 / std::sqrt(candidate.distance_sq);
      result.row(f) += weight * places.row(candidate.index);
      sum += weight;
    }
    result.row(f) /= sum;
  });
  return result;
}

} // namespace phonomime
