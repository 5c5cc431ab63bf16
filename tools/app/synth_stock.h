// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "synth/retarget/marker_face.h"
#include "synth/search/viterbi_search.h"
#include "tools/app/borrowed_style.h"

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace phonomime {

// A face fitted to a speaker's markers, with all that outputs make of it.
struct FittedFace {
  MarkerFace face;
  MorphTargets morphs;
  std::string note; // how well it fits, for people
};

// What every synthesis with one speaker's recordings shares. May be used by several threads.
class SynthStock {
public:
  // `database`: where the table is from, for style models; may be empty where none are asked for.
  explicit SynthStock(MotionTable table, std::filesystem::path database = {});

  const MotionTable& table() const { return table_; }
  // Found when they are first asked for.
  const CostWeights& default_weights(CostModel model);

  // The face that `--face PATH` names, fitted when it is first asked for, kept as long as this.
  // Throws InputError and IoError.
  const FittedFace& face(const std::filesystem::path& path);

  // A style model that knows these emotions (find_style_model), read when it is first asked for,
  // kept as long as this. Throws InputError where there is none.
  const StyleInUse* style(const std::vector<std::string>& emotions);

  // Whether the speaker has no model, fresh or stale; whether some speaker's model knows an
  // emotion.
  bool style_is_missing() const;
  bool any_style_knows(const std::string& emotion) const;

private:
  MotionTable table_;
  std::filesystem::path database_;
  std::mutex mutex_;
  std::map<std::vector<std::string>, StyleInUse> styles_; // by emotions
  std::map<CostModel, CostWeights> default_weights_;
  std::map<std::filesystem::path, FittedFace> faces_;
};

// One thread's search, kept for the next synthesis while recordings and weights stay the same.
class SearchKeeper {
public:
  // Valid until the next call. Throws InputError as ViterbiSearch does.
  ViterbiSearch& search(const MotionTable& table, const CostWeights& weights);

private:
  const MotionTable* table_ = nullptr;
  std::string weights_;
  std::unique_ptr<ViterbiSearch> search_;
};

} // namespace phonomime
