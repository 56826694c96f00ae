#include "content/load/level/particle_warnings.h"

#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particle_mesh.h"
#include "ecs/components/particle_surface.h"
#include "ecs/components/particles.h"
#include "ecs/components/path.h"
#include "ecs/components/point_mass.h"
#include "ecs/components/surface.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

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

void check_gpu_particles(const ParticleCheck& check) {
    const World& world = check.world;
    world.query<const ParticleEmitter>().each([&](Entity entity, const ParticleEmitter& emitter) {
        for (const std::string_view one : {"particle_mesh", "particle_light", "trail"}) {
            if (runs_on_gpu(emitter) && has_component(world, entity, one)) {
                check.warn(
                    entity, fmt::format(
                                "{} has no effect on GPU particles; set "
                                "particle_emitter.executor "
                                "to cpu",
                                one));
            }
        }
    });
    world.query<const ParticleEmitter, const ParticleLook>().each(
        [&](Entity entity, const ParticleEmitter& emitter, const ParticleLook& look) {
            if (runs_on_gpu(emitter) && look.lit_at == ParticleLitAt::Middle) {
                check.warn(
                    entity, "particle_look.lit_at has no effect on GPU particles, whose light is "
                            "evaluated at their corners; set particle_emitter.executor to cpu");
            }
        });
    bool for_cpu = false;
    world.query<const ParticleCollider>().each([&](const ParticleCollider& collider) {
        for_cpu = for_cpu || collider.shape == ColliderShape::Water;
    });
    world.query<const ParticleEmitter, const ParticleCollision>().each(
        [&](Entity entity, const ParticleEmitter& emitter, const ParticleCollision& collision) {
            const bool uses_depth_buffer = collision.collide_depth > 0;
            if (for_cpu && runs_on_gpu(emitter) && !uses_depth_buffer) {
                check.warn(
                    entity,
                    "GPU particles pass through water; set particle_emitter.executor to cpu, or "
                    "particle_collision.collide_depth to collide with what is in view");
            } else if (uses_depth_buffer && !runs_on_gpu(emitter)) {
                check.warn(
                    entity, "particle_collision.collide_depth has no effect on CPU particles; set "
                            "particle_emitter.executor to gpu");
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
