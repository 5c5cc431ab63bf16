# SPDX-License-Identifier: GPL-3.0-or-later
phonomime_test(readers_test
  SOURCES
    readers/c3d_test.cpp
    readers/c3d_writer.cpp
    readers/csv_test.cpp
    readers/detection_test.cpp
    readers/label_test.cpp
    readers/live_link_test.cpp
    readers/mutation_test.cpp
    readers/reference_test.cpp
    readers/textgrid_test.cpp
  LINKS phonomime_import
  LABELS asan)
