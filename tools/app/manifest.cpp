// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/manifest.h"

#include "db/types/errors.h"
#include "db/types/tab_table.h"
#include "db/types/text.h"
#include "tools/app/retime.h"
#include "tools/app/synth_outputs.h"

#include <array>
#include <map>
#include <optional>
#include <system_error>

#include <fmt/format.h>

namespace phonomime {

namespace {

namespace fs = std::filesystem;

enum Column : std::size_t {
  id,
  transcript,
  outputs,
  speaker,
  phoneme_set,
  tier,
  emotion,
  emotions,
  constraints,
  weights,
  audio,
  face,
  fps
};
constexpr std::array<std::string_view, 13> kColumns = {
    "id",       "transcript",  "outputs", "speaker", "phoneme_set", "tier", "emotion",
    "emotions", "constraints", "weights", "audio",   "face",        "fps"};
constexpr std::array<std::size_t, 1> kRequired = {transcript};

constexpr std::string_view kId = "{id}";

// The first `{word}` that stands for nothing.
std::optional<std::string> unknown_placeholder(std::string_view pattern) {
  for (std::size_t open = pattern.find('{'); open != std::string_view::npos;
       open = pattern.find('{', open + 1)) {
    const std::size_t close = pattern.find('}', open);
    if (close == std::string_view::npos) {
      break;
    }
    const std::string_view word = pattern.substr(open, close + 1 - open);
    if (word != kId) {
      return std::string(word);
    }
  }
  return std::nullopt;
}

fs::path with_id(std::string pattern, const std::string& row_id) {
  for (std::size_t at = pattern.find(kId); at != std::string::npos;
       at = pattern.find(kId, at + row_id.size())) {
    pattern.replace(at, kId.size(), row_id);
  }
  return pattern;
}

ErrorDetails placeholder_error(std::string where, const std::string& word) {
  return {.where = std::move(where),
          .what = fmt::format("{} stands for nothing", quoted(word)),
          .expected = "{id}, which stands for the row's id"};
}

// What holds for every row. Whether a face is missing, the rows decide.
void check_defaults(SynthOptions defaults) {
  for (const fs::path& pattern : defaults.outputs) {
    if (const auto word = unknown_placeholder(pattern.string())) {
      throw UsageError(placeholder_error("--output", *word));
    }
  }
  defaults.outputs.clear();
  check_synth_options(defaults);
}

std::vector<fs::path> read_outputs(const TabTable& table, const fs::path& folder,
                                   const std::vector<fs::path>& defaults) {
  std::vector<fs::path> patterns;
  for (const std::string_view field : split_fields(table.field(outputs), ';')) {
    if (const std::string_view pattern = trim(field); !pattern.empty()) {
      if (const auto word = unknown_placeholder(pattern)) {
        throw InputError(placeholder_error(table.where(), *word));
      }
      patterns.push_back(folder / pattern);
    }
  }
  return patterns.empty() ? defaults : patterns;
}

double read_fps(const TabTable& table, double otherwise) {
  const std::string_view field = table.field(fps);
  if (field.empty()) {
    return otherwise;
  }
  const std::optional<double> number = parse_number(field);
  if (!number) {
    throw InputError({.where = table.where(),
                      .what = "fps is not a number",
                      .expected = "1 to 1000",
                      .got = quoted(field)});
  }
  return *number;
}

void check_row(const ManifestRow& row, const std::string& where) {
  if (row.options.outputs.empty()) {
    throw InputError({.where = where,
                      .what = "the row has no output",
                      .remedy = "Name files in the column outputs, or some for every row with "
                                "--output, such as --output 'out/{id}.csv'."});
  }
  try {
    check_synth_options(row.options);
  } catch (const UsageError& error) {
    ErrorDetails details = error.details();
    details.where = details.where.empty() ? where : where + ": " + details.where;
    throw InputError(std::move(details));
  }
}

ManifestRow read_row(const TabTable& table, const fs::path& folder, const SynthOptions& defaults) {
  ManifestRow row{.line = table.line(), .id = std::string(table.field(id)), .options = defaults};
  SynthOptions& options = row.options;
  const auto set_name = [&](Column column, std::string& name) {
    if (const std::string_view field = table.field(column); !field.empty()) {
      name = field;
    }
  };
  const auto set_path = [&](Column column, fs::path& path) {
    if (const std::string_view field = table.field(column); !field.empty()) {
      path = folder / field;
    }
  };
  set_path(transcript, options.transcript);
  if (row.id.empty()) {
    row.id = options.transcript.stem().string();
  }
  set_name(speaker, options.speaker);
  set_name(phoneme_set, options.phoneme_set);
  if (const std::string_view set = table.field(phoneme_set); set.ends_with(".json")) {
    options.phoneme_set = (folder / set).string();
  }
  set_name(tier, options.tier);
  set_name(emotion, options.emotion);
  set_path(emotions, options.emotions);
  set_path(constraints, options.constraints);
  set_path(weights, options.weights);
  set_path(audio, options.audio);
  set_path(face, options.face);
  options.fps = read_fps(table, defaults.fps);
  options.outputs = read_outputs(table, folder, defaults.outputs);
  for (fs::path& output : options.outputs) {
    output = with_id(output.string(), row.id);
  }
  add_retimed_transcript(options);
  check_row(row, table.where());
  return row;
}

// Paths as places on disk: two names of one file are one place. A folder is looked up once.
class Places {
public:
  fs::path of(const fs::path& path) {
    const auto [known, is_new] = folders_.try_emplace(path.parent_path());
    if (is_new) {
      const fs::path folder = fs::absolute(path.parent_path() / ".");
      std::error_code error;
      known->second = fs::weakly_canonical(folder, error);
      if (error) {
        known->second = folder;
      }
    }
    return known->second / path.filename();
  }

private:
  std::map<fs::path, fs::path> folders_;
};

void check_ids(const std::vector<ManifestRow>& rows, const std::string& where) {
  std::map<std::string, long> first_line;
  for (const ManifestRow& row : rows) {
    const auto [first, is_new] = first_line.emplace(row.id, row.line);
    if (!is_new) {
      throw InputError({.where = at_line(where, row.line),
                        .what = fmt::format("id {} is there twice, first at line {}",
                                            quoted(row.id), first->second),
                        .remedy = "Give each row an id of its own in the column id; a row without "
                                  "one is called by its transcript's name."});
    }
  }
}

void check_outputs(const std::vector<ManifestRow>& rows, const fs::path& manifest) {
  Places places;
  std::map<fs::path, const ManifestRow*> writer;
  for (const ManifestRow& row : rows) {
    for (const fs::path& output : row.options.outputs) {
      const auto [first, is_new] = writer.emplace(places.of(output), &row);
      if (!is_new) {
        throw InputError({.where = at_line(manifest.string(), row.line),
                          .what = fmt::format("output {} is written by line {} too",
                                              output.string(), first->second->line),
                          .remedy = "Give each row outputs of its own."});
      }
    }
  }
  const auto check_read = [&](const fs::path& path, const ManifestRow& reader) {
    const auto written = path.empty() ? writer.end() : writer.find(places.of(path));
    if (written != writer.end()) {
      throw InputError(
          {.where = at_line(manifest.string(), written->second->line),
           .what = fmt::format("output {} is read too, for line {}", path.string(), reader.line),
           .remedy = "Name outputs that are no inputs."});
    }
  };
  for (const ManifestRow& row : rows) {
    const SynthOptions& read = row.options;
    for (const fs::path& path :
         {manifest, read.database, read.transcript, read.emotions, read.constraints, read.weights,
          read.audio, read.face, fs::path(read.phoneme_set)}) {
      check_read(path, row);
    }
  }
}

} // namespace

std::vector<ManifestRow> parse_manifest(std::string_view text, const fs::path& path,
                                        const SynthOptions& defaults) {
  check_defaults(defaults);
  TabTable table(text, path.string(), kColumns, kRequired);
  std::vector<ManifestRow> rows;
  while (table.next()) {
    rows.push_back(read_row(table, path.parent_path(), defaults));
  }
  if (rows.empty()) {
    throw InputError({.where = path.string(), .what = "the manifest has no rows"});
  }
  check_ids(rows, path.string());
  check_outputs(rows, path);
  return rows;
}

} // namespace phonomime
