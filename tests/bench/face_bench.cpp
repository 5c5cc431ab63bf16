// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/glb.h"
#include "synth/export/player_document.h"
#include "synth/retarget/marker_face.h"
#include "tests/bench/compare.h"
#include "tests/synth/retarget/made_mesh.h"
#include "tests/synth/search/random_tables.h"

#include <cstring>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <nlohmann/json.hpp>

namespace phonomime {
namespace {

using FloatPoints = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

constexpr float kMetresPerMillimetre = 1e-3f;
constexpr int kColumns = 70;
constexpr int kRows = 91;

// Six seconds of 91 markers' motion, on a sheet with as many vertices as a face.
struct Speech {
  MotionTable table;
  CoefficientMotion motion;
  MarkerFace face;

  static MotionTable make_table() {
    test::Draw draw(4);
    test::TableShape shape;
    shape.groups = 91;
    shape.dimensions = 25;
    shape.sentences = 20;
    return test::random_table(shape, draw);
  }

  // A marker on each row of the sheet, where its rest position is.
  static MarkerFace make_face(MotionTable& table) {
    FaceSource source;
    source.mesh = test::grid(kColumns, kRows, 0.2, 4);
    for (int row = 0; row < kRows; ++row) {
      source.markers.vertices.push_back(row * kColumns + (29 * row) % kColumns);
    }
    table.reference_pose = test::as_frame(source.mesh.positions, source.markers.vertices);
    table.pca.mean = table.reference_pose;
    return MarkerFace(std::move(source), table.layout, table.reference_pose);
  }

  Speech() : table(make_table()), face(make_face(table)) {
    motion.rate_hz = 30.0;
    motion.coefficients = table.coefficients.topRows(180).cast<double>();
  }
};

std::string ours_glb(const Speech& speech) {
  return marker_face_glb(speech.face.mesh(), speech.face.morphs(speech.table.pca), speech.motion,
                         {.title = "made", .credits = {}});
}

// Every frame's vertices, one frame after the other, in metres.
std::vector<FloatPoints> baked_frames(const Speech& speech) {
  std::vector<FloatPoints> frames;
  for (const auto& coefficients : speech.motion.coefficients.rowwise()) {
    frames.push_back(
        kMetresPerMillimetre *
        speech.face.deform(speech.table.pca.reconstruct(coefficients.transpose())).cast<float>());
  }
  return frames;
}

// The numbers of a binary glTF.
struct ReadGlb {
  std::string_view bytes;
  nlohmann::json json;
  std::size_t data = 0;

  explicit ReadGlb(std::string_view glb) : bytes(glb) {
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + 12, sizeof size);
    json = nlohmann::json::parse(bytes.substr(20, size));
    data = 20 + size + 8;
  }
  Eigen::Map<const Eigen::VectorXf> numbers(const nlohmann::json& accessor) const {
    const nlohmann::json& view =
        json["bufferViews"]
            [json["accessors"][accessor.get<std::size_t>()]["bufferView"].get<std::size_t>()];
    return {reinterpret_cast<const float*>(bytes.data() + data +
                                           view.value("byteOffset", std::size_t{0})),
            view["byteLength"].get<Eigen::Index>() / 4};
  }
};

// The mesh at a frame is that of the GLB's morph targets, to 0.01 mm.
void verify_frames(const std::string& bytes, const std::vector<FloatPoints>& frames) {
  const ReadGlb glb(bytes);
  const nlohmann::json& skin = glb.json["meshes"][0]["primitives"][0];
  const Eigen::Map<const Eigen::VectorXf> weights =
      glb.numbers(glb.json["animations"][0]["samplers"][0]["output"]);
  const auto targets = std::ssize(skin["targets"]);
  bench::verify(weights.size() == std::ssize(frames) * targets, "the number of weights");
  for (Eigen::Index frame = 0; frame < std::ssize(frames); frame += 30) {
    Eigen::VectorXf shape = glb.numbers(skin["attributes"]["POSITION"]);
    for (Eigen::Index k = 0; k < targets; ++k) {
      shape += weights[frame * targets + k] *
               glb.numbers(skin["targets"][static_cast<std::size_t>(k)]["POSITION"]);
    }
    const FloatPoints& expected = frames[static_cast<std::size_t>(frame)];
    const Eigen::Map<const Eigen::VectorXf> flat(expected.data(), expected.size());
    bench::verify(shape.size() == flat.size() && (shape - flat).cwiseAbs().maxCoeff() < 1e-5f,
                  "the GLB's vertices are not those of the face");
  }
}

void glb_against_baked_frames(benchmark::State& state) {
  const Speech speech;
  const std::string glb = ours_glb(speech);
  const std::vector<FloatPoints> baked = baked_frames(speech);
  verify_frames(glb, baked);
  state.counters["plain/ours bytes"] = static_cast<double>(baked.size()) *
                                       static_cast<double>(baked.front().size()) * 4.0 /
                                       static_cast<double>(glb.size());
  bench::compare(
      state, [&] { return ours_glb(speech).size(); }, [&] { return baked_frames(speech).size(); });
}
BENCHMARK(glb_against_baked_frames)->Iterations(5)->UseManualTime()->Unit(benchmark::kMillisecond);

constexpr std::string_view kPage =
    "<title>@PHONOMIME_TITLE@</title><script>@PHONOMIME_DATA@</script>";

// Bit by bit (RFC 4648).
std::string plain_base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  unsigned value = 0;
  int bits = 0;
  for (const char c : bytes) {
    for (int bit = 7; bit >= 0; --bit) {
      value = value << 1 | (static_cast<unsigned char>(c) >> bit & 1u);
      if (++bits == 6) {
        text += digits[value];
        value = 0;
        bits = 0;
      }
    }
  }
  if (bits > 0) {
    text += digits[value << (6 - bits)];
  }
  while (text.size() % 4 != 0) {
    text += '=';
  }
  return text;
}

// The page of the same document without its face and sound, which are put in afterwards.
std::string plain_page(PlayerDocument document) {
  const std::string glb = std::exchange(document.glb, {});
  const std::string wav = std::exchange(document.wav, {});
  std::string page = fill_player_template(kPage, document);
  page.replace(page.find(R"("glb":"")"), 8, R"("glb":")" + plain_base64(glb) + '"');
  page.replace(page.find(R"("audio":null)"), 12, R"("audio":")" + plain_base64(wav) + '"');
  return page;
}

void page_against_bits(benchmark::State& state) {
  PlayerDocument document;
  document.title = "made";
  document.glb = ours_glb(Speech());
  document.wav = std::string(6 * 2 * 44100 + 44, 'w');
  document.phonemes.resize(60);
  bench::verify(fill_player_template(kPage, document) == plain_page(document),
                "the page does not hold the face and the sound");
  bench::compare(
      state, [&] { return fill_player_template(kPage, document).size(); },
      [&] { return plain_page(document).size(); });
}
BENCHMARK(page_against_bits)->Iterations(5)->UseManualTime()->Unit(benchmark::kMillisecond);

} // namespace
} // namespace phonomime
