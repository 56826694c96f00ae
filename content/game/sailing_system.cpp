#include "content/game/sailing_system.h"

#include "content/game/sailboat.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {
namespace {

constexpr std::size_t kGrain = 2;      ///< boats per task
constexpr float kRudderRate = 1.8f;    ///< of manual steering [1/s]; all by eye
constexpr float kSheetRate = 0.45f;    ///< of manual trimming [1/s]
constexpr float kFillRate = 5.0f;      ///< at which a sail fills [1/s]
constexpr float kFillWind = 1.5f;      ///< crosswind that fills it completely [m/s]
constexpr float kMinFullness = 0.08f;  ///< a sail is never flat

struct Sailing {
    const Sailboat* boat = nullptr;
    SailboatState* state = nullptr;
    const WaterTouch* touch = nullptr;
    const Floating* floating = nullptr;
    FloatingState* motion = nullptr;
    const Transform* transform = nullptr;
    bool steered = false;
};

float toward(float from, float to, float most) {
    return from + std::clamp(to - from, -most, most);
}

/// Wind of the level; 0 without Weather.
Vec3 wind_of(const OptionalRes<const Weather>& weather, const WeatherState& state) {
    return weather ? current_weather(*weather, state).wind() : Vec3(0);
}

}  // namespace

void add_sailboat_states(Query<const Sailboat, Without<SailboatState>> boats, Commands commands) {
    boats.each([&](Entity entity, const Sailboat& boat) {
        commands.add(entity, SailboatState{.auto_trim = boat.auto_trim, .distance = boat.distance});
    });
}

Helm helm_of(const Input& input) {
    return {
        std::clamp(action_axis(input, "rudder_starboard", "rudder_port"), -1.0f, 1.0f),
        action_axis(input, "sheet_out", "sheet_in"), action_value(input, "auto_trim") > 0};
}

void steer_sailboat(const Helm& helm, float step, SailboatState& boat) {
    boat.rudder = toward(boat.rudder, helm.rudder, kRudderRate * step);
    if (helm.sheet != 0) {
        boat.auto_trim = false;
        boat.sheet = std::clamp(boat.sheet + helm.sheet * kSheetRate * step, 0.0f, 1.0f);
    }
    boat.auto_trim = boat.auto_trim || helm.auto_trim;
}

void update_sailboats(
    Query<
        const Sailboat, SailboatState, const WaterTouch, const Floating, FloatingState,
        const Transform, Without<Parent>>
        boats,
    WaterQuery waters, Query<const Camera> cameras, OptionalRes<const Weather> weather,
    Res<const WeatherState> weather_state, Res<const Assets> assets, Res<const Input> input,
    Res<const FrameTime> time) {
    const Helm helm = helm_of(*input);
    const bool any = helm.rudder != 0 || helm.sheet != 0 || helm.auto_trim;
    std::vector<Sailing> sailing;
    boats.each([&](const Sailboat& boat, SailboatState& state, const WaterTouch& touch,
                   const Floating& floating, FloatingState& motion, const Transform& transform) {
        const auto* camera = cameras.find<const Camera>(boat.camera);
        const bool listens = boat.player && (camera == nullptr || camera->active);
        state.player_active = state.player_active || (listens && any);
        sailing.push_back(
            {&boat, &state, &touch, &floating, &motion, &transform,
             listens && state.player_active});
    });
    if (sailing.empty()) {
        return;
    }
    const std::vector<WaterSurface> surfaces = collect_water_surfaces(waters);
    const Vec3 wind = wind_of(weather, *weather_state);
    const float step = time->step;
    parallel_for(sailing.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto& [boat, state, touch, floating, motion, transform, steered] = sailing[i];
            if (steered) {
                steer_sailboat(helm, step, *state);
            } else if (boat->course.index < assets->paths.size()) {
                const PathData& course = assets->paths[boat->course.index];
                follow_course(course, *touch, *motion, *transform, wind, *state);
            }
            if (state->auto_trim) {
                trim_sail(
                    *boat, *floating, *motion, normalize_or_identity(transform->rotation),
                    transform->scale, wind, step, *state);
            }
            step_sailboat(
                surfaces, wind, *touch, *floating, *transform, *boat, step, *state, *motion);
        }
    });
}

void turn_booms(
    Query<Boom, Transform, const Parent> booms,
    Query<const Sailboat, const SailboatState, const Transform> boats,
    Query<const Floating, const FloatingState> bodies, Query<Transform> transforms,
    OptionalRes<const Weather> weather, Res<const WeatherState> weather_state,
    Res<const FrameTime> time) {
    const Vec3 wind = wind_of(weather, *weather_state);
    booms.each([&](Boom& boom, Transform& transform, const Parent& parent) {
        const auto* boat = boats.find<const Sailboat>(parent.entity);
        const auto* state = boats.find<const SailboatState>(parent.entity);
        const auto* floating = bodies.find<const Floating>(parent.entity);
        const auto* motion = bodies.find<const FloatingState>(parent.entity);
        if (boat == nullptr || state == nullptr || floating == nullptr) {
            return;
        }
        const auto& hull = *boats.find<const Transform>(parent.entity);
        const Quat rotation = normalize_or_identity(hull.rotation);
        const float blows =
            apparent_wind_angle(*boat, *floating, *motion, rotation, hull.scale, wind);
        const float across = glm::length(wind) * std::sin(blows - state->boom);
        const float fills = std::clamp(across / kFillWind, -1.0f, 1.0f);
        boom.fullness += (fills - boom.fullness) * (1 - std::exp(-kFillRate * time->step));
        boom.fullness = std::isfinite(boom.fullness) ? boom.fullness : 0.0f;
        // +x and positive angles are to port of a boom that points astern: rotating about -y
        // takes -z to +x.
        transform.rotation = rotation_about({0, 1, 0}, -state->boom);
        transform.scale.x = boom.fullness < 0 ? std::min(boom.fullness, -kMinFullness)
                                              : std::max(boom.fullness, kMinFullness);
    });
    boats.each([&](const Sailboat& boat, const SailboatState&, const Transform& hull) {
        if (auto* transform = transforms.find<Transform>(boat.camera_target)) {
            transform->position = hull.position;
            // +z toward heading `a`, which is from +x toward +z.
            const float heading = heading_of(normalize_or_identity(hull.rotation));
            transform->rotation = rotation_about({0, 1, 0}, 0.5f * kPi - heading);
        }
    });
}

}  // namespace limn
