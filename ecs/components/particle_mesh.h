#pragma once

#include "ecs/base/math.h"
#include "ecs/components/particles.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Techniques: engine.projectile-instances, particle.mesh-particles

enum class ParticleMeshFacing : std::uint8_t {
    Tumble,    ///< turned at random, about an axis of its own
    Velocity,  ///< its -z axis along the flight, about which it spins
    Emitter,   ///< rotated and scaled as the emitter at its birth, then as Tumble
};

/// The particles of an emitter are drawn as instances of meshes, lit and shadowed as any other:
/// debris, leaves, projectiles (particle.mesh-particles, engine.projectile-instances). Beside a
/// ParticleLook or without one. With a ParticleSurface on the pieces of a mesh, each particle is
/// one of the pieces of the first of `meshes`.
struct ParticleMesh {
    std::vector<MeshId> meshes = {};
    MaterialId material = {};
    float scale = 1;
    float scale_spread = 0;
    std::vector<CurveKey> scale_curve = {};
    ParticleMeshFacing facing = ParticleMeshFacing::Tumble;
    float spin = 0;
    float spin_spread = 6;
    float fade = 0;
};

LIMN_FIELDS(ParticleMesh) {
    LIMN_FIELD(meshes, "meshes of the level, by name; each particle gets one of them");
    LIMN_FIELD(material, "of all");
    LIMN_FIELD(scale, "of the mesh", "", 0, 1e4);
    LIMN_FIELD(scale_spread, "give or take", "", 0, 1e4);
    LIMN_FIELD(scale_curve, "factor on the scale over the life");
    LIMN_FIELD(
        facing,
        .doc = "how it is turned: at random, -z along the flight, or at first as the emitter",
        .values = "tumble velocity emitter");
    LIMN_FIELD(
        spin, "rotation; of particles that collide, slower below 1 m/s", "rad/s", -1000, 1000);
    LIMN_FIELD(spin_spread, "give or take", "rad/s", 0, 1000);
    LIMN_FIELD(fade, "it shrinks to nothing over the last seconds of its life", "s", 0, 1e5);
}

struct MeshParticle {
    std::uint32_t key = 0;
    MeshId mesh;
    float angle = 0;
    Affine now;
    Affine before;
};

LIMN_FIELDS(MeshParticle) {
    LIMN_FIELD(key, "random bits of its particle");
    LIMN_FIELD(mesh, "which it is");
    LIMN_FIELD(angle, "how far it has turned", "rad");
    LIMN_FIELD(now, "at the end of the step");
    LIMN_FIELD(before, "one step earlier, or at its birth");
}

/// What is drawn of each ParticleMesh, in the order of its particles; kept by the systems.
struct ParticleMeshState {
    std::vector<MeshParticle> instances;
};

LIMN_FIELDS(ParticleMeshState) {
    LIMN_FIELD(instances, "one for each particle");
}

template <>
struct ComponentTraits<ParticleMeshState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
