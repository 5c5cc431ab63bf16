// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tune/weight_space.h"

#include "db/types/errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace phonomime {
namespace {

CostWeights some_weights() {
  CostWeights weights;
  weights.alpha1 = 1.0;
  weights.alpha2 = 0.2;
  weights.alpha3 = 20.0;
  weights.alpha4 = 0.4;
  weights.alpha5 = 10.0;
  weights.alpha6 = 10.0;
  weights.target = 0.6;
  weights.context = 1.0;
  weights.duration = 0.3;
  weights.off_lips = 0.5;
  weights.pnt = 1234.0;
  return weights;
}

std::vector<std::string> names(const WeightSpace& space) {
  std::vector<std::string> found;
  for (const TunableWeight& weight : space.weights()) {
    found.emplace_back(weight.name);
  }
  return found;
}

TEST(WeightSpace, HasTheWeightsThatMakeADifference) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(WeightSpace(CostModel::paper, {}, true)),
            (Names{"alpha1", "alpha2", "alpha3", "alpha4", "alpha5", "alpha6"}));
  EXPECT_EQ(names(WeightSpace(CostModel::context, {}, false)),
            (Names{"alpha1", "alpha2", "alpha3", "alpha4", "alpha5", "target", "context",
                   "duration", "off_lips"}));
  const Names chosen = {"position", "alpha3"};
  EXPECT_EQ(names(WeightSpace(CostModel::context, chosen, false)), chosen);
}

TEST(WeightSpace, RefusesWhatChangesNothing) {
  const auto refuses = [](CostModel model, std::vector<std::string> only, const char* word) {
    try {
      const WeightSpace space(model, only, false);
      ADD_FAILURE() << word;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  refuses(CostModel::context, {"alpha6"}, "one emotion");
  refuses(CostModel::paper, {"target"}, "paper");
  refuses(CostModel::context, {"pnt"}, "no weight \"pnt\"");
  refuses(CostModel::context, {"alpha2", "alpha2"}, "twice");
}

TEST(WeightSpace, GoesThereAndBack) {
  const WeightSpace space(CostModel::context, {}, true);
  const CostWeights weights = some_weights();
  const CostWeights back = space.at(space.point(weights), weights);
  EXPECT_EQ(weights_line(back), weights_line(weights));
  EXPECT_EQ(back.pnt, weights.pnt);
}

TEST(WeightSpace, IsLogarithmicBetweenTheEndsOfEachRange) {
  const WeightSpace space(CostModel::context, {}, true);
  const CostWeights base = some_weights();
  const CostWeights low = space.at(std::vector<double>(space.size(), 0.0), base);
  const CostWeights middle = space.at(std::vector<double>(space.size(), 0.5), base);
  const CostWeights high = space.at(std::vector<double>(space.size(), 1.0), base);
  for (const TunableWeight& weight : space.weights()) {
    EXPECT_EQ(low.*weight.member, weight.least);
    EXPECT_EQ(high.*weight.member, weight.most);
    EXPECT_NEAR(middle.*weight.member, std::sqrt(weight.least * weight.most),
                0.005 * (middle.*weight.member))
        << weight.name;
  }
}

TEST(WeightSpace, LeavesTheOtherWeightsAlone) {
  const std::vector<std::string> only = {"context"};
  const WeightSpace space(CostModel::context, only, true);
  CostWeights expected = some_weights();
  expected.context = 6.0;
  EXPECT_EQ(weights_line(space.at(std::vector{1.0}, some_weights())), weights_line(expected));
}

TEST(WeightSpace, KeepsShippedWeightsInsideOfItsRanges) {
  const WeightSpace space(CostModel::context, {}, true);
  const CostWeights shipped = some_weights();
  for (const TunableWeight& weight : space.weights()) {
    EXPECT_GT(shipped.*weight.member, weight.least) << weight.name;
    EXPECT_LT(shipped.*weight.member, weight.most) << weight.name;
  }
}

} // namespace
} // namespace phonomime
