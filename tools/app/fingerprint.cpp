// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/fingerprint.h"

#include "db/types/file_io.h"
#include "synth/retarget/face_source.h"
#include "tools/app/sha256.h"
#include "tools/app/synth_outputs.h"

#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

namespace phonomime {

namespace {

// The structs below are taken apart by structured bindings that name every member: one that gets a
// new member does not compile before somebody has said here whether results depend on it.

// A sequence of values. Whatever varies in size goes in with its size, so that different sequences
// are different bytes.
class Values {
public:
  template <typename Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
  void add(Number number) { add_bytes(&number, sizeof number); }

  void add(std::string_view text) {
    add(text.size());
    add_bytes(text.data(), text.size());
  }
  void add(const std::string& text) { add(std::string_view(text)); }

  template <typename Derived>
  void add(const Eigen::PlainObjectBase<Derived>& matrix) {
    add(matrix.rows());
    add(matrix.cols());
    add_bytes(matrix.data(),
              static_cast<std::size_t>(matrix.size()) * sizeof(typename Derived::Scalar));
  }

  template <typename Value>
  void add(const std::vector<Value>& values) {
    add(values.size());
    for (const Value& value : values) {
      add(value);
    }
  }

  void add(const Phoneme& phoneme) {
    const auto& [name, viseme, visibility] = phoneme;
    add_all(name, viseme, visibility);
  }

  void add(const SentenceInfo& sentence) {
    const auto& [speaker, emotion, id, text] = sentence;
    add_all(speaker, emotion, id, text);
  }

  void add(const MotionNode& node) {
    const auto& [phoneme, viseme, emotion, sentence, order, previous, next, predecessor, successor,
                 first_frame, frame_count] = node;
    add_all(phoneme, viseme, emotion, sentence, order, previous, next, predecessor, successor,
            first_frame, frame_count);
  }

  void add(const UnavailableNode& node) {
    const auto& [key, reason] = node;
    add_all(key, reason);
  }

  void add(const PcaModel& pca) {
    const auto& [mean, basis, variance, total_variance] = pca;
    add_all(mean, basis, variance, total_variance);
  }

  void add(const HeadPose& pose) {
    const auto& [translation_mm, rotation] = pose;
    add_all(translation_mm, rotation.coeffs());
  }

  void add(const SilenceOptions& options) {
    const auto& [fill, rest_at_ends, rest_within_s] = options;
    add_all(fill, rest_at_ends, rest_within_s);
  }

  template <typename... Parts>
  void add_all(const Parts&... parts) {
    (add(parts), ...);
  }

  std::string hex() {
    digest_.add(buffer_);
    return digest_.hex();
  }

private:
  void add_bytes(const void* data, std::size_t size) {
    buffer_.append(static_cast<const char*>(data), size);
    if (buffer_.size() >= kBuffer_bytes) {
      digest_.add(buffer_);
      buffer_.clear();
    }
  }

  static constexpr std::size_t kBuffer_bytes = 1 << 16;
  std::string buffer_; // many small values: few calls of the digest
  Sha256 digest_;
};

} // namespace

std::string FileFingerprints::of(const std::filesystem::path& file) {
  {
    const std::scoped_lock lock(mutex_);
    const auto known = known_.find(file);
    if (known != known_.end()) {
      return known->second;
    }
  }
  std::string read = sha256(read_file(file)); // by several threads at once, at worst
  const std::scoped_lock lock(mutex_);
  return known_.try_emplace(file, std::move(read)).first->second;
}

std::string fingerprint(const MotionTable& table) {
  const auto& [layout, pca, rate_hz, phonemes, visemes, emotions, speaker, sentences, nodes,
               coefficients, reference_pose, unavailable, phoneme_sets, synthetic] = table;
  Values values;
  values.add_all(format_layout(layout), pca, rate_hz, phonemes, visemes, emotions, speaker,
                 sentences, nodes, coefficients, reference_pose, unavailable, phoneme_sets,
                 synthetic);
  return values.hex();
}

std::string fingerprint(const SynthOptions& options, const std::string& table,
                        FileFingerprints& files) {
  const auto& [database, transcript, outputs, speaker, phoneme_set, tier, emotion, emotions,
               constraints, cost, blend, weights, audio, face, fps, head, retime, retime_with_audio,
               silence, smoothing_half_window, runners_up, tells_result, threads, make_folders] =
      options;
  Values values;
  const auto add_file = [&](const std::filesystem::path& file) {
    values.add(file.empty());
    if (!file.empty()) {
      values.add(files.of(file));
    }
  };
  // The recordings of `speaker` in `database` are `table`; neither threads nor folders nor what is
  // told beside the outputs change a byte of them, nor does the leave to retime beside a sound.
  values.add_all(std::string_view("phonomime " PHONOMIME_VERSION), table);
  values.add(transcript.filename().string());
  add_file(transcript);
  values.add(outputs.size());
  for (const std::filesystem::path& output : outputs) {
    values.add(output.filename().string());
  }
  values.add(phoneme_set.ends_with(".json") ? files.of(phoneme_set) : phoneme_set);
  values.add_all(tier, emotion);
  add_file(emotions);
  values.add(constraints.string());
  add_file(constraints);
  add_file(weights);
  add_file(audio);
  if (needs_face(options)) {
    for (const std::filesystem::path& file : face_files(face)) {
      values.add(file.filename().string());
      add_file(file);
    }
  }
  values.add_all(cost.value_or(kUsualCost), blend.value_or(kUsualBlend), fps, head.has_value(),
                 head.value_or(HeadPose{}), retime, silence, smoothing_half_window, runners_up);
  return values.hex();
}

} // namespace phonomime
