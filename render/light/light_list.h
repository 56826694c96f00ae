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

// The world's lights as one packed array that shaders loop over without testing types: directional
// lights first, then point lights, then spots, then point lights and spots that cast shadows or
// project cookies, each in world order. Disabled, black and broken (not finite) lights are left
// out, LightPulse is applied; a light that it turns black for a moment stays. Formulas:
// bench/oracles/light_oracle.h.

/// The range of a point or spot light: a sphere, for spots cut to a cone.
struct LightRange {
    Vec3 center;            ///< [m]
    float radius = 0;       ///< [m]; INFINITY: unbounded
    Vec3 axis = {0, 0, 0};  ///< of a spot, unit; 0: omnidirectional
    float cosine = -1;      ///< cosine of the cone's half angle
};

enum class LightKind : std::uint8_t { Directional, Point, Spot };

/// A light that casts shadows.
struct ShadowedLight {
    std::uint32_t record = 0;  ///< index into LightList::records
    Entity entity;
    LightKind kind = LightKind::Point;
    Shadow settings;
    Vec3 position = {0, 0, 0};  ///< unused for a directional light
    Vec3 axis = {0, 0, -1};     ///< direction of the light, unit; unused for a point light
    Vec3 right = {1, 0, 0};     ///< x axis of the light's entity
    float radius = INFINITY;    ///< [m]
    float outer_angle = 0;      ///< of a spot [rad]
    bool for_volumes = false;   ///< its map only finds where volumes are counted
};

/// A spot or directional light that projects a cookie (Projector).
struct ProjectingLight {
    std::uint32_t record = 0;  ///< index into LightList::records
    LightKind kind = LightKind::Spot;
    Projector projector;
    Affine pose;
};

struct LightList {
    std::vector<layout::LightRecord> records;
    std::vector<LightRange> reach;            ///< of the point and spot lights only
    std::vector<ShadowedLight> shadowed;      ///< in the order of the records
    std::vector<ProjectingLight> projecting;  ///< in the order of the records
    double time = 0;                          ///< time shown [s]
    int directional = 0;
    int points = 0;
    int spots = 0;
    int first_shadowed = 0;          ///< first record of the point lights and spots that
                                     ///< cast shadows or project cookies
    bool linear_fade = false;        ///< some polynomial has a linear term
    bool shadows = false;            ///< some record has a shadow; set by the shadow collectors
    bool spot_angles = false;        ///< some spot has SpotProfile::LinearAngle
    Vec3 sun_direction = {0, 1, 0};  ///< toward the first directional light, unit
    Vec3 sun_color = {0, 0, 0};      ///< [lx]; black: no sun
};

/// Fills `list` from the entities with WorldTransform and a light; `alpha` as in RenderView. With
/// `all` lights also from those that are off.
void collect_lights(const World& world, float alpha, LightList& list, bool all = false);

/// Appends a point light for every particle of a ParticleLight, where it is `back` seconds before
/// the end of the step.
void add_particle_lights(const World& world, float back, LightList& list);

/// Whether some light is off: disabled or black.
[[nodiscard]] bool any_light_off(const World& world);

/// Factor on the intensity at `time` [s] (engine.light-object), >= 0.
[[nodiscard]] float pulse_factor(const LightPulse& pulse, double time);
/// Color of a light of this `color` at `time` [s].
[[nodiscard]] Vec3 pulse_color(const LightPulse& pulse, const Vec3& color, double time);

/// `factor` multiplies the intensity.
[[nodiscard]] layout::LightRecord
make_record(const PointLight& light, const Vec3& position, float factor = 1);
[[nodiscard]] layout::LightRecord
make_record(const SpotLight& light, const Vec3& position, const Vec3& axis, float factor = 1);
[[nodiscard]] layout::LightRecord
make_record(const DirectionalLight& light, const Vec3& axis, float factor = 1);

}  // namespace limn
