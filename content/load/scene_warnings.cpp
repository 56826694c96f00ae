#include "content/load/scene_warnings.h"

#include "ecs/components/camera.h"
#include "ecs/components/name.h"
#include "ecs/components/path.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
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

}  // namespace

std::vector<std::string> find_scene_warnings(const World& world) {
    std::vector<std::string> warnings;
    world.each_entity([&](Entity entity) { check_needs(world, entity, warnings); });
    check_followers(world, warnings);
    check_cameras(world, warnings);
    return warnings;
}

}  // namespace limn
