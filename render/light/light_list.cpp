#include "render/light/light_list.h"

#include "ecs/components/light_map.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/render_view.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: engine.light-object, engine.periodic, light.directional, light.point, shade.noise

namespace limn {
namespace {

/// With Falloff::None the multiplier makes the window a step at the radius.
constexpr float kStep = 1e30f;
/// Minimum difference of the two cones' cosines (or angles): equal cones have a hard edge
/// (light.spot-falloff).
constexpr float kMinConeWidth = 1e-4f;

Vec3 position_of(const Affine& a) {
    return {a.row[0].w, a.row[1].w, a.row[2].w};
}

/// Local -z, the direction of spot and directional lights.
Vec3 axis_of(const Affine& a) {
    return normalize_or({-a.row[0].z, -a.row[1].z, -a.row[2].z}, {0, 0, -1});
}

/// Whether nothing in it is negative, NaN or infinite.
bool is_valid(const layout::LightRecord& r) {
    float sum = 0;
    for (const Vec4* v : {&r.position, &r.color, &r.polynomial, &r.axis}) {
        sum += v->x + v->y + v->z + v->w;
    }
    return std::isfinite(sum) && r.color.x >= 0 && r.color.y >= 0 && r.color.z >= 0;
}

float power_of(const PointLight& light) {
    return light.intensity;
}
float power_of(const SpotLight& light) {
    return light.intensity;
}
float power_of(const DirectionalLight& light) {
    return light.illuminance;
}

/// Regardless of its pulse, so that the shaders of a frame do not change with it.
template <typename Light>
bool is_on(const Light& light) {
    return light.enabled && light.color * power_of(light) != Vec3(0);
}

void set_attenuation(layout::LightRecord& record, const Attenuation& attenuation, float radius) {
    record.position.w = std::isnan(radius) ? radius : radius > 0 ? 1 / square(radius) : 0;
    switch (attenuation.falloff) {
    case Falloff::InverseSquare:
        record.polynomial = {0, 0, 1, 0};
        break;
    case Falloff::Polynomial:
        record.polynomial = {attenuation.constant, attenuation.linear, attenuation.quadratic, 0};
        break;
    case Falloff::Smooth:
        record.polynomial = {1, 0, 0, 0};
        record.color.w = std::max(attenuation.multiplier, 1.0f);
        break;
    case Falloff::None:
        record.polynomial = {1, 0, 0, 0};
        record.color.w = kStep;
        break;
    }
}

float light_radius(const layout::LightRecord& record) {
    return record.position.w > 0 ? 1 / std::sqrt(record.position.w) : INFINITY;
}

/// The components that accompany a light of any type.
struct LightEntity {
    Entity entity;
    const Affine& pose;
    float factor;  ///< on its intensity
    const Shadow* shadow;
    const Projector* projector;
};

/// Calls use(light, LightEntity) for every light of a type that is on, or for all.
template <typename Light, typename Use>
void each_light(const World& world, double time, float alpha, bool all, Use&& use) {
    const auto* const jumps = world.find_resource<StepJumps>();
    world
        .query<
            const Light, const WorldTransform, Optional<const PreviousWorldTransform>,
            Optional<const LightPulse>, Optional<const Shadow>, Optional<const Projector>,
            Without<BakedLight>>()
        .each([&](Entity entity, const Light& light, const WorldTransform& now,
                  const PreviousWorldTransform* before, const LightPulse* pulse,
                  const Shadow* shadow, const Projector* projector) {
            if (all || is_on(light)) {
                const Affine world_from_light =
                    world_at(jumps, entity, now, before, {alpha, alpha});
                const float factor = pulse != nullptr ? pulse_factor(*pulse, time) : 1.0f;
                Light shown = light;
                if (pulse != nullptr) {
                    shown.color = pulse_color(*pulse, light.color, time);
                }
                use(shown, LightEntity{entity, world_from_light, factor, shadow, projector});
            }
        });
}

/// Registers the shadow and the cookie of the record added last, if it has them.
void add_extras(
    LightList& list, const LightEntity& light, LightKind kind, float radius = INFINITY,
    float outer_angle = 0) {
    if (light.shadow != nullptr) {
        list.shadowed.push_back(
            {static_cast<std::uint32_t>(list.records.size() - 1),
             light.entity,
             kind,
             *light.shadow,
             position_of(light.pose),
             axis_of(light.pose),
             {light.pose.row[0].x, light.pose.row[1].x, light.pose.row[2].x},
             radius,
             outer_angle,
             false});
    }
    if (light.projector != nullptr && kind != LightKind::Point) {
        list.projecting.push_back(
            {static_cast<std::uint32_t>(list.records.size() - 1), kind, *light.projector,
             light.pose});
    }
}

}  // namespace

float pulse_factor(const LightPulse& pulse, double time) {
    return std::max(0.0f, evaluate(pulse.function, time));
}

Vec3 pulse_color(const LightPulse& pulse, const Vec3& color, double time) {
    return color + (pulse.color - color) * evaluate_share(pulse.color_function, time);
}

layout::LightRecord make_record(const PointLight& light, const Vec3& position, float factor) {
    layout::LightRecord record{};
    record.position = Vec4(position, 0);
    record.color = Vec4(light.color * (light.intensity * factor), 0);
    record.axis = {0, 0, 0, 1};  // offset 1: omnidirectional
    set_attenuation(record, light.attenuation, light.radius);
    return record;
}

layout::LightRecord
make_record(const SpotLight& light, const Vec3& position, const Vec3& axis, float factor) {
    layout::LightRecord record{};
    record.position = Vec4(position, 0);
    record.color = Vec4(light.color * (light.intensity * factor), 0);
    set_attenuation(record, light.attenuation, light.radius);
    const float outer = std::clamp(light.outer_angle, 0.0f, 0.5f * kPi);
    const float inner = std::clamp(light.inner_angle, 0.0f, outer);
    record.polynomial.w = static_cast<float>(light.profile);
    if (light.profile == SpotProfile::LinearAngle) {
        const float scale = 1 / std::max(outer - inner, kMinConeWidth);
        record.axis = Vec4(axis * scale, outer * scale);
    } else {
        const float scale = 1 / std::max(std::cos(inner) - std::cos(outer), kMinConeWidth);
        record.axis = Vec4(axis * scale, -std::cos(outer) * scale);
    }
    return record;
}

layout::LightRecord make_record(const DirectionalLight& light, const Vec3& axis, float factor) {
    layout::LightRecord record{};
    record.position = Vec4(-axis, 0);
    record.color = Vec4(light.color * (light.illuminance * factor), 0);
    record.axis = {0, 0, 0, 1};
    return record;
}

void collect_lights(const World& world, float alpha, LightList& list, bool all) {
    list.records.clear();
    list.ranges.clear();
    list.shadowed.clear();
    list.projecting.clear();
    list.points = 0;
    list.spots = 0;
    list.sun_color = Vec3(0);
    list.spot_angles = false;
    list.linear_fade = false;
    list.shadows = false;
    const auto* frame = world.find_resource<FrameTime>();
    const double time =
        frame == nullptr ? 0.0 : frame->time - (1.0 - alpha) * static_cast<double>(frame->step);
    list.time = time;

    each_light<DirectionalLight>(
        world, time, alpha, all, [&](const DirectionalLight& light, const LightEntity& entity) {
            const layout::LightRecord record =
                make_record(light, axis_of(entity.pose), entity.factor);
            if (is_valid(record)) {
                if (list.records.empty()) {
                    list.sun_direction = Vec3(record.position);
                    list.sun_color = Vec3(record.color);
                }
                list.records.push_back(record);
                add_extras(list, entity, LightKind::Directional);
            }
        });
    list.directional = static_cast<int>(list.records.size());

    add_particle_lights(world, (1.0f - alpha) * (frame == nullptr ? 0 : frame->step), list);

    // Lights with a shadow or a cookie come last, so that shaders test only those for them.
    for (const bool last : {false, true}) {
        list.first_shadowed = static_cast<int>(list.records.size());
        each_light<PointLight>(
            world, time, alpha, all, [&](const PointLight& light, const LightEntity& entity) {
                const layout::LightRecord record =
                    make_record(light, position_of(entity.pose), entity.factor);
                if (is_valid(record) && last == (entity.shadow != nullptr)) {
                    list.linear_fade = list.linear_fade || record.polynomial.y != 0;
                    list.records.push_back(record);
                    list.ranges.push_back({position_of(entity.pose), light_radius(record)});
                    add_extras(list, entity, LightKind::Point, light_radius(record));
                    ++list.points;
                }
            });
        each_light<SpotLight>(
            world, time, alpha, all, [&](const SpotLight& light, const LightEntity& entity) {
                const layout::LightRecord record = make_record(
                    light, position_of(entity.pose), axis_of(entity.pose), entity.factor);
                if (is_valid(record)
                    && last == (entity.shadow != nullptr || entity.projector != nullptr)) {
                    list.linear_fade = list.linear_fade || record.polynomial.y != 0;
                    list.spot_angles =
                        list.spot_angles || light.profile == SpotProfile::LinearAngle;
                    list.records.push_back(record);
                    list.ranges.push_back(
                        {position_of(entity.pose), light_radius(record), axis_of(entity.pose),
                         std::cos(std::clamp(light.outer_angle, 0.0f, 0.5f * kPi))});
                    add_extras(
                        list, entity, LightKind::Spot, light_radius(record), light.outer_angle);
                    ++list.spots;
                }
            });
    }
}

void add_particle_lights(const World& world, float back, LightList& list) {
    world.query<const ParticleLight, const ParticlePool>().each(
        [&](const ParticleLight& light, const ParticlePool& pool) {
            const auto add = [&](const Vec3& position, float factor) {
                const PointLight one = {
                    .color = light.color, .intensity = light.intensity, .radius = light.radius};
                const layout::LightRecord record = make_record(one, position, factor);
                if (is_valid(record)) {
                    list.records.push_back(record);
                    list.ranges.push_back({position, light_radius(record)});
                    ++list.points;
                }
            };
            const auto lit = static_cast<std::uint32_t>(light.share * 65536.0f);
            std::uint32_t count = 0;
            for (std::size_t i = 0; i < pool.size() && count < light.count; ++i) {
                const float age = pool.age[i] - back;
                if ((pool.look[i] & 0xffff) >= lit || age < 0) {
                    continue;
                }
                const Vec3 velocity = {pool.vx[i], pool.vy[i], pool.vz[i]};
                const float relative_age = age / std::max(pool.life[i], 1e-6f);
                add(Vec3(pool.x[i], pool.y[i], pool.z[i]) - velocity * back,
                    sample_curve(light.curve, std::min(relative_age, 1.0f)));
                ++count;
            }
            if (count == 0) {
                add(Vec3(0), 0);  // keeps the loop over lights in the shaders
            }
        });
}

bool any_light_off(const World& world) {
    bool off = false;
    const auto look = [&off](const auto& light) { off = off || !is_on(light); };
    world.query<const PointLight>().each([&](const PointLight& light) { look(light); });
    world.query<const SpotLight>().each([&](const SpotLight& light) { look(light); });
    world.query<const DirectionalLight>().each([&](const DirectionalLight& light) { look(light); });
    return off;
}

}  // namespace limn
