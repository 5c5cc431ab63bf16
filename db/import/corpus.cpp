// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/import/corpus.h"

#include "db/import/corpus_path.h"
#include "db/import/head.h"
#include "db/import/sentence_table.h"
#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/json_file.h"
#include "db/types/text.h"

#include <algorithm>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace phonomime {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::string_view kCorpusFile = "corpus.json";

fs::path canonical_folder(const fs::path& folder) {
  std::error_code error;
  const fs::path real = fs::canonical(folder, error);
  if (error) {
    throw IoError({.where = folder.string(),
                   .what = "the corpus cannot be opened",
                   .expected = "a corpus folder with a corpus.json",
                   .got = error.message()});
  }
  if (!fs::is_directory(real, error)) {
    throw InputError({.where = folder.string(),
                      .what = "is not a folder",
                      .expected = "a corpus folder with a corpus.json"});
  }
  return real;
}

PhonemeSet find_phoneme_set(const Corpus& corpus, const std::string& named,
                            const std::string& where) {
  if (named.ends_with(".json")) {
    return PhonemeSet::parse(read_file(path_in_corpus(corpus.folder, named, where)), named);
  }
  try {
    return PhonemeSet::built_in(named);
  } catch (const InputError& error) {
    ErrorDetails details = error.details();
    details.where = where;
    throw InputError(details);
  }
}

std::vector<CorpusSentence> find_sentences(const Corpus& corpus, const std::string& table) {
  const fs::path path = path_in_corpus(corpus.folder, table, kCorpusFile);
  std::vector<CorpusSentence> sentences;
  for (SentenceRow& row : parse_sentence_table(read_file(path), table, corpus.name)) {
    CorpusSentence sentence;
    sentence.where = at_line(table, row.line);
    const auto find = [&](const std::string& name) {
      return path_in_corpus(corpus.folder, name, sentence.where);
    };
    sentence.motion = find(row.motion);
    sentence.alignment = find(row.alignment);
    if (!row.audio.empty()) {
      sentence.audio = find(row.audio);
    }
    sentence.id = std::move(row.id);
    sentence.text = std::move(row.text);
    sentence.speaker = std::move(row.speaker);
    sentence.emotion = std::move(row.emotion);
    sentence.motion_name = std::move(row.motion);
    sentence.alignment_name = std::move(row.alignment);
    sentence.start_s = row.start_s;
    sentence.end_s = row.end_s;
    sentences.push_back(std::move(sentence));
  }
  return sentences;
}

void add_reference_frame(Corpus& corpus, const json& value) {
  const auto refuse = [&](std::string what) {
    throw InputError(
        {.where = fmt::format("{}: $.reference_frame", kCorpusFile), .what = std::move(what)});
  };
  std::set<std::string> speakers;
  for (const CorpusSentence& sentence : corpus.sentences) {
    speakers.insert(sentence.speaker);
  }
  std::string speaker = value.value("speaker", "");
  if (speaker.empty()) {
    if (speakers.size() > 1) {
      refuse("the corpus has several speakers and \"speaker\" is left out");
    }
    speaker = *speakers.begin();
  }
  const std::string id = value.at("sentence").get<std::string>();
  const std::string emotion = value.value("emotion", std::string(kNeutral));
  const auto found = std::ranges::find_if(corpus.sentences, [&](const CorpusSentence& sentence) {
    return sentence.speaker == speaker && sentence.emotion == emotion && sentence.id == id;
  });
  if (found == corpus.sentences.end()) {
    refuse(fmt::format("there is no sentence {}/{}/{}", speaker, emotion, id));
  }
  const ReferenceFrame frame{.sentence = static_cast<std::size_t>(found - corpus.sentences.begin()),
                             .time_s = value.at("time").get<double>()};
  if (!corpus.reference_frames.emplace(speaker, frame).second) {
    refuse(fmt::format("speaker {} has two", quoted(speaker)));
  }
}

} // namespace

Corpus read_corpus(const fs::path& folder) {
  Corpus corpus;
  corpus.folder = canonical_folder(folder);
  const std::string where = (folder / kCorpusFile).string();
  const json value = parse_json_as(
      "corpus", read_file(path_in_corpus(corpus.folder, kCorpusFile, folder.string())), where);
  corpus.name = value.at("name").get<std::string>();
  corpus.synthetic = value.value("synthetic", false);
  corpus.alignment_options.tier = value.value("phone_tier", "");
  corpus.phoneme_set = find_phoneme_set(corpus, value.at("phoneme_set").get<std::string>(), where);
  const std::string layout = value.at("layout").get<std::string>();
  corpus.layout = parse_layout(read_file(path_in_corpus(corpus.folder, layout, where)), layout);
  if (corpus.layout.kind == LayoutKind::markers) {
    head_anchor(corpus.layout, layout);
  }
  corpus.sentences = find_sentences(corpus, value.at("sentences").get<std::string>());
  if (const auto frames = value.find("reference_frame"); frames != value.end()) {
    for (const json& frame : frames->is_array() ? *frames : json::array({*frames})) {
      add_reference_frame(corpus, frame);
    }
  }
  return corpus;
}

void keep_sentences(Corpus& corpus, const SentenceFilter& takes) {
  if (!takes) {
    return;
  }
  std::vector<CorpusSentence> kept;
  std::map<std::size_t, std::size_t> place; // of the kept ones: before, after
  for (std::size_t i = 0; i < corpus.sentences.size(); ++i) {
    if (takes(corpus.sentences[i])) {
      place.emplace(i, kept.size());
      kept.push_back(std::move(corpus.sentences[i]));
    }
  }
  if (kept.empty()) {
    throw InputError(
        {.where = corpus.folder.string(), .what = "no sentence of the corpus is left"});
  }
  corpus.sentences = std::move(kept);
  std::erase_if(corpus.reference_frames,
                [&](const auto& named) { return !place.contains(named.second.sentence); });
  for (auto& [speaker, frame] : corpus.reference_frames) {
    frame.sentence = place.at(frame.sentence);
  }
}

} // namespace phonomime
