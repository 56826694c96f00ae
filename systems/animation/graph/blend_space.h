#pragma once

#include "ecs/base/math.h"
#include "ecs/components/motion_graph.h"

#include <array>
#include <span>

namespace limn {

/// Weights of the clips of a state, >= 0, sum 1; 0 beyond its number of clips.
using ClipWeights = std::array<float, kMaxGraphClips>;

/// Weights of clips at a point between them. In one dimension (`is_plane` false: only x counts)
/// linear between neighbors, clamped at the ends. In two, gradient band interpolation: each clip's
/// influence is the smallest of 1 - (p - a).(b - a) / |b - a|^2 over all others, normalized (R. S.
/// Johansen, "Automated Semi-Procedural Animation for Character Locomotion", 2009, ch. 6). Both
/// give a clip alone at its own point. Clips at the same point share the weight there.
[[nodiscard]] ClipWeights
blend_weights(std::span<const GraphClip> clips, bool is_plane, const Vec2& point);

/// The same for a state and the character's parameters.
[[nodiscard]] ClipWeights blend_weights(const GraphState& state, const MotionGraph& graph);

/// Index of the clip with the largest weight, the first of equal ones.
[[nodiscard]] std::size_t heaviest(const ClipWeights& weights);

}  // namespace limn
