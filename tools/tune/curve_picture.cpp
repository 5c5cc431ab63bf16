// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tune/curve_picture.h"

#include "db/types/html_text.h"
#include "db/types/text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr double kWidth = 360.0, kHeight = 220.0;
constexpr double kLeft = 52.0, kRight = 12.0, kTop = 24.0, kBottom = 38.0;

// 1, 2 or 5 times a power of ten that parts a range into about four.
double step_of(double range) {
  const double rough = range / 4.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double times : {1.0, 2.0, 5.0}) {
    if (times * power >= rough) {
      return times * power;
    }
  }
  return 10.0 * power;
}

class Axes {
public:
  explicit Axes(const Plot& plot) : plot_(plot) {
    bool any = false;
    for (const PlotSeries& series : plot.series) {
      for (const PlotPoint& point : series.points) {
        const double x = scaled(point.x);
        least_ = any ? std::min(least_, x) : x;
        most_ = any ? std::max(most_, x) : x;
        any = true;
      }
    }
    most_ = most_ > least_ ? most_ : least_ + 1.0;
  }

  double x(double value) const {
    return kLeft + (scaled(value) - least_) / (most_ - least_) * (kWidth - kLeft - kRight);
  }
  double y(double value) const {
    const double range = plot_.y_most > plot_.y_least ? plot_.y_most - plot_.y_least : 1.0;
    return kHeight - kBottom - (value - plot_.y_least) / range * (kHeight - kTop - kBottom);
  }
  bool holds(const PlotPoint& point) const {
    return point.y >= plot_.y_least && point.y <= plot_.y_most;
  }

  std::string marks() const {
    std::string svg;
    const double step = step_of(std::max(plot_.y_most - plot_.y_least, 1e-9));
    for (double i = std::ceil(plot_.y_least / step); i * step <= plot_.y_most; i += 1.0) {
      svg += fmt::format("<line class='grid' x1='{:.1f}' x2='{:.1f}' y1='{:.1f}' y2='{:.1f}'/>"
                         "<text x='{:.1f}' y='{:.1f}' text-anchor='end'>{:.4g}</text>",
                         kLeft, kWidth - kRight, y(i * step), y(i * step), kLeft - 5.0,
                         y(i * step) + 4.0, i * step);
    }
    for (const double mark : x_marks()) {
      svg += fmt::format("<line class='grid' x1='{:.1f}' x2='{:.1f}' y1='{:.1f}' y2='{:.1f}'/>"
                         "<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{:.4g}</text>",
                         x(mark), x(mark), kTop, kHeight - kBottom, x(mark),
                         kHeight - kBottom + 14.0, mark);
    }
    return svg;
  }

private:
  double scaled(double value) const { return plot_.log_x ? std::log10(value) : value; }

  std::vector<double> x_marks() const {
    std::vector<double> marks;
    if (!plot_.log_x) {
      const double step = step_of(most_ - least_);
      for (double i = std::ceil(least_ / step); i * step <= most_; i += 1.0) {
        marks.push_back(i * step);
      }
      return marks;
    }
    for (double power = std::floor(least_); power <= most_; power += 1.0) {
      for (const double times : {1.0, 2.0, 5.0}) {
        const double mark = times * std::pow(10.0, power);
        if (std::log10(mark) >= least_ && std::log10(mark) <= most_) {
          marks.push_back(mark);
        }
      }
    }
    return marks;
  }

  const Plot& plot_;
  double least_ = 0.0, most_ = 1.0;
};

std::string drawn(const PlotSeries& series, const Axes& axes) {
  std::string svg;
  if (series.line) {
    std::string path;
    for (const PlotPoint& point : series.points) {
      if (axes.holds(point)) {
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', axes.x(point.x),
                            axes.y(point.y));
      }
    }
    return fmt::format("<path d='{}' fill='none' stroke='{}'><title>{}</title></path>", path,
                       series.color, escape_html(series.name));
  }
  for (const PlotPoint& point : series.points) {
    if (axes.holds(point)) {
      svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3' fill='{}'><title>{}: {} {:.5g}"
                         "</title></circle>",
                         axes.x(point.x), axes.y(point.y), series.color, escape_html(series.name),
                         format_number(point.x), point.y);
    }
  }
  return svg;
}

} // namespace

std::string draw_plot(const Plot& plot) {
  const Axes axes(plot);
  std::string svg = fmt::format(
      "<svg viewBox='0 0 {0} {1}' width='{0}' height='{1}' role='img' aria-label=\"{2}\">"
      "<text class='title' x='{3}' y='15'>{2}</text>{4}"
      "<text x='{5:.1f}' y='{6}' text-anchor='middle'>{7}</text>"
      "<text transform='translate(11 {8:.1f}) rotate(-90)' text-anchor='middle'>{9}</text>",
      kWidth, kHeight, escape_html(plot.title), kLeft, axes.marks(),
      (kLeft + kWidth - kRight) / 2.0, kHeight - 6.0, escape_html(plot.x_label),
      (kTop + kHeight - kBottom) / 2.0, escape_html(plot.y_label));
  for (const PlotSeries& series : plot.series) {
    svg += drawn(series, axes);
  }
  return svg + "</svg>\n";
}

} // namespace phonomime
