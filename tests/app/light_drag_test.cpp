#include "content/app/panels/undo.h"
#include "content/app/player/light_drag.h"
#include "ecs/components/light.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "systems/transform_system.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <utility>

namespace limn::light_drag_test {
namespace {

constexpr Vec3 kCenter = {0.2f, 1.5f, -0.1f};

/// A lamp at kLamp in the world, optionally with a rotated and translated parent.
struct Studio {
    explicit Studio(bool carried) {
        const Transform arm = {
            .position = {1, 2, 3}, .rotation = glm::angleAxis(0.7f, glm::normalize(Vec3(1, 2, 0)))};
        const Vec3 from_arm = glm::inverse(arm.rotation) * (kLamp - arm.position);
        lamp = world.create(
            Transform{
                .position = carried ? from_arm : kLamp,
                .rotation = carried ? glm::inverse(arm.rotation) : Quat(1, 0, 0, 0)},
            PointLight{.intensity = 5});
        if (carried) {
            REQUIRE(set_parent(world, lamp, world.create(arm)).ok());
        }
        update();
    }
    void update() {
        world.run(add_world_transforms);
        world.run(update_transforms);
    }
    [[nodiscard]] Affine transform() const { return world.get<WorldTransform>(lamp).world; }

    static constexpr Vec3 kLamp = {-0.8f, 2.0f, 0.9f};
    World world;
    UndoStack undo;
    Entity lamp;
};

float difference(const Affine& a, const Affine& b) {
    float most = 0;
    for (int i = 0; i < 3; ++i) {
        most = std::max(most, glm::length(a.row[i] - b.row[i]));
    }
    return most;
}

}  // namespace

TEST_CASE("light drag: a lamp with a parent turns like a free one") {
    const Affine camera = affine_from({0, 1.5f, 2}, glm::angleAxis(0.2f, Vec3(0, 1, 0)), Vec3(1));
    Studio free(false);
    Studio carried(true);
    CHECK(difference(free.transform(), carried.transform()) < 1e-5f);
    for (Studio* const studio : {&free, &carried}) {
        LightDrag drag;
        drag.drag(studio->world, studio->undo, kCenter, {90, 40}, 720, camera);
        drag.drag(studio->world, studio->undo, kCenter, {-20, 10}, 720, camera);
        studio->update();
    }
    CHECK(difference(free.transform(), carried.transform()) < 1e-5f);
    const Vec3 now = transform_point(carried.transform(), Vec3(0));
    CHECK(glm::distance(now, Studio::kLamp) > 0.2f);
    CHECK(std::abs(glm::distance(now, kCenter) - glm::distance(Studio::kLamp, kCenter)) < 1e-5f);
    carried.undo.undo(carried.world);  // one edit
    carried.update();
    CHECK(glm::distance(transform_point(carried.transform(), Vec3(0)), Studio::kLamp) < 1e-5f);
}

TEST_CASE("light drag: it takes the brightest light on the visible side, whatever its parent") {
    Studio studio(true);
    const Vec3 front = {0, 0, 1};
    const Entity weak =
        studio.world.create(Transform{.position = Studio::kLamp}, PointLight{.intensity = 4});
    CHECK(brightest_light(studio.world, kCenter, front) == studio.lamp);
    studio.world.get<PointLight>(studio.lamp).enabled = false;
    CHECK(brightest_light(studio.world, kCenter, front) == weak);
    const Entity rim = studio.world.create(
        Transform{.position = 2.0f * kCenter - Studio::kLamp}, PointLight{.intensity = 8});
    CHECK(brightest_light(studio.world, kCenter, front) == weak);
    CHECK(brightest_light(studio.world, kCenter, -front) == rim);
    const Entity moon = studio.world.create(
        Transform{.rotation = glm::angleAxis(kPi, Vec3(0, 1, 0))},
        DirectionalLight{.illuminance = 50});
    CHECK(brightest_light(studio.world, kCenter, front) == weak);
    CHECK(brightest_light(studio.world, kCenter, -front) == moon);
}

TEST_CASE("light drag: facing makes a light shine on the center from the given direction") {
    Studio studio(true);
    const Vec3 direction = glm::normalize(Vec3(0.3f, 0.1f, 1));
    face_light(studio.world, studio.undo, kCenter, direction);
    studio.update();
    const float distance = glm::distance(Studio::kLamp, kCenter);
    CHECK(
        glm::distance(transform_point(studio.transform(), Vec3(0)), kCenter + distance * direction)
        < 1e-5f);
    CHECK(glm::distance(transform_vector(studio.transform(), {0, 0, -1}), -direction) < 1e-5f);
}

}  // namespace limn::light_drag_test
