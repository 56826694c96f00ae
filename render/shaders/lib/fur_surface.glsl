// A shell of a coat of fur: holes between strands, whose color gets lighter from root to tip, and their direction, by
// which they are shaded. A surface hook. Definitions:
//   FUR_SHELL  the surface is one
//   FUR_FIN    or fins
// Techniques: shade.fur

#if defined(FUR_SHELL) && !defined(LIT_AT_VERTICES)
#define FUR_DRAWN
#endif

#ifdef FUR_DRAWN
#include "lib/fur.glsl"
#include "lib/fur_record.glsl"

layout(location = 20) in vec4 fur_at;
layout(location = 21) in vec3 fur_strand;

FurPoint fur_here = FurPoint(false, vec4(0.5));
#endif

void fur_color(inout vec4 color) {
#ifdef FUR_DRAWN
    uint flags = material_and_flags.y;
    vec4 ends = fur_texel(flags, 3);
    vec2 per_pixel = max(abs(dFdx(fur_at.xy)), abs(dFdy(fur_at.xy)));
#ifdef FUR_FIN
    per_pixel.y = 0.0;
#endif
    float scale = fur_scale(per_pixel);
#ifdef FUR_FIN
    fur_here = fin_point(fur_at.x * scale, fur_at.z, fur_texel(flags, 2), fur_at.w);
#else
    fur_here = fur_point(fur_at.xy * scale, fur_at.z, fur_texel(flags, 2));
#endif
    float brightness = 1.0 + fur_texel(flags, 4).x * (2.0 * fur_here.random.w - 1.0);
    color.rgb *= mix(vec3(ends.w), ends.rgb, fur_at.z) * brightness;
    color.rgb = min(color.rgb, 1.0);
    color.a = fur_here.covered ? 1e4 : 0.0;  // whatever alpha vertices have, but for 0
#endif
}

void fur_sample(inout SurfaceSample s, vec3 smooth_normal) {
#ifdef FUR_DRAWN
    s.occlusion *= mix(fur_texel(material_and_flags.y, 3).w, 1.0, fur_at.z);
#ifdef STRANDS
    float unruly = fur_texel(material_and_flags.y, 2).w;
    vec3 along = fur_strand * inversesqrt(max(dot(fur_strand, fur_strand), 1e-30));
    s.strand_ws = normalize(along + unruly * (2.0 * fur_here.random.zyx - 1.0) + vec3(1e-6));
#endif
#endif
}
