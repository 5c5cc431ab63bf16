// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/marker_spread.h"

#include "tests/synth/retarget/made_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

// Shortest paths between all vertices, by Floyd and Warshall.
Eigen::MatrixXd all_distances(const TriangleMesh& mesh) {
  const Eigen::Index n = mesh.vertex_count();
  Eigen::MatrixXd d = Eigen::MatrixXd::Constant(n, n, std::numeric_limits<double>::infinity());
  d.diagonal().setZero();
  for (Eigen::Index t = 0; t < mesh.triangle_count(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int a = mesh.triangles(t, corner);
      const int b = mesh.triangles(t, (corner + 1) % 3);
      d(a, b) = d(b, a) = (mesh.positions.row(a) - mesh.positions.row(b)).norm();
    }
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        d(i, j) = std::min(d(i, j), d(i, k) + d(k, j));
      }
    }
  }
  return d;
}

// E14 and E15 as written down, with w0.
Eigen::MatrixXd plain_weights(const Eigen::MatrixXd& distances, const std::vector<int>& markers,
                              const std::vector<double>& sigma) {
  Eigen::MatrixXd weights(distances.rows(), markers.size());
  for (Eigen::Index i = 0; i < weights.rows(); ++i) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < weights.cols(); ++k) {
      const double d = distances(i, markers[static_cast<std::size_t>(k)]);
      const double s = sigma[static_cast<std::size_t>(k)];
      weights(i, k) = std::exp(-d * d / (2.0 * s * s));
      sum += weights(i, k);
    }
    weights.row(i) /= std::max(sum, std::exp(-2.0));
  }
  return weights;
}

const std::vector<int> kMarkers = {3, 11, 30, 38, 52, 60};

TEST(MarkerSpread, OnePassIsE15ByHandOnAStrip) {
  // Two rows of vertices 1 mm apart; markers at x = 0 and x = 10 of the lower row, sigma 2 mm.
  const TriangleMesh strip = test::grid(11, 2);
  const EdgeGraph graph(strip.positions, strip.triangles);
  const SpreadWeights weights =
      spread_weights(graph, std::vector<int>{0, 10}, {.sigma_mm = 2.0, .threads = 1});
  const double near = std::exp(-1.0 / 8.0);
  const double far = std::exp(-81.0 / 8.0);
  EXPECT_NEAR(weights.coeff(1, 0), near / (near + far), 1e-12);
  EXPECT_NEAR(weights.coeff(1, 1), far / (near + far), 1e-12);
  // In the middle the sum, 2 exp(-25/8) = 0.088, is below w0 = exp(-2): the motion fades.
  EXPECT_NEAR(weights.coeff(5, 0), std::exp(-25.0 / 8.0) / std::exp(-2.0), 1e-12);
  EXPECT_NEAR(weights.coeff(5, 0) + weights.coeff(5, 1), 2.0 * std::exp(-9.0 / 8.0), 1e-12);
}

TEST(MarkerSpread, OnePassIsE15WithBruteForceDistances) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const TriangleMesh mesh = test::grid(8, 8, 0.3, seed);
    const EdgeGraph graph(mesh.positions, mesh.triangles);
    const MarkerDistances distances(graph, kMarkers, 2);
    const std::vector<double> sigma = {0.7, 1.0, 2.5, 1.3, 0.9, 1.7};
    const Eigen::MatrixXd expected = plain_weights(all_distances(mesh), kMarkers, sigma);
    EXPECT_LT((Eigen::MatrixXd(distances.weights(sigma)) - expected).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(MarkerSpread, SigmasAreHalfTheMeanDistancesTheyStandFor) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const TriangleMesh mesh = test::grid(8, 8, 0.3, seed);
    const Eigen::MatrixXd d = all_distances(mesh);
    const auto distance = [&](std::size_t a, std::size_t b) { return d(kMarkers[a], kMarkers[b]); };
    std::vector<int> cell;
    for (Eigen::Index v = 0; v < d.rows(); ++v) {
      cell.push_back(
          static_cast<int>(std::ranges::min_element(kMarkers, {}, [&](int m) { return d(v, m); }) -
                           kMarkers.begin()));
    }
    std::vector<std::set<int>> neighbours(kMarkers.size());
    for (Eigen::Index t = 0; t < mesh.triangle_count(); ++t) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          const int a = cell[static_cast<std::size_t>(mesh.triangles(t, i))];
          const int b = cell[static_cast<std::size_t>(mesh.triangles(t, j))];
          if (a != b) {
            neighbours[static_cast<std::size_t>(a)].insert(b);
          }
        }
      }
    }
    const EdgeGraph graph(mesh.positions, mesh.triangles);
    const MarkerDistances measured(graph, kMarkers, 1);
    for (std::size_t k = 0; k < kMarkers.size(); ++k) {
      std::vector<double> others;
      double sum = 0.0;
      for (std::size_t m = 0; m < kMarkers.size(); ++m) {
        if (m != k) {
          others.push_back(distance(k, m));
        }
      }
      for (const int m : neighbours[k]) {
        sum += distance(k, static_cast<std::size_t>(m));
      }
      std::ranges::sort(others);
      EXPECT_NEAR(measured.near_sigma()[k], 0.5 * (others[0] + others[1] + others[2]) / 3.0, 1e-10);
      EXPECT_NEAR(measured.neighbour_sigma()[k],
                  0.5 * sum / static_cast<double>(neighbours[k].size()), 1e-10);
    }
  }
}

TEST(MarkerSpread, EachPassIsE15OfWhatIsLeft) {
  const TriangleMesh mesh = test::grid(8, 8, 0.3, 9);
  const EdgeGraph graph(mesh.positions, mesh.triangles);
  const MarkerDistances measured(graph, kMarkers, 1);
  std::vector<double> finest = measured.near_sigma();
  for (double& sigma : finest) {
    sigma /= 2.0;
  }
  const Eigen::MatrixXd d = all_distances(mesh);
  // A frame of random motions, spread a pass at a time.
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd motion = Eigen::MatrixXd::NullaryExpr(6, 3, [&] { return normal(random); });
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(d.rows(), 3);
  double left_before = 2.0 * motion.norm();
  for (const auto& sigma : {measured.neighbour_sigma(), measured.near_sigma(), finest}) {
    Eigen::MatrixXd left = motion;
    for (Eigen::Index k = 0; k < left.rows(); ++k) {
      left.row(k) -= moved.row(kMarkers[static_cast<std::size_t>(k)]);
    }
    EXPECT_LT(left.norm(), left_before) << "each pass brings the markers' vertices nearer";
    left_before = left.norm();
    moved += plain_weights(d, kMarkers, sigma) * left;
  }
  const Eigen::MatrixXd made = spread_weights(graph, kMarkers, {}) * motion;
  EXPECT_LT((made - moved).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(MarkerSpread, DoesNotDependOnThreads) {
  const TriangleMesh mesh = test::grid(40, 40, 0.3, 2);
  const EdgeGraph graph(mesh.positions, mesh.triangles);
  const std::vector<int> markers = {3, 700, 1500, 820, -1, 40, 1111};
  const Eigen::MatrixXd one = spread_weights(graph, markers, {.threads = 1});
  const Eigen::MatrixXd two = spread_weights(graph, markers, {.threads = 2});
  EXPECT_EQ(one, two);
  EXPECT_TRUE(one.col(4).isZero(0.0)) << "a marker that is not on the mesh moves nothing";
}

TEST(MarkerSpread, AMarkerOnAnIslandMovesItsIslandAlone) {
  // Two separate triangles; one marker on the second, two on the first.
  Points positions(6, 3);
  positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 10, 0, 0, 11, 0, 0, 10, 1, 0;
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 3, 4, 5;
  const EdgeGraph graph(positions, triangles);
  const Eigen::MatrixXd weights = spread_weights(graph, std::vector<int>{0, 1, 3}, {});
  EXPECT_TRUE(weights.allFinite());
  EXPECT_NEAR(weights(3, 2), 1.0, 1e-12);
  EXPECT_TRUE(weights.topRows(3).col(2).isZero(0.0));
  EXPECT_TRUE(weights.bottomRows(3).leftCols(2).isZero(0.0));
}

} // namespace
} // namespace phonomime
