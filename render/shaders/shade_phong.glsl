// Shading model Phong: kd n.l + ks (r.v)^shininess, r the reflected light direction (light.phong-model). Otherwise as
// Blinn.
// Techniques: fakephong.illum-phong, light.phong-model

#include "lib/classic_lobe.glsl"

void prepare_phong(inout Reflector r, SurfaceSample s) {
    prepare_classic(r, s);
}
