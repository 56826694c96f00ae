#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"
#include "ecs/components/wrinkle.h"
#include "systems/faces/wrinkle_batch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace limn::bench {

inline constexpr std::size_t kCrowd = 100;
inline constexpr std::size_t kIdentities = 4;  ///< as many as in the level crowd-of-faces

/// The pose of one face, and its deformed vertices.
struct CrowdMember {
    Pose pose;
    MorphWeights morphs;
    DeformerState deformers;
    std::vector<Vec3> markers;  ///< of the surface that moves the face by patches
    std::vector<Vec4> patches;
    std::vector<Vec3> deformed;
    std::vector<float> intensity;
};

/// A hundred copies of the generated head, each at another time of its expressions, and the rests
/// that measure its skin.
struct FaceCrowd {
    MeshData mesh;
    SkinData skin;
    MeshData markers;                 ///< the surface that moves the mesh by patches
    SurfaceBindingState on_markers;   ///< binding of the mesh to them
    std::vector<WrinkleRest> chord;   ///< one
    std::vector<WrinkleRest> strain;  ///< three
    std::vector<float> resting;       ///< shortening of the folds at rest of old faces
    std::vector<CrowdMember> members;
};

/// One crowd for all callers, with deformed members. Creating it takes seconds.
[[nodiscard]] FaceCrowd& face_crowd();

/// The first `count` members, each with another age.
[[nodiscard]] std::vector<CrowdFace> crowd_faces(FaceCrowd& crowd, std::size_t count);

/// Runs all deformers, like deform_positions.
void deform_crowd(FaceCrowd& crowd, std::size_t count);
/// The same by the scalar versions of all kernels.
void deform_crowd_scalar(FaceCrowd& crowd, std::size_t count);

/// Best times [ms] of two functions, run alternately so that other load affects both equally.
template <typename A, typename B>
std::pair<double, double> race(int repeats, A a, B b) {
    using Clock = std::chrono::steady_clock;
    std::pair<double, double> best = {INFINITY, INFINITY};
    const auto time_of = [](auto& run) {
        const auto begin = Clock::now();
        run();
        return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    };
    for (int i = 0; i < repeats; ++i) {
        best.first = std::min(best.first, time_of(a));
        best.second = std::min(best.second, time_of(b));
    }
    return best;
}

}  // namespace limn::bench
