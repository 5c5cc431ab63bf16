// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/player_document.h"

#include "db/types/errors.h"
#include "synth/export/player_template.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

constexpr std::string_view kPage =
    "<title>@PHONOMIME_TITLE@</title><script>@PHONOMIME_DATA@</script>";

// RFC 4648, the other way and by another method than the writer's.
std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bits;
  for (const char c : text) {
    if (c != '=') {
      const std::size_t value = digits.find(c);
      EXPECT_NE(value, std::string::npos);
      for (int b = 5; b >= 0; --b) {
        bits += (value >> b & 1) != 0 ? '1' : '0';
      }
    }
  }
  std::string bytes;
  for (std::size_t i = 0; i + 8 <= bits.size(); i += 8) {
    bytes += static_cast<char>(std::stoi(bits.substr(i, 8), nullptr, 2));
  }
  return bytes;
}

PlayerDocument some_document() {
  PlayerDocument document;
  document.title = "</title><script>alert(1)</script> & @PHONOMIME_DATA@ \"x\"";
  document.duration_s = 1.5;
  document.fps = 30.0;
  document.glb = std::string("glTF\0\xff\x80", 7);
  document.phonemes = {{.phoneme = "pau", .end_s = 0.5},
                       {.phoneme = "b",
                        .start_s = 0.5,
                        .end_s = 1.5,
                        .node = "s1/neutral/<x>#3",
                        .captured = true,
                        .observation_cost = 1.25,
                        .closure = true}};
  document.emotions = {{.end_s = 1.5, .emotion = "neutral", .color = "#888888"}};
  document.landmarks["chin"] = {.mesh = 0, .primitive = 0, .vertex = 152};
  document.credits = {"Ann </script>"};
  document.synthetic = true;
  return document;
}

nlohmann::json data_in(const std::string& page) {
  const std::size_t first = page.find("<script>", page.find("</title><script>")) + 8;
  return nlohmann::json::parse(page.substr(first, page.rfind("</script>") - first));
}

TEST(PlayerDocument, FillsBothSlotsAndNothingElse) {
  const std::string page = fill_player_template(kPage, some_document());
  EXPECT_TRUE(page.starts_with(
      "<title>&lt;/title&gt;&lt;script&gt;alert(1)&lt;/script&gt; &amp; @PHONOMIME_DATA@ "
      "&quot;x&quot;</title><script>{"))
      << page.substr(0, 200);
  EXPECT_EQ(page.find("</script>"), page.rfind("</script>")) << "no data ends the script early";
  const nlohmann::json data = data_in(page);
  EXPECT_EQ(data["title"], some_document().title);
  EXPECT_EQ(data["credits"][0], "Ann </script>");
  EXPECT_EQ(data["synthetic"], true);
  EXPECT_EQ(data["duration"], 1.5);
  EXPECT_EQ(data["audio"], nullptr);
  EXPECT_EQ(data["phonemes"][0]["node"], nullptr);
  EXPECT_EQ(data["phonemes"][1]["node"], "s1/neutral/<x>#3");
  EXPECT_EQ(data["phonemes"][1]["index"], 1);
  EXPECT_EQ(data["phonemes"][1]["cost"]["observation"], 1.25);
  EXPECT_EQ(data["phonemes"][1]["closure"], true);
  EXPECT_EQ(data["landmarks"]["chin"]["vertex"], 152);
  EXPECT_EQ(from_base64(data["glb"]), some_document().glb);
}

TEST(PlayerDocument, CodesBytesOfAnyLength) {
  for (std::size_t length = 1; length < 70; ++length) {
    PlayerDocument document = some_document();
    document.wav.clear();
    for (std::size_t i = 0; i < length; ++i) {
      document.wav += static_cast<char>(i * 37 + length);
    }
    const std::string text = data_in(fill_player_template(kPage, document))["audio"];
    EXPECT_EQ(text.size() % 4, 0u);
    EXPECT_EQ(from_base64(text), document.wav);
  }
}

TEST(PlayerDocument, NeedsBothSlots) {
  EXPECT_THROW(fill_player_template("<title>@PHONOMIME_TITLE@</title>", some_document()),
               InternalError);
  EXPECT_THROW(fill_player_template("<script>@PHONOMIME_DATA@</script>", some_document()),
               InternalError);
}

TEST(PlayerDocument, IsAPageWhereThisBuildHasAPlayer) {
  if (player_template().empty()) {
    EXPECT_THROW(player_html(some_document()), UsageError);
    return;
  }
  const std::string page = player_html(some_document());
  EXPECT_TRUE(page.starts_with("<!"));
  EXPECT_TRUE(page.ends_with("</html>\n")) << page.substr(page.size() - 40);
  EXPECT_EQ(page.find("@PHONOMIME_TITLE@"), std::string::npos);
}

} // namespace
} // namespace phonomime
