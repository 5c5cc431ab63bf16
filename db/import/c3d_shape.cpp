// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/c3d_shape.h"

#include "db/types/text.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr double kLargestRate_hz = 1e5;
constexpr double kLargestCount = 4294967295.0;
constexpr double kSaturated = 65535.0; // a 16-bit count that says "look elsewhere"

// Words of the header, numbered from 1 as the format's manual does.
enum class HeaderWord : std::size_t {
  points = 2,
  analog_samples = 3,
  first_frame = 4,
  last_frame = 5,
  scale = 7,
  data_start = 9,
  analog_per_channel = 10,
  rate = 11
};

class ShapeReader {
public:
  ShapeReader(const C3dBytes& bytes, const C3dParameters& parameters)
      : bytes_(bytes), parameters_(parameters) {}

  C3dShape read() const {
    C3dShape shape;
    shape.points = points();
    shape.rate_hz = rate_hz();
    shape.scale = scale();
    shape.first_frame = first_frame();
    shape.frames = count("the number of frames", frames());
    shape.data_begin = data_begin();
    shape.analog = analog(shape);
    check_size(shape);
    return shape;
  }

private:
  double header(HeaderWord word) const {
    return bytes_.word(2 * (static_cast<std::size_t>(word) - 1), "the header");
  }
  float header_real(HeaderWord word) const {
    return bytes_.real(2 * (static_cast<std::size_t>(word) - 1), "the header");
  }

  std::size_t count(std::string_view name, double value) const {
    if (!(value >= 1.0) || value > kLargestCount || value != std::floor(value)) {
      bytes_.fail(fmt::format("{} is not usable", name), "a whole number of 1 or more",
                  format_number(value));
    }
    return static_cast<std::size_t>(value);
  }

  std::size_t points() const {
    return count("the number of points",
                 parameters_.number("POINT:USED").value_or(header(HeaderWord::points)));
  }

  double rate_hz() const {
    const auto usable = [](double rate) { return rate > 0.0 && rate <= kLargestRate_hz; };
    const double by_header = static_cast<double>(header_real(HeaderWord::rate));
    const double rate = parameters_.number("POINT:RATE").value_or(by_header);
    if (usable(rate)) {
      return rate;
    }
    if (usable(by_header)) {
      return by_header;
    }
    bytes_.fail("the frame rate is not usable", fmt::format("0 to {} Hz", kLargestRate_hz),
                format_number(rate));
  }

  // A few programs count from 0: that frame is at time 0 too.
  double first_frame() const {
    const double first = parameters_.long_number("TRIAL:ACTUAL_START_FIELD")
                             .value_or(header(HeaderWord::first_frame));
    if (!(first >= 0.0) || first > kLargestCount) {
      bytes_.fail("the number of the first frame is not usable", "1 or more", format_number(first));
    }
    return std::max(first, 1.0);
  }

  float scale() const {
    const float by_header = header_real(HeaderWord::scale);
    const auto scale = static_cast<float>(
        parameters_.number("POINT:SCALE").value_or(static_cast<double>(by_header)));
    if (!std::isfinite(scale) || scale == 0.0F) {
      bytes_.fail("POINT:SCALE is not usable", "a finite number other than 0",
                  format_number(static_cast<double>(scale)));
    }
    if ((scale < 0.0F && by_header > 0.0F) || (scale > 0.0F && by_header < 0.0F)) {
      bytes_.fail("header and POINT:SCALE do not agree whether the points are integers or floats",
                  fmt::format("the header's sign, of {}", by_header), fmt::format("{}", scale));
    }
    return scale;
  }

  // POINT:FRAMES counts unless it is saturated at 16 bits; then, or where it is the rest of a count
  // that went over, the two ways in which makers store longer takes.
  double frames() const {
    const double by_header = header(HeaderWord::last_frame) - header(HeaderWord::first_frame) + 1.0;
    const double plain = parameters_.number("POINT:FRAMES").value_or(by_header);
    const std::optional<double> first = parameters_.long_number("TRIAL:ACTUAL_START_FIELD");
    const std::optional<double> last = parameters_.long_number("TRIAL:ACTUAL_END_FIELD");
    const std::optional<double> by_trial =
        first && last ? std::optional<double>(*last - *first + 1.0) : std::nullopt;
    if (const std::optional<double> by_long = parameters_.number("POINT:LONG_FRAMES")) {
      return *by_long;
    }
    const bool overflowed = by_trial && std::fmod(*by_trial - plain, kSaturated + 1.0) == 0.0;
    return by_trial && (plain == kSaturated || plain == 0.0 || overflowed) ? *by_trial : plain;
  }

  // The header's word counts; POINT:DATA_START is its copy, which not every program keeps right.
  std::size_t data_begin() const {
    const auto usable = [&](double block) {
      return block >= 2.0 &&
             (block - 1.0) * C3dBytes::kBlock >= static_cast<double>(parameters_.end()) &&
             (block - 1.0) * C3dBytes::kBlock < static_cast<double>(bytes_.size());
    };
    const double by_header = header(HeaderWord::data_start);
    const double by_parameter = parameters_.number("POINT:DATA_START").value_or(0.0);
    if (!usable(by_header) && !usable(by_parameter)) {
      bytes_.fail("the data section does not begin inside the file, behind the parameters",
                  fmt::format("a block between {} and {}", parameters_.end() / C3dBytes::kBlock + 1,
                              bytes_.size() / C3dBytes::kBlock),
                  format_number(by_header), "The file seems to be cut off or damaged.");
    }
    const double block = usable(by_header) ? by_header : std::floor(by_parameter);
    return (static_cast<std::size_t>(block) - 1) * C3dBytes::kBlock;
  }

  // Analog samples in a frame. Header and parameters say it both; where they differ, the file's
  // size tells which is right.
  std::size_t analog(const C3dShape& shape) const {
    const double by_header = header(HeaderWord::analog_samples);
    const std::optional<double> channels = parameters_.number("ANALOG:USED");
    double by_parameters = by_header;
    if (channels && *channels == 0.0) {
      by_parameters = 0.0;
    } else if (const std::optional<double> rate = parameters_.number("ANALOG:RATE");
               channels && rate) {
      by_parameters = *channels * std::round(*rate / shape.rate_hz);
    }
    const auto fills_the_file = [&](double samples) {
      const double needed = static_cast<double>(shape.frames * shape.value_bytes()) *
                            (4.0 * static_cast<double>(shape.points) + samples);
      const double there = static_cast<double>(bytes_.size() - shape.data_begin);
      return needed <= there && there - needed < 2.0 * C3dBytes::kBlock;
    };
    if (by_header != by_parameters && !fills_the_file(by_header)) {
      if (!fills_the_file(by_parameters)) {
        bytes_.fail("header and parameters do not agree on the analog samples in a frame",
                    fmt::format("{} as the header says", by_header),
                    fmt::format("{} by ANALOG:USED and ANALOG:RATE", by_parameters));
      }
      return static_cast<std::size_t>(by_parameters);
    }
    return static_cast<std::size_t>(by_header);
  }

  void check_size(const C3dShape& shape) const {
    const std::size_t there = bytes_.size() - shape.data_begin;
    if (there / shape.frame_bytes() < shape.frames) {
      bytes_.fail("the data section is cut off, or the file's counts are wrong",
                  fmt::format("{} frames of {} bytes", shape.frames, shape.frame_bytes()),
                  fmt::format("{} bytes", there));
    }
  }

  const C3dBytes& bytes_;
  const C3dParameters& parameters_;
};

} // namespace

C3dShape read_c3d_shape(const C3dBytes& bytes, const C3dParameters& parameters) {
  return ShapeReader(bytes, parameters).read();
}

} // namespace phonomime
