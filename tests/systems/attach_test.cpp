#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "ecs/components/time.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "systems/attach_system.h"
#include "systems/update_world.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <vector>

namespace limn::attach_test {

namespace {

AttachPoint random_point(Random& random, const char* name) {
    return {
        name, 2.0f * random.direction(),
        rotation_about(random.direction(), random.uniform(0.0f, 6.0f))};
}

glm::dmat4 matrix_of(const Vec3& position, const Quat& rotation) {
    glm::dmat4 m = glm::mat4_cast(glm::normalize(glm::dquat(rotation)));
    m[3] = glm::dvec4(position, 1);
    return m;
}

double difference(const glm::dmat4& a, const glm::dmat4& b) {
    double most = 0;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            most = std::max(most, std::abs(a[column][row] - b[column][row]));
        }
    }
    return most;
}

struct Pair {
    World world;
    Entity cart;
    Entity wagon;

    Pair() {
        cart = world.create(
            Transform{.position = {3, 0, 1}, .rotation = rotation_about({0, 1, 0}, 0.7f)},
            AttachPoints{{{"hook", {0, 0.5f, -1}, rotation_about({1, 0, 0}, 0.2f)}}});
        wagon = world.create(
            Transform{.position = {-5, 0, 2}, .rotation = rotation_about({0, 0, 1}, 0.3f)},
            AttachPoints{{{"ring", {0, 0.4f, 1.2f}, rotation_about({0, 1, 0}, 0.1f)}}});
    }
};

}  // namespace

TEST_CASE("attach: the frames of both points coincide" * technique("engine.attach")) {
    Random random(1, 0, name_hash("attach"), 0);
    for (int i = 0; i < 200; ++i) {
        const AttachPoint at = random_point(random, "at");
        const AttachPoint by = random_point(random, "by");
        const Transform t = attached_transform(at, by, Vec3(1), false);
        const glm::dmat4 m2 = matrix_of(at.position, at.rotation);
        const glm::dmat4 m4 = matrix_of(by.position, by.rotation);
        const glm::dmat4 placed = matrix_of(t.position, t.rotation);
        CHECK(difference(placed * m4, m2) < 4e-6);
        CHECK(difference(placed, m2 * glm::inverse(m4)) < 4e-6);
        CHECK(difference(placed, glm::inverse(m4) * m2) > 1e-3);  // for row vectors
        const Transform turned = attached_transform(at, by, Vec3(1), true);
        const glm::dmat4 facing = matrix_of(turned.position, turned.rotation) * m4;
        CHECK(glm::length(facing[3] - m2[3]) < 4e-6);
        CHECK(glm::length(facing[2] + m2[2]) < 4e-6);
        CHECK(glm::length(facing[1] - m2[1]) < 4e-6);
    }
    // The point of a child that is scaled, too.
    const AttachPoint by = random_point(random, "by");
    const Transform t = attached_transform({}, by, Vec3(2, 3, 0.5f), false);
    CHECK(glm::length(t.position + t.rotation * (t.scale * by.position)) < 1e-5f);
}

TEST_CASE(
    "attach: attached and detached, a root is where it was in the world"
    * technique("engine.attach")) {
    Pair pair;
    World& world = pair.world;
    const Transform before = world.get<const Transform>(pair.wagon);
    REQUIRE(attach(world, pair.cart, "hook", pair.wagon, "ring"));
    CHECK(parent_of(world, pair.wagon) == pair.cart);
    const Transform at = world.get<const Transform>(pair.cart);
    const Transform t = world.get<const Transform>(pair.wagon);
    const glm::dmat4 placed =
        matrix_of(at.position, at.rotation) * matrix_of(t.position, t.rotation);
    REQUIRE(detach(world, pair.wagon));
    CHECK(parent_of(world, pair.wagon).is_null());
    const Transform after = world.get<const Transform>(pair.wagon);
    CHECK(difference(placed, matrix_of(after.position, after.rotation)) < 4e-6);
    CHECK(glm::distance(after.position, before.position) > 1);
    CHECK_FALSE(detach(world, pair.wagon));
    // With the transform that keeps it in place, both steps change nothing.
    const glm::dmat4 local = glm::inverse(matrix_of(at.position, at.rotation))
                             * matrix_of(after.position, after.rotation);
    const Transform kept = {
        .position = Vec3(glm::dvec3(local[3])),
        .rotation = Quat(glm::quat_cast(glm::dmat3(local)))};
    REQUIRE(attach(world, pair.cart, pair.wagon, kept));
    REQUIRE(detach(world, pair.wagon));
    CHECK(glm::distance(world.get<const Transform>(pair.wagon).position, after.position) < 4e-6f);
}

TEST_CASE(
    "attach: an unknown point or a parent that is a descendant changes nothing"
    * technique("engine.attach")) {
    Pair pair;
    World& world = pair.world;
    CHECK_FALSE(attach(world, pair.cart, "hoop", pair.wagon, "ring"));
    CHECK_FALSE(attach(world, pair.cart, "hook", pair.wagon, "hook"));
    CHECK_FALSE(attach(world, pair.cart, "hook", pair.cart, "hook"));
    CHECK_FALSE(attach(world, Entity{}, "", pair.wagon, "ring"));
    CHECK(parent_of(world, pair.wagon).is_null());
    CHECK(world.get<const Transform>(pair.wagon).position == Vec3(-5, 0, 2));
    REQUIRE(attach(world, pair.cart, "hook", pair.wagon, "ring"));
    CHECK_FALSE(attach(world, pair.wagon, "ring", pair.cart, "hook"));
    CHECK(parent_of(world, pair.cart).is_null());
    CHECK(world.get<const Transform>(pair.cart).position == Vec3(3, 0, 1));
}

TEST_CASE("attach: the component attaches, follows, is changed and detaches") {
    Pair pair;
    World& world = pair.world;
    world.insert_resource(FrameTime{.step = 0.5f});
    world.add(pair.cart, Spin{{0, 1, 0}, 1.0f});
    world.add(pair.wagon, Attach{pair.cart, "hook", "ring", false});
    Schedule schedule = make_world_schedule();
    start_world(world);
    const auto point = [&](Entity entity, const char* name) {
        for (const AttachPoint& each : world.get<const AttachPoints>(entity).points) {
            if (each.name == name) {
                return transform_point(
                    world.get<const WorldTransform>(entity).world, each.position);
            }
        }
        return Vec3(INFINITY);
    };
    for (int i = 0; i < 4; ++i) {
        CHECK(glm::distance(point(pair.wagon, "ring"), point(pair.cart, "hook")) < 1e-5f);
        step_world(world, schedule);
    }
    // An event may move it relative to its parent: the attachment is not repeated.
    world.get<Transform>(pair.wagon).position.y += 1;
    step_world(world, schedule);
    CHECK(point(pair.wagon, "ring").y > point(pair.cart, "hook").y + 0.9f);
    world.get<Attach>(pair.wagon).by = "";
    step_world(world, schedule);
    const WorldTransform& placed = world.get<const WorldTransform>(pair.wagon);
    CHECK(glm::distance(transform_point(placed.world, Vec3(0)), point(pair.cart, "hook")) < 1e-5f);
    const Vec3 last = transform_point(placed.world, Vec3(0));
    world.get<Attach>(pair.wagon).to = Entity{};
    step_world(world, schedule);
    CHECK(parent_of(world, pair.wagon).is_null());
    CHECK(glm::distance(world.get<const Transform>(pair.wagon).position, last) < 1e-5f);
}

}  // namespace limn::attach_test
