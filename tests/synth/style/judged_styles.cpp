// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/synth/style/judged_styles.h"

#include "synth/style/align_phonemes.h"
#include "synth/style/infer_style.h"
#include "synth/style/mixture.h"
#include "tests/support/temporary_folder.h"
#include "tools/app/held_out.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

namespace phonomime::test {

namespace {

SpokenReading spoken_reading(const ImportedSentence& sentence, const PcaModel& pca) {
  SpokenReading reading;
  const std::int32_t first = sentence.nodes.front().first_frame;
  const std::int32_t end = sentence.nodes.back().first_frame + sentence.nodes.back().frame_count;
  reading.channels = sentence.channels.middleRows(first, end - first).cast<double>();
  reading.coefficients = (reading.channels.rowwise() - pca.mean.transpose()) * pca.basis;
  for (const ImportedNode& node : sentence.nodes) {
    reading.phonemes.push_back({sentence.rows[static_cast<std::size_t>(node.row)].phoneme.name,
                                node.first_frame - first, node.frame_count});
  }
  return reading;
}

// A frame of one reading and where the same moment of speech is in another, between two frames.
struct SameMoment {
  Eigen::Index frame = 0;
  double place = 0.0;
};

std::vector<SameMoment> same_moments(const SpokenReading& from, const SpokenReading& to) {
  std::map<std::string, std::int32_t> names;
  const auto numbers_of = [&](const SpokenReading& reading) {
    std::vector<std::int32_t> numbers;
    for (const PhonemeFrames& phoneme : reading.phonemes) {
      numbers.push_back(names.try_emplace(phoneme.phoneme, static_cast<std::int32_t>(names.size()))
                            .first->second);
    }
    return numbers;
  };
  const std::vector<std::int32_t> first = numbers_of(from), second = numbers_of(to);
  std::vector<SameMoment> moments;
  for (const auto& [i, j] : align_phonemes(first, second)) {
    const PhonemeFrames& here = from.phonemes[i];
    const PhonemeFrames& there = to.phonemes[j];
    for (Eigen::Index t = 0; t < here.count; ++t) {
      const double relative =
          here.count > 1 ? static_cast<double>(t) / static_cast<double>(here.count - 1) : 0.5;
      moments.push_back({here.first + t, static_cast<double>(there.first) +
                                             relative * static_cast<double>(there.count - 1)});
    }
  }
  return moments;
}

Eigen::RowVectorXd frame_at(const FrameMatrixD& frames, double place) {
  const auto row = static_cast<Eigen::Index>(std::floor(place));
  const double share = place - std::floor(place);
  const Eigen::Index next = std::min(row + 1, frames.rows() - 1);
  return (1.0 - share) * frames.row(row) + share * frames.row(next);
}

// What the training's sentences say of a pair of emotions, frame by frame.
struct Rivals {
  Eigen::RowVectorXd difference; // #dimensions
  Eigen::MatrixXd regression;    // #dimensions + 1 by #dimensions
};

Rivals learn_rivals(const MotionTable& table, const std::string& from, const std::string& to) {
  const FrameVectors vectors(table.pca, 1, StyleVectors::coefficients);
  const Eigen::MatrixXd columns =
      gather_styles(table, vectors, {.styles = {from, to}, .reference = from, .parts = 1})
          .parts.front()
          .columns;
  const Eigen::Index size = vectors.frame_size(), dimensions = vectors.dimension_count();
  Eigen::MatrixXd x = columns.topRows(size).transpose();
  x.col(dimensions).setOnes();
  const Eigen::MatrixXd y = columns.middleRows(size, dimensions).transpose();
  return {y.colwise().mean() - x.leftCols(dimensions).colwise().mean(),
          x.colPivHouseholderQr().solve(y)};
}

Eigen::MatrixXd weights_of(const StyleModel& model, const std::string& emotion, double intensity,
                           Eigen::Index frames) {
  const EmotionModifier part{emotion, intensity};
  return mixture_weights(model.known.styles, model.neutral, {&part, 1}).replicate(1, frames);
}

StyleRequest request_of(const JudgedStyles& judged, const SpokenReading& reading,
                        const std::string& from, const std::string& to, double intensity) {
  const StyleModel& model = judged.trained.model;
  const Eigen::Index frames = reading.coefficients.rows();
  return {.coefficients = reading.coefficients,
          .rate_hz = judged.table.rate_hz,
          .phonemes = reading.phonemes,
          .shown = weights_of(model, from, 1.0, frames),
          .wanted = weights_of(model, to, intensity, frames)};
}

void add_accelerations(const FrameMatrixD& coefficients, const MotionTable& table,
                       std::vector<double>& found) {
  const double squared_rate = table.rate_hz * table.rate_hz;
  for (Eigen::Index t = 1; t + 1 < coefficients.rows(); ++t) {
    const Eigen::VectorXd second =
        table.pca.basis *
        (coefficients.row(t + 1) - 2.0 * coefficients.row(t) + coefficients.row(t - 1)).transpose();
    for (Eigen::Index g = 0; g < second.size(); g += 3) {
      found.push_back(second.segment<3>(g).norm() * squared_rate);
    }
  }
}

double smallest(const CoefficientAperture& lips, const FrameMatrixD& frames,
                const PhonemeFrames& phoneme) {
  double least = lips.at(frames.row(phoneme.first));
  for (Eigen::Index t = phoneme.first; t < phoneme.first + phoneme.count; ++t) {
    least = std::min(least, lips.at(frames.row(t)));
  }
  return least;
}

} // namespace

void PairError::add(const PairError& other) {
  squares.unchanged += other.squares.unchanged;
  squares.mean_difference += other.squares.mean_difference;
  squares.regression += other.squares.regression;
  squares.ours += other.squares.ours;
  markers += other.markers;
}

double PairError::rms(double Squares::*method) const {
  return std::sqrt(squares.*method / static_cast<double>(markers));
}

void LipFigures::add(const LipFigures& other) {
  lips += other.lips;
  closed_before += other.closed_before;
  closed_after += other.closed_after;
  teeth += other.teeth;
  inside_before += other.inside_before;
  inside_after += other.inside_after;
  taken_out += other.taken_out;
  moved += other.moved;
  left += other.left;
  recorded.insert(recorded.end(), other.recorded.begin(), other.recorded.end());
  changed.insert(changed.end(), other.changed.begin(), other.changed.end());
}

JudgedStyles JudgedStyles::train(const std::filesystem::path& corpus, const SentenceFilter& takes,
                                 const SentenceFilter& held_out, const StyleOptions& options) {
  const TemporaryFolder folder;
  ImportOptions import;
  import.corpus = corpus;
  // Sentences that are not taken are held out as well, and not spoken.
  HeldOut split = hold_out(
      import,
      [&](const CorpusSentence& sentence) { return !takes(sentence) || held_out(sentence); }, takes,
      folder / "training.db", {});
  JudgedStyles judged;
  judged.table = std::move(split.tables.begin()->second);
  for (const ImportedSentence& sentence : split.sentences) {
    judged.spoken[sentence.id][sentence.emotion] = spoken_reading(sentence, judged.table.pca);
  }
  judged.trained = train_style(judged.table, options);
  return judged;
}

std::vector<PairError> JudgedStyles::pair_errors() const {
  const PcaModel& pca = table.pca;
  const MotionStyler styler(trained.model, table.layout, pca);
  std::vector<PairError> errors;
  for (const std::string& from : trained.model.known.styles) {
    for (const std::string& to : trained.model.known.styles) {
      if (from == to) {
        continue;
      }
      const Rivals rivals = learn_rivals(table, from, to);
      PairError error{.from = from, .to = to};
      for (const auto& [id, readings] : spoken) {
        if (!readings.contains(from) || !readings.contains(to)) {
          continue;
        }
        const SpokenReading& shown = readings.at(from);
        const SpokenReading& there = readings.at(to);
        const FrameMatrixD ours =
            styler.apply(request_of(*this, shown, from, to, 1.0)).coefficients;
        for (const SameMoment& moment : same_moments(shown, there)) {
          const Eigen::RowVectorXd truth = frame_at(there.channels, moment.place);
          const auto squared = [&](const Eigen::RowVectorXd& coefficients) {
            return (pca.reconstruct(coefficients.transpose()) - truth.transpose()).squaredNorm();
          };
          const Eigen::RowVectorXd before = shown.coefficients.row(moment.frame);
          error.squares.unchanged += squared(before);
          error.squares.mean_difference += squared(before + rivals.difference);
          error.squares.regression += squared(before * rivals.regression.topRows(before.size()) +
                                              rivals.regression.bottomRows(1));
          error.squares.ours += squared(ours.row(moment.frame));
          error.markers += table.layout.group_count();
        }
      }
      errors.push_back(error);
    }
  }
  return errors;
}

LipFigures JudgedStyles::lips(double intensity) const {
  const StyleModel& model = trained.model;
  const CoefficientAperture aperture = *CoefficientAperture::of(table.layout, table.pca);
  const MotionStyler styler(model, table.layout, table.pca);
  LipFigures figures{.intensity = intensity};
  for (const auto& [id, readings] : spoken) {
    for (const auto& [from, reading] : readings) {
      add_accelerations(reading.coefficients, table, figures.recorded);
      for (const std::string& to : model.known.styles) {
        if (to == model.neutral) {
          continue;
        }
        const StyledMotion styled = styler.apply(request_of(*this, reading, from, to, intensity));
        figures.moved += styled.contacts_moved;
        figures.left += styled.contacts_left;
        add_accelerations(styled.coefficients, table, figures.changed);
        for (const PhonemeFrames& phoneme : reading.phonemes) {
          const auto range = model.contacts.find(phoneme.phoneme);
          if (range == model.contacts.end()) {
            continue;
          }
          const double before = smallest(aperture, reading.coefficients, phoneme);
          const double after = smallest(aperture, styled.coefficients, phoneme);
          const auto& [least_mm, most_mm] = range->second;
          if (phoneme.phoneme == "f" || phoneme.phoneme == "v") {
            ++figures.teeth;
            figures.inside_before += before >= least_mm && before <= most_mm ? 1 : 0;
            figures.inside_after += after >= least_mm - 1e-3 && after <= most_mm + 1e-3 ? 1 : 0;
            figures.taken_out += after < std::min(before, least_mm) - 1e-3 ||
                                         after > std::max(before, most_mm) + 1e-3
                                     ? 1
                                     : 0;
          } else {
            ++figures.lips;
            figures.closed_before += before < 1.5 ? 1 : 0;
            figures.closed_after += after < 1.5 ? 1 : 0;
          }
        }
      }
    }
  }
  return figures;
}

FoundStyles JudgedStyles::find_styles(Eigen::Index frames) const {
  const StyleModel& model = trained.model;
  const FrameVectors vectors(table.pca, model.bundle, model.vectors);
  FoundStyles found{.frames = frames};
  for (const auto& [id, readings] : spoken) {
    for (const auto& [emotion, reading] : readings) {
      const Eigen::MatrixXd y = vectors.bundles(reading.coefficients);
      for (Eigen::Index first = 0; first + frames <= y.cols(); first += frames) {
        const InferredStyle style = infer_style(model.unknown, y.middleCols(first, frames), {});
        const Eigen::Index nearest = nearest_style(model.unknown, style.expression);
        found.right += model.unknown.styles[static_cast<std::size_t>(nearest)] == emotion ? 1 : 0;
        ++found.windows;
      }
    }
  }
  return found;
}

} // namespace phonomime::test
