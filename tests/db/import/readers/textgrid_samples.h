// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace phonomime::test {

// One phone tier, one tier of points and one of words, in Praat's two text forms.
inline const std::string kLongTextGrid = R"(File type = "ooTextFile"
Object class = "TextGrid"

xmin = 0 
xmax = 0.9 
tiers? <exists> 
size = 3 
item []: 
    item [1]:
        class = "IntervalTier" 
        name = "words" 
        xmin = 0 
        xmax = 0.9 
        intervals: size = 1 
        intervals [1]:
            xmin = 0 
            xmax = 0.9 
            text = "the ""go"" sign" 
    item [2]:
        class = "TextTier" 
        name = "bells" 
        xmin = 0 
        xmax = 0.9 
        points: size = 1 
        points [1]:
            number = 0.25 
            mark = "H*" 
    item [3]:
        class = "IntervalTier" 
        name = "Phones" 
        xmin = 0 
        xmax = 0.9 
        intervals: size = 3 
        intervals [1]:
            xmin = 0 
            xmax = 0.25 
            text = "" 
        intervals [2]:
            xmin = 0.25 
            xmax = 0.5 
            text = "ɡ""o" 
        intervals [3]:
            xmin = 0.5 
            xmax = 0.9 
            text = "ow" 
)";

inline const std::string kShortTextGrid = R"(File type = "ooTextFile"
Object class = "TextGrid"

0
0.9
<exists>
3
"IntervalTier"
"words"
0
0.9
1
0
0.9
"the ""go"" sign"
"TextTier"
"bells"
0
0.9
1
0.25
"H*"
"IntervalTier"
"Phones"
0
0.9
3
0
0.25
""
0.25
0.5
"ɡ""o"
0.5
0.9
"ow"
)";

// UTF-8 (code points below U+10000) as UTF-16 with its byte order mark.
inline std::string to_utf16(const std::string& text, bool big_endian) {
  std::vector<unsigned> units = {0xFEFF};
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) {
      return static_cast<unsigned char>(text[i + k]) & 0xFFu;
    };
    if (byte(0) < 0x80) {
      units.push_back(byte(0));
      i += 1;
    } else if (byte(0) < 0xE0) {
      units.push_back((byte(0) & 0x1F) << 6 | (byte(1) & 0x3F));
      i += 2;
    } else {
      units.push_back((byte(0) & 0x0F) << 12 | (byte(1) & 0x3F) << 6 | (byte(2) & 0x3F));
      i += 3;
    }
  }
  std::string bytes;
  for (const unsigned unit : units) {
    bytes += static_cast<char>(big_endian ? unit >> 8 : unit & 0xFF);
    bytes += static_cast<char>(big_endian ? unit & 0xFF : unit >> 8);
  }
  return bytes;
}

// `text` with the first occurrence of `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

} // namespace phonomime::test
