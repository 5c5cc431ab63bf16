// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/map_quality.h"

#include "db/types/errors.h"
#include "db/types/parallel_for.h"
#include "isomap/landmarks.h"
#include "isomap/nearest_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace phonomime {

namespace {

// What is looked at: rows of the points, places, labels and groups that were chosen.
struct Sample {
  FrameMatrixD points;
  FrameMatrixD places;
  std::vector<std::int32_t> labels; // from 0 on
  std::vector<std::int32_t> groups;
  std::vector<std::int32_t> label_sizes;

  std::size_t size() const { return labels.size(); }
};

Sample take_sample(const FrameMatrix& points, const MapPlaces& places,
                   std::span<const std::int32_t> labels, std::span<const std::int32_t> groups,
                   const std::vector<std::int32_t>& chosen) {
  Sample sample;
  const auto count = static_cast<Eigen::Index>(chosen.size());
  sample.points.resize(count, points.cols());
  sample.places.resize(count, 2);
  std::map<std::int32_t, std::int32_t> known;
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::int32_t row = chosen[static_cast<std::size_t>(i)];
    sample.points.row(i) = points.row(row).cast<double>();
    sample.places.row(i) = places.row(row);
    const auto next = static_cast<std::int32_t>(known.size());
    const auto label = known.emplace(labels[static_cast<std::size_t>(row)], next).first->second;
    sample.labels.push_back(label);
    sample.groups.push_back(groups[static_cast<std::size_t>(row)]);
    sample.label_sizes.resize(known.size());
    ++sample.label_sizes[static_cast<std::size_t>(label)];
  }
  return sample;
}

struct PointMeasures {
  double purity = 0.0;
  bool has_purity = false;
  double silhouette = 0.0;
  double false_ranks = 0.0, lost_ranks = 0.0; // sums over neighbours of (rank - k) where > 0
};

std::vector<double> distances_sq(const FrameMatrixD& rows, std::size_t i) {
  std::vector<double> result(static_cast<std::size_t>(rows.rows()), 0.0);
  for (std::size_t j = 0; j < result.size(); ++j) {
    const double* a = rows.row(static_cast<Eigen::Index>(i)).data();
    const double* b = rows.row(static_cast<Eigen::Index>(j)).data();
    for (Eigen::Index d = 0; d < rows.cols(); ++d) {
      result[j] += (a[d] - b[d]) * (a[d] - b[d]);
    }
  }
  return result;
}

template <typename Accept>
NearestList nearest(const std::vector<double>& distances_sq, int count, const Accept& accept) {
  NearestList list(count);
  for (std::size_t j = 0; j < distances_sq.size(); ++j) {
    if (distances_sq[j] <= list.reach_sq() && accept(j)) {
      list.offer({distances_sq[j], static_cast<std::int32_t>(j)});
    }
  }
  return list;
}

// Sum over the neighbours in `list` of how far beyond k they rank by other distances from point i.
double excess_ranks(const NearestList& list, const std::vector<double>& other_sq, std::size_t i,
                    int k) {
  double excess = 0.0;
  for (const Candidate& neighbour : list.candidates()) {
    const auto index = static_cast<std::size_t>(neighbour.index);
    std::int64_t rank = 0; // how many are nearer or as near and before it
    for (std::size_t j = 0; j < other_sq.size(); ++j) {
      rank += other_sq[j] < other_sq[index] || (other_sq[j] == other_sq[index] && j <= index);
    }
    // The point itself is not counted.
    rank -= other_sq[i] < other_sq[index] || i <= index;
    excess += static_cast<double>(std::max<std::int64_t>(0, rank - k));
  }
  return excess;
}

double silhouette_of(const Sample& sample, const std::vector<double>& map_sq, std::size_t i) {
  const auto own = static_cast<std::size_t>(sample.labels[i]);
  if (sample.label_sizes[own] < 2) {
    return 0.0;
  }
  std::vector<double> sums(sample.label_sizes.size(), 0.0);
  for (std::size_t j = 0; j < sample.size(); ++j) {
    sums[static_cast<std::size_t>(sample.labels[j])] += std::sqrt(map_sq[j]);
  }
  const double inside = sums[own] / (sample.label_sizes[own] - 1);
  double outside = std::numeric_limits<double>::infinity();
  for (std::size_t label = 0; label < sums.size(); ++label) {
    if (label != own) {
      outside = std::min(outside, sums[label] / sample.label_sizes[label]);
    }
  }
  const double larger = std::max(inside, outside);
  return larger > 0.0 ? (outside - inside) / larger : 0.0;
}

PointMeasures measure_point(const Sample& sample, std::size_t i, int k) {
  const std::vector<double> map_sq = distances_sq(sample.places, i);
  const std::vector<double> point_sq = distances_sq(sample.points, i);
  PointMeasures measures;
  const NearestList others = nearest(
      map_sq, k, [&](std::size_t j) { return j != i && sample.groups[j] != sample.groups[i]; });
  measures.has_purity = !others.candidates().empty();
  if (measures.has_purity) {
    const auto same = std::count_if(
        others.candidates().begin(), others.candidates().end(), [&](const Candidate& other) {
          return sample.labels[static_cast<std::size_t>(other.index)] == sample.labels[i];
        });
    measures.purity = static_cast<double>(same) / static_cast<double>(others.candidates().size());
  }
  if (sample.label_sizes.size() > 1) {
    measures.silhouette = silhouette_of(sample, map_sq, i);
  }
  const auto not_itself = [&](std::size_t j) { return j != i; };
  measures.false_ranks = excess_ranks(nearest(map_sq, k, not_itself), point_sq, i, k);
  measures.lost_ranks = excess_ranks(nearest(point_sq, k, not_itself), map_sq, i, k);
  return measures;
}

// The mean over points with neighbours of the share of others outside their group with their label.
double purity_by_lot(const Sample& sample, const std::vector<PointMeasures>& measures) {
  std::map<std::int32_t, std::map<std::int32_t, std::int32_t>> of_group; // group -> label -> points
  for (std::size_t i = 0; i < sample.size(); ++i) {
    ++of_group[sample.groups[i]][sample.labels[i]];
  }
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    if (!measures[i].has_purity) {
      continue;
    }
    const auto& own = of_group[sample.groups[i]];
    std::int32_t group_size = 0;
    for (const auto& [label, points] : own) {
      group_size += points;
    }
    const auto same = sample.label_sizes[static_cast<std::size_t>(sample.labels[i])];
    sum += static_cast<double>(same - own.at(sample.labels[i])) /
           static_cast<double>(static_cast<std::int32_t>(sample.size()) - group_size);
    count += 1.0;
  }
  return sum / count;
}

} // namespace

MapQuality measure_map(const FrameMatrix& points, const MapPlaces& places,
                       std::span<const std::int32_t> labels, std::span<const std::int32_t> groups,
                       const MapQualityOptions& options) {
  const auto given = static_cast<std::size_t>(points.rows());
  if (places.rows() != points.rows() || labels.size() != given || groups.size() != given) {
    throw InternalError(
        {.where = "map quality", .what = "points, places and labels differ in number"});
  }
  const Sample sample = take_sample(
      points, places, labels, groups,
      choose_landmarks(static_cast<std::int32_t>(given), options.largest_sample, options.seed));
  std::vector<PointMeasures> measures(sample.size());
  parallel_for(static_cast<std::ptrdiff_t>(sample.size()), options.threads, [&](std::ptrdiff_t i) {
    const auto point = static_cast<std::size_t>(i);
    measures[point] = measure_point(sample, point, options.neighbours);
  });
  PointMeasures sums;
  double with_purity = 0.0;
  for (const PointMeasures& of_point : measures) {
    sums.purity += of_point.purity;
    with_purity += of_point.has_purity ? 1.0 : 0.0;
    sums.silhouette += of_point.silhouette;
    sums.false_ranks += of_point.false_ranks;
    sums.lost_ranks += of_point.lost_ranks;
  }
  MapQuality quality;
  const auto n = static_cast<double>(sample.size());
  const double k = options.neighbours;
  if (sample.label_sizes.size() > 1) {
    quality.silhouette = sums.silhouette / n;
    if (with_purity > 0.0) {
      quality.purity = sums.purity / with_purity;
      quality.purity_by_lot = purity_by_lot(sample, measures);
    }
  }
  if (n >= 2.0 * k + 1.0) {
    const double worst = n * k * (2.0 * n - 3.0 * k - 1.0) / 2.0;
    quality.trustworthiness = 1.0 - sums.false_ranks / worst;
    quality.continuity = 1.0 - sums.lost_ranks / worst;
  }
  return quality;
}

} // namespace phonomime
