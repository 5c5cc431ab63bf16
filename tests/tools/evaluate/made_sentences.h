// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/imported_sentence.h"
#include "db/types/layout.h"
#include "tools/evaluate/measures.h"

#include <functional>
#include <string>
#include <vector>

namespace phonomime::test {

inline constexpr double kRate_hz = 100.0;

// Groups of made_layout(), in its order.
enum Group { upper_lip, lower_lip, right_corner, left_corner, chin, brow, lid, skull, group_count };

// Eight markers: four of the lips with the landmarks of aperture and width, one of the jaw, one
// brow, one eyelid, one rigid.
Layout made_layout();
MeasureSetup made_setup(); // the reference pose is rest_pose()

// Lips 2 mm apart, corners 50 mm.
Eigen::VectorXd rest_pose();

struct MadeRow {
  std::string phoneme;
  int frames = 0;
};

// A sentence of these rows at kRate_hz, every frame the rest pose.
ImportedSentence made_sentence(const std::vector<MadeRow>& rows, const std::string& id = "a");

// /pau/ 10 frames, /aa/ so many, /pau/ 10.
ImportedSentence one_phoneme(int frames);

// Moves both lips so that the aperture of frame k is this, in mm.
void set_aperture(FrameMatrix& frames, const std::function<double(int)>& aperture_mm);

// A sentence of several phonemes, closures and contacts among them, that moves everywhere; other
// numbers for each `seed`. And a synthesis of it that errs everywhere.
ImportedSentence moving_sentence(int seed);
FrameMatrix erring_synthesis(const ImportedSentence& sentence, int seed, double error_mm);

} // namespace phonomime::test
