#include "ecs/base/rng.h"
#include "systems/particles/particle_collision.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace limn::particle_collision_test {

using namespace limn::test;

namespace {

constexpr float kStep = 1.0f / 60.0f;
constexpr Vec3 kGravity = {0, -9.81f, 0};
constexpr SurfaceResponse kMirror = {.bounce = 1, .friction = 1};

const Collider kFloor = PlaneCollider{};

Vec3 random_vector(Random& random, float size) {
    return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

void check_near(const Vec3& found, const Vec3& expected, double tolerance = 1e-5) {
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(double{found[axis]} == near(double{expected[axis]}).epsilon(tolerance).scale(1));
    }
}

/// One step under gravity.
CollisionResult fall(const CollisionResult& now, const Collider& floor, float bounce, float dt) {
    return move_with_collisions(
        now.position, now.velocity + dt * kGravity, dt, {&floor, 1},
        {.bounce = bounce, .friction = 1});
}

}  // namespace

// ---- particle.plane-response
// -----------------------------------------------------------------------------

TEST_CASE(
    "particle collision: the table of bump and friction" * technique("particle.plane-response")) {
    const Vec3 v(3, -4, 0);
    const Vec3 up(0, 1, 0);
    CHECK(respond(v, up, {0, 1}) == Vec3(3, 0, 0));
    CHECK(respond(v, up, {1, 0}) == Vec3(0, 4, 0));
    CHECK(respond(v, up, {1, 1}) == Vec3(3, 4, 0));
    CHECK(respond(v, up, {0, 0}) == Vec3(0));
    CHECK(respond(v, up, {0.5f, 0.5f}) == Vec3(1.5f, 2, 0));
}

TEST_CASE(
    "particle collision: velocities along or away from a surface stay"
    * technique("particle.plane-response")) {
    CHECK(respond({3, 4, 1}, {0, 1, 0}, {0, 0}) == Vec3(3, 4, 1));
    CHECK(respond({3, 0, 1}, {0, 1, 0}, {0, 0}) == Vec3(3, 0, 1));
    CHECK(respond({3, -4, 1}, Vec3(0), {0, 0}) == Vec3(3, -4, 1));  // no direction
}

TEST_CASE(
    "particle collision: long normals are normalized, fractions beyond 0 .. 1 are clamped"
    * technique("particle.plane-response")) {
    CHECK(respond({3, -4, 0}, {0, 10, 0}, {0.5f, 0.5f}) == Vec3(1.5f, 2, 0));
    CHECK(respond({3, -4, 0}, {0, 1, 0}, {7, 7}) == Vec3(3, 4, 0));
    CHECK(respond({3, -4, 0}, {0, 1, 0}, {-1, -1}) == Vec3(0));
}

TEST_CASE(
    "particle collision: no response adds speed, only the mirror keeps it"
    * technique("particle.plane-response")) {
    Random random(1, 2, 3, 4);
    for (int i = 0; i < 10000; ++i) {
        const Vec3 v = random_vector(random, 10);
        const Vec3 normal = normalize_or(random_vector(random, 1), Vec3(0, 1, 0));
        const SurfaceResponse response = {random.uniform(), random.uniform()};
        const double before = glm::length(glm::dvec3(v));
        CHECK(glm::length(glm::dvec3(respond(v, normal, response))) <= before * (1 + 1e-6));
        CHECK(glm::length(glm::dvec3(respond(v, normal, kMirror))) == near(before).epsilon(1e-6));
        const double toward = -glm::dot(glm::dvec3(v), glm::dvec3(normal));
        if (toward > 0.1) {
            CHECK(glm::length(glm::dvec3(respond(v, normal, {0.99f, 1}))) < before);
        }
    }
}

TEST_CASE(
    "particle collision: the angle to the plane is atan(bump v_n / friction v_t)"
    * technique("particle.plane-response")) {
    Random random(5, 6, 7, 8);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 v(random.uniform(0.1f, 5.0f), -random.uniform(0.1f, 5.0f), 0);
        const SurfaceResponse response = {random.uniform(0.1f, 1.0f), random.uniform(0.1f, 1.0f)};
        const Vec3 after = respond(v, {0, 1, 0}, response);
        const double expected = std::atan2(
            double{response.bounce} * -double{v.y}, double{response.friction} * double{v.x});
        CHECK(std::atan2(double{after.y}, double{after.x}) == near(expected));
    }
}

// ---- particle.collision-loop
// -----------------------------------------------------------------------------

TEST_CASE(
    "particle collision: a contact costs no time, or no length as in the book"
    * technique("particle.collision-loop")) {
    const Vec3 from(0, 1, 0);
    const Vec3 v(1, -2, 0);
    const SurfaceResponse slide = {.bounce = 0, .friction = 1};
    CollisionOptions options = {.skin = 1e-6f};
    CollisionResult end = move_with_collisions(from, v, 1, {&kFloor, 1}, slide, options);
    check_near(end.position, {1, 0, 0});  // without the loop (0.5, 0, 0)
    check_near(end.velocity, {1, 0, 0});
    CHECK(end.contacts == 1);

    options.mode = CollisionOptions::Mode::Length;
    end = move_with_collisions(from, v, 1, {&kFloor, 1}, slide, options);
    check_near(end.position, {1.618034f, 0, 0});
    check_near(end.velocity, {1, 0, 0});
}

TEST_CASE("particle collision: a mirror gives the same path by time and by length") {
    for (const auto mode : {CollisionOptions::Mode::Time, CollisionOptions::Mode::Length}) {
        const CollisionResult end = move_with_collisions(
            {0, 1, 0}, {1, -2, 0}, 1, {&kFloor, 1}, kMirror, {.skin = 1e-6f, .mode = mode});
        check_near(end.position, {1, 1, 0});
        check_near(end.velocity, {1, 2, 0});
    }
}

TEST_CASE("particle collision: without contact a particle keeps its path") {
    const CollisionResult end =
        move_with_collisions({1, 2, 3}, {0.5f, -1, 0.25f}, 1, {&kFloor, 1}, kMirror);
    CHECK(end.position == Vec3(1.5f, 1, 3.25f));
    CHECK(end.velocity == Vec3(0.5f, -1, 0.25f));
    CHECK(end.contacts == 0);
}

TEST_CASE("particle collision: a surface that takes all speed is where the path ends") {
    for (const auto mode : {CollisionOptions::Mode::Time, CollisionOptions::Mode::Length}) {
        const CollisionResult end = move_with_collisions(
            {0, 1, 0}, {1, -2, 0}, 1, {&kFloor, 1}, {0, 0}, {.skin = 1e-6f, .mode = mode});
        check_near(end.position, {0.5f, 0, 0});
        CHECK(end.velocity == Vec3(0));
    }
}

TEST_CASE(
    "particle collision: a corner takes two contacts" * technique("particle.collision-loop")) {
    const Collider walls[] = {PlaneCollider{}, PlaneCollider{.normal = {-1, 0, 0}, .offset = -1}};
    const CollisionResult end =
        move_with_collisions({0, 0.5f, 0}, {2, -1, 0}, 1, walls, kMirror, {.skin = 1e-6f});
    CHECK(end.contacts == 2);
    check_near(end.position, {0, 0.5f, 0});
    check_near(end.velocity, {-2, 1, 0});
}

TEST_CASE(
    "particle collision: in an acute corner it stops after the largest number of bounces"
    * technique("particle.collision-loop")) {
    const float angle = 0.01f;
    const Collider walls[] = {
        PlaneCollider{}, PlaneCollider{.normal = {std::sin(angle), -std::cos(angle), 0}}};
    const CollisionResult end =
        move_with_collisions({10, 0.05f, 0}, {-100, 3, 0}, 1, walls, kMirror, {.max_bounces = 5});
    CHECK(end.contacts == 5);
    CHECK(end.velocity == Vec3(0));
    CHECK(end.position.y >= 0);
    CHECK(end.position.y <= end.position.x * std::tan(angle) + 1e-4f);
}

TEST_CASE(
    "particle collision: a box of mirrors unfolds to straight flight"
    * technique("particle.collision-loop")) {
    // Oracle: in a room of planes the path is a triangle wave of the straight one along each axis.
    std::vector<Collider> room;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 normal(0);
        normal[axis] = 1;
        room.push_back(PlaneCollider{.normal = normal, .offset = 0});
        room.push_back(PlaneCollider{.normal = -normal, .offset = -1});
    }
    Random random(3, 1, 4, 1);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 from = Vec3(0.5f) + random_vector(random, 0.45f);
        const Vec3 v = random_vector(random, 3);
        const CollisionResult end = move_with_collisions(
            from, v, 1, room, kMirror, {.max_bounces = 100, .skin = 1e-7f, .rest_speed = 0});
        for (int axis = 0; axis < 3; ++axis) {
            const double straight = double{from[axis]} + double{v[axis]};
            const double folded = std::abs(std::remainder(straight, 2.0));
            CHECK(double{end.position[axis]} == near(folded).epsilon(1e-4).scale(1));
        }
    }
}

TEST_CASE("particle collision: nothing that is not finite moves") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, infinity}) {
        const CollisionResult a =
            move_with_collisions({0, 1, 0}, {bad, 0, 0}, 1, {&kFloor, 1}, kMirror);
        CHECK(a.position == Vec3(0, 1, 0));
        CHECK(a.velocity == Vec3(0));
        const CollisionResult b =
            move_with_collisions({0, 1, 0}, {1, 0, 0}, bad, {&kFloor, 1}, kMirror);
        CHECK(b.position == Vec3(0, 1, 0));
        CHECK(b.velocity == Vec3(0));
    }
    CHECK(
        move_with_collisions({0, nan, 0}, {1, 0, 0}, 1, {&kFloor, 1}, kMirror).velocity == Vec3(0));
    CHECK(
        move_with_collisions({0, 1, 0}, {1, 0, 0}, -1, {&kFloor, 1}, kMirror).position
        == Vec3(0, 1, 0));
}

// ---- particle.penetration-guard
// -----------------------------------------------------------------------------

TEST_CASE(
    "particle collision: outside or inside before and after decides the response"
    * technique("particle.penetration-guard")) {
    struct Case {
        const char* name;
        float from, speed;  // height and upward speed
        float to, after;    // expected
        int contacts;
    };
    const float skin = 1e-3f;
    for (const Case& each : {
             Case{"out, out", 1, -0.5f, 0.5f, -0.5f, 0},
             Case{"out, in", 1, -2, 0.5f, 1, 1},
             Case{"in, in, going in", -0.5f, -1, skin, 0, 0},
             Case{"in, in, going out", -0.5f, 0.2f, skin + 0.2f, 0.2f, 0},
             Case{"in, out", -0.5f, 1, skin + 1, 1, 0},
         }) {
        CAPTURE(each.name);
        const CollisionResult end = move_with_collisions(
            {0, each.from, 0}, {0, each.speed, 0}, 1, {&kFloor, 1}, {0.5f, 1}, {.skin = skin});
        CHECK(double{end.position.y} == near(double{each.to}).scale(1).epsilon(2e-3));
        CHECK(double{end.velocity.y} == near(double{each.after}).scale(1e-6));
        CHECK(end.contacts == each.contacts);
    }
}

TEST_CASE(
    "particle collision: a particle at rest stays at rest"
    * technique("particle.penetration-guard")) {
    for (const float bounce : {0.0f, 0.5f, 1.0f}) {
        CollisionResult now = {.position = {0.25f, 0, 0}};
        for (int i = 0; i < 1000; ++i) {
            now = fall(now, kFloor, bounce, kStep);
            CHECK(now.position.y >= 0);
            CHECK(now.position.y < 1e-3f);
            CHECK(glm::length(now.velocity) == 0);
        }
        CHECK(now.position.x == 0.25f);
    }
}

TEST_CASE(
    "particle collision: a particle that starts inside does not bounce in the next step either"
    * technique("particle.penetration-guard")) {
    CollisionResult now = {.position = {0, -0.1f, 0}, .velocity = {0, -5, 0}};
    for (int i = 0; i < 3; ++i) {
        now = fall(now, kFloor, 1, kStep);
        CHECK(now.velocity.y <= 0);
    }
}

TEST_CASE("particle collision: a bouncing particle does not rise higher than it fell from") {
    for (const float bounce : {0.3f, 0.9f, 1.0f}) {
        CollisionResult now = {.position = {0, 2, 0}};
        for (int i = 0; i < 20000; ++i) {
            now = fall(now, kFloor, bounce, kStep / 10);
            CHECK(now.position.y <= 2.0f * 1.01f);
        }
    }
}

// ---- particle.heightfield-collision
// -----------------------------------------------------------------------------

TEST_CASE(
    "particle collision: a drop from z0 rebounds to b^2 z0"
    * technique("particle.heightfield-collision")) {
    const std::vector<float> flat(16, 0.5f);
    const Collider floors[] = {
        PlaneCollider{.offset = 0.5f},
        HeightCollider{.origin = {-1, 0, -1}, .width = 4, .depth = 4, .heights = flat}};
    for (const Collider& floor : floors) {
        for (const float bounce : {0.4f, 0.7f, 1.0f}) {
            CollisionResult now = {.position = {0, 2.5f, 0}};
            float highest = 0;
            bool bounced = false;
            for (int i = 0; i < 8000; ++i) {
                now = fall(now, floor, bounce, 2.5e-4f);
                if (bounced && now.contacts > 0) {
                    break;
                }
                bounced = bounced || now.contacts > 0;
                highest = bounced ? std::max(highest, now.position.y) : 0.0f;
            }
            CHECK(double{highest - 0.5f} == near(2.0 * double{bounce * bounce}).epsilon(0.01));
        }
    }
}

TEST_CASE(
    "particle collision: a linear height field acts as the plane that it is"
    * technique("particle.heightfield-collision")) {
    // y = 0.5 x - 0.25 z
    std::vector<float> heights;
    for (int j = 0; j < 9; ++j) {
        for (int i = 0; i < 9; ++i) {
            heights.push_back(0.5f * static_cast<float>(i - 4) - 0.25f * static_cast<float>(j - 4));
        }
    }
    const Collider field =
        HeightCollider{.origin = {-4, 0, -4}, .width = 9, .depth = 9, .heights = heights};
    const Collider plane = PlaneCollider{.normal = {-0.5f, 1, 0.25f}};
    Random random(2, 7, 1, 8);
    for (int i = 0; i < 2000; ++i) {
        Vec3 from = random_vector(random, 1);
        from.y = 1.5f;
        const Vec3 v(
            random.uniform(-2.0f, 2.0f), random.uniform(-4.0f, -2.0f), random.uniform(-2.0f, 2.0f));
        const SurfaceResponse response = {random.uniform(), random.uniform()};
        const float radius = i % 2 == 0 ? 0.0f : 0.1f;
        const CollisionOptions options = {.radius = radius};
        const CollisionResult a = move_with_collisions(from, v, 1, {&field, 1}, response, options);
        const CollisionResult b = move_with_collisions(from, v, 1, {&plane, 1}, response, options);
        check_near(a.position, b.position, 1e-4);
        check_near(a.velocity, b.velocity, 1e-4);
    }
}

TEST_CASE(
    "particle collision: a mirror keeps the speed on a height field, never below it"
    * technique("particle.heightfield-collision")) {
    Random random(9, 9, 8, 7);
    std::vector<float> heights(32 * 32);
    for (float& height : heights) {
        height = random.uniform();
    }
    const HeightCollider field = {
        .cell = {0.5f, 0.5f}, .width = 32, .depth = 32, .heights = heights};
    const Collider collider = field;
    int contacts = 0;
    for (int i = 0; i < 5000; ++i) {
        const Vec3 from(random.uniform(4.0f, 12.0f), 1.5f, random.uniform(4.0f, 12.0f));
        const Vec3 v = random_vector(random, 3);
        const CollisionResult end = move_with_collisions(
            from, v, 1, {&collider, 1}, kMirror, {.max_bounces = 64, .rest_speed = 0});
        contacts += end.contacts;
        CHECK(double{glm::length(end.velocity)} == near(double{glm::length(v)}).epsilon(1e-4));
        CHECK(push_out(collider, end.position) == end.position);
    }
    CHECK(contacts > 2000);
}

// ---- the guarantee
// -----------------------------------------------------------------------------

namespace {

/// The walls of a cube around the origin, 1 mm thick, turned by a rotation that no axis survives.
struct Room {
    Affine world_from_room = to_affine(
        glm::translate(Mat4(1), Vec3(0.3f, 0.2f, -0.1f))
        * glm::rotate(Mat4(1), 0.7f, glm::normalize(Vec3(1, 2, 3))));
    std::vector<Collider> boxes;
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;

    explicit Room(float half) {
        const float thin = 0.5e-3f;
        for (int axis = 0; axis < 3; ++axis) {
            for (const float side : {-1.0f, 1.0f}) {
                Vec3 center(0);
                center[axis] = side * (half + thin);
                Vec3 size(half + 2 * thin);
                size[axis] = thin;
                add_wall(center, size);
            }
        }
    }
    void add_wall(const Vec3& center, const Vec3& size) {
        const Affine at = world_from_room * to_affine(glm::translate(Mat4(1), center));
        boxes.push_back(BoxCollider{.world_from_box = at, .half = size});
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 sign(
                (corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
            positions.push_back(transform_point(at, sign * size));
        }
        for (const std::uint32_t i : {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                                      2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3}) {
            indices.push_back(first + i);
        }
    }
};

/// How many of 20,000 particles at 60 m/s leave the room in 5 steps.
int count_escaped(const Room& room, float half, std::span<const Collider> walls, float radius) {
    Random random(1, 6, 1, 8);
    const Affine room_from_world = to_affine(glm::inverse(to_mat4(room.world_from_room)));
    int escaped = 0;
    for (int i = 0; i < 20000; ++i) {
        CollisionResult now = {
            .position = transform_point(room.world_from_room, random_vector(random, 0.95f * half)),
            .velocity = 60.0f * normalize_or(random_vector(random, 1), Vec3(1, 0, 0))};
        const SurfaceResponse response = {random.uniform(0.9f, 1.0f), 1};
        for (int step = 0; step < 5; ++step) {
            now = move_with_collisions(
                now.position, now.velocity, kStep, walls, response, {.radius = radius});
        }
        const Vec3 at = glm::abs(transform_point(room_from_world, now.position));
        escaped += std::max({at.x, at.y, at.z}) <= half ? 0 : 1;
    }
    return escaped;
}

}  // namespace

TEST_CASE("particle collision: of 100,000 paths at 60 m/s none passes a box 1 mm thick") {
    const Room room(0.8f);
    CHECK(count_escaped(room, 0.8f, room.boxes, 0) == 0);
    CHECK(count_escaped(room, 0.8f, room.boxes, 0.01f) == 0);
}

TEST_CASE(
    "particle collision: of 100,000 paths at 60 m/s none passes a mesh 1 mm thick"
    * technique("particle.collision-loop")) {
    const Room room(0.8f);
    const MeshBvh bvh = build_mesh_bvh(room.positions, room.indices);
    const Collider mesh = MeshCollider{.bvh = &bvh};
    CHECK(count_escaped(room, 0.8f, {&mesh, 1}, 0) == 0);
    CHECK(count_escaped(room, 0.8f, {&mesh, 1}, 0.01f) == 0);
}

TEST_CASE("particle collision: the skin pushes no particle through a second wall") {
    // Two sheets that meet at an edge along z, at an angle in which there is no room for the skin.
    const float open = 1e-5f;
    const Vec3 positions[] = {{0, 0, -9}, {9, 0, 0}, {0, 0, 9}, {9, 9 * open, 0}};
    const std::uint32_t indices[] = {0, 1, 2, 0, 3, 2};
    const MeshBvh bvh = build_mesh_bvh(positions, indices);
    const Collider wedge = MeshCollider{.bvh = &bvh};
    Random random(1, 2, 1, 2);
    for (int i = 0; i < 1000; ++i) {
        const float x = random.uniform(1.0f, 4.0f);
        const Vec3 from(x, 0.5f * x * open, random.uniform(-1.0f, 1.0f));
        const Vec3 v(random.uniform(-1.0f, 1.0f), random.uniform(-1.0f, 1.0f), 0);
        const Vec3 end = move_with_collisions(from, v, 1, {&wedge, 1}, kMirror).position;
        CHECK(end.y >= 0);
        CHECK(end.y <= end.x * open);
    }
}

}  // namespace limn::particle_collision_test
