// Depth prepass for forward shading. Definitions of lib/material.glsl, and
//   ALPHA_MASK  holes where the opacity is below the cutoff
// Techniques: engine.depth-first, shade.z-prepass
#version 450
#ifdef ALPHA_MASK
#define LIT_AT_VERTICES  // colors only
#include "lib/view.glsl"
#include "lib/material.glsl"
#endif

void main() {
#ifdef ALPHA_MASK
    if (surface_color().a < material_texel(2).w) {
        discard;
    }
#endif
}
