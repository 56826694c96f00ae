#pragma once

#include "ecs/base/math.h"
#include "ecs/components/light.h"
#include "ecs/components/projector.h"
#include "ecs/components/shadow.h"
#include "ecs/entity.h"
#include "render/shaders/light_gpu.h"

#include <vector>

namespace limn {

class World;

// The world's lights as one packed array, directional lights first, then point lights, then spots,
// then point lights and spots that cast shadows or throw images, each in world order: what shaders
// loop over without asking for types. Disabled, black and broken (not finite) lights are left out,
// LightPulse is applied. Bench/oracles/light_oracle.h has the formulas.

/// Where a point or spot light reaches: a sphere, for spots cut to a cone.
struct LightReach {
    Vec3 center;            ///< [m]
    float radius = 0;       ///< [m]; INFINITY: everywhere
    Vec3 axis = {0, 0, 0};  ///< of a spot, unit; 0: all around
    float cosine = -1;      ///< of the cone's half angle
};

enum class LightKind : std::uint8_t { Directional, Point, Spot };

/// A light that casts shadows.
struct ShadowedLight {
    std::uint32_t record = 0;  ///< index into LightList::records
    Entity entity;
    LightKind kind = LightKind::Point;
    Shadow settings;
    Vec3 position = {0, 0, 0};  ///< of a directional light: nothing
    Vec3 axis = {0, 0, -1};     ///< where it shines, unit; of a point light: nothing
    Vec3 right = {1, 0, 0};     ///< of the light's entity
    float radius = INFINITY;    ///< [m]
    float outer_angle = 0;      ///< of a spot [rad]
    bool for_volumes = false;   ///< its map is looked up to find where volumes count, not to light
};

/// A spot or directional light that throws an image.
struct ProjectingLight {
    std::uint32_t record = 0;  ///< index into LightList::records
    LightKind kind = LightKind::Spot;
    Projector projector;
    Affine pose;
};

struct LightList {
    std::vector<layout::LightRecord> records;
    std::vector<LightReach> reach;            ///< of the point and spot lights alone
    std::vector<ShadowedLight> shadowed;      ///< in the order of the records
    std::vector<ProjectingLight> projecting;  ///< in the order of the records
    double time = 0;                          ///< of the moment shown [s]
    int directional = 0;
    int points = 0;
    int spots = 0;
    int first_shadowed = 0;          ///< record from which on point lights and spots cast
                                     ///< shadows or throw images
    bool linear_fade = false;        ///< some polynomial has a linear term
    bool shadows = false;            ///< some record has a shadow; set by who draws them
    bool spot_angles = false;        ///< some spot has SpotProfile::LinearAngle
    Vec3 sun_direction = {0, 1, 0};  ///< toward the first directional light, unit
    Vec3 sun_color = {0, 0, 0};      ///< [lx]; black: there is none
};

/// Fills `list` from the entities with WorldTransform and a light; `alpha` as in RenderView.
void collect_lights(const World& world, float alpha, LightList& list);

/// What the pulse multiplies the intensity by at `time` [s] (engine.light-object), >= 0.
[[nodiscard]] float pulse_factor(const LightPulse& pulse, double time);

/// `factor` multiplies the intensity.
[[nodiscard]] layout::LightRecord
make_record(const PointLight& light, const Vec3& position, float factor = 1);
[[nodiscard]] layout::LightRecord
make_record(const SpotLight& light, const Vec3& position, const Vec3& axis, float factor = 1);
[[nodiscard]] layout::LightRecord
make_record(const DirectionalLight& light, const Vec3& axis, float factor = 1);

}  // namespace limn
