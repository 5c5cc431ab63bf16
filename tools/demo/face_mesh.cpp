// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/face_mesh.h"

#include <optional>
#include <span>

#include <fmt/format.h>

#include "db/types/errors.h"
#include "db/types/text.h"

namespace phonomime::demo {

namespace {

constexpr double kMmPerCm = 10.0;

[[noreturn]] void refuse(std::string_view where, long line, std::string_view expected,
                         std::string_view got) {
  throw InputError({.where = at_line(where, line),
                    .what = "this is not the canonical face mesh",
                    .expected = std::string(expected),
                    .got = quoted(got),
                    .remedy = "Give the canonical-face-model.obj of the npm package mind-ar."});
}

} // namespace

FaceMesh parse_canonical_face(std::string_view obj_text, std::string_view where) {
  FaceMesh mesh;
  long line_number = 0;
  for (const std::string_view line : split_lines(obj_text)) {
    ++line_number;
    const std::vector<std::string_view> words = split_words(line);
    if (words.empty() || (words[0] != "v" && words[0] != "f"))
      continue;
    if (words.size() != 4)
      refuse(where, line_number, "three coordinates or three corners", line);
    if (words[0] == "v") {
      Eigen::Vector3d vertex;
      for (int axis = 0; axis < 3; ++axis) {
        const std::optional<double> value = parse_number(words[axis + 1]);
        if (!value)
          refuse(where, line_number, "a number", words[axis + 1]);
        vertex[axis] = *value * kMmPerCm;
      }
      mesh.vertices_mm.push_back(vertex);
      continue;
    }
    std::array<int, 3> triangle{};
    for (int corner = 0; corner < 3; ++corner) {
      const std::string_view field = words[corner + 1];
      const std::optional<long> index = parse_integer(field.substr(0, field.find('/')));
      if (!index || *index < 1 || *index > kCanonicalVertexCount)
        refuse(where, line_number, "a vertex number from 1 to 468", field);
      triangle[corner] = static_cast<int>(*index) - 1;
    }
    mesh.triangles.push_back(triangle);
  }
  if (mesh.vertices_mm.size() != kCanonicalVertexCount)
    refuse(where, line_number, "468 vertices", std::to_string(mesh.vertices_mm.size()));
  return mesh;
}

std::string format_obj(const FaceMesh& mesh, std::string_view comment) {
  std::string text = fmt::format("# {}\n", comment);
  for (const Eigen::Vector3d& v : mesh.vertices_mm)
    text += fmt::format("v {:.5f} {:.5f} {:.5f}\n", v.x() / kMmPerCm, v.y() / kMmPerCm,
                        v.z() / kMmPerCm);
  for (const auto& t : mesh.triangles)
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

} // namespace phonomime::demo
