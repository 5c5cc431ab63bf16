# SPDX-License-Identifier: GPL-3.0-or-later
set(importer_sources
  channels.cpp corpus.cpp corpus_path.cpp gaps.cpp head.cpp head_scale.cpp nodes.cpp normalise.cpp pca.cpp
  prepare.cpp recorded_faults.cpp recording.cpp reference_pose.cpp report.cpp resample.cpp sentence_table.cpp survey.cpp)
set(importer_links phonomime_curation)
