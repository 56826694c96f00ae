#include "content/load/level/particle_warnings.h"

#include "ecs/archetype.h"
#include "ecs/components/caustics.h"
#include "ecs/components/force_field.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/height_image.h"
#include "ecs/components/ocean.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particle_mesh.h"
#include "ecs/components/particle_surface.h"
#include "ecs/components/particles.h"
#include "ecs/components/path.h"
#include "ecs/components/point_mass.h"
#include "ecs/components/surface.h"
#include "ecs/components/trail.h"
#include "ecs/components/water.h"
#include "ecs/components/water_detail.h"
#include "ecs/components/water_look.h"
#include "ecs/components/water_noise.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_waves.h"
#include "ecs/field_access.h"
#include "ecs/field_watch.h"
#include "ecs/hierarchy.h"
#include "ecs/reflect.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {
namespace {

struct ParticleCheck {
    const World& world;
    std::vector<SceneWarning>& warnings;

    void warn(Entity entity, std::string_view what) const {
        warnings.push_back({fmt::format("{}: {}", label_of(world, entity), what), entity});
    }
};

bool is_without_triangles(const World& world, Entity entity) {
    const auto* const instance = world.find<MeshInstance>(entity);
    const auto* const assets = world.find_resource<Assets>();
    return instance != nullptr && assets != nullptr && instance->mesh.index < assets->meshes.size()
           && assets->meshes[instance->mesh.index].indices.empty();
}

/// Emitters that never show a particle.
void check_emitters(const ParticleCheck& check) {
    check.world.query<const ParticleEmitter>().each(
        [&](Entity entity, const ParticleEmitter& emitter) {
            if (emitter.capacity == 0) {
                check.warn(entity, "particle_emitter.capacity is 0: it emits nothing");
            }
            if (!(emitter.life + emitter.life_spread > 0)) {
                check.warn(entity, "particle_emitter.life is 0 s: nothing is visible");
            }
        });
}

void check_sources(const ParticleCheck& check) {
    const World& world = check.world;
    world.query<const ParticleSource>().each([&](Entity entity, const ParticleSource& source) {
        if (source.emitter == entity) {
            check.warn(entity, "particle_source names itself: it emits nothing");
            return;
        }
        if (!has_component(world, source.emitter, "particle_emitter")) {
            check.warn(entity, "particle_source has no effect without the name of an emitter");
            return;
        }
        Entity next = source.emitter;
        for (int i = 0; i < 100 && next != entity; ++i) {
            const auto* const before = world.find<ParticleSource>(next);
            if (before == nullptr) {
                return;
            }
            next = before->emitter;
        }
        if (next == entity) {
            check.warn(entity, "particle_source is part of a cycle: it emits nothing");
        }
    });
}

/// Frames of less than a pixel.
void check_flipbooks(const ParticleCheck& check) {
    const auto* const assets = check.world.find_resource<Assets>();
    check.world.query<const ParticleLook>().each([&](Entity entity, const ParticleLook& look) {
        if (assets == nullptr || look.image.index >= assets->images.size()) {
            return;
        }
        const ImageData& image = assets->images[look.image.index];
        if (image.width == 0) {
            return;  // not generated yet
        }
        if (look.columns > static_cast<std::uint32_t>(image.width)
            || look.rows > static_cast<std::uint32_t>(image.height)) {
            check.warn(
                entity, fmt::format(
                            "particle_look has {} x {} frames in an image of {} x {} pixels",
                            look.columns, look.rows, image.width, image.height));
        }
    });
}

void check_colliders(const ParticleCheck& check) {
    const World& world = check.world;
    bool any = false;
    world.query<const ParticleCollider>().each([&](Entity entity,
                                                   const ParticleCollider& collider) {
        any = true;
        const auto needs = [&](ColliderShape shape, std::string_view what) {
            if (collider.shape == shape && !has_component(world, entity, what)) {
                check.warn(entity, fmt::format("particle_collider of this shape needs {}", what));
            }
        };
        needs(ColliderShape::Mesh, "mesh_instance");
        if (collider.shape == ColliderShape::HeightField
            && !has_component(world, entity, "noise_surface")
            && !has_component(world, entity, "height_image")
            && !has_component(world, entity, "shoaling_waves")) {
            check.warn(
                entity, "particle_collider of this shape needs noise_surface, height_image or "
                        "shoaling_waves");
        }
        needs(ColliderShape::Water, "water");
    });
    world.query<const HeightImage, const NoiseSurface>().each([&](Entity entity, const HeightImage&,
                                                                  const NoiseSurface&) {
        check.warn(entity, "height_image and noise_surface fill the same heights: leave one out");
    });
    world.query<const ParticleCollision>().each([&](Entity entity, const ParticleCollision&) {
        if (!any) {
            check.warn(entity, "particle_collision has no effect without a particle_collider");
        }
    });
}

void check_surfaces(const ParticleCheck& check) {
    const World& world = check.world;
    const auto* const assets = world.find_resource<Assets>();
    const auto has_pieces = [&](Entity entity) {
        const auto* const mesh = world.find<ParticleMesh>(entity);
        return mesh != nullptr && assets != nullptr && !mesh->meshes.empty()
               && mesh->meshes[0].index < assets->meshes.size()
               && !assets->meshes[mesh->meshes[0].index].pieces.empty();
    };
    world.query<const ParticleSurface>().each([&](Entity entity, const ParticleSurface& surface) {
        const Entity owner = surface.entity.is_null() ? entity : surface.entity;
        const bool on_mesh = surface.on == BirthSurface::Mesh || surface.on == BirthSurface::Volume;
        if (world.has<ParticleSource>(entity)) {
            check.warn(entity, "particle_surface has no effect beside a particle_source");
        } else if (on_mesh && !has_component(world, owner, "mesh_instance")) {
            check.warn(entity, "particle_surface on a mesh needs an entity with mesh_instance");
        } else if (on_mesh && is_without_triangles(world, owner)) {
            check.warn(entity, "particle_surface is on a mesh without triangles: it emits nothing");
        } else if (
            surface.on == BirthSurface::Path
            && (assets == nullptr || surface.path.index >= assets->paths.size())) {
            check.warn(entity, "particle_surface on a path needs a path");
        } else if (surface.on == BirthSurface::Pieces && !has_pieces(entity)) {
            check.warn(entity, "particle_surface on pieces needs a particle_mesh of \"fragments\"");
        }
    });
}

// ---- what has no effect where it is: components, and fields that a level has set

template <typename Component>
const Component& component_or_default(const World& world, Entity entity) {
    static const Component kDefault;
    const auto* const found = world.find<Component>(entity);
    return found != nullptr ? *found : kDefault;
}

const ParticleEmitter& emitter_of(const World& world, Entity entity) {
    return component_or_default<ParticleEmitter>(world, entity);
}
const ParticleMotion& motion_of(const World& world, Entity entity) {
    return component_or_default<ParticleMotion>(world, entity);
}
const ParticleLook& look_of(const World& world, Entity entity) {
    return component_or_default<ParticleLook>(world, entity);
}
const ParticleSource& source_of(const World& world, Entity entity) {
    return component_or_default<ParticleSource>(world, entity);
}
ColliderShape collider_shape_of(const World& world, Entity entity) {
    return component_or_default<ParticleCollider>(world, entity).shape;
}
BirthSurface surface_kind_of(const World& world, Entity entity) {
    return component_or_default<ParticleSurface>(world, entity).on;
}

bool is_on_gpu(const World& world, Entity entity) {
    return world.has<ParticleEmitter>(entity) && runs_on_gpu(emitter_of(world, entity));
}
bool is_on_cpu(const World& world, Entity entity) {
    return world.has<ParticleEmitter>(entity) && !runs_on_gpu(emitter_of(world, entity));
}
bool is_closed_form(const World& world, Entity entity) {
    return motion_of(world, entity).integrator == ParticleIntegrator::ClosedForm;
}
bool is_closed_on_gpu(const World& world, Entity entity) {
    return is_closed_form(world, entity) && is_on_gpu(world, entity);
}
bool has_no_drag(const World& world, Entity entity) {
    return !(motion_of(world, entity).drag > 0) && !is_closed_form(world, entity);
}
bool has_no_turbulence(const World& world, Entity entity) {
    return motion_of(world, entity).turbulence == 0 || is_closed_form(world, entity);
}
bool has_wrap(const World& world, Entity entity) {
    return world.has<ParticleWrap>(entity);
}
bool has_source(const World& world, Entity entity) {
    return world.has<ParticleSource>(entity);
}
bool is_born_at_events(const World& world, Entity entity) {
    return has_source(world, entity) && source_of(world, entity).at != ParticleMoment::Flight
           && emitter_of(world, entity).rate > 0;
}
bool is_born_in_flight(const World& world, Entity entity) {
    return source_of(world, entity).at == ParticleMoment::Flight;
}
bool has_source_or_surface(const World& world, Entity entity) {
    return has_source(world, entity) || world.has<ParticleSurface>(entity);
}
bool has_no_spray(const World& world, Entity entity) {
    return !has_component(world, entity, "spray_source")
           && !has_component(world, entity, "spray_obstacle");
}
bool never_ends(const World& world, Entity entity) {
    return !(emitter_of(world, entity).duration > 0);
}
bool is_radial(const World& world, Entity entity) {
    return emitter_of(world, entity).direction == EmitterDirection::Radial
           && emitter_of(world, entity).shape != EmitterShape::Point;
}
bool does_not_bounce(const World& world, Entity entity) {
    return component_or_default<ParticleCollision>(world, entity).action != CollisionAction::Bounce;
}
bool has_no_size(const World& world, Entity entity) {
    const ColliderShape shape = collider_shape_of(world, entity);
    return shape != ColliderShape::Sphere && shape != ColliderShape::Box;
}
bool is_no_sphere(const World& world, Entity entity) {
    return collider_shape_of(world, entity) != ColliderShape::Sphere;
}
bool does_not_ripple(const World& world, Entity entity) {
    return collider_shape_of(world, entity) != ColliderShape::Water
           || !has_component(world, entity, "water_ripples");
}
bool is_not_on_path(const World& world, Entity entity) {
    return surface_kind_of(world, entity) != BirthSurface::Path;
}
bool is_not_on_mesh(const World& world, Entity entity) {
    const BirthSurface on = surface_kind_of(world, entity);
    return on != BirthSurface::Mesh && on != BirthSurface::Volume;
}
bool has_no_offset(const World& world, Entity entity) {
    const BirthSurface on = surface_kind_of(world, entity);
    return on != BirthSurface::Mesh && on != BirthSurface::Path;
}
bool is_not_on_pieces(const World& world, Entity entity) {
    return surface_kind_of(world, entity) != BirthSurface::Pieces;
}

/// Of the quads of an emitter alone: trails, beams and billboards read a look in other ways. GPU
/// particles have no trails.
bool shows_particles(const World& world, Entity entity) {
    return world.has<ParticleEmitter>(entity)
           && (!has_component(world, entity, "trail") || is_on_gpu(world, entity))
           && !has_component(world, entity, "beam") && !has_component(world, entity, "billboard");
}
bool is_no_streak(const World& world, Entity entity) {
    return shows_particles(world, entity)
           && look_of(world, entity).facing != ParticleFacing::Velocity;
}
bool is_not_in_pixels(const World& world, Entity entity) {
    return shows_particles(world, entity)
           && look_of(world, entity).facing != ParticleFacing::Pixels;
}
bool has_no_image(const World& world, Entity entity) {
    return shows_particles(world, entity) && look_of(world, entity).image.index == kNoAsset;
}
bool has_no_motion_map(const World& world, Entity entity) {
    return shows_particles(world, entity) && look_of(world, entity).motion.index == kNoAsset;
}
bool casts_no_shadow(const World& world, Entity entity) {
    return shows_particles(world, entity) && !(look_of(world, entity).shadow > 0);
}
bool is_unlit(const World& world, Entity entity) {
    return shows_particles(world, entity) && !(look_of(world, entity).lit > 0);
}
bool is_amortized_on_cpu(const World& world, Entity entity) {
    return is_on_cpu(world, entity) && look_of(world, entity).sort == ParticleSort::Amortized;
}
bool is_culled_by_bounds_on_gpu(const World& world, Entity entity) {
    return is_on_gpu(world, entity) && look_of(world, entity).culling == ParticleCulling::Bounds;
}

bool is_on_ocean(const World& world, Entity entity) {
    return has_component(world, entity, "ocean") && !has_component(world, entity, "water_waves");
}
bool is_bounded_water(const World& world, Entity entity) {
    const auto* const water = world.find<Water>(entity);
    return water != nullptr && water->size.x > 0 && water->size.y > 0;
}
bool has_no_fetch(const World& world, Entity entity) {
    const OceanSpectrum spectrum = component_or_default<Ocean>(world, entity).spectrum;
    return spectrum != OceanSpectrum::Jonswap && spectrum != OceanSpectrum::Tma;
}

const WaterLook& water_look_of(const World& world, Entity entity) {
    return component_or_default<WaterLook>(world, entity);
}
bool is_not_planar(const World& world, Entity entity) {
    return water_look_of(world, entity).reflection != WaterReflection::Planar;
}
bool has_no_distortion(const World& world, Entity entity) {
    return is_not_planar(world, entity)
           && water_look_of(world, entity).refraction != WaterRefraction::Shifted;
}
bool shows_no_floor(const World& world, Entity entity) {
    return water_look_of(world, entity).refraction != WaterRefraction::Floor;
}
bool has_no_floor(const World& world, Entity entity) {
    return !shows_no_floor(world, entity)
           && !(component_or_default<Water>(world, entity).depth > 0);
}
bool reflects_no_map(const World& world, Entity entity) {
    return water_look_of(world, entity).reflection != WaterReflection::Map;
}
bool has_no_crests(const World& world, Entity entity) {
    const WaterWaves& waves = component_or_default<WaterWaves>(world, entity);
    return waves.waves.empty() && waves.groups.empty();
}
bool never_breaks(const World& world, Entity entity) {
    return has_no_crests(world, entity) && !has_component(world, entity, "ocean");
}
bool has_no_whitecaps(const World& world, Entity entity) {
    return !(water_look_of(world, entity).foam_below > -1);
}
bool has_no_layers(const World& world, Entity entity) {
    return component_or_default<WaterDetail>(world, entity).layers.empty();
}
bool has_no_normal_map(const World& world, Entity entity) {
    return component_or_default<WaterDetail>(world, entity).normal_map.index == kNoAsset;
}
bool is_not_split(const World& world, Entity entity) {
    return !(component_or_default<WaterDetail>(world, entity).split > 0);
}
bool touches_by_mesh(const World& world, Entity entity) {
    return component_or_default<WaterTouch>(world, entity).shape == TouchShape::Mesh;
}
bool has_no_mirrored_light(const World& world, Entity entity) {
    return !(component_or_default<Caustics>(world, entity).mirror_reach > 0);
}
bool is_spray_body(const World& world, Entity entity) {
    const auto* const collider = world.find<ParticleCollider>(entity);
    return world.has<WaterTouch>(entity)
           || (collider != nullptr
               && (collider->shape == ColliderShape::Box
                   || (collider->shape == ColliderShape::Sphere && !collider->hollow)));
}
bool is_no_wind(const World& world, Entity entity) {
    return component_or_default<ForceField>(world, entity).kind != ForceKind::Wind;
}
bool has_no_sine(const World& world, Entity entity) {
    return component_or_default<ForceField>(world, entity).frequency == 0;
}
TrailPath trail_path_of(const World& world, Entity entity) {
    return component_or_default<Trail>(world, entity).path;
}
bool is_of_births(const World& world, Entity entity) {
    return trail_path_of(world, entity) == TrailPath::Births;
}
bool is_of_no_particles(const World& world, Entity entity) {
    return trail_path_of(world, entity) != TrailPath::Particles;
}
bool is_of_no_entity(const World& world, Entity entity) {
    return trail_path_of(world, entity) != TrailPath::Entity;
}

constexpr std::string_view kOnGpu = "on GPU particles; set particle_emitter.executor to cpu";
constexpr std::string_view kClosedForm = "with the integrator closed_form";
constexpr std::string_view kAtEvents = "beside a particle_source, unless it is in flight";
constexpr std::string_view kWithSource = "beside a particle_source";

/// A component, or a field of it that a level has set, and what ignores it.
struct Ignored {
    std::string_view component;
    std::string_view field;  ///< empty: the component as a whole
    bool (*applies)(const World&, Entity);
    std::string_view where;  ///< after "has no effect "
};

constexpr Ignored kIgnored[] = {
    {"particle_mesh", "", is_on_gpu, kOnGpu},
    {"particle_light", "", is_on_gpu, kOnGpu},
    {"particle_balls", "", is_closed_on_gpu, "on GPU particles in closed form"},
    {"trail", "", is_on_gpu, kOnGpu},
    {"particle_look", "lit_at", is_on_gpu,
     "on GPU particles, whose light is evaluated at their corners; set particle_emitter.executor "
     "to cpu"},
    {"particle_look", "camera_streak", is_on_gpu, kOnGpu},
    {"particle_look", "culling", is_culled_by_bounds_on_gpu, kOnGpu},
    {"particle_look", "sort", is_amortized_on_cpu,
     "on CPU particles, which are sorted as a whole; set particle_emitter.executor to gpu"},
    {"particle_collision", "collide_depth", is_on_cpu,
     "on CPU particles; set particle_emitter.executor to gpu"},

    {"particle_collision", "", is_closed_on_gpu, "on GPU particles in closed form"},
    {"particle_wrap", "", is_closed_form, kClosedForm},
    {"particle_motion", "drag", is_closed_form, kClosedForm},
    {"particle_motion", "wind", is_closed_form, kClosedForm},
    {"particle_motion", "weather", is_closed_form, kClosedForm},
    {"particle_motion", "turbulence", is_closed_form, kClosedForm},
    {"particle_motion", "vortex", is_closed_form, kClosedForm},
    {"particle_motion", "attraction", is_closed_form, kClosedForm},
    {"particle_motion", "orbit", is_closed_form, kClosedForm},
    {"particle_motion", "brake", is_closed_form, kClosedForm},
    {"particle_motion", "fields", is_closed_form, kClosedForm},
    {"particle_motion", "wind", has_no_drag, "without drag"},
    {"particle_motion", "weather", has_no_drag, "without drag"},
    {"particle_motion", "turbulence_size", has_no_turbulence, "without turbulence"},
    {"particle_motion", "turbulence_speed", has_no_turbulence, "without turbulence"},

    {"particle_collision", "", has_wrap, "beside a particle_wrap"},
    {"particle_collision", "bounce", does_not_bounce, "on particles that stick or are killed"},
    {"particle_collision", "friction", does_not_bounce, "on particles that stick or are killed"},
    {"particle_collider", "size", has_no_size, "unless it is a sphere or a box"},
    {"particle_collider", "hollow", is_no_sphere, "unless it is a sphere"},
    {"particle_collider", "ripple", does_not_ripple, "unless it is water with water_ripples"},
    {"particle_collider", "ripple_radius", does_not_ripple,
     "unless it is water with water_ripples"},

    {"particle_emitter", "rate", is_born_at_events, kAtEvents},
    {"particle_emitter", "rate_curve", is_born_at_events, kAtEvents},
    {"particle_emitter", "rate_spread", has_source, kWithSource},
    {"particle_emitter", "bursts", has_source, kWithSource},
    {"particle_emitter", "duration", has_source, kWithSource},
    {"particle_emitter", "prewarm", has_source, kWithSource},
    {"particle_emitter", "by_screen_area", has_source, kWithSource},
    {"particle_emitter", "inherit", has_source_or_surface,
     "beside a particle_source or particle_surface, which has an inherit of its own"},
    {"particle_emitter", "loop", never_ends, "without a duration"},
    {"particle_emitter", "cone", is_radial, "with radial directions"},
    {"particle_emitter", "drop_speed", has_no_spray, "without a spray_source or spray_obstacle"},
    {"particle_source", "count", is_born_in_flight, "in flight; set particle_emitter.rate"},
    {"particle_source", "spread", is_born_in_flight, "in flight; set particle_emitter.rate"},
    {"particle_surface", "path", is_not_on_path, "unless it is on a path"},
    {"particle_surface", "entity", is_not_on_mesh, "unless it is on a mesh or in a volume"},
    {"particle_surface", "offset", has_no_offset, "unless it is on a mesh or a path"},
    {"particle_surface", "blast", is_not_on_pieces, "unless it is on pieces"},

    {"particle_look", "stretch", is_no_streak, "unless it is facing velocity"},
    {"particle_look", "camera_streak", is_no_streak, "unless it is facing velocity"},
    {"particle_look", "attenuation", is_not_in_pixels, "unless it is facing pixels"},
    {"particle_look", "columns", has_no_image, "without an image"},
    {"particle_look", "rows", has_no_image, "without an image"},
    {"particle_look", "frames", has_no_image, "without an image"},
    {"particle_look", "frame_rate", has_no_image, "without an image"},
    {"particle_look", "motion", has_no_image, "without an image"},
    {"particle_look", "negative_light", has_no_image, "without an image"},
    {"particle_look", "motion_strength", has_no_motion_map, "without an image of motion"},
    {"particle_look", "shadow_tint", casts_no_shadow, "without a shadow"},
    {"particle_look", "forward", is_unlit, "unless it is lit"},
    {"particle_look", "lit_at", is_unlit, "unless it is lit"},

    {"spray_source", "steepness", is_on_ocean, "on an ocean, which has a foam_threshold"},
    {"spray_source", "window", is_bounded_water, "on water with a size"},
    {"spray_obstacle", "normal", is_spray_body, "on a body, whose shape has normals"},
    {"water_look", "distortion", has_no_distortion, "unless it reflects planar or is shifted"},
    {"water_look", "map_scale", is_not_planar, "unless it reflects planar"},
    {"water_look", "refraction", has_no_floor, "as a floor without a water.depth"},
    {"water_look", "floor_map", shows_no_floor, "unless it refracts the floor"},
    {"water_look", "floor_tile", shows_no_floor, "unless it refracts the floor"},
    {"water_look", "reflection_map", reflects_no_map, "unless it reflects the map"},
    {"water_look", "reflection_tile", reflects_no_map, "unless it reflects the map"},
    {"water_look", "reflection_height", reflects_no_map, "unless it reflects the map"},
    {"water_look", "foam_below", never_breaks, "without water_waves or an ocean"},
    {"water_look", "foam_decay", has_no_whitecaps, "without foam_below"},
    {"water_detail", "normal_map", has_no_layers, "without layers"},
    {"water_detail", "layers", has_no_normal_map, "without a normal_map"},
    {"water_detail", "split", has_no_crests, "without water_waves"},
    {"water_detail", "tile", is_not_split, "without split"},
    {"water_ripples", "window", is_bounded_water, "on water with a size"},
    {"water_touch", "half", touches_by_mesh, "on the shape mesh"},
    {"water_touch", "offset", touches_by_mesh, "on the shape mesh"},
    {"caustics", "window", is_bounded_water, "on water with a size"},
    {"caustics", "cascades", is_bounded_water, "on water with a size"},
    {"caustics", "mirror_resolution", has_no_mirrored_light, "without mirror_reach"},
    {"force_field", "speed", is_no_wind, "unless it is a wind"},
    {"force_field", "phase", has_no_sine, "without a frequency"},
    {"trail", "active", is_of_births, "on a path of births"},
    {"trail", "length", is_of_births, "on a path of births"},
    {"trail", "life", is_of_births, "on a path of births"},
    {"trail", "count", is_of_no_particles, "unless its path is of particles"},
    {"trail", "span", is_of_no_entity, "unless its path is an entity's"},
    {"ocean", "gamma", has_no_fetch, "unless the spectrum is jonswap or tma"},
    {"ocean", "fetch", has_no_fetch, "unless the spectrum is jonswap or tma"},
};

/// A row of kIgnored with what it names.
struct IgnoredField {
    const Ignored* row = nullptr;
    const ComponentInfo* component = nullptr;
    const FieldInfo* field = nullptr;  ///< null: the component as a whole
};

std::vector<IgnoredField> find_ignored_fields() {
    std::vector<IgnoredField> found;
    for (const Ignored& row : kIgnored) {
        const ComponentInfo* const info = find_component(row.component);
        const FieldInfo* const field =
            info != nullptr ? find_field(info->fields, row.field) : nullptr;
        if (info != nullptr && (row.field.empty() || field != nullptr)) {
            found.push_back({&row, info, field});
        }
    }
    return found;
}

/// Those of components that entities of `archetype` may have.
std::vector<IgnoredField>
fields_in(const Archetype& archetype, std::span<const IgnoredField> fields) {
    const std::span<const ComponentId> has = archetype.components();
    std::vector<IgnoredField> found;
    for (const IgnoredField& one : fields) {
        if (one.component->storage == Storage::Sparse
            || std::binary_search(has.begin(), has.end(), one.component->id)) {
            found.push_back(one);
        }
    }
    return found;
}

/// Whether an entity has this field set to another value than its default; without a field, whether
/// it has the component.
bool is_set(const World& world, Entity entity, const IgnoredField& one) {
    if (one.field == nullptr) {
        return world.has(entity, one.component->id);
    }
    const void* const value = world.find(entity, one.component->id);
    const void* const defaults = one.component->defaults;
    return value != nullptr && defaults != nullptr
           && !equal_fields(
               *one.field, field_ptr(value, *one.field), field_ptr(defaults, *one.field));
}

/// One line for each component or field, whatever the number of reasons.
void check_ignored(
    const ParticleCheck& check, Entity entity, std::span<const IgnoredField> fields) {
    std::vector<std::string> told;
    for (const IgnoredField& one : fields) {
        const Ignored& row = *one.row;
        if (!is_set(check.world, entity, one) || !row.applies(check.world, entity)) {
            continue;
        }
        const std::string whole(row.component);
        const std::string name =
            row.field.empty() ? whole : fmt::format("{}.{}", row.component, row.field);
        if (std::none_of(told.begin(), told.end(), [&](const std::string& other) {
                return other == name || other == whole;
            })) {
            check.warn(entity, fmt::format("{} has no effect {}", name, row.where));
            told.push_back(name);
        }
    }
}

/// By archetype: most entities have none of the components.
void check_all_ignored(const ParticleCheck& check) {
    const std::vector<IgnoredField> fields = find_ignored_fields();
    for (const std::unique_ptr<Archetype>& archetype : check.world.archetypes()) {
        const std::vector<IgnoredField> here = fields_in(*archetype, fields);
        if (!here.empty()) {
            for (const Entity entity : archetype->entities()) {
                check_ignored(check, entity, here);
            }
        }
    }
}

/// GPU particles know no water, and nobody knows where they are.
void check_gpu_particles(const ParticleCheck& check) {
    const World& world = check.world;
    bool has_water = false;
    world.query<const ParticleCollider>().each([&](const ParticleCollider& collider) {
        has_water = has_water || collider.shape == ColliderShape::Water;
    });
    world.query<const ParticleEmitter, const ParticleCollision>().each(
        [&](Entity entity, const ParticleEmitter& emitter, const ParticleCollision& collision) {
            if (has_water && runs_on_gpu(emitter) && !(collision.collide_depth > 0)) {
                check.warn(
                    entity, "GPU particles pass through water; set particle_emitter.executor to "
                            "cpu, or particle_collision.collide_depth to collide with what is in "
                            "view");
            }
        });
    world.query<const ParticleSource>().each([&](Entity entity, const ParticleSource& source) {
        if (world.alive(source.emitter) && is_on_gpu(world, source.emitter)) {
            check.warn(
                entity, "particle_source has no effect with GPU particles, which give birth to no "
                        "others; set the particle_emitter.executor of its emitter to cpu");
        }
    });
    world.query<const Trail>().each([&](Entity entity, const Trail& trail) {
        if (trail.emitter != entity && world.alive(trail.emitter)
            && is_on_gpu(world, trail.emitter)) {
            check.warn(
                entity, "trail has no effect with GPU particles; set the "
                        "particle_emitter.executor of its emitter to cpu");
        }
    });
}

void check_point_masses(const ParticleCheck& check) {
    const World& world = check.world;
    world.query<const PointMass, const Parent>().each(
        [&](Entity entity, const PointMass&, const Parent&) {
            check.warn(entity, "point_mass has no effect on an entity that has a parent");
        });
}

}  // namespace

void find_particle_warnings(const World& world, std::vector<SceneWarning>& warnings) {
    const ParticleCheck check{world, warnings};
    check_emitters(check);
    check_sources(check);
    check_surfaces(check);
    check_flipbooks(check);
    check_all_ignored(check);
    check_gpu_particles(check);
    check_colliders(check);
    check_point_masses(check);
}

std::vector<SceneWarning> find_dropped_births(const World& world) {
    std::vector<SceneWarning> found;
    world.query<const ParticleEmitter>().each([&](Entity entity, const ParticleEmitter& emitter) {
        const auto* const pool = world.find<ParticlePool>(entity);
        const auto* const on_gpu = world.find<GpuParticles>(entity);
        const std::uint64_t dropped = pool != nullptr     ? pool->clock.dropped
                                      : on_gpu != nullptr ? on_gpu->clock.dropped
                                                          : 0;
        if (dropped > 0) {
            found.push_back(
                {fmt::format(
                     "{}: {} new particles were dropped; particle_emitter.capacity is {}",
                     label_of(world, entity), dropped, emitter.capacity),
                 entity});
        }
    });
    return found;
}

}  // namespace limn
