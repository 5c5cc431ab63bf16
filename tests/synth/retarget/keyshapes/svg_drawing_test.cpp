// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/retarget/keyshapes/svg_drawing.h"

#include "tests/support/expect_error.h"

#include <string>

#include <gtest/gtest.h>

namespace phonomime {
namespace {

const std::string kRest = R"svg(<?xml version="1.0"?>
<!-- a face <path d="M9 9"/> -->
<svg xmlns="http://www.w3.org/2000/svg" width="100" height="80">
 <title>9 lives</title>
 <path id="mouth7" fill="#112233" d="M10,20 q5-1.5.5 1e1Z"/>
 <ellipse cx='50' cy="40" rx="4" ry="2" transform="rotate(30)"/>
</svg>
)svg";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(SvgDrawing, ReadsTheNumbersOfItsShapesAlone) {
  const SvgDrawing drawing(kRest, "rest.svg");
  EXPECT_EQ(drawing.numbers(),
            (Eigen::RowVectorXd(11) << 10, 20, 5, -1.5, 0.5, 10, 50, 40, 4, 2, 30).finished());
  EXPECT_EQ(drawing.number_names()[3], "<path> 2, d, number 4");
}

TEST(SvgDrawing, BlendsNumberByNumber) {
  const SvgDrawing rest(kRest, "rest.svg");
  const SvgDrawing wide(replaced(kRest, "rx=\"4\"", "rx=\"10.5\""), "wide.svg");
  rest.check_equal_structure(wide);
  const Eigen::RowVectorXd half = 0.5 * (rest.numbers() + wide.numbers());
  const std::string text = rest.with(half);
  EXPECT_NE(text.find("rx=\"7.25\""), std::string::npos);
  EXPECT_NE(text.find("<title>9 lives</title>"), std::string::npos);
  EXPECT_NE(text.find("id=\"mouth7\" fill=\"#112233\""), std::string::npos);
  EXPECT_EQ(SvgDrawing(text, "again").numbers(), half);
}

TEST(SvgDrawing, NumbersNeverRunTogether) {
  const SvgDrawing rest(kRest, "rest.svg");
  Eigen::RowVectorXd numbers = rest.numbers();
  numbers[3] = 1.5; // 5-1.5 had no other separator than the sign
  numbers[4] = -2e-9;
  EXPECT_EQ(SvgDrawing(rest.with(numbers), "again").numbers()[3], 1.5);
  EXPECT_NE(rest.with(numbers).find("q5 1.5 0 10Z"), std::string::npos);
}

TEST(SvgDrawing, RefusesAnotherStructure) {
  const SvgDrawing rest(kRest, "rest.svg");
  const auto refused = [&](const std::string& from, const std::string& to, const char* part) {
    test::expect_error(
        [&] { rest.check_equal_structure(SvgDrawing(replaced(kRest, from, to), "key.svg")); },
        part);
  };
  refused("1e1Z", "1e1 3 4Z", "key.svg: the drawing is built otherwise than rest.svg");
  refused(" ry=\"2\"", "", "<ellipse>");
  refused("M10,20 q", "M10,20 c", "at its element 2");
  refused("</svg>", "<circle r=\"1\"/></svg>", "no further shape");
}

TEST(SvgDrawing, RefusesWhatIsNoDrawing) {
  for (const std::string text :
       {"", "<html></html>", "<svg></svg>", "<svg><path d=\"M1 2", "<svg><path d></svg>",
        "<svg><path d=M1></svg>", "<svg><!-- ", "<svg><path d=\"M1e999\"/></svg>"}) {
    test::expect_error([&] { SvgDrawing(text, "bad.svg"); }, "bad.svg: ");
  }
}

TEST(SvgDrawing, MovesByItself) {
  const SvgDrawing rest(kRest, "rest.svg");
  FrameMatrixD frames(3, 11);
  frames.rowwise() = rest.numbers();
  frames.col(9) << 2, 3, 4.25; // ry
  const std::string text = rest.animated(frames, 25.0);
  EXPECT_NE(text.find("[3,'ry',['2','3','4.25']]"), std::string::npos);
  EXPECT_EQ(text.find("'cx'"), std::string::npos);
  EXPECT_EQ(SvgDrawing(text, "moving.svg").numbers(), rest.numbers());
}

} // namespace
} // namespace phonomime
