// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/style/style_training.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace phonomime {

namespace {

// Where a column is in each style: rows of the table's coefficients, between two of them.
using Places = std::vector<double>; // S

void add_places(const Reading& nodes, std::vector<Places>& places) {
  const std::int32_t count = nodes.front()->frame_count;
  for (std::int32_t i = 0; i < count; ++i) {
    const double relative = count > 1 ? static_cast<double>(i) / (count - 1) : 0.5;
    Places place;
    for (const MotionNode* node : nodes) {
      place.push_back(static_cast<double>(node->first_frame) + relative * (node->frame_count - 1));
    }
    places.push_back(std::move(place));
  }
}

// The frame at a place between two rows, inside a reading.
Eigen::VectorXd frame_at(const MotionTable& table, const Reading& reading, double place) {
  const auto first = static_cast<double>(reading.front()->first_frame);
  const auto last =
      static_cast<double>(reading.back()->first_frame + reading.back()->frame_count - 1);
  const double inside = std::clamp(place, first, last);
  const auto row = static_cast<Eigen::Index>(std::floor(inside));
  const double share = inside - std::floor(inside);
  Eigen::VectorXd frame = table.coefficients.row(row).cast<double>();
  if (share > 0.0) {
    frame += share * (table.coefficients.row(row + 1).cast<double>().transpose() - frame);
  }
  return frame;
}

void write_columns(const MotionTable& table, const FrameVectors& vectors,
                   const std::vector<Reading>& readings_of_sentence,
                   const std::vector<Places>& places, Eigen::Ref<Eigen::MatrixXd> columns) {
  for (std::size_t t = 0; t < places.size(); ++t) {
    for (std::size_t s = 0; s < readings_of_sentence.size(); ++s) {
      for (int k = 0; k < vectors.bundle(); ++k) {
        const Eigen::Index row =
            static_cast<Eigen::Index>(s) * vectors.vector_size() + k * vectors.frame_size();
        vectors.write_frame(
            frame_at(table, readings_of_sentence[s], places[t][s] + k - vectors.bundle() / 2),
            columns.col(static_cast<Eigen::Index>(t)).segment(row, vectors.frame_size()));
      }
    }
  }
}

struct SentenceColumns {
  const std::vector<Reading>* readings = nullptr;
  std::vector<Places> places;
};

StyleStack make_part(const MotionTable& table, const FrameVectors& vectors,
                     const std::vector<std::string>& styles,
                     const std::vector<SentenceColumns>& sentences, std::size_t part,
                     std::size_t parts) {
  Eigen::Index count = 0;
  for (std::size_t i = part; i < sentences.size(); i += parts) {
    count += static_cast<Eigen::Index>(sentences[i].places.size());
  }
  StyleStack stack{.styles = styles, .vector_size = vectors.vector_size()};
  stack.columns.resize(static_cast<Eigen::Index>(styles.size()) * vectors.vector_size(), count);
  Eigen::Index first = 0;
  for (std::size_t i = part; i < sentences.size(); i += parts) {
    const auto columns = static_cast<Eigen::Index>(sentences[i].places.size());
    write_columns(table, vectors, *sentences[i].readings, sentences[i].places,
                  stack.columns.middleCols(first, columns));
    first += columns;
  }
  return stack;
}

} // namespace

StyleTraining gather_styles(const MotionTable& table, const FrameVectors& vectors,
                            const TrainingOptions& options) {
  AlignedSentences aligned = align_sentences(table, options);
  StyleTraining training{.styles = std::move(aligned.styles),
                         .nodes = aligned.nodes,
                         .nodes_left_out = aligned.nodes_left_out,
                         .not_aligned = std::move(aligned.not_aligned)};
  std::vector<SentenceColumns> sentences;
  for (const AlignedSentence& sentence : aligned.sentences) {
    training.sentences.push_back(sentence.id);
    sentences.push_back({.readings = &sentence.readings});
    for (const Reading& nodes : sentence.nodes) {
      add_places(nodes, sentences.back().places);
    }
  }
  const auto parts =
      std::min(static_cast<std::size_t>(std::max(options.parts, 1)), sentences.size());
  for (std::size_t part = 0; part < parts; ++part) {
    training.parts.push_back(make_part(table, vectors, training.styles, sentences, part, parts));
  }
  return training;
}

} // namespace phonomime
