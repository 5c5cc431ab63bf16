// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include <Eigen/Core>

namespace phonomime {

// What the database keeps of a speaker's style models. What the parts mean, whether they fit each
// other and whether they still belong to the recordings is for whoever made them to say.
struct StoredStyleModel {
  std::string speaker;
  std::string made_of;      // fingerprint of the sentences, the layout and the PCA
  std::string trained_json; // options, styles, what was trained on, what came of it
  std::map<std::string, Eigen::MatrixXd> matrices; // by name, none empty
};

} // namespace phonomime
