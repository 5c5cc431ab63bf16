// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phonomime {

// The shape of ARKit (into kLiveLinkColumns, below kArkitShapeCount) that a name means: in any
// case, `_` and `-` passed over, left and right as `Left`, `_L` or `_l` at the end
// (`browDown_L` = BrowDownLeft). A half of a shape that ARKit has whole is that shape
// (`browInnerUp_L`, `cheekPuff_R`). Nothing for other names.
std::optional<std::size_t> arkit_shape(std::string_view name);

// Which of `targets` a shape stands for: the one of its name; else those of the same name when
// case, `_` and `-` are passed over; else those that mean the same shape of ARKit (two halves of
// one, or the whole of a half). Into `targets`; empty where there is none.
std::vector<std::size_t> matching_shapes(std::string_view name,
                                         std::span<const std::string> targets);

} // namespace phonomime
