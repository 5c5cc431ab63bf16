// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "isomap/map_scene.h"

#include <cstdint>
#include <exception>
#include <memory>
#include <numbers>

#include <cairo.h>

namespace phonomime {

namespace {

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) {
    throw InternalError({.where = "map picture", .what = cairo_status_to_string(status)});
  }
}

class Canvas {
public:
  Canvas(int width_px, int height_px)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px)),
        cairo_(cairo_create(surface_.get())) {
    check(cairo_surface_status(surface_.get()));
    check(cairo_status(cairo_.get()));
    set_colour(kWhite, 1.0);
    cairo_paint(cairo_.get());
  }

  void operator()(const Line& line) {
    trace(line.points);
    set_colour(line.colour, line.opacity);
    cairo_set_line_width(cairo_.get(), line.width_px);
    cairo_set_line_cap(cairo_.get(), line.dashed ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
    constexpr double dashes[] = {5.0, 4.0};
    cairo_set_dash(cairo_.get(), dashes, line.dashed ? 2 : 0, 0.0);
    cairo_stroke(cairo_.get());
  }
  void operator()(const Area& area) {
    trace(area.corners);
    cairo_close_path(cairo_.get());
    set_colour(area.colour, area.opacity);
    cairo_fill(cairo_.get());
  }
  void operator()(const Disc& disc) {
    cairo_new_path(cairo_.get());
    cairo_arc(cairo_.get(), disc.centre.x(), disc.centre.y(), disc.radius_px, 0.0,
              2.0 * std::numbers::pi);
    set_colour(disc.fill, 1.0);
    cairo_fill_preserve(cairo_.get());
    set_colour(disc.edge, 1.0);
    cairo_set_line_width(cairo_.get(), disc.edge_px);
    cairo_set_dash(cairo_.get(), nullptr, 0, 0.0);
    cairo_stroke(cairo_.get());
  }
  void operator()(const Label& label) {
    cairo_select_font_face(cairo_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo_.get(), label.size_px);
    set_colour(Colour{0.1, 0.1, 0.12}, 1.0);
    cairo_move_to(cairo_.get(), label.left.x(), label.left.y());
    cairo_show_text(cairo_.get(), label.text.c_str());
  }

  void put(const Raster& raster, int top_px) {
    cairo_surface_flush(surface_.get());
    unsigned char* bytes = cairo_image_surface_get_data(surface_.get());
    const int stride = cairo_image_surface_get_stride(surface_.get());
    const std::uint8_t* from = raster.bytes.data();
    for (int y = 0; y < raster.height_px; ++y) {
      auto* row = reinterpret_cast<std::uint32_t*>(bytes + (y + top_px) * stride);
      for (int x = 0; x < raster.width_px; ++x, from += 3) {
        row[x] = std::uint32_t{from[0]} << 16 | std::uint32_t{from[1]} << 8 | from[2];
      }
    }
    cairo_surface_mark_dirty(surface_.get());
  }

  std::string png() const {
    check(cairo_status(cairo_.get()));
    std::string file;
    const auto append = [](void* to, const unsigned char* bytes, unsigned int size) {
      try {
        static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), size);
      } catch (const std::exception&) { // cairo is C: no exception may pass
        return CAIRO_STATUS_NO_MEMORY;
      }
      return CAIRO_STATUS_SUCCESS;
    };
    check(cairo_surface_write_to_png_stream(surface_.get(), append, &file));
    return file;
  }

private:
  struct Release {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  };

  void set_colour(const Colour& colour, double opacity) {
    cairo_set_source_rgba(cairo_.get(), colour.red, colour.green, colour.blue, opacity);
  }
  void trace(const std::vector<Eigen::Vector2d>& points) {
    cairo_new_path(cairo_.get());
    for (const Eigen::Vector2d& point : points) {
      cairo_line_to(cairo_.get(), point.x(), point.y());
    }
  }

  std::unique_ptr<cairo_surface_t, Release> surface_;
  std::unique_ptr<cairo_t, Release> cairo_;
};

} // namespace

std::string raster_png(const Raster& raster) {
  Canvas canvas(raster.width_px, raster.height_px);
  canvas.put(raster, 0);
  return canvas.png();
}

std::string draw_png(const MapPicture& picture, const MapPictureOptions& options) {
  const MapScene scene = compose(picture, options);
  Canvas canvas(scene.width_px, scene.height_px);
  canvas.put(scene.raster, scene.raster_top_px);
  for (const Layer& layer : scene.layers) {
    for (const Shape& shape : layer.shapes) {
      std::visit(canvas, shape);
    }
  }
  return canvas.png();
}

} // namespace phonomime
