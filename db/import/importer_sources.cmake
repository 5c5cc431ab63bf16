# SPDX-License-Identifier: GPL-3.0-or-later
set(importer_sources
  channels.cpp gaps.cpp head.cpp nodes.cpp pca.cpp resample.cpp)
set(importer_links OpenMP::OpenMP_CXX)
