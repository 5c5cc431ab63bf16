# SPDX-License-Identifier: GPL-3.0-or-later
list(APPEND app_sources import_corpus.cpp)
