// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/text.h"
#include "tools/evaluate/report.h"

namespace phonomime {

namespace {

// A field that holds a separator, a quote or a line's end stands in quotes (RFC 4180).
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string escaped = "\"";
  for (const char c : text) {
    escaped += c;
    if (c == '"') {
      escaped += '"';
    }
  }
  return escaped + '"';
}

} // namespace

std::string sentences_csv(const Evaluation& evaluation) {
  std::string text = "method,sentence,speaker,emotion,fold,frames,measured_frames";
  for (const Measure measure : all_measures()) {
    text += ',';
    text += info(measure).id;
  }
  text += '\n';
  for (std::size_t m = 0; m < evaluation.methods.size(); ++m) {
    const MethodResult& method = evaluation.methods[m];
    for (std::size_t i = 0; i < method.sentences.size(); ++i) {
      const SentenceMeasures& sentence = method.sentences[i];
      text += field(method.id) + ',' + field(sentence.key) + ',';
      text += field(sentence.key.substr(0, sentence.key.find('/'))) + ',';
      text += field(sentence.emotion) + ',';
      text += method.folds.empty() ? "" : std::to_string(method.folds[i]);
      text += ',' + std::to_string(sentence.frame_count);
      text += ',' + std::to_string(sentence.sums.frames);
      for (const Measure measure : all_measures()) {
        const auto& value = evaluation.tables.at(m).sentences.at(i)[measure];
        text += ',';
        text += value ? format_number(*value) : "";
      }
      text += '\n';
    }
  }
  return text;
}

} // namespace phonomime
