// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mapping/cross_mapping.h"
#include "tests/bench/compare.h"
#include "tests/synth/retarget/mapping/made_pairs.h"

#include <cmath>

#include <benchmark/benchmark.h>

namespace phonomime {
namespace {

// 100 pairs of 91 markers and 53 shapes, four dimensions: X's size.
struct Speech {
  PcaModel pca = test::made_pca(273, 4, 1);
  ReferencePairs pairs;
  FrameMatrixD channels;

  FrameMatrixD spread(Eigen::Index frames, unsigned seed) const {
    return (test::made_matrix(frames, 4, 8.0, seed) * pca.basis.transpose()).rowwise() +
           pca.mean.transpose();
  }
  Speech() {
    pairs.shapes.resize(53, "shape");
    pairs.channels = spread(100, 2);
    pairs.weights = (test::made_matrix(100, 53, 0.5, 3).array() + 0.5).matrix();
    channels = spread(10000, 4);
  }
};

// X4 as it is written, one frame, one shape, one pair after the other.
FrameMatrixD plainly(const Speech& speech, const CrossMapping& mapping,
                     const FrameMatrixD& pair_weights) {
  const double sigma = mapping.network().sigma();
  FrameMatrixD weights(speech.channels.rows(), 53);
  FrameMatrixD centres(100, 4);
  for (Eigen::Index k = 0; k < 100; ++k) {
    centres.row(k) = speech.pca.project(speech.pairs.channels.row(k).transpose()).transpose();
  }
  for (Eigen::Index i = 0; i < weights.rows(); ++i) {
    const Eigen::RowVectorXd at =
        speech.pca.project(speech.channels.row(i).transpose()).transpose();
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(53);
    for (Eigen::Index k = 0; k < 100; ++k) {
      sum += std::exp(-(at - centres.row(k)).squaredNorm() / (2.0 * sigma * sigma)) *
             pair_weights.row(k);
    }
    weights.row(i) = sum.cwiseMax(0.0).cwiseMin(1.0);
  }
  return weights;
}

void cross_mapping(benchmark::State& state) {
  const Speech speech;
  const CrossMapping mapping(speech.pca, speech.pairs, {.sigma = 6.0});
  const FrameMatrixD pair_weights = mapping.network().weights();
  const FrameMatrixD plain = plainly(speech, mapping, pair_weights);
  bench::verify((mapping.weights(speech.channels) - plain).cwiseAbs().maxCoeff() < 1e-9,
                "weights of cross-mapping");
  bench::compare(
      state, [&] { return mapping.weights(speech.channels); },
      [&] { return plainly(speech, mapping, pair_weights); });
  state.SetItemsProcessed(state.iterations() * speech.channels.rows());
}
BENCHMARK(cross_mapping)->UseManualTime()->Unit(benchmark::kMillisecond);

} // namespace
} // namespace phonomime
