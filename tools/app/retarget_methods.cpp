// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/retarget_source.h"

#include "db/types/errors.h"

namespace phonomime {

namespace {

[[noreturn]] void refuse(const char* method) {
  throw UsageError({.where = "--method",
                    .what = std::string("there is no ") + method + " in this build yet",
                    .expected = "weights or fit"});
}

} // namespace

RetargetedWeights retarget_by_pairs(const RetargetSource&, bool equations, const Progress&) {
  refuse(equations ? "equations" : "cross");
}

RetargetedWeights retarget_by_keyshapes(const RetargetSource&, const Progress&) {
  refuse("keyshapes");
}

} // namespace phonomime
