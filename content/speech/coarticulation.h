#pragma once

#include <span>

namespace limn {

// Coarticulation by dominance functions (face.dominance): M. Cohen and D. Massaro, "Modeling
// Coarticulation in Synthetic Visual Speech", 1993. Each sound s pulls a parameter of the mouth to
// its target T_s, most at its center c_s; the parameter is the mean of the targets, weighted by
//
//     D_s(t) = a_s exp(-theta_s |t - c_s|^p),
//
// so that dominant sounds reach their targets and weak ones only approach them.

/// One sound's pull on one parameter.
struct DominanceTarget {
    float center = 0.0f;    ///< c [s]
    float target = 0.0f;    ///< T
    float strength = 1.0f;  ///< a, > 0
    float before = 10.0f;   ///< theta where t < c [1/s], > 0
    float after = 10.0f;    ///< theta where t > c [1/s], > 0
    float power = 1.0f;     ///< p, > 0
};

/// The parameter at `time` [s]; `rest` where the dominance of all targets vanishes, or without
/// targets. Otherwise always between the smallest and the largest target.
[[nodiscard]] float
blend_targets(std::span<const DominanceTarget> targets, float time, float rest = 0.0f);

}  // namespace limn
