// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/db/store/made_corpus.h"

#include <algorithm>
#include <random>

#include <Eigen/QR>

namespace phonomime::test {
namespace {

// The same numbers with every standard library, unlike its distributions.
double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53 * 2.0 - 1.0;
}

} // namespace

Layout made_layout(int markers) {
  Layout layout;
  for (int i = 0; i < markers; ++i) {
    layout.groups.push_back({"m" + std::to_string(i), {i % 2 == 0 ? Region::lips : Region::rigid}});
  }
  return layout;
}

std::vector<Phoneme> made_phonemes() {
  return {{"pau", "pau", Visibility::low}, {"p", "p", Visibility::high},
          {"b", "p", Visibility::high},    {"aa", "aa", Visibility::intermediate},
          {"ae", "aa", Visibility::low},   {"iy", "iy", Visibility::intermediate},
          {"k", "k", Visibility::low}};
}

ImportedSentence made_sentence(const std::string& speaker, const std::string& emotion,
                               const std::string& id, std::uint64_t seed, int markers, int frames) {
  std::mt19937_64 random(seed);
  const std::vector<Phoneme> phonemes = made_phonemes();
  ImportedSentence sentence;
  sentence.speaker = speaker;
  sentence.emotion = emotion;
  sentence.id = id;
  sentence.text = "text of " + id;
  sentence.audio = seed % 3 == 0 ? "/recordings/" + id + ".wav" : "";
  const int row_count = seed % 4 == 0 ? 8 : 7;
  for (int row = 0; row < row_count; ++row) {
    const int first = row * frames / row_count;
    const int end = (row + 1) * frames / row_count;
    const bool silent = row == 0 || row == row_count - 1 || (row_count == 8 && row == 4);
    const std::size_t phoneme = silent ? 0 : 1 + random() % (phonemes.size() - 1);
    sentence.rows.push_back({phonemes[phoneme], first / kRate_hz, end / kRate_hz});
    if (!silent) {
      ImportedNode node;
      node.row = row;
      node.first_frame = first;
      node.frame_count = end - first;
      sentence.nodes.push_back(node);
    }
  }
  sentence.channels.resize(frames, markers * 3);
  for (Eigen::Index i = 0; i < sentence.channels.size(); ++i) {
    sentence.channels.data()[i] = static_cast<float>(50.0 * uniform(random));
  }
  sentence.frame_has_gap.assign(static_cast<std::size_t>(frames), 0);
  for (int frame = 0; frame < frames; ++frame) {
    HeadPose pose;
    pose.translation_mm = {uniform(random), uniform(random), uniform(random)};
    pose.rotation = Eigen::Quaterniond(1.0, uniform(random), uniform(random), uniform(random));
    pose.rotation.normalize();
    sentence.head.push_back(pose);
  }
  return sentence;
}

PcaModel made_pca(Eigen::Index channels, Eigen::Index dimensions, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Eigen::MatrixXd noise =
      Eigen::MatrixXd::NullaryExpr(channels, dimensions, [&] { return uniform(random); });
  PcaModel pca;
  pca.mean = Eigen::VectorXd::NullaryExpr(channels, [&] { return 10.0 * uniform(random); });
  pca.basis = Eigen::HouseholderQR<Eigen::MatrixXd>(noise).householderQ() *
              Eigen::MatrixXd::Identity(channels, dimensions);
  pca.variance = Eigen::VectorXd::LinSpaced(dimensions, static_cast<double>(dimensions), 1.0);
  pca.total_variance = pca.variance.sum() * 1.25;
  return pca;
}

MadeCorpus made_corpus(const std::string& name, int count, int markers, int frames) {
  MadeCorpus corpus;
  corpus.name = name;
  const std::uint64_t first_seed = 1000 * static_cast<unsigned char>(name.front());
  for (int i = 0; i < count; ++i) {
    corpus.sentences.push_back(made_sentence("s1", i % 2 == 0 ? "neutral" : "happiness",
                                             name + std::to_string(i), first_seed + i, markers,
                                             frames));
  }
  return corpus;
}

void import_corpus(MotionDatabase& database, const MadeCorpus& corpus) {
  const auto channels = corpus.sentences.front().channels.cols();
  ImportTransaction import =
      database.begin_import(made_layout(static_cast<int>(channels / 3)), kRate_hz);
  import.add_phonemes(made_phonemes());
  for (const ImportedSentence& sentence : corpus.sentences) {
    import.add_sentence(sentence);
    if (!import.reference_pose(sentence.speaker)) {
      import.set_reference_pose(sentence.speaker,
                                sentence.channels.row(0).transpose().cast<double>());
    }
  }
  import.set_pca(made_pca(channels, corpus.dimensions, corpus.pca_seed), {});
  CorpusRecord record;
  record.name = corpus.name;
  record.phoneme_set = "festival_us";
  record.report_json = "{}";
  import.commit(record);
}

} // namespace phonomime::test
