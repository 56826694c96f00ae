// Shading model Skin: Blinn plus a rim that each light adds, regardless of its direction; it imitates light scattered
// in soft skin (char.skin-shade).
// Techniques: char.skin-shade, skin.blinn

#include "lib/classic_lobe.glsl"

// Rim light by the cosine to the viewer: the form of the paper's listing, or of its text, which is wider.
float skin_rim(float n_v, bool wide) {
    float away = 1.0 - clamp(n_v, 0.0, 1.0);
    return wide ? away * (2.0 - away) : away * away;
}

void prepare_skin(inout Reflector r, SurfaceSample s) {
    prepare_classic(r, s);
    vec4 rim = block_texel(s.material, kSkinBlock, 0);
    r.own.yzw = skin_rim(dot(r.normal, r.to_camera), rim.w > 0.5) * rim.rgb;
}
