#include "content/load/scene_warnings.h"

#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/env_probe.h"
#include "ecs/components/name.h"
#include "ecs/components/ocean.h"
#include "ecs/components/path.h"
#include "ecs/components/rotation_track.h"
#include "ecs/components/script.h"
#include "ecs/components/shadow.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <string_view>

namespace limn {
namespace {

/// `component` has no effect on an entity that has none of `needs`.
struct Need {
    std::string_view component;
    std::array<std::string_view, 3> needs;
};
constexpr Need kNeeds[] = {
    {"shadow", {"point_light", "spot_light", "directional_light"}},
    {"light_pulse", {"point_light", "spot_light", "directional_light"}},
    {"ocean", {"water", "", ""}},
    {"caustics", {"water", "", ""}},
    {"water_look", {"water", "", ""}},
    {"water_waves", {"water", "", ""}},
    {"water_ripples", {"water", "", ""}},
    {"water_detail", {"water", "", ""}},
    {"lens", {"camera", "", ""}},
    {"autofocus", {"camera", "", ""}},
    {"autofocus", {"lens", "", ""}},
    {"camera_path", {"camera", "", ""}},
    {"speed_view", {"camera", "", ""}},
    {"inflate", {"mesh_instance", "", ""}},
    {"no_shadow", {"mesh_instance", "", ""}},
    {"mesh_levels", {"mesh_instance", "", ""}},
    {"deformed", {"mesh_instance", "", ""}},
};

std::string label_of(const World& world, Entity entity) {
    const Name* const name = world.find<Name>(entity);
    return name != nullptr && !name->text.empty() ? fmt::format("entity \"{}\"", name->text)
                                                  : fmt::format("entity {}", entity.index);
}

bool has_component(const World& world, Entity entity, std::string_view name) {
    const ComponentInfo* const info = name.empty() ? nullptr : find_component(name);
    return info != nullptr && world.has(entity, info->id);
}

void check_needs(const World& world, Entity entity, std::vector<std::string>& warnings) {
    for (const Need& need : kNeeds) {
        if (!has_component(world, entity, need.component)
            || std::any_of(need.needs.begin(), need.needs.end(), [&](std::string_view one) {
                   return has_component(world, entity, one);
               })) {
            continue;
        }
        const auto end = std::find(need.needs.begin(), need.needs.end(), "");
        warnings.push_back(fmt::format(
            "{}: {} has no effect without {}", label_of(world, entity), need.component,
            fmt::join(need.needs.begin(), end, " or ")));
    }
}

void check_followers(const World& world, std::vector<std::string>& warnings) {
    const auto* const assets = world.find_resource<Assets>();
    const std::size_t paths = assets != nullptr ? assets->paths.size() : 0;
    world.query<const PathFollower>().each([&](Entity entity, const PathFollower& follower) {
        if (follower.path.index >= paths) {
            warnings.push_back(fmt::format(
                "{}: path_follower has no effect without a path", label_of(world, entity)));
        }
    });
}

void check_cameras(const World& world, std::vector<std::string>& warnings) {
    std::vector<std::string> active;
    world.query<const Camera>().each([&](Entity entity, const Camera& camera) {
        if (camera.active) {
            active.push_back(label_of(world, entity));
        }
    });
    if (active.size() > 1) {
        warnings.push_back(fmt::format(
            "{} active cameras: {}; the first is used, set \"active\": false on the others",
            active.size(), fmt::join(active, ", ")));
    }
}

/// Keyframes whose times do not increase.
template <typename Track>
void check_key_order(
    const World& world, std::string_view component, std::vector<std::string>& warnings) {
    world.query<const Track>().each([&](Entity entity, const Track& track) {
        for (std::size_t i = 1; i < track.keys.size(); ++i) {
            if (!(track.keys[i].time > track.keys[i - 1].time)) {
                warnings.push_back(fmt::format(
                    "{}: {}.keys[{}].time is {} s, not after the key before it ({} s)",
                    label_of(world, entity), component, i, track.keys[i].time,
                    track.keys[i - 1].time));
                return;
            }
        }
    });
}

/// Sizes that the renderer and the simulation round to a power of two.
void check_resolutions(const World& world, std::vector<std::string>& warnings) {
    const auto check = [&](Entity entity, const char* field, int asked, unsigned used) {
        if (static_cast<unsigned>(asked) != used) {
            warnings.push_back(fmt::format(
                "{}: {} {} is rounded to the power of two {}", label_of(world, entity), field,
                asked, used));
        }
    };
    world.query<const Shadow>().each([&](Entity entity, const Shadow& shadow) {
        const auto asked = static_cast<unsigned>(std::max(shadow.resolution, 1));
        check(entity, "shadow.resolution", shadow.resolution, std::bit_ceil(asked));
    });
    world.query<const Ocean>().each([&](Entity entity, const Ocean& ocean) {
        const auto asked = static_cast<unsigned>(std::max(ocean.resolution, 1));
        check(entity, "ocean.resolution", ocean.resolution, std::bit_floor(asked));
    });
    world.query<const EnvProbe>().each([&](Entity entity, const EnvProbe& probe) {
        const auto asked = static_cast<unsigned>(std::max(probe.resolution, 1));
        check(entity, "env_probe.resolution", probe.resolution, std::bit_floor(asked));
    });
}

/// Events that change a component which their entity does not have.
void check_events(const World& world, std::vector<std::string>& warnings) {
    const auto* const list = world.find_resource<EventList>();
    for (std::size_t i = 0; list != nullptr && i < list->events.size(); ++i) {
        for (const ScriptAction& action : list->events[i].actions) {
            const bool is_edit =
                action.action == EventAction::Set || action.action == EventAction::Impulse;
            if (!is_edit || action.is_resource || !world.alive(action.entity)
                || world.has(action.entity, action.value.info().id)) {
                continue;
            }
            warnings.push_back(fmt::format(
                "events[{}]: {} has no {}{}", i, label_of(world, action.entity),
                action.value.info().name,
                action.action == EventAction::Set ? "; the event adds it, with defaults"
                                                  : "; the event does nothing"));
        }
    }
}

}  // namespace

std::vector<std::string> find_scene_warnings(const World& world) {
    std::vector<std::string> warnings;
    world.each_entity([&](Entity entity) { check_needs(world, entity, warnings); });
    check_followers(world, warnings);
    check_cameras(world, warnings);
    check_key_order<CameraPath>(world, "camera_path", warnings);
    check_key_order<RotationTrack>(world, "rotation_track", warnings);
    check_resolutions(world, warnings);
    check_events(world, warnings);
    return warnings;
}

}  // namespace limn
