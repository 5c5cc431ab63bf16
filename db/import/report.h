// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/import/prepare.h"
#include "db/import/survey.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace phonomime {

// What an import did with everything that it was given. The totals add up:
//   sentences.listed = imported + rejected
//   recorded.in_files - outside_sentences + in_several_sentences = in_imported + in_rejected
//   frames.stored = in_nodes + in_silence = in_pca + out_of_pca
//   gaps.missing = filled + held + marked (markers or weights times recorded frames)
struct ImportReport {
  struct RejectedSentence {
    std::string speaker, emotion, id;
    std::string where; // "sentences.tsv:12"
    std::string reason;
  };
  struct GapEntry {       // groups that are missing over the same frames
    std::string file;     // motion file, as the table names it
    std::string sentence; // "speaker/emotion/id"
    double start_s = 0.0; // on the sentence's clock
    std::int64_t frames = 0;
    GapAction action = GapAction::filled;
    std::vector<std::string> groups;
  };
  struct Reference {
    std::string speaker;
    std::string origin;   // as ReferencePose::origin
    std::string sentence; // "speaker/emotion/id", empty where it is no frame of this corpus
    double time_s = 0.0;
  };
  struct HeadScale {             // of markers
    std::string scale;           // as kScaleNames; empty for weights
    std::string origin;          // as Survey::scale_origin
    double size_variation = 0.0; // as Survey::size_variation
  };
  struct StageTime {
    std::string stage;
    double seconds = 0.0;
  };

  std::string corpus;
  std::string phoneme_set;
  bool synthetic = false;
  double rate_hz = 0.0;
  std::int64_t sentences_listed = 0, sentences_imported = 0;
  std::vector<RejectedSentence> rejected; // in the table's order
  std::int64_t files = 0, file_frames = 0, frames_outside = 0, frames_shared = 0;
  std::int64_t imported_recorded_frames = 0, rejected_recorded_frames = 0;
  std::int64_t frames = 0, in_nodes = 0, in_silence = 0, held_frames = 0, gap_frames = 0;
  std::int64_t nodes = 0, nodes_with_gap = 0, interpolated_poses = 0;
  std::int64_t missing = 0, filled = 0, held = 0, marked = 0; // group-frames
  std::vector<GapEntry> gaps;
  std::map<std::string, std::int64_t> suspects;     // reason -> nodes
  std::map<std::string, std::int64_t> extra_groups; // not in the layout -> files
  std::vector<Reference> references;
  HeadScale head_scale;
  std::int64_t pca_frames = 0, pca_left_out = 0; // of the whole database
  int pca_dimensions = 0;
  double pca_share = 0.0;         // 0 to 1
  std::vector<StageTime> timings; // differ from run to run
};

// A report that knows the survey; sentences are added in order.
ImportReport begin_report(const Corpus& corpus, const Survey& survey, double rate_hz);
void add_to_report(ImportReport& report, const Corpus& corpus, const SentenceAccount& account);
void add_rejections(ImportReport& report, const Corpus& corpus,
                    const std::vector<Rejection>& rejections, std::int64_t recorded_frames);

// Everything but the timings, the same for the same input: what the database keeps.
nlohmann::json report_to_json(const ImportReport& report);

// For people, a few lines; each rejection, and each gap that was not filled, has a line.
std::string report_to_text(const ImportReport& report);

} // namespace phonomime
