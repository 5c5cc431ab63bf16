// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/batch_report.h"

#include <array>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

constexpr std::array<std::pair<RowStatus, const char*>, 4> kStatusNames = {
    {{RowStatus::done, "done"},
     {RowStatus::skipped, "skipped"},
     {RowStatus::failed, "failed"},
     {RowStatus::stopped, "stopped"}}};

nlohmann::ordered_json row_to_json(const BatchRow& row) {
  nlohmann::ordered_json json;
  json["line"] = row.line;
  json["id"] = row.id;
  for (const auto& [status, name] : kStatusNames) {
    if (row.status == status) {
      json["status"] = name;
    }
  }
  json["outputs"] = nlohmann::ordered_json::array();
  for (const std::filesystem::path& output : row.outputs) {
    json["outputs"].push_back(output.string());
  }
  if (row.status == RowStatus::failed) {
    json["exit_status"] = static_cast<int>(row.error_class);
    json["error"] = row.error;
  }
  json["warnings"] = row.warnings;
  json["seconds"] = row.seconds;
  return json;
}

} // namespace

nlohmann::ordered_json batch_to_json(const BatchOptions& options, const BatchReport& report) {
  nlohmann::ordered_json json;
  json["format"] = "phonomime-batch";
  json["version"] = 1;
  json["manifest"] = options.manifest.string();
  json["shard"] = format_shard(options.shard);
  for (const auto& [status, name] : kStatusNames) {
    json[name] = report.count(status);
  }
  json["seconds"] = report.seconds;
  json["rows"] = nlohmann::ordered_json::array();
  for (const BatchRow& row : report.rows) {
    json["rows"].push_back(row_to_json(row));
  }
  return json;
}

std::string batch_to_text(const BatchReport& report) {
  std::string text = fmt::format("{} rows: ", report.rows.size());
  for (const auto& [status, name] : kStatusNames) {
    if (status != RowStatus::stopped || report.count(status) > 0) {
      text +=
          fmt::format("{}{} {}", status == RowStatus::done ? "" : ", ", report.count(status), name);
    }
  }
  return text + fmt::format("; {:.2f} s\n", report.seconds);
}

} // namespace phonomime
