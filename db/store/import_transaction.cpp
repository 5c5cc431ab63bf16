// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/blobs.h"
#include "db/store/database_impl.h"
#include "db/store/import_state.h"
#include "db/store/insert_sentence.h"
#include "db/store/refit.h"
#include "db/store/store_error.h"
#include "db/store/suspects.h"
#include "db/store/timestamp.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <cmath>

namespace phonomime {

using store::translated;

struct ImportTransaction::Impl {
  Impl(const std::shared_ptr<store::Connection>& connection, const Layout& layout, double rate_hz)
      : state(connection, layout, rate_hz) {}
  store::ImportState state;

  // Throws InternalError after commit.
  store::ImportState& open() {
    if (!state.transaction) {
      throw InternalError(
          {.where = state.connection->where(), .what = "the import is committed already"});
    }
    return state;
  }
  const std::string& where() const { return state.connection->where(); }
};

ImportTransaction::ImportTransaction(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ImportTransaction::ImportTransaction(ImportTransaction&&) noexcept = default;
ImportTransaction::~ImportTransaction() = default;

ImportTransaction MotionDatabase::begin_import(const Layout& layout, double rate_hz) {
  const std::shared_ptr<store::Connection>& connection = impl_->connection;
  if (!connection->writable()) {
    throw InternalError(
        {.where = connection->where(), .what = "an import into a database opened for reading"});
  }
  if (!std::isfinite(rate_hz) || rate_hz <= 0.0) {
    throw InternalError({.where = connection->where(),
                         .what = "an import without a frame rate",
                         .got = fmt::format("{} Hz", rate_hz)});
  }
  return translated(connection->where(), [&] {
    return ImportTransaction(
        std::make_unique<ImportTransaction::Impl>(connection, layout, rate_hz));
  });
}

std::optional<Eigen::VectorXd> ImportTransaction::reference_pose(const std::string& speaker) const {
  return translated(impl_->where(), [&]() -> std::optional<Eigen::VectorXd> {
    const store::ImportState& import = impl_->open();
    SQLite::Statement select(import.connection->database(),
                             "SELECT reference_pose FROM speakers WHERE name = ?");
    select.bind(1, speaker);
    if (!select.executeStep() || select.isColumnNull(0)) {
      return std::nullopt;
    }
    return store::read_vector(*import.connection, select.getColumn(0),
                              import.layout.channel_count(), "a speaker's reference pose");
  });
}

void ImportTransaction::set_reference_pose(const std::string& speaker,
                                           const Eigen::VectorXd& pose) {
  translated(impl_->where(), [&] {
    store::ImportState& import = impl_->open();
    if (pose.size() != import.layout.channel_count() || !pose.allFinite()) {
      throw InternalError({.where = impl_->where(),
                           .what = "a reference pose that does not have the layout's channels"});
    }
    SQLite::Statement update(import.connection->database(),
                             "UPDATE speakers SET reference_pose = ? WHERE id = ?");
    store::bind_numbers(update, 1, std::span(pose.data(), static_cast<std::size_t>(pose.size())));
    update.bind(2, import.speaker_id(speaker));
    update.exec();
  });
}

void ImportTransaction::add_phonemes(const std::vector<Phoneme>& phonemes) {
  translated(impl_->where(), [&] {
    for (const Phoneme& phoneme : phonemes) {
      impl_->open().add_phoneme(phoneme);
    }
  });
}

bool ImportTransaction::has_sentence(const std::string& speaker, const std::string& emotion,
                                     const std::string& id) const {
  return translated(impl_->where(),
                    [&] { return impl_->open().find_sentence(speaker, emotion, id).has_value(); });
}

void ImportTransaction::add_sentence(const ImportedSentence& sentence) {
  translated(impl_->where(), [&] { store::insert_sentence(impl_->open(), sentence); });
}

void ImportTransaction::for_each_sentence(
    const std::function<void(const FrameMatrix&, const std::vector<std::uint8_t>&)>& visit) const {
  translated(impl_->where(), [&] {
    const store::ImportState& import = impl_->open();
    store::ChannelReader reader(*import.connection, import.layout.channel_count());
    for (const std::int64_t id : import.sentence_ids()) {
      const FrameMatrix channels = reader.read(id);
      visit(channels, reader.frame_has_gap(channels.rows()));
    }
  });
}

void ImportTransaction::for_each_stored_sentence(
    const std::function<void(const StoredSentence&)>& visit) const {
  translated(impl_->where(), [&] {
    const store::ImportState& import = impl_->open();
    store::for_each_stored_sentence(*import.connection, import.layout, visit);
  });
}

void ImportTransaction::set_channel_suspects(const std::vector<NodeMarks>& marks) {
  translated(impl_->where(),
             [&] { store::replace_channel_suspects(*impl_->open().connection, marks); });
}

std::map<std::string, std::int64_t> ImportTransaction::count_suspects() const {
  return translated(impl_->where(), [&] {
    const store::ImportState& import = impl_->open();
    SQLite::Statement select(import.connection->database(),
                             "SELECT u.reason, count(*) FROM suspects u JOIN sentences s "
                             "ON s.id = u.sentence_id WHERE s.corpus_id = ? GROUP BY u.reason");
    select.bind(1, import.corpus_id);
    std::map<std::string, std::int64_t> counts;
    while (select.executeStep()) {
      counts[select.getColumn(0).getString()] = select.getColumn(1).getInt64();
    }
    return counts;
  });
}

void ImportTransaction::set_pca(const PcaModel& pca, const Progress& progress) {
  translated(impl_->where(), [&] { store::refit(impl_->open(), pca, progress); });
}

void ImportTransaction::commit(const CorpusRecord& corpus) {
  translated(impl_->where(), [&] {
    store::ImportState& import = impl_->open();
    if (import.added_sentences == 0) {
      throw InputError({.where = corpus.name,
                        .what = "no sentence of this corpus could be taken in",
                        .remedy = "See the import's report for the reasons."});
    }
    import.check_complete();
    SQLite::Statement insert(import.connection->database(),
                             "INSERT INTO corpora (id, name, phoneme_set, synthetic, imported_at, "
                             "report_json) VALUES (?, ?, ?, ?, ?, ?)");
    insert.bind(1, import.corpus_id);
    insert.bind(2, corpus.name);
    insert.bind(3, corpus.phoneme_set);
    insert.bind(4, corpus.synthetic ? 1 : 0);
    insert.bind(5, corpus.imported_at.empty() ? store::timestamp() : corpus.imported_at);
    insert.bind(6, corpus.report_json);
    insert.exec();
    import.connection->check_space_for_checkpoint();
    import.transaction->commit();
    import.transaction.reset();
  });
  impl_->state.connection->checkpoint();
  impl_->state.end_writing.reset();
}

} // namespace phonomime
