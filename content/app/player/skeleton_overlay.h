#pragma once

#include "content/app/player/skeleton_view.h"

#include <cstdint>
#include <vector>

namespace limn {

struct PoseGizmo;
struct RenderView;

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
