// Depth of shadow casters. Definitions of lib/material.glsl, and
//   OFF_MESH    the depth of the visible point
//   ALPHA_MASK  holes where the opacity is below the cutoff let light through
// Techniques: shadow.map-alpha
#version 450
#define SHADOW_CASTER
#if defined(ALPHA_MASK) || defined(OFF_MESH)
#include "lib/view.glsl"
#include "lib/material.glsl"
#endif

void main() {
#if defined(ALPHA_MASK) || defined(OFF_MESH)
    cut_surface(surface_color().a);
#endif
}
