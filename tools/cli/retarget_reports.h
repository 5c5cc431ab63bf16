// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/app/retarget_apply.h"
#include "tools/app/retarget_list.h"
#include "tools/app/retarget_references.h"

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

} // namespace phonomime
