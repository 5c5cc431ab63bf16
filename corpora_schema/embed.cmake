# SPDX-License-Identifier: GPL-3.0-or-later
# Writes OUTPUT, a C++ source that holds the FILES (relative to FOLDER) as raw string literals.
# A literal may not be longer than 65,536 characters in standard C++; ours stay far below that.
separate_arguments(FILES)
set(entries "")
set(count 0)
foreach(file IN LISTS FILES)
  file(READ ${FOLDER}/${file} content)
  string(APPEND entries "    {\"${file}\", R\"phonomime(${content})phonomime\"},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(WRITE ${OUTPUT} "// Made by corpora_schema/embed.cmake.
#include <string_view>
namespace phonomime::corpora_schema {
struct EmbeddedFile {
  std::string_view path;
  std::string_view content;
};
extern const EmbeddedFile kEmbeddedFiles[];
extern const int kEmbeddedFileCount;
const EmbeddedFile kEmbeddedFiles[] = {
${entries}};
const int kEmbeddedFileCount = ${count};
}  // namespace phonomime::corpora_schema
")
