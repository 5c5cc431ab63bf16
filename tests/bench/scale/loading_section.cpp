// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/store/motion_database.h"
#include "synth/search/cost_weights.h"
#include "synth/search/viterbi_search.h"
#include "tests/bench/compare.h"
#include "tests/bench/scale/measure.h"
#include "tests/bench/scale/scaled_table.h"
#include "tests/bench/scale/sections.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <stdexcept>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace phonomime::bench {

namespace {

// The sentence of nodes [begin, end): their frames one after the other, silence of two frames where
// the recording had something between two nodes.
ImportedSentence imported_sentence(const MotionTable& table, NodeIndex begin, NodeIndex end) {
  constexpr std::int32_t kSilentFrames = 2;
  const MotionNode& first = table.nodes[static_cast<std::size_t>(begin)];
  const SentenceInfo& info = table.sentences[static_cast<std::size_t>(first.sentence)];
  ImportedSentence sentence;
  sentence.speaker = info.speaker;
  sentence.emotion = info.emotion;
  sentence.id = info.id;
  std::vector<std::int64_t> frames;
  const auto add_row = [&](const Phoneme& phoneme, std::int64_t from, std::int32_t count,
                           std::int64_t stride) {
    const auto start = static_cast<double>(frames.size()) / table.rate_hz;
    for (std::int32_t m = 0; m < count; ++m) {
      frames.push_back(from + m * stride);
    }
    sentence.rows.push_back({phoneme, start, static_cast<double>(frames.size()) / table.rate_hz});
  };
  for (NodeIndex i = begin; i < end; ++i) {
    const MotionNode& node = table.nodes[static_cast<std::size_t>(i)];
    if (node.predecessor == kNoNode) {
      add_row(table.phonemes[0], node.first_frame, kSilentFrames, 0);
    }
    ImportedNode imported;
    imported.row = static_cast<std::int32_t>(sentence.rows.size());
    imported.first_frame = static_cast<std::int32_t>(frames.size());
    imported.frame_count = node.frame_count;
    add_row(table.phonemes[static_cast<std::size_t>(node.phoneme)], node.first_frame,
            node.frame_count, 1);
    sentence.nodes.push_back(imported);
  }
  const auto size = static_cast<Eigen::Index>(frames.size());
  sentence.channels.resize(size, table.pca.channel_count());
  for (Eigen::Index m = 0; m < size; ++m) {
    const Eigen::VectorXd coefficients =
        table.coefficients.row(frames[static_cast<std::size_t>(m)]).transpose().cast<double>();
    sentence.channels.row(m) = table.pca.reconstruct(coefficients).transpose().cast<float>();
  }
  sentence.frame_has_gap.assign(frames.size(), 0);
  sentence.head.resize(table.layout.kind == LayoutKind::markers ? frames.size() : 0);
  return sentence;
}

void write_database(const MotionTable& table, const std::filesystem::path& path) {
  MotionDatabase database = MotionDatabase::open(path, OpenMode::read_write);
  ImportTransaction import = database.begin_import(table.layout, table.rate_hz);
  import.add_phonemes(table.phonemes);
  import.set_reference_pose(table.speaker, table.reference_pose);
  for (NodeIndex begin = 0; begin < table.node_count();) {
    NodeIndex end = begin;
    while (end < table.node_count() && table.nodes[static_cast<std::size_t>(end)].sentence ==
                                           table.nodes[static_cast<std::size_t>(begin)].sentence) {
      ++end;
    }
    import.add_sentence(imported_sentence(table, begin, end));
    begin = end;
  }
  import.set_pca(table.pca, {});
  CorpusRecord record;
  record.name = "scaled";
  record.phoneme_set = table.phoneme_sets.empty() ? "festival_us" : table.phoneme_sets.front();
  record.synthetic = table.synthetic;
  record.report_json = "{}";
  import.commit(record);
}

// Takes a file out of the page cache.
void forget(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0 || fsync(file) != 0 || posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED) != 0) {
    throw std::runtime_error(path.string() + " cannot be taken out of the page cache");
  }
  close(file);
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
}

// What a program does from the file to the first answer: {table ms, weights ms, search ms, first
// search ms, MB, nodes, frames}. Weights sample the table for PNT.
std::vector<double> load_once(const std::filesystem::path& path,
                              const std::vector<std::filesystem::path>& phrases) {
  MotionTable table;
  CostWeights weights;
  const double table_s = seconds([&] {
    table = MotionDatabase::open(path, OpenMode::read_only).load_motion_table("");
    return table.node_count();
  });
  const double weights_s = seconds([&] {
    weights = default_cost_weights(table);
    return weights.pnt;
  });
  std::unique_ptr<ViterbiSearch> search;
  const double search_s = seconds([&] {
    search = std::make_unique<ViterbiSearch>(table, weights);
    return search.get();
  });
  double solve_s = 0.0;
  for (const Phrase& phrase : read_phrases(table, phrases)) {
    solve_s = std::max(solve_s, seconds([&] { return search->solve(phrase.steps); }));
  }
  return {1e3 * table_s,
          1e3 * weights_s,
          1e3 * search_s,
          1e3 * solve_s,
          peak_memory_mb(),
          static_cast<double>(table.node_count()),
          static_cast<double>(table.coefficients.rows())};
}

// At least `frames` frames in it, silence between nodes counted.
std::vector<double> make_database(const std::filesystem::path& from, std::int64_t frames,
                                  const std::filesystem::path& path) {
  const MotionTable source = MotionDatabase::open(from, OpenMode::read_only).load_motion_table("");
  const double frames_a_node =
      static_cast<double>(source.coefficients.rows()) / source.node_count();
  auto nodes = static_cast<NodeIndex>(static_cast<double>(frames) / frames_a_node);
  MotionTable table = scaled_table(source, nodes, 0.3);
  nodes = static_cast<NodeIndex>(static_cast<double>(nodes) * static_cast<double>(frames) /
                                 static_cast<double>(table.coefficients.rows())) +
          1;
  table = scaled_table(source, nodes, 0.3);
  write_database(table, path);
  return {static_cast<double>(std::filesystem::file_size(path))};
}

} // namespace

void report_loading(Report& report, const ScaleOptions& options) {
  report.section("Loading (ms; each run in a process of its own; the search is ready after table + "
                 "weights + search; first = dearest of the phrases, said in turn)",
                 {"database        ", "nodes", "frames", "file MB", "cache", "table", "weights",
                  "search", "ready", "first", "peak MB"});
  for (const std::filesystem::path& source : options.databases) {
    const test::TemporaryFolder folder;
    const std::filesystem::path path = folder / "scaled.db";
    const double bytes = in_child([&] { return make_database(source, options.frames, path); })[0];
    for (const bool warm : {false, true}) {
      std::vector<std::vector<double>> columns(7);
      std::vector<double> ready;
      for (int run = 0; run < options.runs; ++run) {
        if (!warm) {
          forget(path);
        }
        const std::vector<double> run_ms =
            in_child([&] { return load_once(path, options.phrases); });
        for (std::size_t i = 0; i < columns.size(); ++i) {
          columns[i].push_back(run_ms.at(i));
        }
        ready.push_back(run_ms[0] + run_ms[1] + run_ms[2]);
      }
      report.row({source.stem().string(), median(columns[5]), median(columns[6]), bytes / 1e6,
                  std::string(warm ? "warm" : "cold"), median(columns[0]), median(columns[1]),
                  median(columns[2]), median(ready), median(columns[3]), median(columns[4])});
    }
  }
}

} // namespace phonomime::bench
