// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

// Looks into databases with SQLite's own C interface, past the code under test.
namespace phonomime::test {

// The rows of a query, fields joined by '|'; blobs in hexadecimal. Fails the test on an error.
std::vector<std::string> raw_query(const std::filesystem::path& path, const std::string& sql);

// Every table's definition and rows, in their order in the file.
std::vector<std::string> raw_dump(const std::filesystem::path& path);

// integrity_check and foreign_key_check say nothing.
void expect_sound(const std::filesystem::path& path);

// At rest: journal_mode=DELETE in the header, and the file says the same without those beside it.
void expect_alone_and_whole(const std::filesystem::path& path);

} // namespace phonomime::test
