#include "systems/light/sunlight_system.h"

#include "ecs/base/air.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {

void update_sunlight(
    Query<const Sunlight, const WorldTransform, DirectionalLight> suns,
    OptionalRes<const Environment> environment) {
    const bool has_air = environment && environment->sky == SkyKind::Atmosphere;
    suns.each([&](const Sunlight& sun, const WorldTransform& at, DirectionalLight& light) {
        Vec3 passed = sun.color;
        if (has_air) {
            const Vec3 toward = transform_vector(at.world, {0, 0, 1});
            const double length = glm::length(toward);
            const double sine = length > 0 ? static_cast<double>(toward.y) / length : 1;
            passed *= Vec3(air_transmittance(kGroundRadius, sine, environment->haze));
        }
        const float largest = std::max({passed.x, passed.y, passed.z});
        light.color = largest > 0 ? passed / largest : Vec3(0);
        light.illuminance = sun.illuminance * largest;
    });
}

}  // namespace limn
