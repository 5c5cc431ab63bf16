// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/batch_record.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/json_file.h"
#include "tools/app/sha256.h"

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <system_error>

#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = ".phonomime-batch";
constexpr const char* kFormat = "phonomime-batch-record";
constexpr int kVersion = 1;

fs::path place_of(const fs::path& path) {
  return fs::absolute(path).lexically_normal();
}

// The outputs as they are, relative to the first one's folder, so that a folder of results can
// move.
nlohmann::ordered_json outputs_to_json(std::span<const fs::path> outputs) {
  const fs::path folder = place_of(outputs.front()).parent_path();
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const fs::path& output : outputs) {
    const std::string bytes = read_file(output);
    json.push_back({{"file", place_of(output).lexically_relative(folder).string()},
                    {"bytes", bytes.size()},
                    {"sha256", sha256(bytes)}});
  }
  return json;
}

nlohmann::ordered_json record_of(std::span<const fs::path> outputs,
                                 const std::string& fingerprint) {
  return {{"format", kFormat},
          {"version", kVersion},
          {"fingerprint", fingerprint},
          {"outputs", outputs_to_json(outputs)}};
}

} // namespace

fs::path record_path(std::span<const fs::path> outputs) {
  fs::path name = outputs.front().filename();
  name += ".json";
  return outputs.front().parent_path() / kFolder / name;
}

bool is_done(std::span<const fs::path> outputs, const std::string& fingerprint) {
  const fs::path path = record_path(outputs);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    return false;
  }
  try {
    const nlohmann::json record = parse_json(read_file(path), path.string());
    // The fingerprint first: outputs that will be made again need not be read.
    return record.is_object() && record.value("fingerprint", "") == fingerprint &&
           record == nlohmann::json(record_of(outputs, fingerprint));
  } catch (const Error&) {
    return false;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

void write_record(std::span<const fs::path> outputs, const std::string& fingerprint) {
  const fs::path path = record_path(outputs);
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) {
    throw IoError({.where = path.parent_path().string(),
                   .what = "the folder for the batch's records cannot be made",
                   .got = error.message()});
  }
  write_file(path, record_of(outputs, fingerprint).dump(1) + "\n");
}

void remove_unfinished(std::span<const fs::path> outputs) {
  std::map<fs::path, std::set<std::string>> targets; // by folder
  for (const fs::path& output : outputs) {
    targets[output.parent_path()].insert(output.filename().string());
  }
  static const std::regex part("(.*)\\.part-[0-9]+-[0-9]+");
  for (const auto& [folder, names] : targets) {
    std::error_code error;
    std::vector<fs::path> unfinished;
    for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error), end;
         !error && entry != end; entry.increment(error)) {
      const std::string name = entry->path().filename().string();
      std::smatch match;
      if (std::regex_match(name, match, part) && names.contains(match[1])) {
        unfinished.push_back(entry->path());
      }
    }
    for (const fs::path& path : unfinished) {
      fs::remove(path, error);
    }
  }
}

} // namespace phonomime
