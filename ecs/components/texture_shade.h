#pragma once

#include "ecs/components/surface.h"

namespace limn {

// Techniques: wrinkle.furrow.texture-space-shading

/// Lights an image texel by texel before each frame (wrinkle.furrow.texture-space-shading), so that
/// lighting does not depend on the resolution of the screen: unlit materials that use `target` show
/// it. Light and view are directional and fixed to the camera, as over an orthographic view.
///
///     color (ambient + light max(N.L, 0)) + light specular (N.H)^shininess    (Bando 2001, 4.12)
///
/// `normals` are viewed along z of the entity, x to the right and y up.
struct TextureShade {
    ImageId normals = {};
    ImageId color = {};
    ImageId target = {};  ///< rendered to; keeps its size and format
    bool unrolled = false;
    Vec3 to_light = {0, 0, 1};
    float ambient = 0.3f;
    float light = 0.7f;
    float specular = 0.2f;
    float shininess = 100;
};

LIMN_FIELDS(TextureShade) {
    LIMN_FIELD(normals, "normal map, green up");
    LIMN_FIELD(color, "color of the surface");
    LIMN_FIELD(target, "image to render to");
    LIMN_FIELD(unrolled, "normals are those of a cylinder, once around y from left to right");
    LIMN_FIELD(to_light, "direction to the light, of any length: right, up, to the camera");
    LIMN_FIELD(ambient, "light from all sides", "", 0, 10);
    LIMN_FIELD(light, "light from its direction", "", 0, 10);
    LIMN_FIELD(specular, "reflectance, of no color", "", 0, 1);
    LIMN_FIELD(shininess, "exponent of the highlight", "", 0, 128);
}

}  // namespace limn
