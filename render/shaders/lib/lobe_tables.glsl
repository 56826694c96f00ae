// Lookups in place of the arithmetic of classic lobes (render/light/lobe_tables.h). Definitions:
//   LOBE_TABLE    one lookup for diffuse light and highlight (shade.phong-lut)
//   LOBE_FACTORS  one for each factor of a lobe (shade.factorise)
// Techniques: shade.factorise, shade.phong-lut

#if defined(LOBE_TABLE) || defined(LOBE_FACTORS)
#include "lobe_tables_gpu.h"

layout(binding = kLobeTablesUnit) uniform sampler2DArray lobe_tables;
layout(binding = kLobeLayersUnit) uniform usamplerBuffer lobe_layers;  // by material record

float lobe_layer(uint material) {
    return float(texelFetch(lobe_layers, int(material)).x);
}

// Texture coordinate of a cosine in 0 .. 1: samples are from texel center to texel center.
vec2 lobe_at(vec2 cosines) {
    vec2 size = vec2(textureSize(lobe_tables, 0).xy);
    return (clamp(cosines, 0.0, 1.0) * (size - 1.0) + 0.5) / size;
}
#endif

#ifdef LOBE_TABLE
// Diffuse light and highlight.
vec2 lobe_lookup(float u, float v, float layer) {
    vec2 light = textureLod(lobe_tables, vec3(lobe_at(vec2(u, u > 0.0 ? v : 0.0)), layer), 0.0).rg;
    return u > 0.0 ? light : vec2(0.0);
}
#endif

#ifdef LOBE_FACTORS
// v^n of the exponent of a layer.
float lobe_power(float v, float layer) {
    return textureLod(lobe_tables, vec3(lobe_at(vec2(v)).x, 0.5, layer + 1.0), 0.0).r;
}

// sqrt(1 - x^2).
float lobe_sine(float x) {
    return textureLod(lobe_tables, vec3(lobe_at(vec2(0.5 * x + 0.5)).x, 0.5, 0.0), 0.0).r;
}
#endif
