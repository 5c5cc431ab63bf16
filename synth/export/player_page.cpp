// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/player_page.h"

#ifdef PHONOMIME_PLAYER_HTML
// The assembler copies the file: half a megabyte is more than a string literal may hold.
asm(".section .rodata\n"
    "phonomime_player_page_first:\n"
    ".incbin \"" PHONOMIME_PLAYER_HTML "\"\n"
    "phonomime_player_page_past:\n"
    ".byte 0\n"
    ".previous\n");
extern "C" {
extern const char phonomime_player_page_first[];
extern const char phonomime_player_page_past[];
}
#endif

namespace phonomime {

std::string_view player_page() {
#ifdef PHONOMIME_PLAYER_HTML
  return {phonomime_player_page_first, phonomime_player_page_past};
#else
  return {};
#endif
}

} // namespace phonomime
