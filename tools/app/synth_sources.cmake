# SPDX-License-Identifier: GPL-3.0-or-later
list(APPEND app_sources synth.cpp synth_inputs.cpp synth_outputs.cpp)
