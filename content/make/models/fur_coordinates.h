#pragma once

namespace limn {

class World;
struct MeshData;

// Texture coordinates for the roots of fur (Fur), which must be as dense everywhere, on any mesh:
// the second set gets positions projected along the axis that the surface faces most [m]. Its
// charts meet where three axes are equally far from the normal; there, strands are cut, and lost
// in the coat. Lengths shrink by at most sqrt(3).

/// Splits vertices where the facing axis changes. Leaves a mesh alone that has a second set.
void add_fur_coordinates(MeshData& mesh);

/// For the meshes of all entities with fur.
void add_fur_coordinates(World& world);

}  // namespace limn
