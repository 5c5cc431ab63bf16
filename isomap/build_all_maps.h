// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/progress.h"
#include "isomap/isomap.h"
#include "isomap/phoneme_cluster.h"

#include <cstddef>
#include <functional>
#include <span>

namespace phonomime {

// Makes the maps of every cluster as build_maps does, the larger ones with all threads, the smaller
// ones side by side. `take` gets the maps of clusters[i] as soon as they are made, one at a time,
// in any order; what it was given depends on neither threads nor order. Progress counts frames.
// Where `take` throws, or a stop is asked for, no further cluster begins, and that is thrown.
void build_all_maps(std::span<const PhonemeCluster> clusters, const IsomapOptions& options,
                    const Progress& progress,
                    const std::function<void(std::size_t i, ClusterMaps&& maps)>& take);

} // namespace phonomime
