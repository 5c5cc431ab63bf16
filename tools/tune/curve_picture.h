// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace phonomime {

struct PlotPoint {
  double x = 0.0, y = 0.0;
};

// Points, or a line through them.
struct PlotSeries {
  std::string name;
  std::string color; // CSS
  bool line = false;
  std::vector<PlotPoint> points;
};

struct Plot {
  std::string title, x_label, y_label;
  bool log_x = false;                 // all x above 0
  double y_least = 0.0, y_most = 0.0; // what is outside is left out
  std::vector<PlotSeries> series;
};

// An SVG element that stands in a page as it is, about 360 by 220 pixels.
std::string draw_plot(const Plot& plot);

} // namespace phonomime
