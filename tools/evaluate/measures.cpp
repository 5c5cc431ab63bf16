// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/measures.h"

#include "db/types/errors.h"
#include "db/types/row_frames.h"
#include "db/types/sentence_key.h"
#include "tools/evaluate/measured_motion.h"
#include "tools/evaluate/time_warping.h"

#include <algorithm>
#include <cmath>

namespace phonomime {

namespace {

constexpr std::int64_t kJoinReach = 3; // frames either side of a join that its jerk is sought in

// One pair of recording and synthesis being measured.
class Meter {
public:
  Meter(const MeasureSetup& setup, const ImportedSentence& sentence, const FrameMatrix& synthesised)
      : setup_(setup), sentence_(sentence), groups_(setup.layout),
        recorded_(setup.layout, setup.rate_hz, sentence.channels),
        synthesised_(setup.layout, setup.rate_hz, synthesised),
        ranges_(row_frames(sentence.rows, setup.rate_hz)), frames_(sentence.channels.rows()) {
    result_.key = sentence_key(sentence);
    result_.emotion = sentence.emotion;
    result_.frame_count = frames_;
    for (FrameRange& range : ranges_) {
      range.first = std::clamp<std::int64_t>(range.first, 0, frames_);
      range.count = std::clamp<std::int64_t>(range.count, 0, frames_ - range.first);
    }
    mark_frames();
    result_.sums.group_error_sq.assign(groups_.all.size(), 0.0);
  }

  SentenceMeasures measure(std::span<const JoinPlace> joins) {
    add_frames();
    if (result_.sums.frames > 0) {
      result_.sums.sentences = 1;
      add_upper_face();
      add_warped_curves();
      add_jerk(joins);
    }
    add_lip_events();
    for (const JoinPlace& join : joins) {
      result_.sums.captured.add(join.captured ? 1.0 : 0.0);
    }
    return std::move(result_);
  }

private:
  void mark_frames() {
    in_phoneme_.assign(static_cast<std::size_t>(frames_), 0);
    usable_.assign(static_cast<std::size_t>(frames_), 1);
    for (std::size_t k = 0; k < sentence_.frame_has_gap.size(); ++k) {
      usable_[k] = sentence_.frame_has_gap[k] == 0 ? 1 : 0;
    }
    bool began = false;
    for (std::size_t row = 0; row < ranges_.size(); ++row) {
      if (sentence_.rows[row].is_silence()) {
        continue;
      }
      const FrameRange& range = ranges_[row];
      std::fill_n(in_phoneme_.begin() + range.first, range.count, std::uint8_t{1});
      result_.first_speech_frame = began ? result_.first_speech_frame : range.first;
      result_.end_speech_frame = range.end();
      began = true;
    }
  }

  // Within the speech and without a gap.
  bool counts(std::int64_t k) const {
    return k >= result_.first_speech_frame && k < result_.end_speech_frame &&
           usable_[static_cast<std::size_t>(k)] != 0;
  }

  void add_frames() {
    result_.frame_error.reserve(static_cast<std::size_t>(frames_));
    std::vector<MeasureSums*> phoneme_of(static_cast<std::size_t>(frames_), nullptr);
    for (std::size_t row = 0; row < ranges_.size(); ++row) {
      if (!sentence_.rows[row].is_silence() && ranges_[row].count > 0) {
        MeasureSums& sums = result_.phoneme_sums[sentence_.rows[row].phoneme.name];
        sums.group_error_sq.assign(groups_.all.size(), 0.0);
        std::fill_n(phoneme_of.begin() + ranges_[row].first, ranges_[row].count, &sums);
      }
    }
    for (std::int64_t k = 0; k < frames_; ++k) {
      double sum = 0.0;
      for (const int group : groups_.all) {
        sum += error_sq(recorded_, synthesised_, k, group);
      }
      result_.frame_error.push_back(
          static_cast<float>(sum / static_cast<double>(groups_.all.size())));
      if (!counts(k)) {
        continue;
      }
      add_frame(k, result_.sums);
      add_speeds(k);
      if (MeasureSums* phoneme = phoneme_of[static_cast<std::size_t>(k)]) {
        add_frame(k, *phoneme);
      }
    }
    // A phoneme whose frames all have gaps has nothing to tell.
    std::erase_if(result_.phoneme_sums, [](const auto& sums) { return sums.second.frames == 0; });
  }

  void add_frame(std::int64_t k, MeasureSums& sums) const {
    ++sums.frames;
    for (const int group : groups_.all) {
      sums.group_error_sq[static_cast<std::size_t>(group)] +=
          error_sq(recorded_, synthesised_, k, group);
    }
    double largest = 0.0;
    for (const int group : groups_.lips) {
      const double error = error_sq(recorded_, synthesised_, k, group);
      sums.lip_error_sq.add(error);
      largest = std::max(largest, error);
    }
    if (!groups_.lips.empty()) {
      sums.largest_lip_error_sq.add(largest);
    }
    for (std::size_t c = 0; c < kLipCurves; ++c) {
      const auto& recorded = recorded_.curve(static_cast<LipCurve>(c));
      if (!recorded.empty()) {
        sums.curves[c].add(
            recorded[static_cast<std::size_t>(k)],
            synthesised_.curve(static_cast<LipCurve>(c))[static_cast<std::size_t>(k)]);
      }
    }
    if (counts(k - 1)) {
      add_velocity_errors(k, groups_.all, sums.velocity_error);
      add_velocity_errors(k, groups_.lips, sums.lip_velocity_error);
    }
  }

  void add_velocity_errors(std::int64_t k, const std::vector<int>& groups, Tally& errors) const {
    for (const int group : groups) {
      errors.add((synthesised_.velocity(k, group) - recorded_.velocity(k, group)).norm());
    }
  }

  void add_speeds(std::int64_t k) {
    if (!counts(k - 1)) {
      return;
    }
    MeasureSums& sums = result_.sums;
    if (setup_.layout.kind == LayoutKind::markers && !groups_.lips.empty()) {
      sums.lip_speed_recorded.push_back(recorded_.speed(k, groups_.lips));
      sums.lip_speed_synthesised.push_back(synthesised_.speed(k, groups_.lips));
    }
    const auto speed = [&](const std::vector<double>& curve) {
      const auto at = static_cast<std::size_t>(k);
      return std::abs(curve[at] - curve[at - 1]) * setup_.rate_hz;
    };
    if (!recorded_.curve(LipCurve::aperture).empty()) {
      sums.aperture_speed_recorded.push_back(speed(recorded_.curve(LipCurve::aperture)));
      sums.aperture_speed_synthesised.push_back(speed(synthesised_.curve(LipCurve::aperture)));
    }
  }

  // How a group's squared distance from the reference pose varies over time.
  double dynamics(const MeasuredMotion& motion, int group) const {
    const auto width = static_cast<Eigen::Index>(setup_.layout.channels_per_group());
    const auto rest = setup_.reference_pose.segment(group * width, width).transpose();
    PairMoments moments;
    for (std::int64_t k = 0; k < frames_; ++k) {
      if (counts(k)) {
        const double distance_sq = (motion.position(k, group) - rest).squaredNorm();
        moments.add(distance_sq, distance_sq);
      }
    }
    return std::sqrt(moments.recorded_sq / static_cast<double>(moments.count));
  }

  void add_upper_face() {
    Tally signed_difference, absolute_difference;
    for (const int group : groups_.upper_face) {
      const double difference = dynamics(recorded_, group) - dynamics(synthesised_, group);
      signed_difference.add(difference);
      absolute_difference.add(std::abs(difference));
    }
    if (const auto mean = signed_difference.mean()) {
      result_.sums.upper_face_dynamics.add(*mean);
      result_.sums.upper_face_dynamics_absolute.add(*absolute_difference.mean());
    }
  }

  void add_warped_curves() {
    std::vector<std::int64_t> frames;
    for (std::int64_t k = 0; k < frames_; ++k) {
      if (counts(k)) {
        frames.push_back(k);
      }
    }
    const auto band = static_cast<std::int64_t>(std::lround(kWarpBand_s * setup_.rate_hz));
    for (std::size_t c = 0; c < kLipCurves; ++c) {
      const auto which = static_cast<LipCurve>(c);
      if (recorded_.curve(which).empty()) {
        continue;
      }
      std::vector<double> recorded, synthesised;
      for (const std::int64_t k : frames) {
        recorded.push_back(recorded_.curve(which)[static_cast<std::size_t>(k)]);
        synthesised.push_back(synthesised_.curve(which)[static_cast<std::size_t>(k)]);
      }
      const std::vector<double> warped = warp_onto(recorded, synthesised, frames, band);
      for (std::size_t i = 0; i < frames.size(); ++i) {
        result_.sums.warped_curves[c].add(recorded[i], warped[i]);
      }
    }
  }

  // The third difference of frame k lies half a frame behind k, a join half a frame before its own.
  void add_jerk(std::span<const JoinPlace> joins) {
    for (std::int64_t k = 1; k + 2 < frames_; ++k) {
      bool whole = true;
      for (std::int64_t i = k - 1; i <= k + 2; ++i) {
        whole = whole && counts(i) && in_phoneme_[static_cast<std::size_t>(i)] != 0;
      }
      if (!whole) {
        continue;
      }
      const bool at_join = std::ranges::any_of(joins, [&](const JoinPlace& join) {
        return !join.captured && std::abs(k - join.frame + 1) <= kJoinReach;
      });
      (at_join ? result_.sums.jerk_at_joins : result_.sums.jerk_inside)
          .add(synthesised_.jerk(k, groups_.all));
      result_.sums.jerk_recorded.add(recorded_.jerk(k, groups_.all));
    }
  }

  void add_lip_events() {
    if (recorded_.curve(LipCurve::aperture).empty()) {
      return;
    }
    result_.lip_events =
        find_lip_events(sentence_.rows, recorded_.curve(LipCurve::aperture),
                        synthesised_.curve(LipCurve::aperture), usable_, setup_.rate_hz);
    for (const LipEvent& event : result_.lip_events) {
      for (MeasureSums* sums : {&result_.sums, &result_.phoneme_sums[event.phoneme]}) {
        add_lip_event(event, *sums);
      }
    }
  }

  static void add_lip_event(const LipEvent& event, MeasureSums& sums) {
    sums.minimum_timing.add(event.timing_s);
    sums.minimum_timing_absolute.add(std::abs(event.timing_s));
    if (event.demand == LipDemand::contact) {
      sums.contact_error.add(std::abs(event.synthesised_aperture_mm - event.recorded_aperture_mm));
      return;
    }
    const double closed = event.synthesised_closed() ? 1.0 : 0.0;
    sums.closed.add(closed);
    sums.closed_recorded.add(event.recorded_closed() ? 1.0 : 0.0);
    if (event.recorded_closed()) {
      sums.closed_kept.add(closed);
    }
  }

  const MeasureSetup& setup_;
  const ImportedSentence& sentence_;
  GroupSets groups_;
  MeasuredMotion recorded_, synthesised_;
  std::vector<FrameRange> ranges_; // #rows, within the frames
  std::int64_t frames_;
  std::vector<std::uint8_t> usable_, in_phoneme_; // #frames
  SentenceMeasures result_;
};

void check(const MeasureSetup& setup, const ImportedSentence& recorded,
           const FrameMatrix& synthesised) {
  const Eigen::Index channels = setup.layout.channel_count();
  const auto demand = [&](Eigen::Index got, Eigen::Index expected, const char* what) {
    if (got != expected) {
      throw InternalError({.where = sentence_key(recorded),
                           .what = what,
                           .expected = std::to_string(expected),
                           .got = std::to_string(got)});
    }
  };
  demand(recorded.channels.cols(), channels, "a recording does not fit the layout's channels");
  demand(synthesised.cols(), channels, "a synthesis does not fit the layout's channels");
  demand(synthesised.rows(), recorded.channels.rows(),
         "a synthesis has not as many frames as its recording");
  demand(setup.reference_pose.size(), channels, "a reference pose does not fit the layout");
}

} // namespace

SentenceMeasures measure_sentence(const MeasureSetup& setup, const ImportedSentence& recorded,
                                  const FrameMatrix& synthesised,
                                  std::span<const JoinPlace> joins) {
  check(setup, recorded, synthesised);
  return Meter(setup, recorded, synthesised).measure(joins);
}

} // namespace phonomime
