// Common to forward-shaded surfaces. Include after lib/lighting.glsl.

#include "lib/material.glsl"

// The surface quantized as in the G-buffer, so that forward and deferred shading give the same image. Alpha-masked
// holes need no test: the depth prepass has left them out.
SurfaceSample forward_surface() {
    SurfaceSample whole = surface_sample(surface_color().rgb);
    uvec4 bits = pack_surface(whole);
    SurfaceSample s = unpack_surface(bits);
#ifdef OFF_MESH
    gl_FragDepth = surface_depth;
#endif
    s.material = material_and_flags.x;
#ifdef KEY_SHADOWS
    s.key_visibility = floor(whole.key_visibility * 255.0 + 0.5) / 255.0;
#endif
#ifdef LAYERED
    s.layers = unpack_layers(pack_layers(whole.layers, bits.x), s.normal_ws);
#endif
    return s;
}
