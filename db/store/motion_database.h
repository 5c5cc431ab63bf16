// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/store/curation.h"
#include "db/store/phoneme_maps.h"
#include "db/store/style_models.h"
#include "db/types/imported_sentence.h"
#include "db/types/layout.h"
#include "db/types/motion_table.h"
#include "db/types/node_marks.h"
#include "db/types/progress.h"
#include "db/types/stored_sentence.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace phonomime {

enum class OpenMode {
  read_only, // also from read-only media (opened immutable there)
  read_write // an existing database or, where the file does not exist or is empty, a new one
};

// One speaker of a database.
struct SpeakerRecord {
  std::string name;
  Eigen::VectorXd reference_pose; // #channels, mm in the layout's axes or weights
};

// One corpus that went into a database.
struct CorpusRecord {
  std::string name;
  std::string phoneme_set;
  bool synthetic = false;
  std::string imported_at;    // UTC, ISO 8601; empty on commit: now, or $SOURCE_DATE_EPOCH
  std::int64_t sentences = 0; // counted when read
  std::string report_json;    // the import report, as JSON
};

// What `info` tells.
struct DatabaseInfo {
  std::filesystem::path path;
  int schema_version = 0;
  double rate_hz = 0.0;
  Layout layout;
  PcaModel pca;
  std::vector<CorpusRecord> corpora;
  std::vector<std::string> speakers;
  std::vector<std::string> emotions;
  std::int64_t sentences = 0, frames = 0, nodes = 0, pruned = 0, suspect = 0, with_gaps = 0;
  struct Count {
    std::string name;
    std::int64_t count = 0;
  };
  std::vector<Count> nodes_per_phoneme, nodes_per_emotion;
  std::int64_t triphones = 0; // different ones
};

// Which nodes `nodes` lists; empty members do not filter.
struct NodeFilter {
  std::string phoneme, emotion, speaker, sentence;
  std::string previous_phoneme, next_phoneme; // triphone context
  std::optional<bool> suspect, pruned, has_gap;
};

struct NodeRecord {
  std::string key;
  std::string phoneme, viseme, emotion, speaker, sentence, previous_phoneme, next_phoneme;
  double start_s = 0.0, end_s = 0.0; // in its sentence
  std::int64_t first_frame = 0;      // into its sentence's frames
  std::int32_t frame_count = 0;
  bool pruned = false, has_gap = false;
  std::string pruned_reason;
  std::vector<SuspectMark> suspect; // by reason
};

class ImportTransaction;

// The SQLite motion database (DESIGN 3). Movable, one thread at a time. Its file is alone and whole
// whenever no import is open; a new file is removed again where no import was committed to it.
class MotionDatabase {
public:
  // Throws InputError (not a Phonomime database, of a future version, damaged) and IoError.
  static MotionDatabase open(const std::filesystem::path& path, OpenMode mode);
  MotionDatabase(MotionDatabase&&) noexcept;
  MotionDatabase& operator=(MotionDatabase&&) noexcept;
  ~MotionDatabase();

  bool empty() const; // no corpus in it yet
  DatabaseInfo info() const;
  // In order of key. Throws InputError for a name in the filter that the database does not know,
  // with the nearest ones.
  std::vector<NodeRecord> list_nodes(const NodeFilter& filter) const;
  std::vector<std::string> speakers() const;

  // Everything a search needs of one speaker; `speaker` may be empty where there is only one.
  // Pruned nodes and nodes with gaps are left out (MotionTable::unavailable) and links across them
  // are gone. Throws InputError (no such speaker, several and none named: lists them).
  MotionTable load_motion_table(const std::string& speaker) const;

  // One sentence's stored channels (#frames by #channels) and head poses.
  FrameMatrix load_channels(const SentenceInfo& sentence) const;
  std::vector<HeadPose> load_head(const SentenceInfo& sentence) const;

  // The phoneme-Isomaps that are stored for a speaker, by phoneme, fresh or stale; one of them,
  // nothing where there is none. Throw InputError (damaged).
  std::vector<StoredMapRecord> list_maps(const std::string& speaker) const;
  std::optional<StoredMap> load_map(const std::string& speaker, const std::string& phoneme) const;

  // Stores a phoneme's maps in the place of those that there were, in a transaction of its own
  // (read_write only). Throws InternalError for parts that do not fit each other, IoError.
  void save_map(const StoredMap& map);

  // The style models that are stored for a speaker, fresh or stale; nothing where there are none.
  // Throws InputError (damaged).
  std::optional<StoredStyleModel> load_style_model(const std::string& speaker) const;

  // Stores a speaker's style models in the place of those that there were, in a transaction of its
  // own (read_write only). Throws InternalError for numbers that are not finite, IoError.
  void save_style_model(const StoredStyleModel& model);

  // Every sentence with its channels, in order of (speaker, emotion, id): what suspects are judged
  // by. Throws InputError (damaged).
  void for_each_stored_sentence(const std::function<void(const StoredSentence&)>& visit) const;

  // Puts the marks that `judge` finds in the place of all that the channels showed before, those of
  // the recordings stay; in one transaction, begun before it is called. Throws IoError (read-only,
  // locked); a failure of `judge` changes nothing.
  void
  replace_channel_suspects(const std::function<std::vector<NodeMarks>(MotionDatabase&)>& judge);

  // Prunes, restores or undoes, and writes it into the journal, all in one transaction (read_write
  // only). The PCA stays as it is. Throws InputError (a key that is unknown or ambiguous, nothing
  // to undo) and IoError (locked, read-only); then nothing is changed.
  CurationOutcome curate(const CurationRequest& request);

  // Every prune, restore and undo, the first one first.
  std::vector<JournalEntry> journal() const;

  // Starts the one transaction in which a corpus goes in (read_write only). The layout and the rate
  // must be the database's own where it holds a corpus already: InputError.
  ImportTransaction begin_import(const Layout& layout, double rate_hz);

private:
  friend class ImportTransaction;
  struct Impl;
  explicit MotionDatabase(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// Rolled back unless committed. Everything in it becomes visible at once or never.
class ImportTransaction {
public:
  ImportTransaction(ImportTransaction&&) noexcept;
  ~ImportTransaction();

  // The speaker's reference pose where an earlier corpus has set it.
  std::optional<Eigen::VectorXd> reference_pose(const std::string& speaker) const;
  void set_reference_pose(const std::string& speaker, const Eigen::VectorXd& pose);

  // The phonemes of the corpus' set, /pau/ among them, before the first sentence. Throws InputError
  // where the database knows one with another viseme or visibility.
  void add_phonemes(const std::vector<Phoneme>& phonemes);

  bool has_sentence(const std::string& speaker, const std::string& emotion,
                    const std::string& id) const;

  // Throws InputError for a repeated (speaker, emotion, id), InternalError for a sentence whose
  // parts do not fit each other, the layout or the phonemes that were added.
  void add_sentence(const ImportedSentence& sentence);

  // Channels of every sentence in the database (#frames by #channels) with its frame_has_gap, those
  // of earlier corpora too, in order of (speaker, emotion, id): what the PCA is fitted to.
  void for_each_sentence(
      const std::function<void(const FrameMatrix& channels,
                               const std::vector<std::uint8_t>& frame_has_gap)>& visit) const;

  // As MotionDatabase::for_each_stored_sentence, those of earlier corpora too.
  void for_each_stored_sentence(const std::function<void(const StoredSentence&)>& visit) const;

  // Puts these marks in the place of all that the channels of any corpus showed before; those of
  // the recordings stay. After the last sentence.
  void set_channel_suspects(const std::vector<NodeMarks>& marks);

  // How many of this import's nodes are marked, by reason.
  std::map<std::string, std::int64_t> count_suspects() const;

  // Stores the model and, for every sentence, its coefficients (float), computed in blocks by
  // several threads. After the last sentence. Throws Interrupted.
  void set_pca(const PcaModel& pca, const Progress& progress);

  // Records the corpus and commits. Throws InputError where no sentence was added, InternalError
  // where the PCA or a speaker's reference pose is missing, IoError (then nothing is changed).
  void commit(const CorpusRecord& corpus);

private:
  friend class MotionDatabase;
  struct Impl;
  explicit ImportTransaction(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

} // namespace phonomime
