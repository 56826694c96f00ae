#pragma once

#include "ecs/components/surface.h"
#include "ecs/entity.h"

#include <span>

namespace limn {

class World;
struct ModelView;

// The ground under a single model: an added one that fades into the backdrop, or the file's own,
// made to fade as well, since its edge would be a hard line in front of a studio.

/// Adds a ground under view.subject, and its mesh and material to Assets.
void add_ground(World& world, ModelView& view);

/// Fades the flat, opaque, undeformed meshes of `scenery` that extend much farther than
/// view.subject: their instances draw a copy with as many triangles as the fading needs and a
/// matte, blended material. Both are added to Assets.
void fade_grounds(World& world, std::span<const Entity> scenery, ModelView& view);

}  // namespace limn
