#pragma once

namespace limn {

inline constexpr double kGravity = 9.81;  ///< acceleration of falling bodies [m/s^2]

}  // namespace limn
