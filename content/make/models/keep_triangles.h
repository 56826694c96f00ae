#pragma once

#include <cstdint>
#include <vector>

namespace limn {

struct MeshData;

/// Replaces the triangles of `mesh` by `indices`, three per triangle. Unused vertices are removed,
/// with their skin weights, morph targets and regions; the others keep their order. Clears pieces;
/// keeps `bounds`.
void keep_triangles(MeshData& mesh, std::vector<std::uint32_t> indices);

/// Replaces the vertices of `mesh` by copies of them: new vertex i is old vertex source[i], with
/// its skin weights, morph targets and regions. Indices stay as they are.
void gather_vertices(MeshData& mesh, const std::vector<std::uint32_t>& source);

}  // namespace limn
