#pragma once

#include "ecs/base/math.h"
#include "ecs/components/path.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Techniques: engine.explode, particle.mesh-volume

enum class BirthSurface : std::uint8_t {
    Mesh,    ///< a mesh as it is deformed and moved in this step, even by area
    Path,    ///< a path of the level in the emitter's space, even by arc length
    Pieces,  ///< the pieces of the emitter's ParticleMesh: birth n is piece n, again from the first
    Volume,  ///< within a closed mesh, as it is deformed and moved in this step, even by volume
};

/// Particles of the emitter of its entity are born on a surface, or in what it encloses, instead of
/// at its position: dust of a running animal, embers along a rope, the pieces of what bursts and
/// what was in it (engine.explode, particle.mesh-particles). The emitter's shape is centered at
/// each birth, with +y along the normal: that of the triangle's front, up from the path with +z
/// ahead, or away from `blast`; a piece at `blast` flies in a random direction; in a volume +y is
/// the world's. Where a mesh is not closed along the vertical, it has no volume. Triangles without
/// area or with coordinates that are not finite are skipped; if none is left, no particle is born,
/// and `dropped` of the emitter's clock counts it. Not with a ParticleSource.
struct ParticleSurface {
    BirthSurface on = BirthSurface::Mesh;
    Entity entity{};
    PathId path{};
    float offset = 0;
    float inherit = 0;
    Vec3 blast = {0, 0, 0};
};

LIMN_FIELDS(ParticleSurface) {
    LIMN_FIELD(
        on,
        .doc =
            "a mesh, even by area; a path, even by length; pieces of a mesh, one birth for each; "
            "the volume of a closed mesh",
        .values = "mesh path pieces volume");
    LIMN_FIELD(entity, "whose mesh_instance, for mesh and volume; none: of the emitter itself");
    LIMN_FIELD(path, "a path of the level, by name, placed as the emitter is");
    LIMN_FIELD(offset, "of births on a mesh or path, along the normal", "m", -1e3, 1e3);
    LIMN_FIELD(
        inherit, "fraction of the surface's velocity that is added, without its deformation", "",
        -10, 10);
    LIMN_FIELD(blast, "what pieces fly away from, in the emitter's space", "m", -1e5, 1e5);
}

}  // namespace limn
