// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/contacts.h"

#include "db/types/errors.h"
#include "db/types/lip_measures.h"
#include "db/types/percentile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace phonomime {

namespace {

constexpr std::array<std::string_view, 3> kLipsMeet = {"p", "b", "m"};
constexpr std::array<std::string_view, 2> kLipMeetsTeeth = {"f", "v"};
constexpr double kSpare_mm = 1e-6; // to which a range is met
constexpr double kInside_mm =
    0.05; // closed lips that had opened are brought so far under the limit
constexpr int kMostRounds = 40;

// The cubic B-spline of support (-2, 2), 2/3 at its middle: smooth, and any sum of shifted ones can
// take given values at given places (its Fourier transform is never negative).
double b_spline(double x) {
  const double u = std::abs(x);
  if (u >= 2.0) {
    return 0.0;
  }
  return u >= 1.0 ? (2.0 - u) * (2.0 - u) * (2.0 - u) / 6.0 : 2.0 / 3.0 - u * u + u * u * u / 2.0;
}

// A frame whose aperture is to be this.
struct Pin {
  Eigen::Index frame = 0;
  double aperture_mm = 0.0;
};

// The change of the aperture at every frame that puts the pins' frames where they are to be.
Eigen::VectorXd pinned_change(const std::vector<Pin>& pins, const Eigen::VectorXd& apertures,
                              double spread) {
  Eigen::VectorXd change = Eigen::VectorXd::Zero(apertures.size());
  for (std::size_t first = 0, last = 0; first < pins.size(); first = last) {
    last = first + 1;
    while (last < pins.size() &&
           static_cast<double>(pins[last].frame - pins[last - 1].frame) < 4.0 * spread) {
      ++last;
    }
    const auto size = static_cast<Eigen::Index>(last - first);
    Eigen::MatrixXd overlap(size, size);
    Eigen::VectorXd wanted(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const Pin& pin = pins[first + static_cast<std::size_t>(i)];
      wanted[i] = pin.aperture_mm - apertures[pin.frame];
      for (Eigen::Index j = 0; j < size; ++j) {
        const Pin& other = pins[first + static_cast<std::size_t>(j)];
        overlap(i, j) = b_spline(static_cast<double>(pin.frame - other.frame) / spread);
      }
    }
    const Eigen::VectorXd heights = overlap.ldlt().solve(wanted);
    const auto reach = static_cast<Eigen::Index>(std::ceil(2.0 * spread));
    for (Eigen::Index i = 0; i < size; ++i) {
      const Eigen::Index frame = pins[first + static_cast<std::size_t>(i)].frame;
      const Eigen::Index end = std::min(apertures.size(), frame + reach + 1);
      for (Eigen::Index t = std::max<Eigen::Index>(0, frame - reach); t < end; ++t) {
        change[t] += heights[i] * b_spline(static_cast<double>(t - frame) / spread);
      }
    }
  }
  return change;
}

void set_pin(std::vector<Pin>& pins, Eigen::Index frame, double aperture_mm) {
  const auto at = std::ranges::lower_bound(pins, frame, {}, &Pin::frame);
  if (at != pins.end() && at->frame == frame) {
    at->aperture_mm = aperture_mm;
  } else {
    pins.insert(at, {frame, aperture_mm});
  }
}

// Pins a contact where it has left its range; false where it keeps it.
bool pin_contact(const Contact& contact, const Eigen::VectorXd& apertures, std::vector<Pin>& pins) {
  Eigen::Index least = 0;
  const double smallest = apertures.segment(contact.first, contact.count).minCoeff(&least);
  if (smallest > contact.most_mm + kSpare_mm) {
    set_pin(pins, contact.first + least, contact.most_mm);
  } else if (smallest < contact.least_mm - kSpare_mm) {
    set_pin(pins, contact.first + least, contact.least_mm);
  } else {
    return false;
  }
  return true;
}

} // namespace

std::optional<CoefficientAperture> CoefficientAperture::of(const Layout& layout,
                                                           const PcaModel& pca) {
  const LipMeasures measures(layout);
  const auto aperture = [&](const Eigen::VectorXd& channels) {
    return measures.aperture_mm({channels.data(), static_cast<std::size_t>(channels.size())});
  };
  const std::optional<double> origin = aperture(pca.mean);
  if (!origin) {
    return std::nullopt;
  }
  CoefficientAperture made;
  made.origin_mm_ = *origin;
  made.gradient_.resize(pca.dimension_count());
  for (Eigen::Index d = 0; d < pca.dimension_count(); ++d) {
    made.gradient_[d] = *aperture(pca.basis.col(d)); // linear in the channels
  }
  return made;
}

bool asks_for_contact(std::string_view phoneme) {
  return std::ranges::find(kLipsMeet, phoneme) != kLipsMeet.end() ||
         std::ranges::find(kLipMeetsTeeth, phoneme) != kLipMeetsTeeth.end();
}

ContactRanges recorded_contacts(const MotionTable& table, const CoefficientAperture& aperture) {
  std::map<std::string, std::vector<double>, std::less<>> smallest;
  for (NodeIndex n = 0; n < table.node_count(); ++n) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(n)];
    const std::string& phoneme = table.phonemes[static_cast<std::size_t>(node.phoneme)].name;
    if (asks_for_contact(phoneme)) {
      double least = std::numeric_limits<double>::infinity();
      const FrameMatrixD frames = table.node_frames(n).cast<double>();
      for (Eigen::Index t = 0; t < frames.rows(); ++t) {
        least = std::min(least, aperture.at(frames.row(t)));
      }
      smallest[phoneme].push_back(least);
    }
  }
  ContactRanges ranges;
  for (auto& [phoneme, values] : smallest) {
    ranges[phoneme] = {*percentile(values, 0.1), *percentile(values, 0.9)};
  }
  return ranges;
}

std::vector<Contact> contacts_to_hold(std::span<const PhonemeFrames> phonemes,
                                      const ContactRanges& ranges,
                                      const CoefficientAperture& aperture,
                                      const Eigen::Ref<const FrameMatrixD>& before) {
  std::vector<Contact> contacts;
  for (const PhonemeFrames& phoneme : phonemes) {
    const auto range = ranges.find(phoneme.phoneme);
    if (range == ranges.end() || phoneme.count == 0) {
      continue;
    }
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index t = phoneme.first; t < phoneme.first + phoneme.count; ++t) {
      least = std::min(least, aperture.at(before.row(t)));
    }
    Contact contact{phoneme.first, phoneme.count, std::min(range->second.least_mm, least),
                    std::max(range->second.most_mm, least)};
    const bool lips = std::ranges::find(kLipsMeet, phoneme.phoneme) != kLipsMeet.end();
    if (lips && least < kClosedAperture_mm) {
      contact.most_mm = std::min(contact.most_mm, std::max(least, kClosedAperture_mm - kInside_mm));
    }
    contacts.push_back(contact);
  }
  return contacts;
}

HeldContacts hold_contacts(const Eigen::Ref<const FrameMatrixD>& coefficients, double rate_hz,
                           std::span<const Contact> contacts, const CoefficientAperture& aperture,
                           const Eigen::VectorXd& variance, double fade_s) {
  HeldContacts held{.coefficients = coefficients};
  Eigen::VectorXd before(coefficients.rows());
  for (Eigen::Index t = 0; t < coefficients.rows(); ++t) {
    before[t] = aperture.at(coefficients.row(t));
  }
  const double spread = std::max(fade_s * rate_hz / 2.0, 0.5); // frames between a spline's knots
  std::vector<Pin> pins;
  std::vector<bool> moved(contacts.size(), false);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(before.size());
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::VectorXd apertures = before + change;
    held.left = 0;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      if (pin_contact(contacts[c], apertures, pins)) {
        ++held.left;
        moved[c] = true;
      }
    }
    if (held.left == 0) {
      break;
    }
    change = pinned_change(pins, before, spread);
  }
  held.moved = static_cast<int>(std::ranges::count(moved, true));
  if (pins.empty()) {
    return held;
  }
  // Of all changes of the coefficients that change the aperture by 1 mm, the one that takes the
  // fewest standard deviations.
  const Eigen::RowVectorXd direction = variance.transpose().cwiseProduct(aperture.gradient());
  const double gain = direction.dot(aperture.gradient());
  if (!(gain > 0.0)) {
    throw InputError({.where = "style model", .what = "the PCA does not move the lips at all"});
  }
  held.coefficients += change * (direction / gain);
  return held;
}

} // namespace phonomime
