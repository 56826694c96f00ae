#pragma once

#include "ecs/components/surface.h"
#include "ecs/entity.h"

#include <span>

namespace limn {

class World;
struct ModelView;

// What a model by itself stands on: a ground of its own that fades into the backdrop, or one that
// the file has, made to fade as well, since its edge would be a hard line before a studio.

/// Adds a ground under view.subject, and its mesh and material to Assets.
void add_ground(World& world, ModelView& view);

/// Fades the flat, opaque, undeformed meshes of `scenery` that reach much farther than
/// view.subject: their instances draw a copy with as many triangles as the fading needs and a
/// matte, blended material. Both are added to Assets.
void fade_grounds(World& world, std::span<const Entity> scenery, ModelView& view);

}  // namespace limn
