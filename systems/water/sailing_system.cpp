#include "systems/water/sailing_system.h"

#include "ecs/base/jobs.h"
#include "ecs/base/rotation.h"
#include "ecs/components/camera.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/weather.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "systems/water/sailboat.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace limn {
namespace {

constexpr std::size_t kGrain = 2;    ///< boats a task
constexpr float kRudderRate = 1.8f;  ///< [1/s] that a hand turns it; all by eye
constexpr float kSheetRate = 0.45f;  ///< [1/s] that a hand hauls
constexpr float kFillRate = 5.0f;    ///< [1/s] at which a sail fills
constexpr float kFillWind = 1.5f;    ///< [m/s] of wind across it that fills it
constexpr float kFlattest = 0.08f;   ///< a sail is never a plane

struct Sailing {
    Sailboat* boat = nullptr;
    const WaterTouch* touch = nullptr;
    Floating* floating = nullptr;
    const Transform* transform = nullptr;
    bool steered = false;
};

float toward(float from, float to, float most) {
    return from + std::clamp(to - from, -most, most);
}

/// Of the level; none where it has no weather.
Vec3 wind_of(const World& world) {
    const auto* weather = world.find_resource<Weather>();
    return weather != nullptr ? weather->wind() : Vec3(0);
}

}  // namespace

void steer_sailboat(const Input& input, float step, Sailboat& boat) {
    boat.rudder = toward(boat.rudder, std::clamp(input.move.x, -1.0f, 1.0f), kRudderRate * step);
    if (input.move.z != 0) {
        boat.trims_itself = false;
        boat.sheet = std::clamp(boat.sheet - input.move.z * kSheetRate * step, 0.0f, 1.0f);
    }
    boat.trims_itself = boat.trims_itself || input.fast;
}

void update_sailboats(World& world) {
    const World& settings = world;
    const auto* input = settings.find_resource<Input>();
    const auto* assets = settings.find_resource<Assets>();
    const auto* time = settings.find_resource<FrameTime>();
    if (input == nullptr || assets == nullptr || time == nullptr) {
        return;
    }
    const auto boats =
        world.query<Sailboat, const WaterTouch, Floating, const Transform, Without<Parent>>();
    std::vector<Sailing> sailing;
    boats.each([&](Sailboat& boat, const WaterTouch& touch, Floating& floating,
                   const Transform& transform) {
        const auto* camera = settings.find<Camera>(boat.camera);
        const bool listens = boat.player && (camera == nullptr || camera->active);
        const bool any = input->move.x != 0 || input->move.z != 0 || input->fast;
        boat.taken = boat.taken || (listens && any);
        sailing.push_back({&boat, &touch, &floating, &transform, listens && boat.taken});
    });
    if (sailing.empty()) {
        return;
    }
    std::vector<WaterSurface> surfaces;
    const auto waters = world.query<
        const Water, const WorldTransform, Optional<const OceanState>, Optional<const WaveTable>,
        Optional<const RippleState>>();
    waters.each([&](const Water& water, const WorldTransform& place, const OceanState* ocean,
                    const WaveTable* waves, const RippleState* ripples) {
        surfaces.push_back({water_frame(place.world), water, ocean, waves, ripples});
    });
    const Vec3 wind = wind_of(world);
    parallel_for(sailing.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Sailboat& boat = *sailing[i].boat;
            const WaterTouch& touch = *sailing[i].touch;
            Floating& floating = *sailing[i].floating;
            const Transform& transform = *sailing[i].transform;
            if (sailing[i].steered) {
                steer_sailboat(*input, time->step, boat);
            } else if (boat.course.index < assets->paths.size()) {
                const PathData& course = assets->paths[boat.course.index];
                follow_course(course, touch, floating, transform, wind, boat);
            }
            if (boat.trims_itself) {
                trim_sail(
                    floating, unit_or_none(transform.rotation), transform.scale, wind, time->step,
                    boat);
            }
            step_sailboat(surfaces, wind, touch, transform, time->step, boat, floating);
        }
    });
}

void turn_booms(World& world) {
    const World& others = world;
    const auto* time = others.find_resource<FrameTime>();
    if (time == nullptr) {
        return;
    }
    const Vec3 wind = wind_of(world);
    std::vector<std::pair<Entity, const Transform*>> lookouts;
    world.query<Boom, Transform, const Parent>().each(
        [&](Boom& boom, Transform& transform, const Parent& parent) {
            const auto* boat = others.find<Sailboat>(parent.entity);
            const auto* floating = others.find<Floating>(parent.entity);
            const auto* hull = others.find<Transform>(parent.entity);
            if (boat == nullptr || floating == nullptr || hull == nullptr) {
                return;
            }
            const Quat rotation = unit_or_none(hull->rotation);
            const float blows = apparent_wind_angle(*boat, *floating, rotation, hull->scale, wind);
            const float across = glm::length(wind) * std::sin(blows - boat->boom);
            const float fills = std::clamp(across / kFillWind, -1.0f, 1.0f);
            boom.fullness += (fills - boom.fullness) * (1 - std::exp(-kFillRate * time->step));
            boom.fullness = std::isfinite(boom.fullness) ? boom.fullness : 0.0f;
            // +x is to port of a boom that points astern, and so is a positive angle: -y turns -z
            // to +x.
            transform.rotation = rotation_about({0, 1, 0}, -boat->boom);
            transform.scale.x = boom.fullness < 0 ? std::min(boom.fullness, -kFlattest)
                                                  : std::max(boom.fullness, kFlattest);
        });
    world.query<const Sailboat, const Transform>().each(
        [&](const Sailboat& boat, const Transform& hull) {
            if (boat.lookout != Entity{}) {
                lookouts.push_back({boat.lookout, &hull});
            }
        });
    for (const auto& [lookout, hull] : lookouts) {
        if (auto* transform = world.find<Transform>(lookout)) {
            transform->position = hull->position;
            // +z toward heading `a`, which is from +x toward +z.
            const float heading = heading_of(unit_or_none(hull->rotation));
            transform->rotation = rotation_about({0, 1, 0}, 0.5f * kPi - heading);
        }
    }
}

}  // namespace limn
