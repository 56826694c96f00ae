// Rigid capsules on joints, without a world: laws of mechanics and closed forms.

#include "ecs/base/rng.h"
#include "systems/animation/ragdoll/closest_points.h"
#include "systems/animation/ragdoll/ragdoll_solver.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::ragdoll_solver_test {

using namespace limn::test;

namespace {

constexpr double kFrame = 1.0 / 60;
constexpr double kGravity = 9.81;
constexpr double kPiD = 3.14159265358979323846;

RigidCapsule
rod(double length, double radius, const RigidVec& origin, const RigidVec& along, double mass = 2) {
    const RigidQuat turn(RigidVec(0, 1, 0), glm::normalize(along));
    return make_capsule(RigidVec(0), RigidVec(0, length, 0), radius, mass, origin, turn);
}

RigidCapsule fixed_ball(const RigidVec& at) {
    RigidCapsule body = make_capsule(RigidVec(0), RigidVec(0), 0.01, 1, at, {1, 0, 0, 0});
    body.inverse_mass = body.inverse_along = body.inverse_across = 0;
    return body;
}

RagdollLimit free_limit() {
    RagdollLimit limit;
    limit.min = -4;
    limit.max = 4;
    limit.swing = limit.sway = 4;
    return limit;
}

/// Joins two bodies at a point of the world, at rest as they are.
RagdollJoint
join(const RagdollScene& scene, std::size_t parent, std::size_t child, const RigidVec& at) {
    const RigidCapsule& a = scene.bodies[parent];
    const RigidCapsule& b = scene.bodies[child];
    RagdollJoint joint;
    joint.parent = parent;
    joint.child = child;
    joint.anchor_parent = glm::conjugate(a.rotation) * (at - a.position);
    joint.anchor_child = glm::conjugate(b.rotation) * (at - b.position);
    joint.rest = glm::conjugate(a.rotation) * b.rotation;
    joint.target = joint.rest;
    joint.limit = free_limit();
    return joint;
}

/// Rods end to end along +x.
RagdollScene make_chain(std::size_t count) {
    RagdollScene scene;
    for (std::size_t i = 0; i < count; ++i) {
        const RigidVec at(0.3 * static_cast<double>(i), 0, 0);
        scene.bodies.push_back(rod(0.3, 0.04, at, {1, 0, 0}, 1 + 0.5 * static_cast<double>(i % 3)));
        if (i > 0) {
            scene.joints.push_back(join(scene, i - 1, i, at));
        }
    }
    return scene;
}

RigidVec inertia_spin(const RigidCapsule& body) {
    const RigidVec axis = body.rotation * body.axis;
    const RigidVec along = glm::dot(axis, body.spin) * axis;
    return along / body.inverse_along + (body.spin - along) / body.inverse_across;
}

struct Momenta {
    RigidVec linear = RigidVec(0);
    RigidVec angular = RigidVec(0);
    RigidVec moment = RigidVec(0);  ///< sum of mass times position
    double kinetic = 0;
    double size = 0;  ///< sum of the sizes of the linear momenta
};
Momenta momenta(const RagdollScene& scene) {
    Momenta sum;
    for (const RigidCapsule& body : scene.bodies) {
        const double mass = 1 / body.inverse_mass;
        sum.linear += mass * body.velocity;
        sum.size += mass * glm::length(body.velocity);
        sum.moment += mass * body.position;
        sum.angular += mass * glm::cross(body.position, body.velocity) + inertia_spin(body);
        sum.kinetic += 0.5 * mass * glm::dot(body.velocity, body.velocity)
                       + 0.5 * glm::dot(body.spin, inertia_spin(body));
    }
    return sum;
}

RigidVec draw(Random& random, float size) {
    const float x = random.uniform(-size, size);
    const float y = random.uniform(-size, size);
    const float z = random.uniform(-size, size);
    return RigidVec(Vec3(x, y, z));
}

void shake(RagdollScene& scene, std::uint64_t seed, float speed) {
    Random random(seed, 0, name_hash("shake"), 0);
    for (RigidCapsule& body : scene.bodies) {
        body.velocity = draw(random, speed);
        body.spin = draw(random, 3 * speed);
    }
}

/// Contacts with the ground y < 0 turned by `slope` about z.
FindContacts ground(double slope = 0) {
    const RigidVec normal(-std::sin(slope), std::cos(slope), 0);
    return [normal](
               const std::vector<RigidCapsule>& bodies, double,
               std::vector<RagdollContact>& contacts) {
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const LineSegment segment = bodies[i].placed();
            for (const RigidVec& end : {segment.from, segment.to}) {
                const double height = glm::dot(end, normal);
                if (height < bodies[i].radius) {
                    RagdollContact contact;
                    contact.body = i;
                    contact.normal = normal;
                    contact.point = glm::conjugate(bodies[i].rotation)
                                    * (end - bodies[i].radius * normal - bodies[i].position);
                    contact.under = end - height * normal;
                    contacts.push_back(contact);
                }
            }
        }
    };
}

/// Period of a pendulum of amplitude `angle`: 2 pi / omega / agm(1, cos(angle / 2)).
double pendulum_period(double omega, double angle) {
    double a = 1;
    double b = std::cos(angle / 2);
    for (int i = 0; i < 20; ++i) {
        const double mean = (a + b) / 2;
        b = std::sqrt(a * b);
        a = mean;
    }
    return 2 * kPiD / (omega * a);
}

}  // namespace

TEST_CASE("ragdoll solver: a body falls by 1/2 g t^2" * technique("char.dynamics")) {
    RagdollScene scene;
    scene.bodies.push_back(rod(0.3, 0.05, {0, 0, 0}, {1, 1, 0}));
    scene.bodies[0].velocity = {1, 2, -3};
    const RigidVec start = scene.bodies[0].position;
    for (int i = 0; i < 60; ++i) {
        step_ragdoll(scene, kFrame, {});
    }
    const RigidVec way = scene.bodies[0].position - start;
    CHECK(way.x == near(1).epsilon(1e-9));
    CHECK(way.z == near(-3).epsilon(1e-9));
    // Substeps end at the new velocity: 1/2 g t h lower.
    CHECK(way.y == near(2 - kGravity / 2 - kGravity / 2 * kRagdollSubstep).epsilon(1e-9));
    CHECK(scene.bodies[0].velocity.y == near(2 - kGravity).epsilon(1e-9));
}

TEST_CASE(
    "ragdoll solver: a free rod keeps angular momentum and energy, and precesses at L / I"
    * technique("char.dynamics")) {
    RagdollScene scene;
    scene.bodies.push_back(rod(0.4, 0.05, {0, 0, 0}, {0, 1, 0}));
    RigidCapsule& body = scene.bodies[0];
    body.spin = {2, 8, 0};
    const Momenta before = momenta(scene);
    const double rate = glm::length(before.angular) * body.inverse_across;
    const double nutation = glm::dot(glm::normalize(before.angular), body.rotation * body.axis);
    const RagdollOptions still = {.gravity = RigidVec(0)};
    const int frames = 120;
    for (int i = 0; i < frames; ++i) {
        step_ragdoll(scene, kFrame, still);
    }
    const Momenta after = momenta(scene);
    CHECK(glm::length(after.angular - before.angular) < 1e-4 * glm::length(before.angular));
    CHECK(after.kinetic == near(before.kinetic).epsilon(1e-3));
    const RigidVec up = glm::normalize(before.angular);
    const RigidVec axis = body.rotation * body.axis;
    CHECK(glm::dot(up, axis) == near(nutation).epsilon(1e-3));
    // The axis goes around L by rate * t.
    const RigidVec first = glm::normalize(RigidVec(0, 1, 0) - nutation * up);
    const RigidVec last = glm::normalize(axis - glm::dot(up, axis) * up);
    const double angle = std::atan2(glm::dot(glm::cross(first, last), up), glm::dot(first, last));
    const double expected = std::remainder(rate * frames * kFrame, 2 * kPiD);
    CHECK(std::abs(std::remainder(angle - expected, 2 * kPiD)) < 0.01);
}

TEST_CASE(
    "ragdoll solver: bodies on joints keep momentum without gravity, and gain no energy"
    * technique("char.dynamics")) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        RagdollScene scene = make_chain(8);
        for (RagdollJoint& joint : scene.joints) {
            joint.limit.swing = joint.limit.sway = 0.7f;
            joint.limit.min = -0.5f;
            joint.limit.max = 0.5f;
        }
        shake(scene, seed, 2);
        const Momenta before = momenta(scene);
        const RagdollOptions options = {.gravity = RigidVec(0), .damping = 1};
        Momenta last;
        double energy = 1e9;
        for (int i = 0; i < 120; ++i) {
            step_ragdoll(scene, kFrame, options);
            last = momenta(scene);
            CHECK(last.kinetic <= energy * (1 + 1e-4));
            energy = last.kinetic;
        }
        CHECK(glm::length(last.linear - before.linear) < 1e-9 * before.size);
        CHECK(glm::length(last.moment - before.moment - 2.0 * before.linear) < 1e-9 * before.size);
        CHECK(glm::length(last.angular - before.angular) < 0.01 * glm::length(before.angular));
        CHECK(last.kinetic < before.kinetic);
        CHECK(last.kinetic > 0.02 * before.kinetic);
    }
}

TEST_CASE(
    "ragdoll solver: anchors stay together, and limits hold, in a chain that is thrown about"
    * technique("char.dynamics")) {
    RagdollScene scene = make_chain(6);
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        RagdollLimit& limit = scene.joints[i].limit;
        limit.bone = {0, 1, 0};
        limit.center = {0, 1, 0};
        if (i % 2 == 0) {
            limit.kind = RagdollJointKind::Hinge;
            limit.axis = {1, 0, 0};
            limit.min = 0;
            limit.max = 2.4f;
        } else {
            limit.axis = {1, 0, 0};
            limit.swing = 0.8f;
            limit.sway = 0.3f;
            limit.min = -0.4f;
            limit.max = 0.2f;
        }
    }
    double anchor = 0;
    double excess = 0;
    double reached = 0;
    Random random(5, 0, name_hash("throw"), 0);
    for (int i = 0; i < 300; ++i) {
        if (i % 50 == 0) {
            for (RigidCapsule& body : scene.bodies) {
                body.velocity += draw(random, 3);
                body.velocity.y += 4;
            }
        }
        step_ragdoll(scene, kFrame, {}, ground());
        for (const RagdollJoint& joint : scene.joints) {
            anchor = std::max(anchor, anchor_error(scene, joint));
            excess = std::max(excess, limit_excess(scene, joint));
            RagdollJoint narrow = joint;
            narrow.limit.min += 0.02f;
            narrow.limit.max -= 0.02f;
            reached = std::max(reached, limit_excess(scene, narrow));
        }
    }
    CHECK(anchor < 1e-3);
    CHECK(excess < 0.02);
    CHECK(reached > 0.01);  // they were needed
}

TEST_CASE(
    "ragdoll solver: a rod swings with the period of a physical pendulum, small and large"
    * technique("char.dynamics")) {
    for (const double amplitude : {0.1, 2.0}) {
        RagdollScene scene;
        scene.bodies.push_back(fixed_ball({0, 0, 0}));
        const RigidVec along(std::sin(amplitude), -std::cos(amplitude), 0);
        scene.bodies.push_back(rod(0.5, 0.03, {0, 0, 0}, along));
        scene.joints.push_back(join(scene, 0, 1, {0, 0, 0}));
        const RigidCapsule& body = scene.bodies[1];
        const double arm = 0.25;
        const double inertia = 1 / body.inverse_across + arm * arm / body.inverse_mass;
        const double omega = std::sqrt(kGravity * arm / body.inverse_mass / inertia);
        const double period = pendulum_period(omega, amplitude);
        // From the amplitude through the lowest point, at a quarter and at three quarters.
        std::vector<double> crossings;
        double last = body.position.x;
        double time = 0;
        const double step = 1.0 / 4000;  // the method loses energy in proportion to it
        while (crossings.size() < 3 && time < 10) {
            step_ragdoll(scene, step, {});
            time += step;
            const double x = body.position.x;
            if ((x < 0) != (last < 0)) {
                crossings.push_back(time - step * x / (x - last));
            }
            last = x;
        }
        REQUIRE(crossings.size() == 3);
        CHECK(crossings[2] - crossings[0] == near(period).epsilon(0.01));
        CHECK(crossings[0] == near(period / 4).epsilon(0.01));
        CHECK(std::abs(body.position.z) < 1e-6);
    }
}

TEST_CASE("ragdoll solver: friction stops a sliding rod after v^2 / (2 mu g)") {
    RagdollScene scene;
    scene.bodies.push_back(rod(0.4, 0.02, {0, 0.02, 0}, {1, 0, 0}));
    scene.bodies[0].velocity = {2, 0, 0};
    const double start = scene.bodies[0].position.x;
    const RagdollOptions options = {.friction = 0.4};
    for (int i = 0; i < 90; ++i) {
        step_ragdoll(scene, kFrame, options, ground());
    }
    CHECK(scene.bodies[0].position.x - start == near(4 / (2 * 0.4 * kGravity)).epsilon(0.02));
    CHECK(glm::length(scene.bodies[0].velocity) < 1e-3);
}

TEST_CASE("ragdoll solver: on a slope a rod sticks up to atan mu, and slides beyond") {
    const double slope = std::atan(0.5);
    for (const double friction : {0.55, 0.3}) {
        RagdollScene scene;
        const RigidVec down(-std::cos(slope), -std::sin(slope), 0);
        const RigidVec normal(-std::sin(slope), std::cos(slope), 0);
        scene.bodies.push_back(rod(0.6, 0.01, 0.01 * normal, down));
        const RigidVec start = scene.bodies[0].position;
        const RagdollOptions options = {.friction = friction};
        for (int i = 0; i < 60; ++i) {
            step_ragdoll(scene, kFrame, options, ground(slope));
        }
        const double way = glm::dot(scene.bodies[0].position - start, down);
        const double sliding = 0.5 * kGravity * (std::sin(slope) - friction * std::cos(slope));
        if (friction > 0.5) {
            CHECK(std::abs(way) < 2e-3);
        } else {
            CHECK(way == near(sliding).epsilon(0.02));
        }
    }
}

TEST_CASE("ragdoll solver: a ball bounces to the square of the restitution of its height") {
    RagdollScene scene;
    scene.bodies.push_back(make_capsule({}, {}, 0.1, 1, {0, 1.1, 0}, {1, 0, 0, 0}));
    const RagdollOptions options = {.bounce = 0.6};
    double highest = 0;
    bool was_low = false;
    for (int i = 0; i < 55; ++i) {
        step_ragdoll(scene, kFrame, options, ground());
        const double height = scene.bodies[0].position.y - 0.1;
        was_low = was_low || height < 0.05;
        highest = was_low ? std::max(highest, height) : 0.0;
    }
    CHECK(highest == near(0.36).epsilon(0.03));
}

TEST_CASE("ragdoll solver: a heap comes to rest without jitter") {
    RagdollScene scene = make_chain(6);
    for (RigidCapsule& body : scene.bodies) {
        body.position.y += 0.5;
    }
    shake(scene, 4, 1);
    const RagdollOptions options = {.damping = 3};
    for (int i = 0; i < 300; ++i) {
        step_ragdoll(scene, kFrame, options, ground());
    }
    const std::vector<RigidCapsule> before = scene.bodies;
    for (int i = 0; i < 60; ++i) {
        step_ragdoll(scene, kFrame, options, ground());
        for (const RigidCapsule& body : scene.bodies) {
            CHECK(glm::length(body.velocity) < 0.01);
            CHECK(glm::length(body.spin) < 0.1);
        }
    }
    for (std::size_t i = 0; i < before.size(); ++i) {
        CHECK(glm::distance(before[i].position, scene.bodies[i].position) < 3e-3);
        const LineSegment segment = scene.bodies[i].placed();
        CHECK(std::min(segment.from.y, segment.to.y) > scene.bodies[i].radius - 1e-3);
    }
}

TEST_CASE(
    "ragdoll solver: what overlaps the ground at first leaves it slowly"
    * technique("char.dynamics")) {
    RagdollScene scene = make_chain(4);
    for (RigidCapsule& body : scene.bodies) {
        body.position.y -= 0.2;
    }
    double fastest = 0;
    for (int i = 0; i < 120; ++i) {
        step_ragdoll(scene, kFrame, {}, ground());
        for (const RigidCapsule& body : scene.bodies) {
            fastest = std::max(fastest, glm::length(body.velocity));
        }
    }
    CHECK(fastest < 1.6);
    for (const RigidCapsule& body : scene.bodies) {
        CHECK(body.position.y > 0.035);  // it is out
    }
}

TEST_CASE("ragdoll solver: muscles hold a pose against gravity, the better the stiffer") {
    double last = 10;
    for (const double rate : {0.0, 10.0, 40.0, 1e4}) {
        RagdollScene scene;
        scene.bodies.push_back(fixed_ball({0, 0, 0}));
        scene.bodies.push_back(rod(0.4, 0.04, {0, 0, 0}, {1, 0, 0}));
        scene.joints.push_back(join(scene, 0, 1, {0, 0, 0}));
        const RagdollOptions options = {.damping = 8, .muscles = rate};
        for (int i = 0; i < 240; ++i) {
            step_ragdoll(scene, kFrame, options);
        }
        const double sag = -scene.bodies[1].position.y;
        CHECK(sag < last);
        last = sag;
    }
    CHECK(last < 1e-3);
}

TEST_CASE("ragdoll solver: bodies of no length, steps of 0 and of 1 s stay finite") {
    RagdollScene scene = make_chain(3);
    scene.bodies.push_back(make_capsule({}, {}, 1e-3, 1e-3, {0.9, 0, 0}, {1, 0, 0, 0}));
    scene.joints.push_back(join(scene, 2, 3, {0.9, 0, 0}));
    scene.joints.back().limit.min = 1;  // nothing is left between
    scene.joints.back().limit.max = 1;
    const RigidVec before = scene.bodies[0].position;
    step_ragdoll(scene, 0, {}, ground());
    CHECK(scene.bodies[0].position == before);
    step_ragdoll(scene, 1, {}, ground());
    step_ragdoll(scene, NAN, {}, ground());
    for (const RigidCapsule& body : scene.bodies) {
        CHECK(std::isfinite(glm::length(body.position) + glm::length(body.spin)));
        CHECK(glm::length(body.position) < 20);
    }
}

TEST_CASE("ragdoll rig: mass and moments of a capsule are those of points spread over it") {
    const double length = 0.3;
    const double radius = 0.1;
    double count = 0;
    double along = 0;
    double across = 0;
    const int n = 80;
    const double cell = (length + 2 * radius) / n;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            for (int k = 0; k < n; ++k) {
                const RigidVec p =
                    cell * RigidVec(i - n / 2 + 0.5, j - n / 2 + 0.5, k - n / 2 + 0.5);
                const LineSegment segment = {{0, -length / 2, 0}, {0, length / 2, 0}};
                if (glm::distance(p, segment.at(closest_fraction(segment, p))) < radius) {
                    ++count;
                    along += p.x * p.x + p.z * p.z;
                    across += p.x * p.x + p.y * p.y;
                }
            }
        }
    }
    const CapsuleMass mass = find_capsule_mass(length, radius);
    CHECK(mass.volume == near(count * cell * cell * cell).epsilon(0.01));
    CHECK(mass.along == near(along / count).epsilon(0.01));
    CHECK(mass.across == near(across / count).epsilon(0.01));
}

TEST_CASE("ragdoll contacts: closest points are closer than any others") {
    Random random(7, 0, name_hash("closest"), 0);
    for (int i = 0; i < 300; ++i) {
        const LineSegment a = {draw(random, 1), draw(random, 1)};
        const LineSegment b = {draw(random, 1), draw(random, 1)};
        const Triangle3 triangle = {draw(random, 1), draw(random, 1), draw(random, 1)};
        const RigidVec half(0.4, 0.2, 0.3);
        const ClosestPair pair = closest_points(a, b);
        const RigidVec p = draw(random, 2);
        const RigidVec on_triangle = closest_point(triangle, p);
        const double at_box = closest_fraction_to_box(a, half);
        const auto box_distance = [&](const RigidVec& q) {
            return glm::length(glm::max(glm::abs(q) - half, RigidVec(0)));
        };
        for (int k = 0; k < 100; ++k) {
            const double u = static_cast<double>(random.uniform(0.0f, 1.0f));
            const double v = static_cast<double>(random.uniform(0.0f, 1.0f));
            CHECK(glm::distance(pair.on_a, pair.on_b) <= glm::distance(a.at(u), b.at(v)) + 1e-9);
            const double w = u + v > 1 ? 1 - v : v;
            const double x = u + v > 1 ? 1 - u : u;
            const RigidVec other =
                triangle.a + x * (triangle.b - triangle.a) + w * (triangle.c - triangle.a);
            CHECK(glm::distance(on_triangle, p) <= glm::distance(other, p) + 1e-9);
            CHECK(box_distance(a.at(at_box)) <= box_distance(a.at(u)) + 1e-3);
        }
    }
}

}  // namespace limn::ragdoll_solver_test
