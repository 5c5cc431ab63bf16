// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// An SVG drawing as the numbers of its shapes: those in the attributes d, points, cx, cy, r, rx,
// ry, x, y, x1, y1, x2, y2, width, height, transform, stroke-width and opacity. Drawings of equal
// structure (the same elements with the same attributes and as many numbers in each, the same path
// commands) can be blended number by number; all else (colours, texts) is the first drawing's.
class SvgDrawing {
public:
  // `where` names the file. Throws InputError where it is no SVG text or has no shapes. Flags of an
  // arc that stand without a space before what follows are not understood.
  SvgDrawing(std::string text, std::string where);

  const Eigen::RowVectorXd& numbers() const { return numbers_; }
  // "<path> 3, d, number 7", for people.
  std::vector<std::string> number_names() const;

  // Throws InputError that names the first element that differs.
  void check_equal_structure(const SvgDrawing& other) const;

  // The drawing with other numbers (#numbers, three decimals).
  std::string with(const Eigen::Ref<const Eigen::RowVectorXd>& numbers) const;

  // The drawing in motion, played again and again by a script in it (browsers run it): `frames`:
  // #frames by #numbers, at least one.
  std::string animated(const FrameMatrixD& frames, double rate_hz) const;

private:
  // An attribute that has numbers.
  struct Slot {
    std::size_t element = 0; // counted from 0 over all elements of the file
    std::string tag, attribute;
    std::size_t start = 0, end = 0;   // of its value in the text
    std::vector<std::string> between; // text around the numbers: one more than there are
    Eigen::Index first = 0;           // of its numbers
  };

  void read_attribute(std::size_t element, const std::string& tag, const std::string& name,
                      std::size_t start, std::size_t end);
  std::string value(const Slot& slot, const Eigen::Ref<const Eigen::RowVectorXd>& numbers) const;

  std::string text_, where_;
  std::vector<Slot> slots_;
  Eigen::RowVectorXd numbers_;
  std::size_t end_of_root_ = 0; // of "</svg>"
};

} // namespace phonomime
