// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/import_state.h"
#include "db/types/progress.h"

#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <vector>

namespace phonomime::store {

// Reads sentences back while the import is open.
class ChannelReader {
public:
  ChannelReader(const Connection& connection, int channel_count);

  // #frames by #channels
  FrameMatrix read(std::int64_t sentence_id);

  // Of the sentence read last, which has `frames` frames.
  std::vector<std::uint8_t> frame_has_gap(Eigen::Index frames) const;

private:
  const Connection& connection_;
  int channel_count_;
  SQLite::Statement select_;
};

// As ImportTransaction::set_pca; also throws SQLite::Exception.
void refit(const ImportState& import, const PcaModel& pca, const Progress& progress);

} // namespace phonomime::store
