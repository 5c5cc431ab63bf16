// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace phonomime {

// The lips' aperture (LipMeasures) as PCA coefficients give it, to which it is linear.
class CoefficientAperture {
public:
  // Nothing where the layout holds weights or lacks the landmarks.
  static std::optional<CoefficientAperture> of(const Layout& layout, const PcaModel& pca);

  double at(const Eigen::Ref<const Eigen::RowVectorXd>& coefficients) const {
    return origin_mm_ + coefficients.dot(gradient_);
  }
  const Eigen::RowVectorXd& gradient() const { return gradient_; } // mm a coefficient

private:
  double origin_mm_ = 0.0;
  Eigen::RowVectorXd gradient_;
};

// /p b m/, where the lips meet, and /f v/, where the lower lip meets the teeth.
bool asks_for_contact(std::string_view phoneme);

// Where the smallest aperture of a phoneme lies in the recordings: 10th and 90th percentile.
struct RecordedContact {
  double least_mm = 0.0, most_mm = 0.0;
};

// By phoneme, of those that ask for contact and were recorded.
using ContactRanges = std::map<std::string, RecordedContact, std::less<>>;
ContactRanges recorded_contacts(const MotionTable& table, const CoefficientAperture& aperture);

// One phoneme of a motion.
struct PhonemeFrames {
  std::string phoneme;
  Eigen::Index first = 0, count = 0;
};

// Where a motion's contacts have to stay.
struct Contact {
  Eigen::Index first = 0, count = 0; // frames
  double least_mm = 0.0, most_mm = 0.0;
};

// The contacts of a motion before its style changes. Each keeps to the recorded range of its
// phoneme, widened by what the motion itself has; lips that close (kClosedAperture_mm) close
// afterwards too.
std::vector<Contact> contacts_to_hold(std::span<const PhonemeFrames> phonemes,
                                      const ContactRanges& ranges,
                                      const CoefficientAperture& aperture,
                                      const Eigen::Ref<const FrameMatrixD>& before);

struct HeldContacts {
  FrameMatrixD coefficients; // #frames by #dimensions
  int moved = 0;             // contacts that had left their range
  int left = 0;              // of them, those that could not be brought back
};

// Motion whose contacts keep their ranges: the least change, in the PCA's own measure (each
// dimension by its standard deviation), that brings the smallest aperture of every contact into its
// range and no frame of it below, faded in time under cubic B-splines of `fade_s` on either side.
// Contacts nearer than their fades are solved together. Motion that keeps every range stays as it
// is.
HeldContacts hold_contacts(const Eigen::Ref<const FrameMatrixD>& coefficients, double rate_hz,
                           std::span<const Contact> contacts, const CoefficientAperture& aperture,
                           const Eigen::VectorXd& variance, double fade_s = 0.1);

} // namespace phonomime
