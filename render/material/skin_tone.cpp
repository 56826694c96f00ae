#include "render/material/skin_tone.h"

#include "ecs/components/surface.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

// Techniques: skin.blinn, skin.melanin-blood

namespace limn {

Vec3 skin_tone(const Material& material) {
    switch (material.pigments) {
    case Pigments::None:
        break;
    case Pigments::Plane:
        return glm::max(
            Vec3(0.97f, 0.87f, 0.67f) - material.melanin * Vec3(0.69f, 0.71f, 0.90f)
                - material.blood * Vec3(0.0f, 0.24f, 0.24f),
            Vec3(0));
    case Pigments::Density:
        return Vec3(0.55f, 0.34f, 0.26f)
               * glm::exp(
                   -material.melanin * Vec3(1.52f, 1.73f, 1.87f)
                   - (material.blood - 0.2f) * Vec3(0.10f, 0.53f, 0.42f));
    }
    return Vec3(1);
}

}  // namespace limn
