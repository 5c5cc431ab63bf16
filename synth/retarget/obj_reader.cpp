// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/mesh_reader.h"

#include "db/types/errors.h"
#include "db/types/text.h"

#include <cmath>
#include <optional>

namespace phonomime {
namespace {

constexpr std::size_t kMostElements = 20'000'000;
constexpr double kLargestCoordinate = 1e9;

class ObjParser {
public:
  ObjParser(std::string_view where) : where_(where) {}

  void add_vertex(const std::vector<std::string_view>& words, long line) {
    if (words.size() < 4) {
      fail(line, "a vertex needs three coordinates", "v X Y Z",
           std::to_string(words.size() - 1) + " coordinates");
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto field = words[static_cast<std::size_t>(axis) + 1];
      const std::optional<double> value = parse_number(field);
      if (!value || std::abs(*value) > kLargestCoordinate) {
        fail(line, "a coordinate is not a usable number", "a finite number", quoted(field));
      }
      coordinates_.push_back(*value);
    }
    check_size(line, coordinates_.size());
  }

  void add_face(const std::vector<std::string_view>& words, long line) {
    if (words.size() < 4) {
      fail(line, "a face needs three corners", "f A B C",
           std::to_string(words.size() - 1) + " corners");
    }
    const long first = corner(words[1], line);
    long previous = corner(words[2], line);
    for (std::size_t i = 3; i < words.size(); ++i) {
      const long next = corner(words[i], line);
      if (first != previous && previous != next && next != first) {
        corners_.insert(corners_.end(), {first, previous, next});
        lines_.push_back(line);
      }
      previous = next;
    }
    check_size(line, corners_.size());
  }

  TriangleMesh mesh() const {
    if (corners_.empty()) {
      throw InputError({.where = where_,
                        .what = "there is no triangle in this mesh",
                        .expected = "lines `v X Y Z` and `f A B C`"});
    }
    TriangleMesh mesh;
    mesh.source = where_;
    const long vertices = vertex_count();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (corners_[i] >= vertices) {
        fail(lines_[i / 3], "a face names a vertex that does not exist",
             "1 to " + std::to_string(vertices), std::to_string(corners_[i] + 1));
      }
    }
    mesh.positions = Eigen::Map<const Points>(coordinates_.data(), vertices, 3);
    mesh.triangles = Eigen::Map<const Eigen::Matrix<long, Eigen::Dynamic, 3, Eigen::RowMajor>>(
                         corners_.data(), static_cast<Eigen::Index>(corners_.size() / 3), 3)
                         .cast<int>();
    mesh.parts = {{.vertex_count = mesh.vertex_count(), .triangle_count = mesh.triangle_count()}};
    return mesh;
  }

private:
  [[noreturn]] void fail(long line, std::string what, std::string expected, std::string got) const {
    throw InputError({.where = at_line(where_, line),
                      .what = std::move(what),
                      .expected = std::move(expected),
                      .got = std::move(got)});
  }

  void check_size(long line, std::size_t elements) const {
    if (elements > 3 * kMostElements) {
      fail(line, "the mesh is too large",
           "at most " + std::to_string(kMostElements) + " vertices and triangles", "more");
    }
  }

  long vertex_count() const { return static_cast<long>(coordinates_.size() / 3); }

  // Vertex of a face's corner, counted from 0.
  long corner(std::string_view word, long line) const {
    const std::optional<long> number = parse_integer(word.substr(0, word.find('/')));
    const bool relative = number && *number < 0;
    if (!number || *number == 0 || (relative && *number < -vertex_count()) ||
        *number > static_cast<long>(kMostElements)) {
      fail(line, "a face's corner names no vertex",
           "a vertex number from 1, or from the end if negative", quoted(word));
    }
    return relative ? vertex_count() + *number : *number - 1;
  }

  std::string where_;
  std::vector<double> coordinates_;
  std::vector<long> corners_;
  std::vector<long> lines_; // of each triangle
};

} // namespace

TriangleMesh parse_obj(std::string_view text, std::string_view where) {
  ObjParser parser(where);
  long line = 0;
  for (const std::string_view row : split_lines(text)) {
    ++line;
    const auto words = split_words(row.substr(0, row.find('#')));
    if (words.empty()) {
      continue;
    }
    if (words[0] == "v") {
      parser.add_vertex(words, line);
    } else if (words[0] == "f") {
      parser.add_face(words, line);
    }
  }
  return parser.mesh();
}

} // namespace phonomime
