// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/apply_rig.h"
#include "tools/app/choose_keyshapes.h"
#include "tools/app/retarget_apply.h"
#include "tools/app/retarget_list.h"
#include "tools/app/retarget_references.h"

namespace phonomime {

// What the words of `phonomime retarget ...` ask for.
struct RetargetListArguments {
  RetargetListOptions options;
};

struct RetargetApplyArguments {
  RetargetApplyOptions options;
};

struct RetargetReferencesArguments {
  RetargetReferencesOptions options;
};

// retarget keyshapes select
struct ChooseKeyshapesArguments {
  ChooseKeyshapesOptions options;
};

// retarget keyshapes apply
struct ApplyRigArguments {
  ApplyRigOptions options;
};

} // namespace phonomime
