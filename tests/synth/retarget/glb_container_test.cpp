// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/glb_container.h"

#include "db/types/errors.h"
#include "synth/retarget/mesh_reader.h"
#include "tests/support/expect_error.h"
#include "tests/synth/retarget/glb_bytes.h"

#include <cstring>
#include <random>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

TEST(GlbContainer, KeepsWhatItDoesNotAddTo) {
  const test::SmallGlb small;
  GlbContainer container = parse_glb_container(small.bytes(), "a.glb");
  EXPECT_EQ(nlohmann::json(container.json), small.json);
  EXPECT_EQ(container.binary.substr(0, 42), small.binary.substr(0, 42));
  const std::size_t times = container.add_times(3, 50.0);
  const std::size_t turns = container.add({0, 0, 0, 1, 0.5F, 0.5F, 0.5F, 0.5F}, "VEC4", 4);
  const std::string bytes = container.bytes();
  EXPECT_EQ(bytes.size() % 4, 0u);
  // The same mesh for a reader of its own (tinygltf).
  EXPECT_EQ(parse_glb(bytes, "b.glb").positions, parse_glb(small.bytes(), "a.glb").positions);
  const GlbContainer again = parse_glb_container(bytes, "b.glb");
  const auto numbers = [&](std::size_t accessor) {
    const auto& view =
        again.json["bufferViews"]
                  [again.json["accessors"][accessor]["bufferView"].get<std::size_t>()];
    std::vector<float> values(view["byteLength"].get<std::size_t>() / sizeof(float));
    std::memcpy(values.data(), again.binary.data() + view["byteOffset"].get<std::size_t>(),
                values.size() * sizeof(float));
    return values;
  };
  EXPECT_EQ(numbers(times), (std::vector<float>{0.0F, 0.02F, 0.04F}));
  EXPECT_EQ(again.json["accessors"][times]["max"][0].get<float>(), 0.04F);
  EXPECT_EQ(again.json["accessors"][turns]["count"], 2);
  EXPECT_EQ(numbers(turns).back(), 0.5F);
  EXPECT_EQ(again.json["buffers"][0]["byteLength"].get<std::size_t>(), again.binary.size());
}

TEST(GlbContainer, SaysWhatIsWrong) {
  using test::glb_container;
  const auto expect = [](const std::string& bytes, const char* words) {
    test::expect_error([&] { parse_glb_container(bytes, "x.glb"); }, words);
  };
  expect("solid cube", "x.glb: this is not a binary glTF file");
  std::string old = test::SmallGlb().bytes();
  old[4] = 1;
  expect(old, "this is not a binary glTF file");
  const std::string whole = test::SmallGlb().bytes();
  expect(whole.substr(0, 100), "cut short");
  expect(whole.substr(0, whole.size() - 4), "cut short");
  expect(glb_container("[", ""), "damaged");
  expect(glb_container("[]", ""), "damaged");
  expect(glb_container(R"({"nodes":{}})", ""), "damaged");
  expect(glb_container(R"({"nodes":[7]})", ""), "damaged");
  expect(glb_container(R"({"buffers":[{"uri":"x.bin"}]})", ""), "in another");
}

// Whatever bytes come, there is an answer or an InputError.
TEST(GlbContainer, BearsSpoiltFiles) {
  const std::string whole = test::SmallGlb().bytes();
  const auto bears = [](const std::string& bytes) {
    try {
      parse_glb_container(bytes, "x.glb").bytes();
    } catch (const InputError&) {
    }
  };
  for (std::size_t size = 0; size < whole.size(); ++size) {
    bears(whole.substr(0, size));
  }
  std::mt19937 random(1);
  for (int trial = 0; trial < 3000; ++trial) {
    std::string spoilt = whole;
    for (int byte = 0; byte < 1 + trial % 3; ++byte) {
      spoilt[random() % spoilt.size()] = static_cast<char>(random());
    }
    bears(spoilt);
  }
}

} // namespace
} // namespace phonomime
