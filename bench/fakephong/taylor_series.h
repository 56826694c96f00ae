#pragma once

#include "bench/fakephong/counted.h"

#include <array>

namespace limn::fakephong {

/// f + fx x + fy y + fxx x^2 / 2 + fxy x y + fyy y^2 / 2 of L.N / |N| with N = a x + b y + c, about
/// x = y = 0 (fakephong.taylor; G. Bishop and D. Weimer, "Fast Phong Shading", 1986): in this order
/// f, fx, fy, fxx, fxy, fyy. All zero where c is.
[[nodiscard]] std::array<Real, 6>
taylor_series(const Vec3r& l, const Vec3r& a, const Vec3r& b, const Vec3r& c);

}  // namespace limn::fakephong
