// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Marks a kernel that is compiled for plain x86-64 and for AVX2, chosen once at load time. Both
// give the same bytes: the order of every sum is fixed in the source and nothing is fused. The
// sanitizers' start-up does not survive such a choice, so that they run the plain kernel.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PHONOMIME_DISPATCHED __attribute__((target_clones("default", "avx2")))
#else
#define PHONOMIME_DISPATCHED
#endif
