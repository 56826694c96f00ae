#pragma once

#include "ecs/base/math.h"

#include <cstddef>
#include <vector>

namespace limn {

// Inverse kinematics of thousands of chains at once: one chain per lane of a vector (Highway,
// dispatched at run time), and the same operations one chain after the other, `_scalar`: both have
// the same bits on every machine, without fused multiply-add and libm. Chains are points in arrays
// per coordinate; bones keep their lengths. Rotations of joints are the shortest arcs between
// bones before and after.
// Techniques: char.ik-ccd, char.ik-pinv, char.ik-two-link

/// Vectors in arrays per component.
struct Vec3Lanes {
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> z;

    void resize(std::size_t count) {
        x.resize(count);
        y.resize(count);
        z.resize(count);
    }
    [[nodiscard]] std::size_t size() const { return x.size(); }
    void set(std::size_t i, const Vec3& v) {
        x[i] = v.x;
        y[i] = v.y;
        z[i] = v.z;
    }
    [[nodiscard]] Vec3 get(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Rotations in arrays per component.
struct QuatLanes {
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> z;
    std::vector<float> w;

    void resize(std::size_t count) {
        x.resize(count);
        y.resize(count);
        z.resize(count);
        w.resize(count);
    }
    [[nodiscard]] Quat get(std::size_t i) const { return {w[i], x[i], y[i], z[i]}; }
};

/// Limbs of two links with their targets; all lists have one entry per limb.
struct TwoLinkBatch {
    Vec3Lanes root;
    Vec3Lanes middle;
    Vec3Lanes tip;
    Vec3Lanes target;
    Vec3Lanes pole;   ///< where the middle should point, of any length
    QuatLanes upper;  ///< result: rotation of the upper link
    QuatLanes lower;  ///< result: of the lower link, after that of the upper one

    void resize(std::size_t count);
};

/// Turns both links by shortest arcs so that the tip is at the target, or as close as it gets, and
/// the middle lies toward the pole. Links of length 0 and targets at the root are defined: the
/// identity, or some direction.
void solve_two_links(TwoLinkBatch& batch);
void solve_two_links_scalar(TwoLinkBatch& batch);

/// Directions that are to point elsewhere.
struct AimBatch {
    Vec3Lanes forward;   ///< any length
    Vec3Lanes wanted;    ///< any length
    QuatLanes rotation;  ///< result: the shortest arc; half a turn about some axis if opposite

    void resize(std::size_t count);
};
void aim(AimBatch& batch);
void aim_scalar(AimBatch& batch);

/// Chains of `links` bones that turn freely.
struct ChainBatch {
    static constexpr std::size_t kMaxLinks = 16;

    std::size_t links = 7;
    std::size_t count = 0;  ///< chains
    Vec3Lanes points;       ///< point k of chain i at k * count + i; k = 0 is fixed
    Vec3Lanes goals;        ///< of the tips

    void resize(std::size_t new_links, std::size_t new_count);
};

struct ChainOptions {
    int iterations = 10;
    float damping = 0.1f;  ///< lambda of solve_chains_dls, relative to the length of the chain
};

/// Damped least squares: each iteration turns every joint i by r_i x y about its point, r_i being
/// the way from it to the tip, and (sum of |r_i|^2 I - r_i r_i^T + lambda^2 I) y = goal - tip.
void solve_chains_dls(ChainBatch& batch, const ChainOptions& options);
void solve_chains_dls_scalar(ChainBatch& batch, const ChainOptions& options);

/// Forward and backward reaching.
void solve_chains_fabrik(ChainBatch& batch, const ChainOptions& options);
void solve_chains_fabrik_scalar(ChainBatch& batch, const ChainOptions& options);

/// Cyclic coordinate descent; an iteration turns all joints from the tip to the root.
void solve_chains_ccd(ChainBatch& batch, const ChainOptions& options);
void solve_chains_ccd_scalar(ChainBatch& batch, const ChainOptions& options);

}  // namespace limn
