// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo/corpus_writer.h"

#include <set>
#include <span>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"
#include "tools/demo/c3d_writer.h"
#include "tools/demo/corruption.h"
#include "tools/demo/marker_layout.h"
#include "tools/demo/performance.h"

namespace phonomime::demo {

namespace fs = std::filesystem;

namespace {

constexpr int kSentencesPerFloatFile = 10;

// One sentence in one emotion.
struct Take {
  const Sentence* sentence;
  const EmotionStyle* style;
  std::string name; // "<emotion>/<id>"
};

std::vector<Take> list_takes(const std::vector<Sentence>& sentences) {
  std::vector<Take> takes;
  for (const EmotionStyle& style : emotion_styles())
    for (const Sentence& sentence : sentences)
      takes.push_back({&sentence, &style, fmt::format("{}/{}", style.emotion, sentence.id)});
  return takes;
}

void write_text(const fs::path& path, std::string_view bytes) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error)
    throw IoError({.where = path.parent_path().string(),
                   .what = "the folder cannot be made",
                   .got = error.message()});
  write_file(path, bytes);
}

std::string corpus_json() {
  nlohmann::ordered_json corpus;
  corpus["format"] = "phonomime-corpus";
  corpus["version"] = 1;
  corpus["name"] = "demo";
  corpus["description"] = "synthetic: made by rule, not recorded (voice by Festival, motion by "
                          "Phonomime's tools/demo)";
  corpus["synthetic"] = true;
  corpus["phoneme_set"] = "festival_us";
  corpus["layout"] = "layout.json";
  corpus["sentences"] = "sentences.tsv";
  return corpus.dump(1) + "\n";
}

std::string markers_tsv(const FaceModel& face) {
  std::string text = "marker\tvertex\n";
  const std::span<const int> vertices = marker_vertices();
  for (std::size_t i = 0; i < vertices.size(); ++i)
    text += fmt::format("{}\t{}\n", marker_name(vertices[i]), face.marker_vertex[i]);
  return text;
}

std::string sentence_table(const std::vector<Take>& takes) {
  std::string text = "id\ttext\tspeaker\temotion\tmotion\talignment\taudio\n";
  for (const Take& take : takes)
    text += fmt::format("{0}\t{1}\t{2}\t{3}\tmotion/{4}.c3d\talignment/{4}.lab\taudio/{4}.wav\n",
                        take.sentence->id, take.sentence->text, kSpeaker, take.style->emotion,
                        take.name);
  return text;
}

// The truth about planted faults of one family: drop-outs, or all the others.
std::string fault_table(const std::vector<Take>& takes,
                        const std::vector<std::vector<PlantedFault>>& plan, bool dropouts) {
  std::string text = "speaker\temotion\tid\tmarkers\tstart\tend\tkind\n";
  for (std::size_t i = 0; i < takes.size(); ++i)
    for (const PlantedFault& fault : plan[i]) {
      if ((fault.fault == Fault::dropout) != dropouts)
        continue;
      std::vector<std::string> markers;
      for (const int marker : fault.markers)
        markers.push_back(marker_name(marker_vertices()[static_cast<std::size_t>(marker)]));
      text += fmt::format("{}\t{}\t{}\t{}\t{:.4f}\t{:.4f}\t{}\n", kSpeaker, takes[i].style->emotion,
                          takes[i].sentence->id, fmt::join(markers, ","), fault.start_s,
                          fault.end_s, fault_name(fault.fault));
    }
  return text;
}

void write_into(const fs::path& folder, const CorpusJob& job, CorpusReport& report) {
  const std::vector<Take> takes = list_takes(job.sentences);
  std::vector<std::vector<Segment>> segments;
  for (const Take& take : takes) {
    const fs::path lab = job.speech / (take.name + ".lab");
    const std::string text = read_file(lab);
    segments.push_back(parse_festival_segments(text, lab.string()));
    write_text(folder / "alignment" / (take.name + ".lab"), text);
    write_text(folder / "audio" / (take.name + ".wav"),
               read_file(job.speech / (take.name + ".wav")));
  }
  const FaceFields fields(job.face.rest);
  const auto plan = plan_faults(segments, job.face.rest, job.seed);
  for (std::size_t i = 0; i < takes.size(); ++i) {
    Performance performance =
        perform(segments[i], *takes[i].style, fields, seed_for(job.seed, takes[i].name));
    for (const PlantedFault& fault : plan[i]) {
      plant(fault, kRate_hz, performance.measured);
      ++(fault.fault == Fault::dropout ? report.with_dropouts : report.contaminated);
    }
    const C3dNumbers numbers = i % kSentencesPerFloatFile == kSentencesPerFloatFile - 1
                                   ? C3dNumbers::floats
                                   : C3dNumbers::scaled_integers;
    write_text(folder / "motion" / (takes[i].name + ".c3d"),
               format_c3d(performance.measured, kRate_hz, numbers));
    ++report.sentences;
    report.frames += static_cast<long>(performance.measured.size());
  }
  write_text(folder / "face" / "face.obj", job.face.obj_text);
  write_text(folder / "face" / "markers.tsv", markers_tsv(job.face));
  write_text(folder / "layout.json", format_layout(marker_layout()));
  write_text(folder / "sentences.tsv", sentence_table(takes));
  write_text(folder / "planted_contamination.tsv", fault_table(takes, plan, false));
  write_text(folder / "planted_dropouts.tsv", fault_table(takes, plan, true));
  write_text(folder / "corpus.json", corpus_json());
}

// An earlier demo corpus may be replaced, anything else stays.
void check_replaceable(const fs::path& out) {
  if (!fs::exists(out) || (fs::is_directory(out) && fs::is_empty(out)))
    return;
  const fs::path corpus = out / "corpus.json";
  if (fs::is_regular_file(corpus)) {
    const auto json = nlohmann::json::parse(read_file(corpus), nullptr, false);
    if (json.is_object() && json.value("name", "") == "demo" && json.value("synthetic", false))
      return;
  }
  throw InputError({.where = out.string(),
                    .what = "there is something else than a demo corpus",
                    .remedy = "Name a new folder."});
}

void replace_folder(const fs::path& made, const fs::path& out) {
  fs::path old = out;
  old += ".old";
  fs::remove_all(old);
  if (fs::exists(out))
    fs::rename(out, old);
  fs::rename(made, out);
  fs::remove_all(old);
}

void remove_quietly(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

} // namespace

std::vector<Sentence> parse_sentences(std::string_view text, std::string_view where) {
  std::vector<Sentence> sentences;
  std::set<std::string, std::less<>> ids;
  long line_number = 0;
  for (const std::string_view line : split_lines(text)) {
    ++line_number;
    if (trim(line).empty() || line.front() == '#')
      continue;
    const std::vector<std::string_view> fields = split_fields(line, '\t');
    if (fields.size() != 2 || fields[0].empty() || fields[1].empty() ||
        fields[0].find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") !=
            std::string_view::npos)
      throw InputError({.where = at_line(where, line_number),
                        .what = "this is not a sentence",
                        .expected = "an id of a-z, 0-9 and _, a tab, and a text",
                        .got = quoted(line)});
    if (!ids.emplace(fields[0]).second)
      throw InputError({.where = at_line(where, line_number),
                        .what = "sentence " + quoted(fields[0]) + " stands there twice"});
    sentences.push_back({std::string(fields[0]), std::string(fields[1])});
  }
  if (sentences.empty())
    throw InputError({.where = std::string(where), .what = "there are no sentences"});
  return sentences;
}

CorpusReport write_corpus(const CorpusJob& job) {
  CorpusReport report;
  const fs::path out = job.out.has_filename() ? job.out : job.out.parent_path();
  fs::path partial = out;
  partial += ".partial";
  try {
    check_replaceable(out);
    fs::remove_all(partial);
    write_into(partial, job, report);
    replace_folder(partial, out);
  } catch (const fs::filesystem_error& error) {
    remove_quietly(partial);
    throw IoError({.where = out.string(),
                   .what = "the corpus folder cannot be written",
                   .got = error.code().message()});
  } catch (const Error&) {
    remove_quietly(partial);
    throw;
  }
  return report;
}

} // namespace phonomime::demo
