// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/motion_table.h"
#include "db/types/progress.h"
#include "synth/style/bilinear_model.h"
#include "synth/style/choose_dimensions.h"
#include "synth/style/choose_unknown.h"
#include "synth/style/contacts.h"
#include "synth/style/restyler.h"
#include "synth/style/style_training.h"
#include "synth/style/valid_range.h"

#include <optional>
#include <string>
#include <vector>

namespace phonomime {

struct StyleOptions {
  TrainingOptions training;
  StyleVectors vectors = StyleVectors::channels;
  int bundle = 3;                                   // frames, odd (T2.14)
  std::optional<Eigen::Index> content_size;         // J of known styles; empty: by cross-validation
  std::optional<double> ridge;                      // likewise; a variance
  std::optional<Eigen::Index> style_size;           // I of unknown styles; likewise
  std::optional<Eigen::Index> unknown_content_size; // J of unknown styles; likewise
  int threads = 0;                                  // 0: as many as there are

  // Throws UsageError, which says what is out of range.
  void validate() const;
};

// All that a change of style needs, learned from one speaker's recordings.
struct StyleModel {
  std::string neutral; // the style that intensity 0 is
  StyleVectors vectors = StyleVectors::channels;
  int bundle = 3;
  double ridge = 0.0;
  AsymmetricModel known;         // for motion whose style is known
  SymmetricModel unknown;        // for motion whose style has to be found
  ContactRanges contacts;        // empty where the layout cannot say
  std::vector<ValidRange> valid; // of each style but neutral
  // #dimensions: from the face of whoever is restyled to the face that it was trained on; empty:
  // they are the same. A bilinear model would take the shape of another face for speech.
  Eigen::VectorXd to_own_face;

  // The same motion (#frames by #dimensions) of the model's own face.
  FrameMatrixD on_own_face(const FrameMatrixD& coefficients) const;
};

struct TrainedStyle {
  StyleModel model;
  // Where there was something to choose.
  std::optional<ChosenDimensions> chosen;
  std::optional<ChosenUnknown> chosen_unknown;
  // Of what was trained on, without the columns.
  std::vector<std::string> sentences;
  std::int64_t nodes = 0, nodes_left_out = 0, columns = 0;
  std::vector<NotAligned> not_aligned;
};

// Throws UsageError, InputError (gather_styles, summarise, the fits) and Interrupted.
TrainedStyle train_style(const MotionTable& table, const StyleOptions& options,
                         const Progress& progress = {});

// Motion that is to show another style.
struct StyleRequest {
  FrameMatrixD coefficients; // #frames by #dimensions
  double rate_hz = 0.0;
  std::vector<PhonemeFrames> phonemes; // for the contacts; may be empty
  // S by #frames in the order of the model's styles: what each frame shows and is to show
  // (mixture_weights); a column sums to 1.
  Eigen::MatrixXd shown, wanted;
  double glide_s = 0.3; // over which a change of style is spread
  // Over which what the motion shows changes; empty: glide_s.
  std::optional<double> shown_glide_s;
};

struct StyledMotion {
  FrameMatrixD coefficients; // #frames by #dimensions
  int contacts = 0;          // phonemes that ask for contact
  int contacts_moved = 0;    // of them, those that the new style would have taken from their range
  int contacts_left = 0;     // of those, the ones that stayed outside
  std::vector<std::string> warnings;
};

// A model made ready for motion of one layout and PCA, so that many motions cost no more than their
// frames. Keeps pointers to `model` and `pca`.
class MotionStyler {
public:
  // Throws InputError where the model was trained on motion of another size.
  MotionStyler(const StyleModel& model, const Layout& layout, const PcaModel& pca);

  // Glide, Restyler, hold_contacts, and a warning for each emotion beyond its valid range.
  StyledMotion apply(const StyleRequest& request) const;

private:
  const StyleModel* model_;
  const PcaModel* pca_;
  Restyler restyler_;
  std::optional<CoefficientAperture> aperture_;
};

// The same for a single motion.
StyledMotion apply_style(const StyleModel& model, const Layout& layout, const PcaModel& pca,
                         const StyleRequest& request);

} // namespace phonomime
