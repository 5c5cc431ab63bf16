// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/held_out.h"

#include "db/import/prepare.h"
#include "db/store/motion_database.h"
#include "db/types/errors.h"
#include "db/types/text.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phonomime {

namespace {

void check_layout(const std::filesystem::path& path, const MotionDatabase& database,
                  const Corpus& corpus) {
  const Layout known = database.info().layout;
  Layout offered = corpus.layout;
  offered.scale = known.scale; // recordings are brought to the database's
  if (format_layout(known) != format_layout(offered)) {
    throw InputError({.where = corpus.folder.string(),
                      .what = "the corpus' layout is not that of the database " + path.string(),
                      .remedy = "Evaluate with recordings of the same markers or weights."});
  }
}

std::map<std::string, MotionTable> load_tables(const std::filesystem::path& path,
                                               const MotionDatabase& database,
                                               const Corpus& corpus) {
  const std::vector<std::string> speakers = database.speakers();
  std::map<std::string, MotionTable> tables;
  for (const CorpusSentence& sentence : corpus.sentences) {
    if (tables.contains(sentence.speaker)) {
      continue;
    }
    if (std::ranges::find(speakers, sentence.speaker) == speakers.end()) {
      throw InputError({.where = sentence.where,
                        .what = fmt::format("there are no recordings of speaker {} to speak {} "
                                            "with",
                                            quoted(sentence.speaker), quoted(sentence.id)),
                        .expected = fmt::format("one of {}", fmt::join(speakers, ", ")),
                        .got = path.string()});
    }
    tables.emplace(sentence.speaker, database.load_motion_table(sentence.speaker));
  }
  return tables;
}

} // namespace

HeldOut read_held_out(const std::filesystem::path& path, const Corpus& corpus,
                      const RecordingOptions& options, const Progress& progress) {
  const MotionDatabase database = MotionDatabase::open(path, OpenMode::read_only);
  check_layout(path, database, corpus);
  HeldOut held_out;
  held_out.tables = load_tables(path, database, corpus);
  KnownHeads heads;
  for (const auto& [speaker, table] : held_out.tables) {
    heads.references[speaker] = table.reference_pose;
    heads.scale = table.layout.scale.value_or(Scale::measured);
  }
  const Survey survey = survey_corpus(corpus, options, heads, progress);
  for (const Rejection& rejection : survey.rejections) {
    held_out.notes.push_back(rejection.reason);
  }
  const PrepareContext context{.corpus = corpus,
                               .survey = survey,
                               .options = options,
                               .rate_hz = held_out.tables.begin()->second.rate_hz};
  const auto take = [&](std::vector<PreparedRecording>& some) {
    for (PreparedRecording& recording : some) {
      for (const Rejection& rejection : recording.rejections) {
        held_out.notes.push_back(rejection.reason);
      }
      for (PreparedSentence& sentence : recording.sentences) {
        held_out.sentences.push_back(std::move(sentence.sentence));
      }
    }
  };
  prepare_recordings(context, progress, "reading held-out sentences", take);
  std::ranges::sort(held_out.sentences, {}, [](const ImportedSentence& sentence) {
    return std::tie(sentence.speaker, sentence.emotion, sentence.id);
  });
  return held_out;
}

HeldOut hold_out(const ImportOptions& options, const SentenceFilter& held_out,
                 const SentenceFilter& spoken, const std::filesystem::path& database,
                 const Progress& progress) {
  ImportOptions training = options;
  training.database = database;
  training.takes = [&](const CorpusSentence& sentence) { return !held_out(sentence); };
  import_corpus(training, progress);
  Corpus corpus = read_corpus(options.corpus);
  keep_sentences(corpus, [&](const CorpusSentence& sentence) {
    return held_out(sentence) && spoken(sentence);
  });
  return read_held_out(database, corpus, options.recordings, progress);
}

} // namespace phonomime
