// What shaders that light surfaces while they draw them share. After lib/lighting.glsl.

#include "lib/material.glsl"

// The surface rounded as the G-buffer would keep it, so that both ways of drawing give one picture. Holes of masked
// surfaces need no test: the depth pass before has left them out.
SurfaceSample forward_surface() {
    return unpack_surface(pack_surface(surface_sample(surface_color().rgb)));
}
