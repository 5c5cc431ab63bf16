// SPDX-License-Identifier: GPL-3.0-or-later
#include "isomap/map_scene.h"

#include "db/types/html_text.h"

#include <array>
#include <iterator>

#include <fmt/format.h>

namespace phonomime {

namespace {

std::string path_of(const std::vector<Eigen::Vector2d>& points) {
  std::string path;
  for (const Eigen::Vector2d& point : points) {
    fmt::format_to(std::back_inserter(path), "{}{:.2f} {:.2f}", path.empty() ? "M" : "L", point.x(),
                   point.y());
  }
  return path;
}

// One element a shape.
struct Element {
  std::string operator()(const Line& line) const {
    return fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="{:.2f}" )"
                       R"(stroke-opacity="{:.2f}" stroke-linejoin="round"{}/>)",
                       path_of(line.points), format_colour(line.colour), line.width_px,
                       line.opacity,
                       line.dashed ? R"( stroke-dasharray="5 4")" : R"( stroke-linecap="round")");
  }
  std::string operator()(const Area& area) const {
    return fmt::format(R"(<path d="{}Z" fill="{}" fill-opacity="{:.2f}"/>)", path_of(area.corners),
                       format_colour(area.colour), area.opacity);
  }
  std::string operator()(const Disc& disc) const {
    return fmt::format(
        R"(<circle cx="{:.2f}" cy="{:.2f}" r="{:.2f}" fill="{}" stroke="{}" stroke-width="{:.2f}"/>)",
        disc.centre.x(), disc.centre.y(), disc.radius_px, format_colour(disc.fill),
        format_colour(disc.edge), disc.edge_px);
  }
  std::string operator()(const Label& label) const {
    return fmt::format(R"(<text x="{:.2f}" y="{:.2f}" font-size="{:.0f}">{}</text>)",
                       label.left.x(), label.left.y(), label.size_px, escape_html(label.text));
  }
};

} // namespace

// By hand: cairo numbers what it writes to SVG through the whole process, so that the same picture
// would have other bytes the second time, and it would turn texts into outlines.
std::string draw_svg(const MapPicture& picture, const MapPictureOptions& options) {
  const MapScene scene = compose(picture, options);
  std::string file = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      R"(<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" )"
      "width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n"
      "<image y=\"{2}\" width=\"{3}\" height=\"{4}\" xlink:href=\"data:image/png;base64,{5}\"/>\n",
      scene.width_px, scene.height_px, scene.raster_top_px, scene.raster.width_px,
      scene.raster.height_px, base64(raster_png(scene.raster)));
  for (const Layer& layer : scene.layers) {
    file += fmt::format("<g id=\"{}\">\n", escape_html(layer.name));
    for (const Shape& shape : layer.shapes) {
      file += std::visit(Element{}, shape) + "\n";
    }
    file += "</g>\n";
  }
  return file + "</svg>\n";
}

} // namespace phonomime
