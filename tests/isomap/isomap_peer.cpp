// SPDX-License-Identifier: GPL-3.0-or-later
// usage: isomap_peer points.f32 DIMENSIONS K LARGEST_EXACT LANDMARKS THREADS OUT
// Builds the maps of points (little-endian float32, row by row) for isomap_peer_test.py: OUT.json
// has the figures, OUT.map and OUT.pca the places (float64, row by row), and for maps of up to
// 2,500 points, which are exact, OUT.geodesics the distances; quality is that of the Isomap with
// label i % 3 for point i.
#include "db/types/file_io.h"
#include "isomap/geodesics.h"
#include "isomap/isomap.h"
#include "isomap/map_quality.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace {

using namespace phonomime; // NOLINT: a program of one file

template <typename Matrix>
void write_matrix(const std::string& path, const Matrix& matrix) {
  write_file(path, {reinterpret_cast<const char*>(matrix.data()),
                    static_cast<std::size_t>(matrix.size()) * sizeof(double)});
}

void run(std::span<char*> words) {
  const std::string bytes = read_file(words[1]);
  const int dimensions = std::atoi(words[2]);
  FrameMatrix points(static_cast<Eigen::Index>(bytes.size() / sizeof(float)) / dimensions,
                     dimensions);
  std::memcpy(points.data(), bytes.data(), bytes.size());
  const IsomapOptions options = {.neighbours = std::atoi(words[3]),
                                 .largest_exact = std::atoi(words[4]),
                                 .landmarks = std::atoi(words[5]),
                                 .threads = std::atoi(words[6])};
  const std::string out = words[7];

  const auto start = std::chrono::steady_clock::now();
  const ClusterMaps maps = build_maps(points, options);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  struct rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  nlohmann::json figures = {{"seconds", time.count()},
                            {"landmarks", maps.landmarks},
                            {"components", maps.component_sizes.size()},
                            {"isomap_residual_variance", maps.isomap_residual_variance},
                            {"pca_residual_variance", maps.pca_residual_variance},
                            {"largest_memory_mib", usage.ru_maxrss / 1024}};
  write_matrix(out + ".map", maps.isomap);
  write_matrix(out + ".pca", maps.pca);
  if (points.rows() <= 2500) {
    std::vector<std::int32_t> labels, groups;
    for (std::int32_t i = 0; i < points.rows(); ++i) {
      labels.push_back(i % 3);
      groups.push_back(i);
    }
    const MapQuality quality = measure_map(points, maps.isomap, labels, groups);
    figures["silhouette"] = quality.silhouette.value();
    figures["trustworthiness"] = quality.trustworthiness.value();
    const NeighbourGraph graph(static_cast<std::int32_t>(points.rows()),
                               nearest_neighbours(points, options.neighbours, options.threads),
                               maps.joined);
    std::vector<std::int32_t> sources(static_cast<std::size_t>(points.rows()));
    std::iota(sources.begin(), sources.end(), 0);
    write_matrix(out + ".geodesics", geodesic_distances(graph, sources, options.threads));
  }
  write_file(out + ".json", figures.dump());
}

} // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 8) {
      return 2;
    }
    run({argv, static_cast<std::size_t>(argc)});
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "isomap_peer: %s\n", error.what());
    return 1;
  }
}
