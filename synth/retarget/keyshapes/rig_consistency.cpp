// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/rig_consistency.h"

#include "db/types/errors.h"
#include "synth/retarget/keyshapes/region_basis.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace phonomime {
namespace {

constexpr double kAlike = 0.9;
constexpr double kContrary = -0.25;
constexpr double kLeastChange = 0.1; // of a set's largest

// From one pose of a set to another; pose 0 is at rest.
struct Change {
  Eigen::Index from = 0, to = 0;
};

// Scalar products of changes, from those of the poses.
class Changes {
public:
  // `poses`: #poses by #values.
  explicit Changes(const Eigen::MatrixXd& poses) : products_(poses * poses.transpose()) {}

  double product(const Change& a, const Change& b) const {
    return products_(a.to, b.to) - products_(a.to, b.from) - products_(a.from, b.to) +
           products_(a.from, b.from);
  }
  double length(const Change& a) const { return std::sqrt(std::max(0.0, product(a, a))); }

private:
  Eigen::MatrixXd products_;
};

// The value whose two changes pull most against each other.
std::string most_contrary(const Eigen::MatrixXd& poses, const Change& a, const Change& b,
                          double sign, const std::vector<std::string>& names) {
  Eigen::Index worst = 0;
  const Eigen::RowVectorXd one = poses.row(a.to) - poses.row(a.from);
  const Eigen::RowVectorXd other = sign * (poses.row(b.to) - poses.row(b.from));
  one.cwiseProduct(other).minCoeff(&worst);
  return names[static_cast<std::size_t>(worst)];
}

// Changes that are large enough in source and target.
std::vector<Change> large_changes(Eigen::Index poses, const Changes& source,
                                  const Changes& target) {
  std::vector<Change> all;
  double largest_source = 0.0;
  double largest_target = 0.0;
  for (Eigen::Index from = 0; from < poses; ++from) {
    for (Eigen::Index to = from + 1; to < poses; ++to) {
      all.push_back({from, to});
      largest_source = std::max(largest_source, source.length(all.back()));
      largest_target = std::max(largest_target, target.length(all.back()));
    }
  }
  std::erase_if(all, [&](const Change& change) {
    return source.length(change) <= kLeastChange * largest_source ||
           target.length(change) <= kLeastChange * largest_target;
  });
  return all;
}

} // namespace

std::string conflict_words(const RigConflict& c) {
  return fmt::format("{}, {}: from {} to {} and from {} to {} the source changes alike (cosine "
                     "{:.2f}), the target contrarily ({:.2f}), most of all {}",
                     c.expression, c.part, c.from, c.to, c.other_from, c.other_to,
                     c.source_likeness, c.target_likeness, c.value);
}

std::vector<RigConflict> find_conflicts(const Rig& rig, const Layout& layout,
                                        const FrameMatrixD& source, const RigTargets& targets,
                                        std::size_t most) {
  if (targets.values.rows() != static_cast<Eigen::Index>(keyshape_names(rig).size())) {
    throw InternalError({.what = "the rig's targets do not fit it"});
  }
  std::vector<RigConflict> conflicts;
  Eigen::Index first = 0;
  for (const RigSet& set : rig.sets) {
    const std::vector<int> channels = part_channels(layout, set.part);
    const auto count = static_cast<Eigen::Index>(set.keyshapes.size());
    std::vector<std::string> names = {"rest"};
    Eigen::MatrixXd here =
        Eigen::MatrixXd::Zero(count + 1, static_cast<Eigen::Index>(channels.size()));
    Eigen::MatrixXd there = Eigen::MatrixXd::Zero(count + 1, targets.values.cols());
    for (Eigen::Index i = 0; i < count; ++i) {
      const RigKeyshape& keyshape = set.keyshapes[static_cast<std::size_t>(i)];
      names.push_back(keyshape.name);
      here.row(i + 1) = source(keyshape.source, channels);
      there.row(i + 1) = targets.values.row(first + i);
    }
    first += count;
    const Changes of_source(here);
    const Changes of_target(there);
    const std::vector<Change> changes = large_changes(count + 1, of_source, of_target);
    for (std::size_t i = 0; i < changes.size(); ++i) {
      for (std::size_t j = i + 1; j < changes.size(); ++j) {
        const Change& a = changes[i];
        const Change& b = changes[j];
        const double alike = of_source.product(a, b) / (of_source.length(a) * of_source.length(b));
        if (std::abs(alike) < kAlike) {
          continue;
        }
        const double sign = alike > 0.0 ? 1.0 : -1.0;
        const double contrary =
            sign * of_target.product(a, b) / (of_target.length(a) * of_target.length(b));
        if (contrary < kContrary) {
          const auto name = [&](Eigen::Index pose) {
            return names[static_cast<std::size_t>(pose)];
          };
          conflicts.push_back({set.expression, set.part, name(a.from), name(a.to),
                               name(sign > 0.0 ? b.from : b.to), name(sign > 0.0 ? b.to : b.from),
                               std::abs(alike), contrary,
                               most_contrary(there, a, b, sign, targets.names)});
        }
      }
    }
  }
  std::ranges::stable_sort(conflicts, {}, &RigConflict::target_likeness);
  conflicts.resize(std::min(most, conflicts.size()));
  return conflicts;
}

} // namespace phonomime
