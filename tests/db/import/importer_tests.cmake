# SPDX-License-Identifier: GPL-3.0-or-later
set(importer_tests_folder ${CMAKE_CURRENT_LIST_DIR}/importer)
phonomime_test(importer_test
  SOURCES
    ${importer_tests_folder}/channels_test.cpp
    ${importer_tests_folder}/corpus_test.cpp
    ${importer_tests_folder}/gaps_test.cpp
    ${importer_tests_folder}/head_test.cpp
    ${importer_tests_folder}/nodes_test.cpp
    ${importer_tests_folder}/pca_test.cpp
    ${importer_tests_folder}/resample_test.cpp
  LINKS phonomime_import
  LABELS tsan)
# Whole imports of made corpora. Of tools/app only what imports: the thread sanitizer's build needs
# nothing of synth/ for it.
phonomime_test(import_corpus_test
  SOURCES
    ${importer_tests_folder}/import_corpus_test.cpp
    ${importer_tests_folder}/import_faults_test.cpp
    ${PROJECT_SOURCE_DIR}/tools/app/find_suspects.cpp
    ${PROJECT_SOURCE_DIR}/tools/app/import_corpus.cpp
  LINKS phonomime_store phonomime_import
  LABELS tsan)
phonomime_test(import_recordings_test
  SOURCES ${importer_tests_folder}/import_recordings_test.cpp
  LINKS phonomime_app)
