#include "ecs/base/rotation.h"
#include "ecs/components/all.h"
#include "ecs/components/time.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/floating_body.h"
#include "systems/water/floating_contact.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace limn::floating_contact_test {
namespace {

ContactShape ball_at(const Vec3& center, float radius) {
    return {.center = center, .half = Vec3(radius), .ball = true};
}
ContactShape box_at(const Vec3& center, const Vec3& half, const Quat& rotation = {1, 0, 0, 0}) {
    return {.center = center, .axes = glm::mat3_cast(rotation), .half = half};
}

/// Distance by which the farthest points of `a` and `b` along a direction overlap, in double
/// precision.
double overlap_along(const ContactShape& a, const ContactShape& b, const glm::dvec3& direction) {
    const auto farthest = [&](const ContactShape& shape) {
        double extent = 0;
        for (int corner = 0; corner < 8; ++corner) {
            glm::dvec3 point(0);
            for (int i = 0; i < 3; ++i) {
                const double sign = (corner >> i & 1) != 0 ? 1 : -1;
                point += sign * double{shape.half[i]} * glm::dvec3(shape.axes[i]);
            }
            extent = std::max(extent, glm::dot(point, direction));
        }
        return extent;
    };
    return farthest(a) + farthest(b) - glm::dot(glm::dvec3(a.center - b.center), direction);
}

/// The least overlap over many directions: an upper bound of the true one, and close to it.
double least_overlap(const ContactShape& a, const ContactShape& b) {
    constexpr int kDirections = 40000;
    double least = INFINITY;
    for (int i = 0; i < kDirections; ++i) {
        const double y = 1 - 2 * (i + 0.5) / kDirections;
        const double r = std::sqrt(1 - y * y);
        const double turn = 2.399963229728653 * i;
        least = std::min(least, overlap_along(a, b, {r * std::cos(turn), y, r * std::sin(turn)}));
    }
    return least;
}

/// Two bodies in space.
struct Duel {
    WaterTouch touch[2];
    Floating floating[2];
    FloatingState state[2];
    Transform place[2];

    int collide() {
        const ContactBody bodies[] = {
            {&touch[0], &floating[0], &state[0], &place[0]},
            {&touch[1], &floating[1], &state[1], &place[1]}};
        return separate_floating_bodies(bodies);
    }
    struct Totals {
        glm::dvec3 momentum{0};
        double energy = 0;
    };
    /// With `place` as before a collision, which moves bodies apart besides.
    [[nodiscard]] Totals totals(const Transform (&pose)[2]) const {
        Totals sum;
        for (int i = 0; i < 2; ++i) {
            const BodyMass mass = body_mass(touch[i], floating[i], pose[i].scale);
            const glm::dmat3 axes(glm::mat3_cast(pose[i].rotation));
            const glm::dvec3 spin(state[i].spin);
            const glm::dvec3 local = glm::transpose(axes) * spin;
            const glm::dvec3 turning = axes * (glm::dvec3(mass.inertia) * local);
            const glm::dvec3 velocity(state[i].velocity);
            sum.momentum += double{mass.mass} * velocity;
            sum.energy +=
                0.5 * mass.mass * glm::dot(velocity, velocity) + 0.5 * glm::dot(turning, spin);
        }
        return sum;
    }
};

}  // namespace

TEST_CASE("floating contact: closed forms of balls and boxes") {
    const auto balls = find_contact(ball_at({0, 0, 0}, 1), ball_at({1.5f, 0, 0}, 0.75f));
    REQUIRE(balls);
    CHECK(balls->depth == test::near(0.25f));
    CHECK(balls->normal.x == test::near(-1));
    CHECK(balls->point.x == test::near(0.875f));
    CHECK_FALSE(find_contact(ball_at({0, 0, 0}, 1), ball_at({1.8f, 0, 0}, 0.75f)));

    const ContactShape box = box_at({0, 0, 0}, {1, 2, 3});
    const auto face = find_contact(ball_at({1.4f, 0.5f, -1}, 0.5f), box);
    REQUIRE(face);
    CHECK(face->depth == test::near(0.1f));
    CHECK(face->normal.x == test::near(1));
    CHECK(face->point.y == test::near(0.5f));
    const auto corner = find_contact(box, ball_at({1.1f, 2.2f, 3.2f}, 0.5f));
    REQUIRE(corner);
    CHECK(corner->depth == test::near(0.2f));
    CHECK(corner->normal.y == test::near(-2.0f / 3));
    const auto inside = find_contact(ball_at({0.7f, 0, 0}, 0.5f), box);
    REQUIRE(inside);
    CHECK(inside->depth == test::near(0.8f));
    CHECK(inside->normal.x == test::near(1));

    const auto stack = find_contact(box, box_at({0.2f, 3.9f, 0}, {1, 2, 3}));
    REQUIRE(stack);
    CHECK(stack->depth == test::near(0.1f));
    CHECK(stack->normal.y == test::near(-1));
    const Quat diamond = glm::angleAxis(kPi / 4, Vec3(0, 0, 1));
    const auto edge = find_contact(box_at({2.4f, 0, 0}, Vec3(1), diamond), box);
    REQUIRE(edge);
    CHECK(edge->depth == test::near(1 + std::sqrt(2.0f) - 2.4f));
    CHECK(edge->normal.x == test::near(1));
}

TEST_CASE("floating contact: boxes overlap by the least overlap of 40,000 directions") {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> any(-1, 1);
    int met = 0;
    for (int i = 0; i < 60; ++i) {
        const auto turned = [&] {
            return glm::normalize(Quat(any(random), any(random), any(random), any(random) + 0.01f));
        };
        const ContactShape a = box_at(
            {any(random), any(random), any(random)},
            0.6f + 0.4f * Vec3(any(random), any(random), any(random)), turned());
        const ContactShape b = box_at(
            {any(random), any(random), any(random)},
            0.6f + 0.4f * Vec3(any(random), any(random), any(random)), turned());
        const double least = least_overlap(a, b);
        const auto contact = find_contact(a, b);
        CAPTURE(i);
        if (least < 0) {
            CHECK_FALSE(contact);
        } else if (least > 0.02) {
            REQUIRE(contact);
            ++met;
            CHECK(contact->depth <= 1.06 * least);  // edges yield to faces that are little deeper
            CHECK(contact->depth > least - 0.012);
            CHECK(
                overlap_along(b, a, glm::dvec3(-contact->normal))
                == test::near(contact->depth).epsilon(1e-3));
        }
    }
    CHECK(met > 25);
}

TEST_CASE("floating contact: equal balls that meet head on by their restitution") {
    Duel duel;
    for (int i = 0; i < 2; ++i) {
        duel.touch[i] = {.half = Vec3(0.5f)};
        duel.place[i].position.x = i == 0 ? 0.0f : 0.99f;
    }
    duel.state[0].velocity = {2, 0, 0};
    CHECK(duel.collide() == 1);
    CHECK(duel.state[0].velocity.x == test::near(0.5f * (1 - 0.25f) * 2));
    CHECK(duel.state[1].velocity.x == test::near(0.5f * (1 + 0.25f) * 2));
    CHECK(duel.place[1].position.x - duel.place[0].position.x > 0.99f);
}

TEST_CASE("floating contact: momentum is kept, and energy does not grow") {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> any(-1, 1);
    int met = 0;
    for (int i = 0; i < 300; ++i) {
        Duel duel;
        for (int k = 0; k < 2; ++k) {
            duel.touch[k] = {
                .shape = any(random) > 0 ? TouchShape::Box : TouchShape::Ball,
                .half = 0.5f + 0.3f * Vec3(any(random), any(random), any(random))};
            duel.floating[k].density = 300 + 200 * any(random);
            duel.floating[k].center_of_mass = {0, 0.1f * any(random), 0};
            duel.place[k].position = 0.7f * Vec3(any(random), any(random), any(random));
            duel.place[k].rotation =
                glm::normalize(Quat(any(random), any(random), any(random), any(random) + 0.01f));
            duel.state[k].velocity = 3.0f * Vec3(any(random), any(random), any(random));
            duel.state[k].spin = 2.0f * Vec3(any(random), any(random), any(random));
        }
        const Transform places[2] = {duel.place[0], duel.place[1]};
        const Duel::Totals before = duel.totals(places);
        met += duel.collide();
        const Duel::Totals after = duel.totals(places);
        // Positions are moved apart between rounds, so that arms differ a little.
        CHECK(glm::length(after.momentum - before.momentum) < 1e-3 * 1000);
        CHECK(after.energy < before.energy * (1 + 1e-3) + 1e-3);
    }
    CHECK(met > 150);
}

TEST_CASE("floating contact: bodies dropped on one heap end up side by side") {
    Schedule schedule = make_world_schedule();
    World world;
    world.insert_resource(FrameTime{.step = 1.0f / 60});
    world.create(Water{.size = {6, 6}, .depth = 4}, Transform{}, WorldTransform{});
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-1, 1);
    std::vector<Entity> bodies;
    for (int i = 0; i < 24; ++i) {
        const bool is_box = i % 2 == 0;
        bodies.push_back(world.create(
            WaterTouch{
                .shape = is_box ? TouchShape::Box : TouchShape::Ball,
                .half = is_box ? Vec3(0.3f, 0.2f, 0.35f) : Vec3(0.25f)},
            Floating{.density = 350},
            Transform{
                .position = {0.7f * any(random), 0.3f + 0.4f * static_cast<float>(i), any(random)},
                .rotation = glm::normalize(
                    Quat(any(random), any(random), any(random), any(random) + 0.01f))},
            WorldTransform{}));
    }
    for (int i = 0; i < 60 * 25; ++i) {
        step_world(world, schedule);
    }
    const auto shape_of = [&](Entity entity) {
        const auto& touch = world.get<WaterTouch>(entity);
        const auto& pose = world.get<Transform>(entity);
        return touch.shape == TouchShape::Box ? box_at(pose.position, touch.half, pose.rotation)
                                              : ball_at(pose.position, touch.half.x);
    };
    float deepest = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        CHECK(std::abs(world.get<Transform>(bodies[i]).position.y) < 0.5f);
        CHECK(glm::length(world.get<FloatingState>(bodies[i]).velocity) < 0.2f);
        for (std::size_t k = 0; k < i; ++k) {
            if (const auto contact = find_contact(shape_of(bodies[i]), shape_of(bodies[k]))) {
                deepest = std::max(deepest, contact->depth);
            }
        }
    }
    CHECK(deepest < 0.02f);
}

}  // namespace limn::floating_contact_test
