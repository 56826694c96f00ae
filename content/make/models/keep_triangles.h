#pragma once

#include <cstdint>
#include <vector>

namespace limn {

struct MeshData;

/// Replaces the triangles of `mesh` by some of them or others between its vertices: `indices`,
/// three each. Vertices that are not used any more are removed, with their skin weights, morph
/// targets and regions; the others keep their order. The mesh has no pieces then; `bounds` stay.
void keep_triangles(MeshData& mesh, std::vector<std::uint32_t> indices);

}  // namespace limn
