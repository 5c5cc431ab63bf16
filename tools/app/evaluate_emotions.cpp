// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/evaluate_emotions.h"

#include "db/types/sentence_key.h"
#include "tools/app/speak_held_out.h"
#include "tools/evaluate/measure_sums.h"
#include "tools/evaluate/paired_test.h"

#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

constexpr std::string_view kPaper = "paper";

// Frames of a sentence that are within the speech.
auto speech_frames(const FrameMatrix& channels, const SentenceMeasures& measures) {
  return channels.middleRows(measures.first_speech_frame,
                             measures.end_speech_frame - measures.first_speech_frame);
}

// The sentences as they are, or each in every other emotion of its speaker's recordings.
std::vector<ImportedSentence> asked_sentences(const HeldOut& held_out, bool changed) {
  std::vector<ImportedSentence> asked;
  for (const ImportedSentence& sentence : held_out.sentences) {
    if (!changed) {
      asked.push_back(sentence);
      continue;
    }
    for (const std::string& emotion : held_out.tables.at(sentence.speaker).emotions) {
      if (emotion != sentence.emotion) {
        asked.push_back(sentence);
        asked.back().emotion = emotion;
      }
    }
  }
  return asked;
}

} // namespace

EmotionStudy::EmotionStudy(const MethodEntry& main)
    : recordings_{.id = "recordings", .description = "the held-out recordings themselves"} {
  std::vector<MethodEntry> methods = {main};
  if (main.name != kPaper) {
    const std::vector<std::string> names = {std::string(kPaper)};
    methods.push_back(find_methods(names).front());
  }
  for (const MethodEntry& method : methods) {
    const std::string name(method.name);
    const auto add = [&](bool changed, bool no_alpha6, std::string id, std::string description) {
      Trial trial{.method = method, .changed = changed, .no_alpha6 = no_alpha6};
      trial.found.id = std::move(id);
      trial.found.description = std::move(description);
      trials_.push_back(std::move(trial));
    };
    add(false, false, name, "asked for the emotion that was recorded");
    add(true, false, name + ", changed", "asked for each of the other emotions");
    add(false, true, name + ", alpha6 = 0",
        "asked for the emotion that was recorded, another one of a node costs nothing");
  }
}

void EmotionStudy::add(const HeldOut& held_out, const SynthOptions& options,
                       const Progress& progress) {
  std::map<std::string, Classifiers> classifiers;
  for (const auto& [speaker, table] : held_out.tables) {
    classifiers.emplace(
        speaker,
        Classifiers{.pose = EmotionClassifier(table, EmotionFeatures::pose),
                    .moving = EmotionClassifier(table, EmotionFeatures::pose_and_movement)});
  }
  for (Trial& trial : trials_) {
    speak(trial, held_out, options, classifiers, progress);
  }
}

void EmotionStudy::speak(Trial& trial, const HeldOut& held_out, const SynthOptions& options,
                         const std::map<std::string, Classifiers>& classifiers,
                         const Progress& progress) {
  const std::vector<ImportedSentence> sentences = asked_sentences(held_out, trial.changed);
  const bool hears_recordings = &trial == &trials_.front();

  std::vector<std::optional<double>> closures(sentences.size());
  speak_held_out(
      held_out.tables, sentences, std::span(&trial.method, 1), options, progress,
      [&](std::size_t i, SpokenSentence&& spoken) {
        const ImportedSentence& sentence = sentences[i];
        const SentenceMeasures& measures = spoken.measures.front();
        if (measures.first_speech_frame >= measures.end_speech_frame) {
          return;
        }
        const MotionTable& table = held_out.tables.at(sentence.speaker);
        const Classifiers& own = classifiers.at(sentence.speaker);
        count(trial.found, own, table, sentence.emotion,
              speech_frames(spoken.synthesised.front().channels, measures));
        if (hears_recordings) {
          count(recordings_, own, table, sentence.emotion,
                speech_frames(sentence.channels, measures));
        }
        closures[i] = measure_values(measures.sums)[Measure::closure_recall];
      },
      [&](CostWeights& weights) {
        if (trial.no_alpha6) {
          weights.alpha6 = 0.0;
        }
      });
  // In the order of the sentences, whatever the order in which they were spoken.
  std::size_t i = 0;
  for (const ImportedSentence& recorded : held_out.sentences) {
    const std::size_t asked =
        trial.changed ? held_out.tables.at(recorded.speaker).emotions.size() - 1 : 1;
    for (std::size_t k = 0; k < asked; ++k, ++i) {
      if (closures[i]) {
        trial.closures[sentences[i].emotion + " " + sentence_key(recorded)] = *closures[i];
      }
    }
  }
}

void EmotionStudy::count(EmotionTrial& trial, const Classifiers& classifiers,
                         const MotionTable& table, const std::string& asked,
                         const Eigen::Ref<const FrameMatrix>& speech) {
  const auto heard = [&](const EmotionClassifier& classifier) {
    return table.emotions[static_cast<std::size_t>(classifier.recognise(speech))];
  };
  const std::string by_pose = heard(classifiers.pose);
  ++trial.taken_for[asked][by_pose];
  ++trial.sentences;
  trial.recognised += asked == by_pose ? 1 : 0;
  trial.recognised_moving += asked == heard(classifiers.moving) ? 1 : 0;
}

EmotionFindings EmotionStudy::findings() const {
  EmotionFindings findings;
  findings.trials.push_back(recordings_);
  for (const Trial& trial : trials_) {
    findings.trials.push_back(trial.found);
    Tally closures;
    for (const auto& [key, closure] : trial.closures) {
      closures.add(closure);
    }
    findings.trials.back().closures = closures.mean();
  }
  // Of the main method: as recorded, then changed.
  std::map<std::string, double> as_recorded;
  for (const auto& [asked, closure] : trials_[0].closures) {
    as_recorded[asked.substr(asked.find(' '))] = closure;
  }
  PairMoments moments;
  std::vector<double> differences;
  for (const auto& [asked, closure] : trials_[1].closures) {
    const auto own = as_recorded.find(asked.substr(asked.find(' ')));
    if (own != as_recorded.end()) {
      differences.push_back(closure - own->second);
      moments.add(differences.back(), differences.back());
    }
  }
  findings.closure_pairs = moments.count;
  if (moments.count > 0) {
    findings.closure_change = moments.mean_recorded;
  }
  findings.closure_change_error = moments.recorded_mean_error();
  findings.closure_p = signed_rank_test(differences).p_value;
  return findings;
}

} // namespace phonomime
