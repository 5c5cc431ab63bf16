// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace phonomime {

// sin(pi x), exact at whole and half x, elsewhere to a few units of the last place. Made of
// additions and multiplications alone: the C library's sine takes another path on machines with
// fused multiply-add, and the same input must give the same bytes on every machine.
double sin_pi(double x);

} // namespace phonomime
