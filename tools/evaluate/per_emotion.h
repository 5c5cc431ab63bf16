// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/pipeline/transcript_steps.h"
#include "tools/evaluate/method.h"

#include <string>
#include <vector>

namespace phonomime {

// A model of its own for each emotion of a table.
template <typename Model>
class PerEmotion {
public:
  // fit(emotion) gives the model of an emotion, an index into MotionTable::emotions.
  template <typename Fit>
  PerEmotion(const MotionTable& table, const Fit& fit) : table_(table) {
    for (std::size_t emotion = 0; emotion < table.emotions.size(); ++emotion) {
      models_.push_back(fit(static_cast<std::int32_t>(emotion)));
    }
  }

  // Throws InputError for an emotion that the table does not have.
  const Model& of(const SentenceRequest& request) const {
    const std::int32_t emotion =
        find_asked_emotion(table_, {.emotion = std::string(request.emotion)}, "sentence");
    return models_[static_cast<std::size_t>(emotion)];
  }

private:
  const MotionTable& table_;
  std::vector<Model> models_; // by emotion
};

} // namespace phonomime
