#pragma once

#include "ecs/commands.h"
#include "ecs/components/height_field.h"
#include "ecs/components/time.h"
#include "ecs/components/water_noise.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Perlin's 3D noise (2002): 0 at integer points, twice differentiable, absolute value at most
/// 1.04. Equals ecs/base/gradient_noise.h, which has the same twelve gradients, in Perlin's scale.
[[nodiscard]] float perlin_noise(const Vec3& at, std::uint32_t seed);

/// The sum of all octaves at (x, z) in the surface's local space at `time` [s]. 0 if not finite.
[[nodiscard]] float noise_height(const NoiseSurface& noise, const Vec2& at, double time);

/// Fills `field`, reusing its memory. Normals are from central differences between points.
void fill_noise_field(const NoiseSurface& noise, double time, HeightField& field);

/// Adds a HeightField to every NoiseSurface that lacks one. Before update_noise_surfaces, with a
/// sync point in between.
void add_noise_fields(Query<const NoiseSurface, Without<HeightField>> bare, Commands commands);

/// Fills all fields for the time at the end of the step.
void update_noise_surfaces(
    Query<const NoiseSurface, HeightField> surfaces, Res<const FrameTime> time);

}  // namespace limn
