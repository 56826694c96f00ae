#pragma once

#include "ecs/commands.h"
#include "ecs/components/time.h"
#include "ecs/components/water_noise.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Perlin's noise of three coordinates (2002): 0 at integer points, twice differentiable, never
/// beyond 1.04. That of ecs/base/gradient_noise.h, which has the same twelve gradients, in his
/// scale.
[[nodiscard]] float perlin_noise(const Vec3& at, std::uint32_t seed);

/// The sum of all octaves at (x, z) in the surface's own space at `time` [s]. 0 where a number is
/// not finite.
[[nodiscard]] float noise_height(const NoiseSurface& noise, const Vec2& at, double time);

/// Fills `field`, keeping its memory. Normals are those of central differences between points.
void fill_noise_field(const NoiseSurface& noise, double time, NoiseField& field);

/// Gives a NoiseField to every NoiseSurface that lacks one. Before update_noise_surfaces, with a
/// sync point between.
void add_noise_fields(Query<const NoiseSurface, Without<NoiseField>> bare, Commands commands);

/// Fills all fields for the end of the step.
void update_noise_surfaces(
    Query<const NoiseSurface, NoiseField> surfaces, Res<const FrameTime> time);

}  // namespace limn
