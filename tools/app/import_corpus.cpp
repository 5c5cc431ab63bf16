// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/import_corpus.h"

#include "db/import/corpus.h"
#include "db/import/prepare.h"
#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "db/types/text.h"
#include "tools/app/find_suspects.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace {

constexpr double kLeastDefaultRate_hz = 100.0;
constexpr double kLeastRate_hz = 10.0;
constexpr double kMostRate_hz = 1000.0;
constexpr int kMostThreads = 256;

// What an existing database settles.
struct Settled {
  std::optional<Layout> layout;
  double rate_hz = 0.0; // 0: nothing yet
  KnownHeads heads;
  std::set<std::tuple<std::string, std::string, std::string>> sentences; // speaker, emotion, id
};

// Adds the time since the last call to the report's stages.
class Stopwatch {
public:
  void stop(std::vector<ImportReport::StageTime>& timings, std::string_view stage) {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    const auto found = std::ranges::find(timings, stage, &ImportReport::StageTime::stage);
    if (found == timings.end()) {
      timings.push_back({.stage = std::string(stage), .seconds = seconds});
    } else {
      found->seconds += seconds;
    }
  }

private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

Settled look_into(const std::filesystem::path& path) {
  Settled settled;
  std::error_code error;
  if (!std::filesystem::exists(path, error) || std::filesystem::file_size(path, error) == 0) {
    return settled;
  }
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  if (database.empty()) {
    return settled;
  }
  const DatabaseInfo info = database.info();
  settled.layout = info.layout;
  settled.rate_hz = info.rate_hz;
  if (info.layout.kind == LayoutKind::markers) {
    settled.heads.scale = info.layout.scale.value_or(Scale::measured);
  }
  for (const std::string& speaker : database.speakers()) {
    const MotionTable table = database.load_motion_table(speaker);
    settled.heads.references[speaker] = table.reference_pose;
    for (const SentenceInfo& sentence : table.sentences) {
      settled.sentences.insert({sentence.speaker, sentence.emotion, sentence.id});
    }
  }
  return settled;
}

double choose_rate(const ImportOptions& options, const Settled& settled, const Survey& survey) {
  if (settled.rate_hz > 0.0) {
    if (options.rate_hz > 0.0 && options.rate_hz != settled.rate_hz) {
      throw InputError({.where = options.database.string(),
                        .what = "the database has another rate",
                        .expected = format_number(settled.rate_hz) + " Hz",
                        .got = format_number(options.rate_hz) + " Hz",
                        .remedy = "Leave the rate out, or import into a new database."});
    }
    return settled.rate_hz;
  }
  if (options.rate_hz > 0.0) {
    return options.rate_hz;
  }
  if (survey.fastest_rate_hz > kMostRate_hz) {
    throw InputError({.where = options.corpus.string(),
                      .what = "a recording is faster than a database may be",
                      .expected = fmt::format("up to {} Hz", kMostRate_hz),
                      .got = format_number(survey.fastest_rate_hz) + " Hz",
                      .remedy = "Name a lower rate for the database."});
  }
  return std::max(kLeastDefaultRate_hz, survey.fastest_rate_hz);
}

// What every later corpus of the database goes by. One that does not say was made when every scale
// was taken as measured.
void settle_scale(Layout& layout, const Survey& survey, const Settled& settled) {
  const bool unsaid = settled.layout && !settled.layout->scale;
  if (layout.kind == LayoutKind::markers && !(unsaid && survey.scale == Scale::measured)) {
    layout.scale = survey.scale;
  } else {
    layout.scale.reset();
  }
}

void store_sentences(ImportTransaction& transaction, const PrepareContext& context,
                     ImportReport& report, Stopwatch& stopwatch, const Progress& progress) {
  prepare_recordings(context, progress, "importing", [&](std::vector<PreparedRecording>& some) {
    stopwatch.stop(report.timings, "prepare");
    for (const PreparedRecording& recording : some) {
      for (const PreparedSentence& sentence : recording.sentences) {
        transaction.add_sentence(sentence.sentence);
        add_to_report(report, context.corpus, sentence.account);
      }
      add_rejections(report, context.corpus, recording.rejections, recording.rejected_frames);
    }
    stopwatch.stop(report.timings, "store");
  });
}

PcaModel fit_to_database(const ImportTransaction& transaction, const ImportOptions& options,
                         Eigen::Index channel_count, ImportReport& report,
                         const Progress& progress) {
  CovarianceAccumulator accumulator(channel_count, options.recordings.threads);
  transaction.for_each_sentence(
      [&](const FrameMatrix& channels, const std::vector<std::uint8_t>& frame_has_gap) {
        if (progress.stop_requested()) {
          throw Interrupted();
        }
        accumulator.add(channels, frame_has_gap);
      });
  const FrameStatistics statistics = accumulator.finish();
  const PcaModel model = fit_pca(statistics, options.pca);
  report.pca_frames = statistics.frames;
  report.pca_left_out = statistics.left_out;
  report.pca_dimensions = static_cast<int>(model.dimension_count());
  report.pca_share = explained_share(model);
  return model;
}

// Speakers that the database knows keep their pose, which the survey went by.
void set_references(ImportTransaction& transaction, const Survey& survey,
                    const std::filesystem::path& database) {
  for (const auto& [speaker, reference] : survey.references) {
    const std::optional<Eigen::VectorXd> known = transaction.reference_pose(speaker);
    if (!known) {
      transaction.set_reference_pose(speaker, reference.pose);
    } else if (*known != reference.pose) {
      throw InputError({.where = database.string(),
                        .what = fmt::format("another import has given speaker {} a reference pose "
                                            "in the meantime",
                                            quoted(speaker)),
                        .remedy = "Import again."});
    }
  }
}

// Found before the database is opened for writing; what another import may add in the meantime the
// store refuses.
void check_new(const Settled& settled, const Corpus& corpus) {
  for (const CorpusSentence& sentence : corpus.sentences) {
    if (settled.sentences.contains({sentence.speaker, sentence.emotion, sentence.id})) {
      throw InputError({.where = sentence.where,
                        .what = fmt::format("sentence {}/{}/{} is in the database already",
                                            sentence.speaker, sentence.emotion, sentence.id),
                        .remedy = "Import into a new database, or take the sentence out."});
    }
  }
}

} // namespace

void ImportOptions::validate() const {
  const auto require = [](bool fits, const char* option, std::string expected, double got) {
    if (!fits) {
      throw UsageError({.where = option,
                        .what = "is out of range",
                        .expected = std::move(expected),
                        .got = format_number(got)});
    }
  };
  require(rate_hz == 0.0 || (rate_hz >= kLeastRate_hz && rate_hz <= kMostRate_hz), "--rate",
          fmt::format("{} to {} Hz", kLeastRate_hz, kMostRate_hz), rate_hz);
  require(pca.dimensions >= 1, "--dimensions", "at least 1", pca.dimensions);
  require(!pca.share || (*pca.share > 0.0 && *pca.share <= 1.0), "--share",
          "a share of the variance above 0 and up to 1", pca.share.value_or(0.0));
  require(recordings.gap_limit_s >= 0.0 && recordings.gap_limit_s <= 10.0, "--gap-limit",
          "0 to 10 s", recordings.gap_limit_s);
  require(recordings.tolerance_s >= 0.0 && recordings.tolerance_s <= 10.0, "--tolerance",
          "0 to 10 s", recordings.tolerance_s);
  require(recordings.threads >= 0 && recordings.threads <= kMostThreads, "--threads",
          fmt::format("0 (one for each core) to {}", kMostThreads), recordings.threads);
}

ImportReport import_corpus(const ImportOptions& options, const Progress& progress) {
  options.validate();
  Stopwatch stopwatch;
  Corpus corpus = read_corpus(options.corpus);
  keep_sentences(corpus, options.takes);
  const Settled settled = look_into(options.database);
  check_new(settled, corpus);
  const Survey survey = survey_corpus(corpus, options.recordings, settled.heads, progress);
  const double rate_hz = choose_rate(options, settled, survey);
  settle_scale(corpus.layout, survey, settled);
  ImportReport report = begin_report(corpus, survey, rate_hz);
  stopwatch.stop(report.timings, "survey");

  MotionDatabase database = MotionDatabase::open(options.database, OpenMode::read_write);
  ImportTransaction transaction = database.begin_import(corpus.layout, rate_hz);
  transaction.add_phonemes(corpus.phoneme_set.phonemes());
  set_references(transaction, survey, options.database);
  const PrepareContext context{
      .corpus = corpus, .survey = survey, .options = options.recordings, .rate_hz = rate_hz};
  store_sentences(transaction, context, report, stopwatch, progress);
  transaction.set_channel_suspects(
      find_suspects([&](const auto& visit) { transaction.for_each_stored_sentence(visit); },
                    corpus.layout, rate_hz, options.recordings.threads, progress));
  for (const auto& [reason, nodes] : transaction.count_suspects()) {
    report.suspects[reason] = nodes;
  }
  stopwatch.stop(report.timings, "suspects");
  progress.update("fitting", 0, 1);
  const PcaModel pca =
      fit_to_database(transaction, options, corpus.layout.channel_count(), report, progress);
  stopwatch.stop(report.timings, "pca");
  transaction.set_pca(pca, progress);
  stopwatch.stop(report.timings, "project");
  transaction.commit({.name = corpus.name,
                      .phoneme_set = corpus.phoneme_set.name(),
                      .synthetic = corpus.synthetic,
                      .imported_at = {},
                      .sentences = report.sentences_imported,
                      .report_json = report_to_json(report).dump()});
  stopwatch.stop(report.timings, "commit");
  return report;
}

} // namespace phonomime
