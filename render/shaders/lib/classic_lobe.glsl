// The response of Blinn, Phong and Skin to one light. They share this code, since a software OpenGL would evaluate the
// power of each model for every pixel. Reflector::own: x = shininess, or with tables the layer; yzw = added to n.l.
// Techniques: bump.mipmap, fakephong.illum-blinn, fakephong.illum-phong, fakephong.vectors, skin.blinn,
//     wrinkle.compression.lighting

#include "lib/brdf.glsl"
#include "lib/lobe_tables.glsl"
#include "lib/material_record.glsl"

// The shininess n of normals whose slopes have this variance about their mean, and the brightness of the highlight, which
// keeps its energy (Toksvig 2005).
vec2 wider_highlight(float n, float variance) {
    float wide = n / (1.0 + n * variance);
    return vec2(wide, (1.0 + wide) / (1.0 + n));
}

// Nothing is added to n.l, and the environment is not mirrored.
void prepare_classic(inout Reflector r, SurfaceSample s) {
    vec4 specular = block_texel(s.material, kClassicBlock, 0);
    float alpha = s.roughness * s.roughness;
    vec2 highlight = wider_highlight(abs(specular.a), specular.a < 0.0 ? 0.5 * alpha * alpha : 0.0);
    r.diffuse = s.albedo;
    r.specular_0 = specular.rgb * highlight.y;
    r.mirror = vec3(0.0);
#if defined(LOBE_TABLE) || defined(LOBE_FACTORS)
    highlight = vec2(lobe_layer(s.material), 1.0);
    r.specular_0 = specular.rgb;
#endif
    r.own = vec4(highlight.x, 0.0, 0.0, 0.0);
}

Response lobe_classic(Reflector r, Cosines c) {
    float mirrored = 2.0 * c.n_l * r.n_v - c.l_v;
    float v = r.model == kModelPhong ? mirrored : c.n_h;
#if defined(LOBE_TABLE)
    vec2 light = lobe_lookup(c.n_l, v, r.own.x);
#elif defined(LOBE_FACTORS)
    vec2 light = vec2(c.n_l, c.n_l > 0.0 && v > 0.0 ? lobe_power(v, r.own.x) : 0.0);
#else
    vec2 light = lit(c.n_l, v, r.own.x).yz;
#endif
    return Response(light.x + r.own.yzw, light.y / kPi, 0.0);
}
