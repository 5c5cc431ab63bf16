// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/html_text.h"

#include "db/types/errors.h"

#include <gtest/gtest.h>

namespace phonomime {
namespace {

TEST(HtmlText, Base64IsThatOfRfc4648) { // section 10, and bytes above 127
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\xff\x00\xfe", 3)), "/wD+");
}

TEST(HtmlText, MarkupStaysText) {
  EXPECT_EQ(escape_html("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;");
  EXPECT_EQ(script_safe(R"({"a":"</script><!--"})"), "{\"a\":\"\\u003c/script>\\u003c!--\"}");
}

TEST(HtmlText, FillsTheFirstSlotAndMissesNone) {
  std::string page = "<b>@A@</b>@A@";
  fill_slot(page, "@A@", "@A@ $1");
  EXPECT_EQ(page, "<b>@A@ $1</b>@A@");
  EXPECT_THROW(fill_slot(page, "@B@", ""), InternalError);
}

} // namespace
} // namespace phonomime
