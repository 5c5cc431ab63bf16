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

// An output's path from the first one's folder, so that a folder of results can move.
std::string name_in_record(const fs::path& output, const fs::path& first) {
  const auto place = [](const fs::path& path) { return fs::absolute(path).lexically_normal(); };
  return place(output).lexically_relative(place(first).parent_path()).string();
}

// Of a file's last change; what matters is whether it is another.
std::int64_t time_of_change(const fs::path& file) {
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(file, error);
  if (error) {
    throw IoError({.where = file.string(), .what = "cannot be examined", .got = error.message()});
  }
  return time.time_since_epoch().count();
}

// A file of the recorded size and time is taken for the recorded one; of another time, its content
// says. So the outputs of thousands of rows need not be read each time.
bool is_as_recorded(const fs::path& output, const nlohmann::json& record) {
  const std::int64_t time = time_of_change(output);
  std::error_code error;
  return fs::file_size(output, error) == record.at("bytes").get<std::uintmax_t>() && !error &&
         (time == record.at("changed").get<std::int64_t>() ||
          sha256(read_file(output)) == record.at("sha256").get<std::string>());
}

bool are_as_recorded(std::span<const fs::path> outputs, const nlohmann::json& records) {
  if (records.size() != outputs.size()) {
    return false;
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (records.at(i).at("file").get<std::string>() != name_in_record(outputs[i], outputs[0]) ||
        !is_as_recorded(outputs[i], records.at(i))) {
      return false;
    }
  }
  return true;
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
    return record.at("format").get<std::string>() == kFormat &&
           record.at("version").get<int>() == kVersion &&
           record.at("fingerprint").get<std::string>() == fingerprint &&
           are_as_recorded(outputs, record.at("outputs"));
  } catch (const Error&) { // something is gone or cannot be read
    return false;
  } catch (const nlohmann::json::exception&) { // the record holds something else
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
  nlohmann::ordered_json record = {{"format", kFormat},
                                   {"version", kVersion},
                                   {"fingerprint", fingerprint},
                                   {"outputs", nlohmann::ordered_json::array()}};
  for (const fs::path& output : outputs) {
    const std::string bytes = read_file(output);
    record["outputs"].push_back({{"file", name_in_record(output, outputs.front())},
                                 {"bytes", bytes.size()},
                                 {"changed", time_of_change(output)},
                                 {"sha256", sha256(bytes)}});
  }
  write_file(path, record.dump(1) + "\n");
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
