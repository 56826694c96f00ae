#pragma once

#include "content/app/player/skeleton_view.h"
#include "ecs/base/math.h"

#include <array>
#include <cstdint>
#include <vector>

namespace limn {

struct PoseGizmo;
struct RenderView;

// Colors of what is drawn, sRGB.
inline constexpr Vec3 kPastColor = {0.35f, 0.65f, 1.0f};
inline constexpr Vec3 kFutureColor = {1.0f, 0.5f, 0.35f};
inline constexpr Vec3 kLimitColor = {0.85f, 0.45f, 1.0f};
inline constexpr std::array<Vec3, 3> kAxisColors = {
    Vec3(1.0f, 0.3f, 0.3f), Vec3(0.35f, 0.9f, 0.35f), Vec3(0.4f, 0.6f, 1.0f)};

/// What is drawn over a character.
struct SkeletonOverlay {
    bool bones = true;
    bool names = false;
    bool axes = false;         ///< of joints: x red, y green, z blue
    bool limits = false;       ///< arcs from the least to the largest angle, and where it is
    int ghosts = 0;            ///< poses on each side of the present one
    float ghost_step = 0.15f;  ///< between them [s]
    float trail = 1.0f;        ///< of the trails, on each side [s]
    std::vector<std::uint16_t> trails;  ///< joints
    int selected = -1;                  ///< joint
};

/// Draws it behind the HUD's panels, without depth test.
void draw_skeleton_overlay(
    const RenderView& view, const CharacterView& character, const MotionHistory& history,
    const SkeletonOverlay& overlay);

/// The rings, the one of axis `held` bold; -1: none.
void draw_gizmo(const RenderView& view, const PoseGizmo& gizmo, int held);

}  // namespace limn
