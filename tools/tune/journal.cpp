// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tune/journal.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/json_file.h"
#include "db/types/text.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <unistd.h>

namespace phonomime {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "phonomime-tune-journal";
constexpr int kVersion = 1;

[[noreturn]] void fail(const std::filesystem::path& path, const char* what) {
  throw IoError(
      {.where = path.string(), .what = what, .got = std::system_category().message(errno)});
}

[[noreturn]] void refuse(std::string where, std::string what, std::string expected = {},
                         std::string got = {}) {
  throw InputError({.where = std::move(where),
                    .what = std::move(what),
                    .expected = std::move(expected),
                    .got = std::move(got),
                    .remedy = "Name another journal, or repeat the call that wrote this one."});
}

// Says how the run that a journal is of differs from this one.
void check_header(const std::string& where, const nlohmann::json& theirs, const Json& ours) {
  if (!theirs.is_object() || theirs.value("format", "") != kFormat ||
      theirs.value("version", 0) != kVersion || !theirs.contains("run")) {
    refuse(where, "this is no journal of `tune`");
  }
  const nlohmann::json run = theirs["run"];
  for (const auto& [name, value] : ours["run"].items()) {
    const std::string got = run.is_object() ? run.value(name, "nothing") : "nothing";
    if (got != value.get<std::string>()) {
      refuse(where, "the journal is of another run: " + name + " differs", value.get<std::string>(),
             got);
    }
  }
}

} // namespace

Journal::Journal(std::filesystem::path path, const std::map<std::string, std::string>& run)
    : path_(std::move(path)) {
  if (path_.empty()) {
    return;
  }
  const Json header = {{"format", kFormat}, {"version", kVersion}, {"run", run}};
  open(header.dump() + "\n");
}

Journal::~Journal() {
  if (file_ >= 0) {
    ::close(file_);
  }
}

void Journal::open(const std::string& header) {
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) {
    fail(path_, "the journal cannot be opened");
  }
  try {
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      fail(path_, "another run is at work on the journal");
    }
    read(read_file(path_), header);
  } catch (...) { // no destructor is called
    ::close(file_);
    throw;
  }
}

void Journal::read(const std::string& text, const std::string& header) {
  const std::size_t whole = text.rfind('\n') + 1; // 0 where there is no line
  if (whole == 0) {
    if (!header.starts_with(text)) { // empty, or cut off
      refuse(path_.string(), "this is no journal of `tune`");
    }
    append(header);
    return;
  }
  long number = 0;
  for (const std::string_view line : split_lines(std::string_view(text).substr(0, whole))) {
    const std::string where = at_line(path_.string(), ++number);
    if (number == 1) {
      check_header(path_.string(), nlohmann::json::parse(line, nullptr, false),
                   Json::parse(header));
      continue;
    }
    const nlohmann::json json = parse_json(line, where);
    try {
      SentenceValues values;
      for (const nlohmann::json& value : json.at("values")) {
        values.push_back(value.is_null() ? std::nullopt : std::optional(value.get<double>()));
      }
      const std::string weights = Json::parse(line).at("weights").dump();
      known_[{json.at("set").get<std::string>(), weights}] = std::move(values);
    } catch (const nlohmann::json::exception&) {
      refuse(where, "the line holds no evaluation");
    }
  }
  found_ = known_.size();
  size_ = static_cast<std::int64_t>(whole);
}

std::optional<SentenceValues> Journal::find(std::string_view set, std::string_view weights) const {
  const std::scoped_lock lock(mutex_);
  const auto known = known_.find({std::string(set), std::string(weights)});
  return known == known_.end() ? std::nullopt : std::optional(known->second);
}

void Journal::add(std::string_view set, std::string_view weights, const SentenceValues& values) {
  Json line = {{"set", set}, {"weights", Json::parse(weights)}, {"values", Json::array()}};
  for (const std::optional<double>& value : values) {
    line["values"].push_back(value ? Json(*value) : Json(nullptr));
  }
  const std::scoped_lock lock(mutex_);
  const auto [place, is_new] = known_.try_emplace({std::string(set), std::string(weights)}, values);
  if (is_new && file_ >= 0) {
    append(line.dump() + "\n");
  }
}

// Behind the last whole line, over whatever was begun there.
void Journal::append(const std::string& line) {
  if (::ftruncate(file_, size_) != 0) {
    fail(path_, "the journal cannot be written");
  }
  std::size_t done = 0;
  while (done < line.size()) {
    const ssize_t wrote = ::pwrite(file_, line.data() + done, line.size() - done,
                                   static_cast<off_t>(size_) + static_cast<off_t>(done));
    if (wrote < 0 && errno != EINTR) {
      fail(path_, "the journal cannot be written");
    }
    done += wrote > 0 ? static_cast<std::size_t>(wrote) : 0;
  }
  if (::fsync(file_) != 0) {
    fail(path_, "the journal cannot be written");
  }
  size_ += static_cast<std::int64_t>(line.size());
}

} // namespace phonomime
