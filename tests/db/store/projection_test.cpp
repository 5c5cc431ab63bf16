// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/projection.h"

#include "tests/db/store/made_corpus.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

// Against the plain sum in the order of the channels, bit for bit, for frames and dimensions that
// fill the tiles and that do not.
TEST(Projection, IsThePlainSumInDoubleRoundedOnce) {
  for (const int frames : {1, 3, 4, 9}) {
    for (const int dimensions : {1, 4, 7, 25}) {
      const auto sentence = test::made_sentence("s", "e", "i", 11, 10, frames);
      const PcaModel pca = test::made_pca(30, dimensions);
      const store::Projection projection(pca);
      store::Projection::Job job;
      projection.prepare(job, sentence.channels);
      projection.run(job);
      ASSERT_EQ(job.coefficients.rows(), frames);
      ASSERT_EQ(job.coefficients.cols(), dimensions);
      for (int i = 0; i < frames; ++i) {
        for (int d = 0; d < dimensions; ++d) {
          double sum = 0.0;
          for (int c = 0; c < 30; ++c) {
            sum += (static_cast<double>(sentence.channels(i, c)) - pca.mean(c)) * pca.basis(c, d);
          }
          ASSERT_EQ(job.coefficients(i, d), static_cast<float>(sum));
        }
      }
    }
  }
}

} // namespace
} // namespace phonomime
