// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/motion_database.h"
#include "tests/bench/compare.h"
#include "tests/db/store/made_corpus.h"
#include "tests/support/temporary_folder.h"

#include <filesystem>
#include <string>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <benchmark/benchmark.h>

namespace phonomime {
namespace {

constexpr int kMarkers = 91;
constexpr int kDimensions = 25;

test::MadeCorpus face_like_corpus() {
  test::MadeCorpus corpus = test::made_corpus("a", 40, kMarkers, 300);
  corpus.dimensions = kDimensions;
  return corpus;
}

std::uintmax_t import_ours(const std::filesystem::path& path, const test::MadeCorpus& corpus) {
  std::filesystem::remove(path);
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  test::import_corpus(database, corpus);
  return std::filesystem::file_size(path);
}

// A row a frame, coefficients frame by frame; no alignments, nodes or head poses, nothing checked.
std::uintmax_t import_plainly(const std::filesystem::path& path, const test::MadeCorpus& corpus) {
  std::filesystem::remove(path);
  SQLite::Database database(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database.exec("CREATE TABLE frames (emotion TEXT, id TEXT, frame INTEGER, channels BLOB, "
                "coefficients BLOB, PRIMARY KEY (emotion, id, frame))");
  SQLite::Transaction transaction(database);
  SQLite::Statement insert(database, "INSERT INTO frames VALUES (?, ?, ?, ?, ?)");
  const PcaModel pca = test::made_pca(3 * kMarkers, kDimensions, corpus.pca_seed);
  for (const ImportedSentence& sentence : corpus.sentences) {
    for (Eigen::Index frame = 0; frame < sentence.channels.rows(); ++frame) {
      const Eigen::RowVectorXf channels = sentence.channels.row(frame);
      const Eigen::VectorXf coefficients =
          (pca.basis.transpose() * (channels.transpose().cast<double>() - pca.mean)).cast<float>();
      insert.bind(1, sentence.emotion);
      insert.bind(2, sentence.id);
      insert.bind(3, static_cast<std::int64_t>(frame));
      insert.bind(4, channels.data(), static_cast<int>(channels.size() * 4));
      insert.bind(5, coefficients.data(), static_cast<int>(coefficients.size() * 4));
      insert.exec();
      insert.reset();
    }
  }
  transaction.commit();
  return std::filesystem::file_size(path);
}

FrameMatrix read_ours(const std::filesystem::path& path) {
  return MotionDatabase::open(path, OpenMode::read_only).load_motion_table("s1").coefficients;
}

FrameMatrix read_plainly(const std::filesystem::path& path) {
  SQLite::Database database(path);
  const int count = database.execAndGet("SELECT count(*) FROM frames").getInt();
  SQLite::Statement select(database, "SELECT coefficients FROM frames ORDER BY emotion, id, frame");
  FrameMatrix coefficients(count, kDimensions);
  for (Eigen::Index frame = 0; select.executeStep(); ++frame) {
    coefficients.row(frame) = Eigen::Map<const Eigen::RowVectorXf>(
        static_cast<const float*>(select.getColumn(0).getBlob()), kDimensions);
  }
  return coefficients;
}

// Both databases with the same coefficients in them.
struct Databases {
  test::TemporaryFolder folder;
  test::MadeCorpus corpus = face_like_corpus();
  std::filesystem::path ours = folder / "ours.db";
  std::filesystem::path plain = folder / "plain.db";

  Databases() {
    import_ours(ours, corpus);
    import_plainly(plain, corpus);
    const FrameMatrix read = read_ours(ours);
    const FrameMatrix expected = read_plainly(plain);
    bench::verify(read.rows() == expected.rows() && read.cols() == expected.cols() &&
                      (read - expected).norm() < 1e-5f * expected.norm(),
                  "the coefficients are not those of the corpus");
  }
};

void import_against_a_row_a_frame(benchmark::State& state) {
  const Databases databases;
  bench::compare(
      state, [&] { return import_ours(databases.ours, databases.corpus); },
      [&] { return import_plainly(databases.plain, databases.corpus); });
}
BENCHMARK(import_against_a_row_a_frame)
    ->Iterations(5)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void motion_table_against_a_row_a_frame(benchmark::State& state) {
  const Databases databases;
  bench::compare(
      state, [&] { return read_ours(databases.ours).sum(); },
      [&] { return read_plainly(databases.plain).sum(); });
}
BENCHMARK(motion_table_against_a_row_a_frame)
    ->Iterations(20)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace phonomime
