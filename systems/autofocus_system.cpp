#include "systems/autofocus_system.h"

#include <cmath>

namespace limn {

float pull_focus(float focus, float wanted, float response, float dt) {
    if (!(response > 0)) {
        return wanted;
    }
    const float left = std::exp(-dt / response);
    return 1 / (1 / wanted + left * (1 / focus - 1 / wanted));
}

void update_autofocus(
    Query<const Autofocus, Lens, const WorldTransform> cameras, Query<const WorldTransform> bodies,
    Query<const WorldTransform, With<Teleport>> teleporting, Res<const FrameTime> time) {
    cameras.each([&](Entity entity, const Autofocus& autofocus, Lens& lens,
                     const WorldTransform& camera) {
        if (!autofocus.active || autofocus.target.is_null()) {
            return;
        }
        const auto* body = bodies.find<const WorldTransform>(autofocus.target);
        if (body == nullptr) {
            return;  // destroyed: keep the focus
        }
        const auto& row = camera.world.row;
        const Vec3 eye = {row[0].w, row[1].w, row[2].w};
        const Vec3 back = normalize_or({row[0].z, row[1].z, row[2].z}, {0, 0, 1});
        const Vec3 point = transform_point(body->world, autofocus.offset);
        const float wanted = glm::dot(eye - point, back);
        if (!(wanted > 0) || !std::isfinite(wanted)) {
            return;  // behind the camera: keep the focus
        }
        const bool jumps = time->frame == 0 || teleporting.contains(entity)
                           || teleporting.contains(autofocus.target) || !(lens.focus_distance > 0);
        lens.focus_distance =
            jumps ? wanted
                  : pull_focus(lens.focus_distance, wanted, autofocus.response, time->step);
    });
}

}  // namespace limn
