// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/held_out.h"
#include "tools/app/synth.h"
#include "tools/evaluate/emotion_classifier.h"
#include "tools/evaluate/emotion_findings.h"
#include "tools/evaluate/method.h"

#include <map>
#include <string>
#include <vector>

namespace phonomime {

// Whether the emotion that is asked for is seen in the motion. Held-out sentences are spoken by the
// main method and the paper's, asked for the emotion that was recorded, once more with alpha6 at
// zero, and for each other emotion; a classifier that is fitted to the training recordings says
// what it takes each of them for, and the recordings themselves.
class EmotionStudy {
public:
  explicit EmotionStudy(const MethodEntry& main);

  // Of each fold once. Throws InputError where the training recordings of a speaker are of one
  // emotion, and what speak_held_out does.
  void add(const HeldOut& held_out, const SynthOptions& options, const Progress& progress);

  EmotionFindings findings() const;

private:
  struct Trial {
    MethodEntry method;
    bool changed = false; // asked for the other emotions
    bool no_alpha6 = false;
    EmotionTrial found;
    std::map<std::string, double> closures; // "asked for key" -> closure recall
  };

  struct Classifiers {
    EmotionClassifier pose, moving;
  };

  static void count(EmotionTrial& trial, const Classifiers& classifiers, const MotionTable& table,
                    const std::string& asked, const Eigen::Ref<const FrameMatrix>& speech);
  void speak(Trial& trial, const HeldOut& held_out, const SynthOptions& options,
             const std::map<std::string, Classifiers>& classifiers, const Progress& progress);

  EmotionTrial recordings_;
  std::vector<Trial> trials_;
};

} // namespace phonomime
