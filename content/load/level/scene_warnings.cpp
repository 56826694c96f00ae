#include "content/load/level/scene_warnings.h"

#include "content/load/faces/inside_mesh.h"
#include "content/load/level/particle_warnings.h"
#include "content/load/level/wrinkle_warnings.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/caustics.h"
#include "ecs/components/env_probe.h"
#include "ecs/components/environment.h"
#include "ecs/components/key_track.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/ocean.h"
#include "ecs/components/path.h"
#include "ecs/components/post.h"
#include "ecs/components/rotation_track.h"
#include "ecs/components/script.h"
#include "ecs/components/shadow.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "ecs/components/water_spray.h"
#include "ecs/components/water_wake.h"
#include "ecs/components/water_walls.h"
#include "ecs/components/water_waves.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <string_view>
#include <type_traits>
#include <utility>

// Techniques: wrinkle.maps.texture-set

namespace limn {
namespace {

/// `component` has no effect on an entity that has none of `needs`. Rows of one component are
/// consecutive.
struct Need {
    std::string_view component;
    std::array<std::string_view, 4> needs;
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
    {"spray_source", {"water", "", ""}},
    {"spray_source", {"water_waves", "ocean", ""}},
    {"spray_source", {"particle_emitter", "", ""}},
    {"spray_obstacle", {"particle_emitter", "", ""}},
    {"floating", {"water_touch", "", ""}},
    {"mirror_caustic", {"mesh_instance", "", ""}},
    {"lens", {"camera", "", ""}},
    {"autofocus", {"camera", "", ""}},
    {"autofocus", {"lens", "", ""}},
    {"camera_path", {"camera", "", ""}},
    {"sunlight", {"directional_light", "", ""}},
    {"crowd_pose", {"skeleton", "", ""}},
    {"crowd_pose", {"clip_player", "crowd_walk", ""}},
    {"crowd_walk", {"skeleton", "", ""}},
    {"crowd_script", {"crowd_walk", "", ""}},
    {"crowd_place", {"crowd_exit", "", ""}},
    {"crowd_visitor", {"crowd_agent", "", ""}},
    {"crowd_visitor", {"crowd_goal", "", ""}},
    {"crowd_visitor", {"move_intent", "", ""}},
    {"crowd_stand_in", {"crowd_agent", "", ""}},
    {"crowd_stand_in", {"move_intent", "", ""}},
    {"motion_graph", {"skeleton", "", ""}},
    {"motion_style", {"motion_graph", "", ""}},
    {"motion_match", {"skeleton", "", ""}},
    {"motion_match", {"move_intent", "character_motor", ""}},
    {"hero", {"character_motor", "", ""}},
    {"motor_pose", {"character_motor", "", ""}},
    {"motor_pose", {"walk", "", ""}},
    {"walk_route", {"move_intent", "", ""}},
    {"walk_route", {"walk", "motion_match", "motion_graph"}},
    {"speed_view", {"camera", "", ""}},
    {"fur", {"mesh_instance", "", ""}},
    {"inflate", {"mesh_instance", "", ""}},
    {"surface_binding", {"mesh_instance", "", ""}},
    {"no_shadow", {"mesh_instance", "", ""}},
    {"mesh_levels", {"mesh_instance", "", ""}},
    {"deformed", {"mesh_instance", "control_surface", ""}},
    {"particle_emitter", {"particle_look", "particle_mesh", ""}},
    {"particle_mesh", {"particle_emitter", "", ""}},
    {"force_field", {"transform", "", ""}},
    {"trail", {"particle_look", "", ""}},
    {"beam", {"particle_look", "", ""}},
    {"particle_motion", {"particle_emitter", "", ""}},
    {"billboard", {"particle_look", "", ""}},
    {"particle_look", {"particle_emitter", "trail", "beam", "billboard"}},
    {"particle_source", {"particle_emitter", "", ""}},
    {"particle_light", {"particle_emitter", "", ""}},
    {"particle_surface", {"particle_emitter", "", ""}},
    {"particle_balls", {"particle_emitter", "", ""}},
    {"particle_wrap", {"particle_emitter", "", ""}},
    {"particle_collision", {"particle_emitter", "point_mass", ""}},
    {"point_mass", {"transform", "", ""}},
    {"air_drag", {"point_mass", "", ""}},
    {"variable_mass", {"point_mass", "", ""}},
    {"furrows", {"mesh_instance", "", ""}},
    {"furrow_view", {"furrows", "", ""}},
    {"wrinkle_maps", {"wrinkle_weights", "wrinkle_response", ""}},
    {"wrinkle_weights", {"wrinkle_maps", "", ""}},
    {"wrinkle_response", {"wrinkle_maps", "", ""}},
    {"wrinkle_track", {"wrinkle_weights", "", ""}},
};

constexpr double kInside = 0.5;       // winding number above which a point counts as inside
constexpr float kMinSunSine = 0.02f;  // sine of the elevation of a sun that causes caustics

/// The local +z axis in world space; assumes uniform scale.
Vec3 back_of(const World& world, Entity entity) {
    Vec3 back(0, 0, 1);
    for (; !entity.is_null(); entity = parent_of(world, entity)) {
        const auto* const transform = world.find<Transform>(entity);
        back = transform != nullptr ? transform->rotation * back : back;
    }
    return back;
}

/// From the world to the entity's space.
Vec3 local_point(const World& world, Entity entity, Vec3 point) {
    const Entity parent = parent_of(world, entity);
    point = parent.is_null() ? point : local_point(world, parent, point);
    const auto* const t = world.find<Transform>(entity);
    return t == nullptr ? point : glm::conjugate(t->rotation) * (point - t->position) / t->scale;
}

Vec3 world_position(const World& world, Entity entity) {
    Vec3 point(0);
    for (; !entity.is_null(); entity = parent_of(world, entity)) {
        if (const auto* const t = world.find<Transform>(entity)) {
            point = t->position + t->rotation * (t->scale * point);
        }
    }
    return point;
}

bool contains(const Bounds& box, const Vec3& point) {
    return glm::all(glm::greaterThan(point, box.min)) && glm::all(glm::lessThan(point, box.max));
}

/// Whether an entity is opaque and single-sided, hence invisible from inside.
bool is_solid(const Assets& assets, const MeshInstance& instance) {
    return instance.mesh.index < assets.meshes.size()
           && (instance.material.index >= assets.materials.size()
               || (!is_see_through(assets.materials[instance.material.index])
                   && assets.materials[instance.material.index].alpha_mode == AlphaMode::Opaque
                   && !assets.materials[instance.material.index].double_sided));
}

// Illuminance [lx] times exposure: above which matte white is over thirty times too bright to
// display, and a suitable value.
constexpr float kBurns = 100;
constexpr float kSuits = 5;

struct SceneCheck {
    const World& world;
    std::vector<SceneWarning> warnings = {};

    void warn(Entity entity, std::string_view what) {
        warnings.push_back({fmt::format("{}: {}", label_of(world, entity), what), entity});
    }

    void check_needs(Entity entity) {
        std::string missing;  // missing requirements of the component, over its rows
        for (std::size_t i = 0; i < std::size(kNeeds); ++i) {
            const auto& [component, needs] = kNeeds[i];
            const bool lacks =
                has_component(world, entity, component)
                && std::none_of(needs.begin(), needs.end(), [&](std::string_view one) {
                       return has_component(world, entity, one);
                   });
            if (lacks) {
                const auto end = std::find(needs.begin(), needs.end(), "");
                missing += fmt::format(
                    "{}{}", missing.empty() ? "" : " and ", fmt::join(needs.begin(), end, " or "));
            }
            const bool is_last = i + 1 == std::size(kNeeds) || kNeeds[i + 1].component != component;
            if (is_last && !missing.empty()) {
                warn(entity, fmt::format("{} has no effect without {}", component, missing));
                missing.clear();
            }
        }
    }

    void check_followers() {
        const auto* const assets = world.find_resource<Assets>();
        const std::size_t paths = assets != nullptr ? assets->paths.size() : 0;
        world.query<const PathFollower>().each([&](Entity entity, const PathFollower& follower) {
            if (follower.path.index >= paths) {
                warn(entity, "path_follower has no effect without a path");
            }
        });
    }

    void check_cameras() {
        std::vector<std::string> active;
        Entity last;
        world.query<const Camera>().each([&](Entity entity, const Camera& camera) {
            if (camera.active) {
                active.push_back(label_of(world, entity));
                last = entity;
            }
        });
        if (active.size() > 1) {
            warnings.push_back(
                {fmt::format(
                     "{} active cameras: {}; the first is used, set \"active\": false on the "
                     "others",
                     active.size(), fmt::join(active, ", ")),
                 last});
        }
    }

    /// Cameras that start inside a closed mesh, where they see neither it nor light.
    void check_camera_positions() {
        const auto* const assets = world.find_resource<Assets>();
        world.query<const Camera, const Transform>().each([&](Entity camera, const Camera& settings,
                                                              const Transform&) {
            if (assets == nullptr || !settings.active || world.has<OrbitCamera>(camera)
                || world.has<PathFollower>(camera)) {  // positioned by the first step
                return;
            }
            const Vec3 position = world_position(world, camera);
            world.query<const MeshInstance>().each([&](Entity entity,
                                                       const MeshInstance& instance) {
                if (!is_solid(*assets, instance) || world.has<Deformed>(entity)) {
                    return;
                }
                const MeshData& mesh = assets->meshes[instance.mesh.index];
                const Vec3 point = local_point(world, entity, position);
                if (contains(mesh.bounds, point) && winding_number(mesh, point) > kInside) {
                    warn(
                        camera, fmt::format(
                                    "the camera starts inside {}, at [{:.3g}, {:.3g}, {:.3g}]",
                                    label_of(world, entity), position.x, position.y, position.z));
                }
            });
        });
    }

    /// Caustics need a sun above the horizon, which may be disabled at first.
    void check_caustics() {
        bool has_sun = false;
        world.query<const DirectionalLight>().each([&](Entity entity, const DirectionalLight&) {
            has_sun = has_sun || back_of(world, entity).y > kMinSunSine;
        });
        world.query<const Caustics>().each([&](Entity entity, const Caustics&) {
            if (!has_sun) {
                warn(entity, "caustics has no effect without a directional_light from above");
            }
        });
    }

    template <typename Component>
    void warn_of_all(std::string_view what) {
        world.query<const Component>().each(
            [&](Entity entity, const Component&) { warn(entity, what); });
    }

    /// What meets water, in a world that has none.
    void check_water() {
        if (world.query<const Water>().count() == 0) {
            warn_of_all<SprayObstacle>("spray_obstacle has no effect without a water");
            warn_of_all<WaterWall>("water_wall has no effect without a water");
        }
        if (world.query<const Water, const WaterWaves>().count() == 0) {
            warn_of_all<WakeEmitter>("wake_emitter has no effect without a water with water_waves");
        }
    }

    void check_sky() {
        const auto* const environment = world.find_resource<Environment>();
        if (environment != nullptr && environment->sky == SkyKind::Atmosphere
            && world.query<const Sunlight, const DirectionalLight>().count() == 0) {
            warnings.push_back({"environment: the sky \"atmosphere\" is black without a sunlight"});
        }
    }

    /// Suns with real outdoor illuminance, in an image exposed for a few lux.
    void check_exposure() {
        const auto* const found = world.find_resource<Exposure>();
        const Exposure exposure = found != nullptr ? *found : Exposure{};
        if (exposure.metering != Metering::Manual) {
            return;
        }
        const float factor = std::exp2(exposure.ev + exposure.manual_ev);
        world.query<const DirectionalLight>().each([&](Entity entity,
                                                       const DirectionalLight& light) {
            if (light.enabled && light.illuminance * factor > kBurns) {
                warn(
                    entity, fmt::format(
                                "{:.6g} lx is far too bright for the exposure, which suits about "
                                "{:.1g} lx, as skies and effects do; \"exposure\": {{\"metering\": "
                                "\"auto\"}} follows any light",
                                light.illuminance, kSuits / factor));
            }
        });
    }

    /// Lights whose color exceeds 1 and so scales their intensity.
    template <typename Light>
    void check_colors() {
        world.query<const Light>().each([&](Entity entity, const Light& light) {
            const Vec3& color = light.color;
            if (std::max({color.x, color.y, color.z}) > 1) {
                warn(
                    entity,
                    fmt::format(
                        "{0}.color is a tint in 0 .. 1, found [{1}, {2}, {3}]; raise {0}.{4} "
                        "instead",
                        component_info<Light>().name, color.x, color.y, color.z,
                        std::is_same_v<Light, DirectionalLight> ? "illuminance" : "intensity"));
            }
        });
    }

    /// Keyframes whose times do not increase.
    template <typename Track>
    void check_key_order() {
        world.query<const Track>().each([&](Entity entity, const Track& track) {
            for (std::size_t i = 1; i < track.keys.size(); ++i) {
                if (!(track.keys[i].time > track.keys[i - 1].time)) {
                    warn(
                        entity, fmt::format(
                                    "{}.keys[{}].time is {} s, not after the previous key ({} s)",
                                    component_info<Track>().name, i, track.keys[i].time,
                                    track.keys[i - 1].time));
                    return;
                }
            }
        });
    }

    /// Tracks of fields that do not exist, or with bad keys.
    void check_key_tracks() {
        world.query<const KeyTrack>().each([&](Entity entity, const KeyTrack& tracks) {
            for (const FieldTrack& track : tracks.tracks) {
                const Result<TrackTarget> target = find_track_target(track);
                if (!target) {
                    warn(entity, target.error().message);
                } else if (!world.has(entity, target->component->id)) {
                    warn(
                        entity, fmt::format(
                                    "key_track: {} has no effect without {}", track.field,
                                    target->component->name));
                }
            }
        });
    }

    /// Sizes that the renderer and the simulation round to a power of two.
    void check_resolutions() {
        const auto check = [&](Entity entity, const char* field, int asked, unsigned used) {
            if (static_cast<unsigned>(asked) != used) {
                warn(
                    entity,
                    fmt::format("{} {} is rounded to the power of two {}", field, asked, used));
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
};

/// When an action first runs; simultaneous events run in file order.
struct ActionTime {
    double time = 0;
    std::size_t event = 0;
    std::size_t action = 0;

    [[nodiscard]] auto operator<=>(const ActionTime&) const = default;
};

/// Events that change a component that their entity lacks, or an entity that was destroyed.
void check_events(SceneCheck& check) {
    const World& world = check.world;
    const auto* const list = world.find_resource<EventList>();
    if (list == nullptr) {
        return;
    }
    const auto warn = [&](std::size_t event, std::string_view what) {
        check.warnings.push_back(
            {fmt::format("events[{}]: {}", event, what), {}, static_cast<int>(event)});
    };
    std::map<Entity, ActionTime> destroyed;
    const auto each_action = [&](auto&& visit) {
        for (std::size_t i = 0; i < list->events.size(); ++i) {
            for (std::size_t k = 0; k < list->events[i].actions.size(); ++k) {
                const ScriptAction& action = list->events[i].actions[k];
                if (world.alive(action.entity)) {
                    visit(ActionTime{list->events[i].time, i, k}, action);
                }
            }
        }
    };
    each_action([&](const ActionTime& time, const ScriptAction& action) {
        if (action.action == EventAction::Destroy) {
            ActionTime& first = destroyed.try_emplace(action.entity, time).first->second;
            first = std::min(first, time);
        }
    });
    const auto is_gone = [&](const ActionTime& time, const ScriptAction& action) {
        for (Entity e = action.entity; !e.is_null(); e = parent_of(world, e)) {
            const auto found = destroyed.find(e);
            if (found != destroyed.end() && found->second < time) {
                warn(
                    time.event,
                    fmt::format(
                        "{} no longer exists: events[{}] destroys it at {} s",
                        label_of(world, action.entity), found->second.event, found->second.time));
                return true;
            }
        }
        return false;
    };
    each_action([&](const ActionTime& time, const ScriptAction& action) {
        if (is_gone(time, action) || action.value.is_empty()
            || world.has(action.entity, action.value.info().id)) {
            return;
        }
        warn(
            time.event,
            fmt::format(
                "{} has no {}{}", label_of(world, action.entity), action.value.info().name,
                action.action == EventAction::Set ? "; the event adds it with defaults"
                                                  : "; the event does nothing"));
    });
}

}  // namespace

std::string label_of(const World& world, Entity entity) {
    const Name* const name = world.find<Name>(entity);
    return name != nullptr && !name->text.empty() ? fmt::format("entity \"{}\"", name->text)
                                                  : fmt::format("entity {}", entity.index);
}

bool has_component(const World& world, Entity entity, std::string_view name) {
    const ComponentInfo* const info = name.empty() ? nullptr : find_component(name);
    return info != nullptr && world.has(entity, info->id);
}

std::vector<SceneWarning> find_scene_warnings(const World& world) {
    SceneCheck check{world};
    world.each_entity([&](Entity entity) { check.check_needs(entity); });
    check.check_followers();
    find_particle_warnings(world, check.warnings);
    check.check_cameras();
    check.check_camera_positions();
    check.check_caustics();
    check.check_water();
    check.check_sky();
    check.check_exposure();
    check.check_colors<PointLight>();
    check.check_colors<SpotLight>();
    check.check_colors<DirectionalLight>();
    check.check_key_order<CameraPath>();
    check.check_key_order<RotationTrack>();
    check.check_key_tracks();
    check.check_key_order<WrinkleTrack>();
    find_wrinkle_warnings(world, check.warnings);
    check.check_resolutions();
    check_events(check);
    return std::move(check.warnings);
}

}  // namespace limn
