// Depth of shadow casters. Definitions of lib/material.glsl, and
//   ALPHA_MASK  holes where the opacity is below the cutoff let light through
// Techniques: shadow.map-alpha
#version 450
#ifdef ALPHA_MASK
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
