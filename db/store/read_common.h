// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/connection.h"
#include "db/types/layout.h"
#include "db/types/motion.h"
#include "db/types/phoneme_set.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

// Reads that several verbs share. All throw SQLite::Exception, and InputError where the content is
// not what the schema promises.
namespace phonomime::store {

struct Settings {
  double rate_hz = 0.0;
  Layout layout;
};
// Nothing in a database into which nothing was imported.
std::optional<Settings> read_settings(const Connection& connection);

// Throws InputError where nothing was imported yet.
Settings require_settings(const Connection& connection);

std::optional<PcaModel> read_pca(const Connection& connection, int channel_count);

struct StoredPhoneme {
  std::int64_t id = 0;
  Phoneme phoneme;
};
// Silence first, then by name.
std::vector<StoredPhoneme> read_phonemes(const Connection& connection);

struct NamedRow {
  std::int64_t id = 0;
  std::string name;
};
// A table with names ("speakers", "sentences"), by name.
std::vector<NamedRow> read_names(const Connection& connection, const char* table);

std::vector<std::string> names_of(const std::vector<NamedRow>& rows);

// float64[count] of one column. Throws InputError for another length and for NaN.
Eigen::VectorXd read_vector(const Connection& connection, const SQLite::Column& column,
                            Eigen::Index count, const char* what);

// float32[frames][columns] of one column. Throws InputError for another length and for NaN.
FrameMatrix read_frames(const Connection& connection, const SQLite::Column& column,
                        Eigen::Index frames, Eigen::Index columns);

const char* visibility_name(Visibility visibility);

} // namespace phonomime::store
