// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/evaluate/method.h"

#include <memory>

namespace phonomime {

// One maker a file; what each does stands in the table of method.cpp and in docs/evaluation.md.
std::unique_ptr<Method> make_default(const MethodContext& context, const Progress& progress);
std::unique_ptr<Method> make_one_path(const MethodContext& context, const Progress& progress);
std::unique_ptr<Method> make_paper(const MethodContext& context, const Progress& progress);
std::unique_ptr<Method> make_mean_pose(const MethodContext& context, const Progress& progress);
std::unique_ptr<Method> make_viseme_keyframes(const MethodContext& context,
                                              const Progress& progress);
std::unique_ptr<Method> make_dominance(const MethodContext& context, const Progress& progress);
std::unique_ptr<Method> make_triphone(const MethodContext& context, const Progress& progress);
std::unique_ptr<Method> make_oracle(const MethodContext& context, const Progress& progress);

} // namespace phonomime
