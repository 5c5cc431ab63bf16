// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// One value a sentence; nothing where the measure has no meaning there.
using SentenceValues = std::vector<std::optional<double>>;

// What has been evaluated, so that a run that was stopped, killed or is asked for again does not do
// it twice. A file of lines of JSON: the first says what run it is of, each other holds one
// evaluation and is on disk before add() returns. A last line that was cut off is dropped.
//
//   {"format":"phonomime-tune-journal","version":1,"run":{"seed":"1",...}}
//   {"set":"fold 1","weights":{"alpha1":1.0,...},"values":[1.25,null,...]}
//
// All members may be called from several threads.
class Journal {
public:
  // `run`: all that values depend on beside set and weights. An empty path: kept in memory alone.
  // Throws InputError where the file is no journal, or one of another run, and says what differs;
  // IoError, also where another run is at work on it.
  Journal(std::filesystem::path path, const std::map<std::string, std::string>& run);
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  ~Journal();

  // `set`: which sentences, spoken with which recordings; `weights`: as weights_line writes them.
  std::optional<SentenceValues> find(std::string_view set, std::string_view weights) const;

  // Throws IoError.
  void add(std::string_view set, std::string_view weights, const SentenceValues& values);

  std::size_t found() const { return found_; } // evaluations that were there from the start

private:
  void open(const std::string& header);
  void read(const std::string& text, const std::string& header);
  void append(const std::string& line);

  std::filesystem::path path_;
  int file_ = -1;
  std::int64_t size_ = 0; // of whole lines, bytes
  std::size_t found_ = 0;
  std::map<std::pair<std::string, std::string>, SentenceValues> known_;
  mutable std::mutex mutex_;
};

} // namespace phonomime
