// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/face_picture.h"

#include "db/types/errors.h"
#include "isomap/map_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr int kHeight_px = 480;
constexpr int kFiner = 2;       // times as many rows and columns are drawn, then averaged
constexpr double kMargin = 0.2; // on each side, of what is to be seen
constexpr double kAmbient = 0.35;
const Eigen::Vector3d kToLight = Eigen::Vector3d(-0.35, 0.55, 0.76).normalized();
const Eigen::Vector3d kPlainSkin(0.72, 0.52, 0.43); // linear

using Rgb = Eigen::Vector3d; // linear light, 0 to 1

std::uint8_t srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double value = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * value));
}

// A picture with depths.
class Screen {
public:
  Screen(int width, int height)
      : width_(width), height_(height),
        colours_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), Rgb::Ones()),
        depths_(colours_.size(), -std::numeric_limits<double>::infinity()) {}

  // Corners in pixels (x to the right, y down, z towards the viewer), each with its colour.
  void triangle(const std::array<Eigen::Vector3d, 3>& corners, const std::array<Rgb, 3>& colours) {
    const Eigen::Vector2d a = corners[0].head<2>();
    const Eigen::Vector2d ab = corners[1].head<2>() - a;
    const Eigen::Vector2d ac = corners[2].head<2>() - a;
    const double area = ab.x() * ac.y() - ab.y() * ac.x();
    if (area == 0.0) {
      return;
    }
    const auto [low_x, high_x] = std::minmax({corners[0].x(), corners[1].x(), corners[2].x()});
    const auto [low_y, high_y] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
    const int first_x = std::max(0, static_cast<int>(std::floor(low_x)));
    const int last_x = std::min(width_ - 1, static_cast<int>(std::ceil(high_x)));
    const int first_y = std::max(0, static_cast<int>(std::floor(low_y)));
    const int last_y = std::min(height_ - 1, static_cast<int>(std::ceil(high_y)));
    for (int y = first_y; y <= last_y; ++y) {
      for (int x = first_x; x <= last_x; ++x) {
        const Eigen::Vector2d at = Eigen::Vector2d(x + 0.5, y + 0.5) - a;
        const double v = (at.x() * ac.y() - at.y() * ac.x()) / area;
        const double w = (ab.x() * at.y() - ab.y() * at.x()) / area;
        const double u = 1.0 - v - w;
        if (u < 0.0 || v < 0.0 || w < 0.0) {
          continue;
        }
        const double depth = u * corners[0].z() + v * corners[1].z() + w * corners[2].z();
        const std::size_t place = index(x, y);
        if (depth > depths_[place]) {
          depths_[place] = depth;
          colours_[place] = u * colours[0] + v * colours[1] + w * colours[2];
        }
      }
    }
  }

  // Each pixel the mean of kFiner by kFiner.
  Raster raster() const {
    Raster result{.width_px = width_ / kFiner, .height_px = height_ / kFiner, .bytes = {}};
    for (int y = 0; y < result.height_px; ++y) {
      for (int x = 0; x < result.width_px; ++x) {
        Rgb sum = Rgb::Zero();
        for (int i = 0; i < kFiner * kFiner; ++i) {
          sum += colours_[index(kFiner * x + i % kFiner, kFiner * y + i / kFiner)];
        }
        for (const double channel : sum) {
          result.bytes.push_back(srgb(channel / (kFiner * kFiner)));
        }
      }
    }
    return result;
  }

private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_, height_;
  std::vector<Rgb> colours_;
  std::vector<double> depths_;
};

} // namespace

FacePainter::FacePainter(const TriangleMesh& mesh, const Points& around) : mesh_(mesh) {
  const Eigen::RowVector3d low = around.colwise().minCoeff();
  const Eigen::RowVector3d high = around.colwise().maxCoeff();
  const double height = std::max(high.y() - low.y(), 1e-9) * (1.0 + 2.0 * kMargin);
  const double width = std::max(high.x() - low.x(), 0.25 * height) * (1.0 + 2.0 * kMargin);
  pixel_ = height / kHeight_px;
  height_px_ = kHeight_px;
  width_px_ = std::clamp(static_cast<int>(std::ceil(width / pixel_)), 1, 4 * kHeight_px);
  left_top_ = {0.5 * (low.x() + high.x()) - 0.5 * pixel_ * width_px_,
               0.5 * (low.y() + high.y()) + 0.5 * height};
}

std::string FacePainter::png(const Points& positions) const {
  if (positions.rows() != mesh_.positions.rows()) {
    throw InternalError({.what = "a pose has other vertices than its mesh"});
  }
  Screen screen(kFiner * width_px_, kFiner * height_px_);
  const double scale = kFiner / pixel_;
  const Points normals = vertex_normals(positions, mesh_.triangles);
  for (const MeshPart& part : mesh_.parts) {
    const Rgb own =
        part.material < 0
            ? Rgb(kPlainSkin)
            : Rgb(mesh_.materials[static_cast<std::size_t>(part.material)].base_color.data());
    for (int t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      std::array<Eigen::Vector3d, 3> corners;
      std::array<Rgb, 3> colours;
      for (std::size_t c = 0; c < 3; ++c) {
        const int vertex = mesh_.triangles(t, static_cast<Eigen::Index>(c));
        const Eigen::RowVector3d at = positions.row(vertex);
        corners[c] = {scale * (at.x() - left_top_.x()), scale * (left_top_.y() - at.y()),
                      scale * at.z()};
        const double lit = std::max(0.0, normals.row(vertex).dot(kToLight.transpose()));
        colours[c] = (kAmbient + (1.0 - kAmbient) * lit) * own;
      }
      screen.triangle(corners, colours);
    }
  }
  return raster_png(screen.raster());
}

std::string marker_picture(const Eigen::VectorXd& rest, const Eigen::VectorXd& pose,
                           const std::vector<int>& channels) {
  constexpr double kEdge_mm = 10.0;
  const Eigen::Map<const Points> places(rest.data(), rest.size() / 3, 3);
  const double left = places.col(0).minCoeff() - kEdge_mm;
  const double top = -places.col(1).maxCoeff() - kEdge_mm;
  const double width = places.col(0).maxCoeff() + kEdge_mm - left;
  const double height = -places.col(1).minCoeff() + kEdge_mm - top;
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{0:.1f} {1:.1f} {2:.1f} {3:.1f}\">\n"
      "<rect x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{3:.1f}\" fill=\"#ffffff\"/>\n",
      left, top, width, height);
  for (Eigen::Index i = 0; i + 2 < pose.size(); i += 3) {
    text += fmt::format("<path d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\" stroke=\"#c9803a\" "
                        "stroke-width=\"0.6\"/>\n",
                        rest[i], -rest[i + 1], pose[i], -pose[i + 1]);
    const bool own = std::ranges::find(channels, static_cast<int>(i)) != channels.end();
    text += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"1\" fill=\"{}\" "
                        "stroke=\"#1f4e9c\" stroke-width=\"0.3\"/>\n",
                        pose[i], -pose[i + 1], own ? "#1f4e9c" : "#ffffff");
  }
  return text + "</svg>\n";
}

} // namespace phonomime
