// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace phonomime {

// "speaker/emotion/id" of whatever has the three as strings: what tells sentences apart.
template <typename Sentence>
std::string sentence_key(const Sentence& sentence) {
  return sentence.speaker + '/' + sentence.emotion + '/' + sentence.id;
}

} // namespace phonomime
