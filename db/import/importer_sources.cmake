# SPDX-License-Identifier: GPL-3.0-or-later
set(importer_sources
  channels.cpp corpus.cpp corpus_path.cpp gaps.cpp head.cpp head_scale.cpp log_histogram.cpp nodes.cpp pca.cpp
  prepare.cpp recording.cpp reference_pose.cpp report.cpp resample.cpp sentence_table.cpp suspect.cpp survey.cpp
  tab_table.cpp)
set(importer_links OpenMP::OpenMP_CXX)
