#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Techniques: particle.depth-collision
// Source of particle.depth-collision: depth-buffer collision of GPU particles, as in most engines

/// A shape that particles collide with, in the entity's local space; nothing else stops them.
enum class ColliderShape : std::uint8_t {
    Plane,        ///< solid below the local xz plane, unbounded
    Sphere,       ///< of radius size.x
    Box,          ///< of half extents `size`
    Mesh,         ///< the triangles of the entity's mesh, deformed as it is; both of their sides
    HeightField,  ///< solid below its heights (noise_surface, height_image, shoaling_waves), which
                  ///< must not be turned or scaled
    Water,        ///< the surface of its water with all waves, from above
};

struct ParticleCollider {
    ColliderShape shape = ColliderShape::Plane;
    Vec3 size = {0.5f, 0.5f, 0.5f};
    bool hollow = false;
    float ripple = 0.004f;
    float ripple_radius = 0.1f;
};

LIMN_FIELDS(ParticleCollider) {
    LIMN_FIELD(
        shape,
        .doc = "plane: solid below local y = 0; mesh, height_field, water: as the entity is drawn",
        .values = "plane sphere box mesh height_field water");
    LIMN_FIELD(size, "half extents of a box; its x is the radius of a sphere", "m", 0, 1e5);
    LIMN_FIELD(hollow, "a sphere that is solid outside");
    LIMN_FIELD(
        ripple, "depth of the ripple that a hit at 10 m/s leaves in water_ripples, in proportion",
        "m", 0, 1);
    LIMN_FIELD(ripple_radius, "of that ripple", "m", 0.001, 100);
}

/// What a collider does to a particle.
enum class CollisionAction : std::uint8_t {
    Bounce,
    Stick,  ///< stays where it hit until it dies, even if the collider moves away
    Kill,   ///< after the births of a ParticleSource at "hit" and "death"
};

/// The emitter's particles collide, whatever their speed (particle.plane-response,
/// particle.collision-loop).
struct ParticleCollision {
    CollisionAction action = CollisionAction::Bounce;
    float bounce = 0.3f;
    float friction = 0.8f;
    float radius = 0.005f;
    float collide_depth = 0;
};

LIMN_FIELDS(ParticleCollision) {
    LIMN_FIELD(action, .doc = "what a hit does", .values = "bounce stick kill");
    LIMN_FIELD(bounce, "fraction of the speed toward the surface that is kept, outward", "", 0, 1);
    LIMN_FIELD(friction, "fraction of the velocity along the surface that is kept", "", 0, 1);
    LIMN_FIELD(radius, "of the particle, for all colliders but water", "m", 0, 100);
    LIMN_FIELD(
        collide_depth,
        "on the GPU: they also collide with the depth of the previous frame, assumed this thick, "
        "and with nothing outside of it; visual only, as it depends on the camera; 0: no",
        "m", 0, 100);
}

}  // namespace limn
