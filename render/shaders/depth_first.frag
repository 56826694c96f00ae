// Depth prepass for forward shading. Definitions of lib/material.glsl, and
//   OFF_MESH    the depth of the visible point
//   FUR_SHELL   holes between its strands
//   ALPHA_MASK  holes where the opacity is below the cutoff
// Techniques: engine.depth-first, shade.z-prepass
#version 450
#if defined(ALPHA_MASK) || defined(OFF_MESH)
#if !defined(OFF_MESH) && !defined(FUR_SHELL)
#define LIT_AT_VERTICES  // colors only
#endif
#include "lib/view.glsl"
#include "lib/material.glsl"
#endif

void main() {
#if defined(ALPHA_MASK) || defined(OFF_MESH)
    cut_surface(surface_color().a);
#endif
}
