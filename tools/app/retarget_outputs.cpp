// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/retarget_outputs.h"

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"
#include "synth/export/audio.h"
#include "synth/export/player_document.h"
#include "synth/export/shape_files.h"
#include "synth/export/shape_glb.h"
#include "synth/retarget/face_source.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace phonomime {

namespace {

enum class OutputKind { live_link, weights, glb, html, bvh, maya, blender };

OutputKind output_kind(const std::filesystem::path& path) {
  constexpr std::array<std::pair<std::string_view, OutputKind>, 7> kSuffixes = {
      {{".livelink.csv", OutputKind::live_link},
       {".csv", OutputKind::weights},
       {".glb", OutputKind::glb},
       {".html", OutputKind::html},
       {".bvh", OutputKind::bvh},
       {".maya.py", OutputKind::maya},
       {".blender.py", OutputKind::blender}}};
  const std::string name = to_lower(path.filename().string());
  for (const auto& [suffix, kind] : kSuffixes) {
    if (name.ends_with(suffix)) {
      return kind;
    }
  }
  throw UsageError({.where = path.string(),
                    .what = "the suffix names no kind of output",
                    .expected = ".csv, .livelink.csv, .glb, .html, .bvh, .maya.py or .blender.py",
                    .got = quoted(path.extension().string())});
}

class ShapeOutputs {
public:
  ShapeOutputs(const RetargetApplyOptions& options, const ShapeFace& face,
               const ShapeMotion& motion)
      : options_(options), face_(face), motion_(motion) {}

  std::string bytes(OutputKind kind) {
    switch (kind) {
    case OutputKind::live_link:
      return shape_live_link_csv(motion_);
    case OutputKind::weights:
      return shape_weight_csv(motion_);
    case OutputKind::glb:
      return glb();
    case OutputKind::html:
      return html();
    case OutputKind::bvh:
      return head_bvh(motion_);
    case OutputKind::maya:
      return maya_script(motion_, face_.neutral.source);
    case OutputKind::blender:
      return blender_script(motion_, face_.neutral.source);
    }
    return {};
  }

private:
  std::string title() const { return options_.motion.stem().string(); }

  const std::string& glb() {
    if (glb_.empty()) {
      glb_ = animated_glb(read_file(face_files(options_.face).front()), face_.neutral.source,
                          motion_, {.title = title(), .credits = {}, .synthetic = false});
    }
    return glb_;
  }

  std::string html() {
    PlayerDocument document;
    document.title = title();
    document.fps = motion_.weights.rate_hz;
    document.duration_s =
        static_cast<double>(motion_.weights.frames.rows()) / motion_.weights.rate_hz;
    document.glb = glb();
    if (!options_.audio.empty()) {
      document.wav = read_audio(options_.audio).bytes;
    }
    return player_html(document);
  }

  const RetargetApplyOptions& options_;
  const ShapeFace& face_;
  const ShapeMotion& motion_;
  std::string glb_; // made once for all outputs that hold it
};

} // namespace

void check_retarget_outputs(const RetargetApplyOptions& options) {
  bool plays = false;
  for (const std::filesystem::path& path : options.outputs) {
    plays = output_kind(path) == OutputKind::html || plays;
  }
  if (!options.audio.empty() && !plays) {
    throw UsageError({.where = "--audio",
                      .what = "no output plays the sound",
                      .remedy = "Name one with -o FILE.html, or leave --audio out."});
  }
}

std::vector<std::filesystem::path> write_retargeted(const RetargetApplyOptions& options,
                                                    const ShapeFace& face,
                                                    const ShapeMotion& motion) {
  ShapeOutputs outputs(options, face, motion);
  OutputFiles files;
  for (const std::filesystem::path& path : options.outputs) {
    files.stage(path, outputs.bytes(output_kind(path)));
  }
  files.commit();
  return options.outputs;
}

} // namespace phonomime
