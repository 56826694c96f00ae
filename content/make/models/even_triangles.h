#pragma once

#include "content/make/models/implicit_mesh.h"

namespace limn {

// Triangles as good as those of a remesher: edges shorter than half the mean are collapsed, edges
// are flipped toward six neighbors for each vertex, and vertices are relaxed on the surface, in
// rounds (Botsch and Kobbelt, "A Remeshing Approach to Multiresolution Modeling", 2004). The
// surface stays closed and 2-manifold.

/// `cell` bounds how far a vertex moves at once.
void even_triangles(ImplicitMesh& mesh, const SignedDistance& distance, float cell, int rounds);

/// 4 sqrt(3) area / sum of squared edges: 1 for an equilateral triangle, 0 for a sliver.
[[nodiscard]] float triangle_quality(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace limn
