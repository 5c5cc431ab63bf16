// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/apply_rig.h"
#include "tools/app/choose_keyshapes.h"
#include "tools/app/retarget_apply.h"
#include "tools/app/retarget_list.h"
#include "tools/app/retarget_references.h"

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace phonomime {

// What the verbs of `phonomime retarget` print: as JSON, and for people.
nlohmann::ordered_json face_offer_json(const FaceOffer& offer);
std::string face_offer_text(const FaceOffer& offer);

nlohmann::ordered_json retarget_json(const RetargetReport& report);
std::string retarget_text(const RetargetReport& report);

nlohmann::ordered_json references_json(const ReferencesReport& report);
std::string references_text(const ReferencesReport& report);

nlohmann::ordered_json keyshapes_json(const ChooseKeyshapesReport& report);
std::string keyshapes_text(const ChooseKeyshapesReport& report,
                           const std::filesystem::path& folder);

nlohmann::ordered_json rig_json(const ApplyRigReport& report);
std::string rig_text(const ApplyRigReport& report);

} // namespace phonomime
