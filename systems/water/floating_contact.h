#pragma once

#include "ecs/components/buoyancy.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_ripples.h"

#include <optional>
#include <span>

namespace limn {

// Contacts of floating bodies, boxes and balls, with one another.
//
// Pairs are found by sweep and prune along x. Boxes are tested along the 15 axes of separation
// (Gottschalk et al. 1996), a ball against the nearest point of a box. Each contact is one point,
// which impulses keep from approaching: restitution, Coulomb friction, then positions are moved
// apart by a part of the overlap. Pairs are solved in their order, so that results do not depend on
// threads.

/// Where two shapes overlap.
struct BodyContact {
    Vec3 point = {0, 0, 0};   ///< world space [m]
    Vec3 normal = {0, 1, 0};  ///< from the second to the first, unit
    float depth = 0;          ///< overlap along it, > 0 [m]
};

/// A box or ball in world space.
struct ContactShape {
    Vec3 center = {0, 0, 0};
    Mat3 axes = Mat3(1);    ///< of a box, unit
    Vec3 half = {0, 0, 0};  ///< half extents; of a ball, x is its radius [m]
    bool ball = false;
};

/// None if they do not overlap.
[[nodiscard]] std::optional<BodyContact> find_contact(const ContactShape& a, const ContactShape& b);

/// A body that may touch others.
struct ContactBody {
    const WaterTouch* touch = nullptr;
    const Floating* floating = nullptr;
    FloatingState* state = nullptr;
    Transform* transform = nullptr;
};

/// Changes velocities and positions of bodies that overlap; those of shape Mesh, and those with
/// positions that are not finite, are left out. Returns the number of contacts.
int separate_floating_bodies(std::span<const ContactBody> bodies);

}  // namespace limn
