#pragma once

#include "render/light_clusters.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace limn::oracle {

// The light clusters without cleverness and in double precision: every light against every point
// or every cell. What the lists that compute shaders make are held against.

using DVec3 = glm::dvec3;

/// Whether the light reaches the point: nearer than its radius, within its cone.
[[nodiscard]] bool reaches(const LightReach& light, const DVec3& point);

/// For every cell the lights whose sphere meets the box around the cell in view space, `slack` of
/// the radius wider; numbered from 0, in order. Lists of point lights may hold no others.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> brute_force_lists(
    const RenderView& view, const ClusterShape& shape, std::span<const LightReach> lights,
    double slack);

}  // namespace limn::oracle
