// Shading model Blinn: kd n.l + ks (n.h)^shininess, h halfway between light and viewer (light.halfway-vector). Does not
// reflect the environment. kd is the albedo; ks and shininess are in its ClassicBlock.
// Techniques: fakephong.illum-blinn, light.halfway-vector

#include "lib/classic_lobe.glsl"

void prepare_blinn(inout Reflector r, SurfaceSample s) {
    prepare_classic(r, s);
}
