// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/motion_database.h"

#include "db/store/database_impl.h"
#include "db/store/schema.h"

namespace phonomime {

MotionDatabase::MotionDatabase(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MotionDatabase::MotionDatabase(MotionDatabase&&) noexcept = default;
MotionDatabase& MotionDatabase::operator=(MotionDatabase&&) noexcept = default;
MotionDatabase::~MotionDatabase() = default;

MotionDatabase MotionDatabase::open(const std::filesystem::path& path, OpenMode mode) {
  auto impl = std::make_unique<Impl>();
  impl->connection = store::Connection::open(path, mode, store::built_in_migrations());
  return MotionDatabase(std::move(impl));
}

} // namespace phonomime
