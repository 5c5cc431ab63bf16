// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/blobs.h"
#include "db/store/database_impl.h"
#include "db/store/read_common.h"
#include "db/store/store_error.h"
#include "db/types/parallel_for.h"
#include "db/types/text.h"
#include "db/types/vector_dispatch.h"
#include "db/types/vector_lanes.h"

#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <sys/mman.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>

namespace phonomime {
namespace {

using store::Connection;
using store::throw_damaged;

// Ids of the file onto indexes into the table's vectors.
using IndexOfId = std::unordered_map<std::int64_t, std::int32_t>;

std::int32_t at(const IndexOfId& index, std::int64_t id, const Connection& connection) {
  const auto found = index.find(id);
  if (found == index.end()) {
    throw_damaged(connection.where(), fmt::format("a reference to nothing (id {})", id));
  }
  return found->second;
}

store::NamedRow choose_speaker(const Connection& connection, const std::string& wanted) {
  const std::vector<store::NamedRow> speakers = store::read_names(connection, "speakers");
  const std::vector<std::string> names = store::names_of(speakers);
  if (wanted.empty() && speakers.size() == 1) {
    return speakers.front();
  }
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (!wanted.empty() && found != names.end()) {
    return speakers[static_cast<std::size_t>(found - names.begin())];
  }
  throw InputError(
      {.where = connection.where(),
       .what = wanted.empty() ? "the database holds several speakers"
                              : fmt::format("there is no speaker {}", quoted(wanted)),
       .expected = fmt::format("one of {}", fmt::join(names, ", ")),
       .remedy = wanted.empty() ? "Choose one with --speaker." : did_you_mean(wanted, names)});
}

PHONOMIME_DISPATCHED bool all_finite(const float* numbers, std::size_t count) {
  FloatLanes sums[4] = {}; // of zeros, unless one is no number
  std::size_t i = 0;
  for (; i + 4 * kFloatLanes <= count; i += 4 * kFloatLanes) {
    for (std::size_t part = 0; part < 4; ++part) {
      FloatLanes lanes;
      load(lanes, numbers + i + part * kFloatLanes);
      sums[part] += lanes * 0.0F;
    }
  }
  float sum = sum_of_lanes((sums[0] + sums[1]) + (sums[2] + sums[3]));
  for (; i < count; ++i) {
    sum += numbers[i] * 0.0F;
  }
  return sum == 0.0F;
}

// Memory that is about to be filled takes less time to fill so. No more than a hint.
void ask_for_large_pages([[maybe_unused]] std::span<float> numbers) {
#ifdef MADV_HUGEPAGE
  constexpr std::size_t kLargePage = std::size_t{2} << 20;
  void* begin = numbers.data();
  std::size_t bytes = numbers.size_bytes();
  if (std::align(kLargePage, kLargePage, begin, bytes) != nullptr) {
    madvise(begin, bytes / kLargePage * kLargePage, MADV_HUGEPAGE);
  }
#endif
}

constexpr int kMostParts = 4; // that are read side by side

// Fills a MotionTable within one read transaction.
class TableReader {
public:
  TableReader(const Connection& connection, MotionTable& table)
      : connection_(connection), table_(table) {}

  void read(const std::string& wanted_speaker) {
    store::Settings settings = store::require_settings(connection_);
    table_.layout = std::move(settings.layout);
    table_.rate_hz = settings.rate_hz;
    std::optional<PcaModel> pca = store::read_pca(connection_, table_.layout.channel_count());
    if (!pca) {
      throw_damaged(connection_.where(), "it has no PCA");
    }
    table_.pca = *std::move(pca);
    const store::NamedRow speaker = choose_speaker(connection_, wanted_speaker);
    table_.speaker = speaker.name;
    read_reference_pose(speaker.id);
    read_corpora(speaker.id);
    read_symbols();
    read_sentences(speaker.id);
    divide();
    read_nodes();
    link_captured_neighbours();
    read_coefficients();
  }

private:
  struct Sentence {
    std::int64_t id = 0;
    std::int64_t first_frame = 0; // into the rows of MotionTable::coefficients
    std::int64_t frame_count = 0;
  };

  void read_reference_pose(std::int64_t speaker_id) {
    SQLite::Statement statement(connection_.database(),
                                "SELECT reference_pose FROM speakers WHERE id = ?");
    statement.bind(1, speaker_id);
    statement.executeStep();
    table_.reference_pose =
        store::read_vector(connection_, statement.getColumn(0), table_.layout.channel_count(),
                           "the speaker's reference pose");
  }

  void read_corpora(std::int64_t speaker_id) {
    SQLite::Statement statement(
        connection_.database(),
        "SELECT phoneme_set, synthetic FROM corpora WHERE id IN "
        "(SELECT corpus_id FROM sentences WHERE speaker_id = ?) ORDER BY id");
    statement.bind(1, speaker_id);
    while (statement.executeStep()) {
      const std::string set = statement.getColumn(0).getString();
      if (std::find(table_.phoneme_sets.begin(), table_.phoneme_sets.end(), set) ==
          table_.phoneme_sets.end()) {
        table_.phoneme_sets.push_back(set);
      }
      table_.synthetic = table_.synthetic || statement.getColumn(1).getInt() != 0;
    }
  }

  void read_symbols() {
    std::map<std::string, std::int32_t> viseme_index;
    for (store::StoredPhoneme& stored : store::read_phonemes(connection_)) {
      const auto next = static_cast<std::int32_t>(table_.visemes.size());
      const auto [viseme, is_new] = viseme_index.try_emplace(stored.phoneme.viseme, next);
      if (is_new) {
        table_.visemes.push_back(stored.phoneme.viseme);
      }
      viseme_of_phoneme_.push_back(viseme->second);
      phoneme_index_[stored.id] = static_cast<std::int32_t>(table_.phonemes.size());
      table_.phonemes.push_back(std::move(stored.phoneme));
    }
    if (table_.phonemes.empty() || table_.phonemes.front().name != kSilence) {
      throw_damaged(connection_.where(), "it does not know silence");
    }
    for (const store::NamedRow& emotion : store::read_names(connection_, "emotions")) {
      emotion_index_[emotion.id] = static_cast<std::int32_t>(table_.emotions.size());
      table_.emotions.push_back(emotion.name);
    }
  }

  void read_sentences(std::int64_t speaker_id) {
    SQLite::Statement statement(
        connection_.database(),
        "SELECT s.id, e.name, s.name, s.text, s.frame_count, length(c.frames) FROM sentences s "
        "JOIN emotions e ON e.id = s.emotion_id LEFT JOIN coefficients c ON c.sentence_id = s.id "
        "WHERE s.speaker_id = ? ORDER BY e.name, s.name");
    const std::int64_t bytes_per_frame = table_.pca.dimension_count() * sizeof(float);
    statement.bind(1, speaker_id);
    while (statement.executeStep()) {
      const std::int64_t frame_count = statement.getColumn(4).getInt64();
      // Before memory for so many frames is asked for.
      if (frame_count < 1 || frame_count > std::numeric_limits<std::int32_t>::max() ||
          frame_count * bytes_per_frame != statement.getColumn(5).getInt64()) {
        throw_damaged(connection_.where(), "coefficients that do not fit their sentence's frames");
      }
      sentences_.push_back({statement.getColumn(0).getInt64(), frame_total_, frame_count});
      frame_total_ += frame_count;
      table_.sentences.push_back({table_.speaker, statement.getColumn(1).getString(),
                                  statement.getColumn(2).getString(),
                                  statement.getColumn(3).getString()});
    }
  }

  // What one thread reads: the sentences [begin, end), and what they hold.
  struct Part {
    std::unique_ptr<SQLite::Database> reader; // nothing: the connection itself
    std::size_t begin = 0, end = 0;           // into sentences_
    std::vector<MotionNode> nodes;
    std::vector<UnavailableNode> unavailable;
  };

  // Into parts of about as many frames for as many threads as there are and can read.
  void divide() {
    const auto most = static_cast<std::size_t>(std::clamp(omp_get_max_threads(), 1, kMostParts));
    std::vector<std::unique_ptr<SQLite::Database>> readers;
    while (most > 1 && readers.size() < most) {
      readers.push_back(connection_.reader_beside());
      if (!readers.back()) {
        readers.clear();
        break;
      }
    }
    readers.resize(std::max<std::size_t>(1, readers.size()));
    for (std::size_t p = 0; p < readers.size(); ++p) {
      const std::int64_t end_frame = frame_total_ * static_cast<std::int64_t>(p + 1) /
                                     static_cast<std::int64_t>(readers.size());
      const auto end = std::ranges::lower_bound(sentences_, end_frame, {}, &Sentence::first_frame);
      parts_.push_back({std::move(readers[p]),
                        p == 0 ? 0 : parts_[p - 1].end,
                        static_cast<std::size_t>(end - sentences_.begin()),
                        {},
                        {}});
    }
  }

  const SQLite::Database& database_of(const Part& part) const {
    return part.reader ? *part.reader : connection_.database();
  }

  template <typename Read>
  void read_parts(const Read& read) {
    parallel_for(static_cast<std::ptrdiff_t>(parts_.size()), 0,
                 [&](std::ptrdiff_t part) { read(parts_[static_cast<std::size_t>(part)]); });
  }

  void read_nodes() {
    read_prunings();
    read_parts([this](Part& part) {
      SQLite::Statement statement(database_of(part),
                                  "SELECT row, first_frame, frame_count, phoneme_id, "
                                  "previous_phoneme_id, next_phoneme_id, emotion_id, has_gap "
                                  "FROM nodes WHERE sentence_id = ? ORDER BY row");
      for (std::size_t s = part.begin; s < part.end; ++s) {
        statement.reset();
        statement.bind(1, sentences_[s].id);
        while (statement.executeStep()) {
          read_node(statement, static_cast<std::int32_t>(s), part);
        }
      }
    });
    for (Part& part : parts_) {
      table_.nodes.insert(table_.nodes.end(), part.nodes.begin(), part.nodes.end());
      std::ranges::move(part.unavailable, std::back_inserter(table_.unavailable));
    }
  }

  void read_prunings() {
    SQLite::Statement statement(connection_.database(),
                                "SELECT sentence_id, row, pruned_by, pruned_at, reason "
                                "FROM prunings");
    while (statement.executeStep()) {
      prunings_[{statement.getColumn(0).getInt64(), statement.getColumn(1).getInt()}] = fmt::format(
          "pruned by {} on {}: {}", statement.getColumn(2).getString(),
          statement.getColumn(3).getString().substr(0, 10), statement.getColumn(4).getString());
    }
  }

  void read_node(SQLite::Statement& row, std::int32_t sentence, Part& part) const {
    const Sentence& owner = sentences_[static_cast<std::size_t>(sentence)];
    MotionNode node;
    node.sentence = sentence;
    node.order = row.getColumn(0).getInt();
    const std::int64_t first = row.getColumn(1).getInt64();
    const std::int64_t count = row.getColumn(2).getInt64();
    if (first < 0 || count < 1 || count > owner.frame_count || first > owner.frame_count - count) {
      throw_damaged(connection_.where(),
                    fmt::format("frames of {} outside its sentence", key(sentence, node.order)));
    }
    if (const auto pruned = prunings_.find({owner.id, node.order}); pruned != prunings_.end()) {
      part.unavailable.push_back({key(sentence, node.order), pruned->second});
      return;
    }
    if (row.getColumn(7).getInt() != 0) {
      part.unavailable.push_back({key(sentence, node.order), "has unfilled gaps"});
      return;
    }
    node.first_frame = owner.first_frame + first;
    node.frame_count = static_cast<std::int32_t>(count);
    node.phoneme = at(phoneme_index_, row.getColumn(3).getInt64(), connection_);
    node.previous_phoneme = at(phoneme_index_, row.getColumn(4).getInt64(), connection_);
    node.next_phoneme = at(phoneme_index_, row.getColumn(5).getInt64(), connection_);
    node.emotion = at(emotion_index_, row.getColumn(6).getInt64(), connection_);
    node.viseme = viseme_of_phoneme_[static_cast<std::size_t>(node.phoneme)];
    part.nodes.push_back(node);
  }

  // Rows of silence have no node and what is pruned or has gaps is not in the table, so a captured
  // succession is one of nodes whose rows follow each other.
  void link_captured_neighbours() {
    for (std::size_t i = 1; i < table_.nodes.size(); ++i) {
      MotionNode& previous = table_.nodes[i - 1];
      MotionNode& node = table_.nodes[i];
      if (previous.sentence == node.sentence && previous.order + 1 == node.order) {
        node.predecessor = static_cast<NodeIndex>(i - 1);
        previous.successor = static_cast<NodeIndex>(i);
      }
    }
  }

  void read_coefficients() {
    const Eigen::Index dimensions = table_.pca.dimension_count();
    table_.coefficients.resize(frame_total_, dimensions);
    ask_for_large_pages(std::span(table_.coefficients.data(),
                                  static_cast<std::size_t>(table_.coefficients.size())));
    read_parts([this](const Part& part) {
      SQLite::Statement statement(database_of(part),
                                  "SELECT frames FROM coefficients WHERE sentence_id = ?");
      for (std::size_t s = part.begin; s < part.end; ++s) {
        const Sentence& sentence = sentences_[s];
        statement.reset();
        statement.bind(1, sentence.id);
        if (!statement.executeStep()) {
          throw_damaged(connection_.where(), "a sentence without coefficients");
        }
        auto block = table_.coefficients.middleRows(sentence.first_frame, sentence.frame_count);
        store::copy_numbers(statement.getColumn(0),
                            std::span(block.data(), static_cast<std::size_t>(block.size())),
                            connection_.where(), "a sentence's coefficients");
        if (!all_finite(block.data(), static_cast<std::size_t>(block.size()))) {
          throw_damaged(connection_.where(), "coefficients that are no numbers");
        }
      }
    });
  }

  std::string key(std::int32_t sentence, std::int32_t order) const {
    const SentenceInfo& info = table_.sentences[static_cast<std::size_t>(sentence)];
    return fmt::format("{}/{}/{}#{}", info.speaker, info.emotion, info.id, order);
  }

  const Connection& connection_;
  MotionTable& table_;
  IndexOfId phoneme_index_, emotion_index_;
  std::vector<std::int32_t> viseme_of_phoneme_;
  std::vector<Sentence> sentences_;
  std::int64_t frame_total_ = 0;
  std::map<std::pair<std::int64_t, std::int32_t>, std::string> prunings_; // by sentence and row
  std::vector<Part> parts_;
};

} // namespace

MotionTable MotionDatabase::load_motion_table(const std::string& speaker) const {
  const Connection& connection = *impl_->connection;
  return store::translated(connection.where(), [&] {
    const store::Snapshot snapshot(connection);
    MotionTable table;
    TableReader(connection, table).read(speaker);
    return table;
  });
}

} // namespace phonomime
