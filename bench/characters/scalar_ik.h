#pragma once

#include <cstddef>

namespace limn::bench {

// Inverse kinematics as people write it by hand, one chain after another: what `limn bench
// characters` compares with. Points are three floats, rotations four (x y z w).

/// Law of cosines without trigonometry, the knee, two shortest arcs. `points`: root, middle, tip,
/// target and pole of each limb; `rotations`: of the upper and the lower link.
void two_links_by_hand(const float* points, std::size_t count, float* rotations);

/// One shortest arc from each `forward` to `wanted`.
void aim_by_hand(const float* forward, const float* wanted, std::size_t count, float* rotations);

/// Chains of `links` bones: `points` of each, links + 1 of them, are moved in place.
void dls_by_hand(
    float* points, const float* goals, std::size_t count, int links, int iterations, float damping);
void fabrik_by_hand(
    float* points, const float* goals, std::size_t count, int links, int iterations);
void ccd_by_hand(float* points, const float* goals, std::size_t count, int links, int iterations);

}  // namespace limn::bench
