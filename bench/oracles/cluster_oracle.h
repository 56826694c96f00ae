#pragma once

#include "render/light/light_clusters.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace limn::oracle {

// The light clusters by brute force in double precision: every light against every point or every
// cell. The reference of the lists built by compute shaders.

using DVec3 = glm::dvec3;

/// Whether the light reaches the point: nearer than its radius, within its cone.
[[nodiscard]] bool reaches(const LightRange& light, const DVec3& point);

/// For every cell, the indices of the lights whose sphere, `slack` (relative to the radius) larger,
/// overlaps the cell's bounding box in view space, ascending. Lists of point lights must not
/// contain any others.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> brute_force_lists(
    const RenderView& view, const ClusterShape& shape, std::span<const LightRange> lights,
    double slack);

}  // namespace limn::oracle
