// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/batch.h"

#include "db/store/motion_database.h"
#include "db/types/file_io.h"
#include "tools/app/batch_record.h"
#include "tools/app/borrowed_style.h"
#include "tools/app/fingerprint.h"
#include "tools/app/manifest.h"
#include "tools/app/synth_stock.h"
#include "tools/app/workers.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <tuple>

namespace phonomime {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// One speaker's recordings.
struct Recordings {
  Recordings(MotionTable table, const std::filesystem::path& database)
      : stock(std::move(table), database) {
    table_fingerprint = fingerprint(stock.table()) + style_models_fingerprint(database);
  }
  SynthStock stock;
  std::string table_fingerprint;
};

// A row on its way.
struct Job {
  SynthOptions options;
  Recordings* recordings = nullptr;
  std::string fingerprint;
  BatchRow* row = nullptr;
};

// Tells from several threads how many rows are done with.
class RowProgress {
public:
  RowProgress(const Progress& progress, const char* stage, std::size_t total)
      : progress_(progress), stage_(stage), total_(static_cast<std::int64_t>(total)) {}

  void next() {
    const std::scoped_lock lock(mutex_);
    ++done_;
    if (progress_.report) {
      progress_.report(stage_, done_, total_);
    }
  }

private:
  const Progress& progress_;
  const char* stage_;
  std::int64_t total_;
  std::int64_t done_ = 0;
  std::mutex mutex_;
};

// Runs one step of a row; what it throws becomes the row's failure.
template <typename Step>
void attempt(BatchRow& row, const Step& step) {
  const auto fail = [&](ErrorClass error_class, std::string what) {
    row.status = RowStatus::failed;
    row.error_class = error_class;
    row.error = std::move(what);
  };
  const Clock::time_point begin = Clock::now();
  try {
    step();
  } catch (const Interrupted&) {
    row.status = RowStatus::stopped;
  } catch (const Error& error) {
    fail(error.error_class(), error.what());
  } catch (const std::bad_alloc&) {
    fail(ErrorClass::internal, "there is not enough memory for this");
  } catch (const std::exception& error) {
    fail(ErrorClass::internal, std::string("internal error: ") + error.what());
  }
  row.seconds += seconds_since(begin);
}

// The recordings of every speaker that a row asks for.
std::map<std::string, Recordings> load_recordings(const BatchOptions& options,
                                                  const std::vector<ManifestRow>& rows) {
  const MotionDatabase database = MotionDatabase::open(options.synth.database, OpenMode::read_only);
  std::map<std::string, Recordings> recordings;
  for (const ManifestRow& row : rows) {
    const std::string& speaker = row.options.speaker;
    if (recordings.contains(speaker)) {
      continue;
    }
    try {
      recordings.try_emplace(speaker, database.load_motion_table(speaker), options.synth.database);
    } catch (const InputError& error) {
      if (speaker == options.synth.speaker) {
        throw;
      }
      throw InputError(
          {.where = at_line(options.manifest.string(), row.line), .what = error.what()});
    }
  }
  return recordings;
}

std::vector<ManifestRow> rows_of_shard(std::vector<ManifestRow> rows, const Shard& shard) {
  std::vector<ManifestRow> chosen;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (shard.holds(i)) {
      chosen.push_back(std::move(rows[i]));
    }
  }
  return chosen;
}

// Fingerprints the rows and marks those that need no work.
void find_done(std::vector<Job>& jobs, const BatchOptions& options, const Progress& progress) {
  FileFingerprints files;
  RowProgress shown(progress, "looking for what is done", jobs.size());
  share_out(jobs.size(), worker_count(options.synth.threads), progress.stop,
            [&](std::size_t, std::size_t i) {
              Job& job = jobs[i];
              attempt(*job.row, [&] {
                job.fingerprint =
                    fingerprint(job.options, job.recordings->table_fingerprint, files);
                if (!options.redo && is_done(job.options.outputs, job.fingerprint)) {
                  job.row->status = RowStatus::skipped;
                }
              });
              shown.next();
            });
}

// Rows with the same recordings and weights one after the other, so that a worker's search can
// stay.
bool comes_before(const Job& a, const Job& b) {
  return std::tie(a.options.speaker, a.options.weights) <
         std::tie(b.options.speaker, b.options.weights);
}

void do_jobs(std::vector<Job>& jobs, const BatchOptions& options, const Progress& progress) {
  const std::size_t threads = worker_count(options.synth.threads);
  const std::size_t workers = std::clamp<std::size_t>(jobs.size(), 1, threads);
  std::vector<SearchKeeper> keepers(workers);
  RowProgress shown(progress, "synthesising", jobs.size());
  share_out(jobs.size(), workers, progress.stop, [&](std::size_t worker, std::size_t i) {
    Job& job = jobs[i];
    // A search of its own for each row; threads that would be left over share in the searches.
    job.options.threads = static_cast<int>(threads / workers);
    attempt(*job.row, [&] {
      SynthReport report = run_synth(job.options, job.recordings->stock, keepers[worker],
                                     {.report = {}, .stop = progress.stop});
      write_record(job.options.outputs, job.fingerprint);
      job.row->warnings = std::move(report.warnings);
      job.row->status = RowStatus::done;
    });
    shown.next();
  });
}

void remove_unfinished_of(const std::vector<Job>& jobs) {
  std::vector<std::filesystem::path> written;
  for (const Job& job : jobs) {
    written.insert(written.end(), job.options.outputs.begin(), job.options.outputs.end());
    written.push_back(record_path(job.options.outputs));
  }
  remove_unfinished(written);
}

} // namespace

std::size_t BatchReport::count(RowStatus status) const {
  return static_cast<std::size_t>(std::ranges::count(rows, status, &BatchRow::status));
}

ErrorClass BatchReport::worst_error() const {
  ErrorClass worst = ErrorClass::usage;
  for (const BatchRow& row : rows) {
    if (row.status == RowStatus::failed) {
      worst = std::max(worst, row.error_class);
    }
  }
  return worst;
}

BatchReport run_batch(const BatchOptions& options, const Progress& progress) {
  const Clock::time_point begin = Clock::now();
  BatchReport report;
  const std::vector<ManifestRow> rows = rows_of_shard(
      parse_manifest(read_file(options.manifest), options.manifest, options.synth), options.shard);
  std::map<std::string, Recordings> recordings = load_recordings(options, rows);
  std::vector<Job> jobs;
  report.rows.reserve(rows.size());
  for (const ManifestRow& row : rows) {
    report.rows.push_back({.line = row.line, .id = row.id, .outputs = row.options.outputs});
    jobs.push_back({.options = row.options,
                    .recordings = &recordings.at(row.options.speaker),
                    .row = &report.rows.back()});
    jobs.back().options.make_folders = true;
  }
  remove_unfinished_of(jobs);
  find_done(jobs, options, progress);
  std::erase_if(jobs, [](const Job& job) { return job.row->status != RowStatus::stopped; });
  std::ranges::stable_sort(jobs, comes_before);
  do_jobs(jobs, options, progress);
  report.seconds = seconds_since(begin);
  return report;
}

} // namespace phonomime
