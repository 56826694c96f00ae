#include "ecs/base/rng.h"
#include "ecs/components/deformers.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/animation/deformer_kernels.h"
#include "systems/animation/deformer_system.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <hwy/targets.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace limn::deformers_test {
namespace {

using test::near;

constexpr LinearMuscle kMuscleUp{
    .attachment = {0, 0, 0},
    .insertion = {0, 0.05f, 0},
    .angle = 0.6f,
    .full = 0.04f,
    .reach = 0.06f,
    .contraction = 0.2f};

Vec3 through(const Deformers& deformers, const Vec3& p) {
    return deform_point(pack_deformers(deformers), p);
}

Deformers with(const LinearMuscle& muscle) {
    return {.muscles = {muscle}, .sphincters = {}, .lattices = {}};
}

Deformers with(const SphincterMuscle& muscle) {
    return {.muscles = {}, .sphincters = {muscle}, .lattices = {}};
}

Deformers with(Lattice lattice) {
    return {.muscles = {}, .sphincters = {}, .lattices = {std::move(lattice)}};
}

std::size_t index_of(int i, int j, int k) {
    return static_cast<std::size_t>(i + 4 * j + 16 * k);
}

/// A slanted box whose points are moved by `offset`.
template <typename Offset>
Lattice make_lattice(Offset&& offset) {
    Lattice lattice{
        .origin = {0.1f, -0.2f, 0.3f},
        .u = {1, 0.2f, 0},
        .v = {0, 0.8f, 0.1f},
        .w = {0.1f, 0, 0.5f},
        .offsets = {}};
    lattice.offsets.resize(kLatticePoints);
    for (int k = 0; k < 4; ++k) {
        for (int j = 0; j < 4; ++j) {
            for (int i = 0; i < 4; ++i) {
                const Vec3 at = lattice.origin + static_cast<float>(i) / 3.0f * lattice.u
                                + static_cast<float>(j) / 3.0f * lattice.v
                                + static_cast<float>(k) / 3.0f * lattice.w;
                lattice.offsets[index_of(i, j, k)] = offset(at, i, j, k);
            }
        }
    }
    return lattice;
}

Vec3 inside(const Lattice& lattice, float u, float v, float w) {
    return lattice.origin + u * lattice.u + v * lattice.v + w * lattice.w;
}

const std::vector<Vec3> kPlaces{
    {0, 0, 0},
    {1, 0, 0},
    {0.5f, 0.5f, 0.5f},
    {0.2f, 0.7f, 0.9f},
    {0.99f, 0.01f, 0.4f},
    {0.33f, 0.66f, 0.1f},
    {0.75f, 0.25f, 0.6f}};

}  // namespace

TEST_CASE(
    "muscle: at rest nothing moves, and points beyond its range or cone never do"
    * technique("face.waters-muscle")) {
    LinearMuscle muscle = kMuscleUp;
    muscle.contraction = 0.0f;
    for (float x = -0.1f; x <= 0.1f; x += 0.01f) {
        for (float y = -0.1f; y <= 0.1f; y += 0.01f) {
            const Vec3 p(x, y, 0.003f);
            CHECK(through(with(muscle), p) == p);
            const bool beyond = glm::length(p) > 0.06f || p.y / glm::length(p) < std::cos(0.6f);
            if (beyond) {
                CHECK(through(with(kMuscleUp), p) == p);
            }
        }
    }
}

TEST_CASE(
    "muscle: it pulls to the bone, most at full, not at all there or at its range"
    * technique("face.waters-muscle")) {
    const auto pull = [](float distance) {
        const Vec3 p(0, distance, 0);
        const Vec3 moved = through(with(kMuscleUp), p) - p;
        CHECK(moved.x == 0.0f);
        CHECK(moved.z == 0.0f);
        return -moved.y;
    };
    CHECK(pull(1e-5f) < 1e-5f);
    CHECK(pull(0.04f) == near(0.2 * 0.05));
    CHECK(pull(0.0599f) < 1e-6f);  // no crease
    CHECK(pull(0.02f) == near(0.01 * std::cos(kPi / 4)));
    CHECK(pull(0.05f) == near(0.01 * 0.5));
    float last = pull(1e-5f);
    for (float distance = 1e-5f; distance < 0.07f; distance += 1e-5f) {
        const float now = pull(distance);
        CHECK(std::abs(now - last) < 1e-5f);
        last = now;
    }
    // Off the axis the pull still leads to the attachment, and ends at the border of the cone.
    const Vec3 p = 0.04f * Vec3(std::sin(0.3f), std::cos(0.3f), 0);
    const Vec3 moved = through(with(kMuscleUp), p) - p;
    CHECK(glm::length(glm::cross(moved, p)) < 1e-9f);
    CHECK(glm::length(moved) == near(0.01 * 0.5));
    const Vec3 border = 0.04f * Vec3(std::sin(0.5999f), std::cos(0.5999f), 0);
    CHECK(glm::distance(through(with(kMuscleUp), border), border) < 1e-8f);  // no crease
}

TEST_CASE("muscle: pulls add, but never beyond the bone" * technique("face.waters-muscle")) {
    Deformers twice = with(kMuscleUp);
    twice.muscles.push_back(kMuscleUp);
    const Vec3 p(0, 0.04f, 0);
    CHECK(through(twice, p).y == near(0.04 - 0.02));
    for (int i = 0; i < 50; ++i) {
        twice.muscles.push_back(kMuscleUp);
    }
    CHECK(std::abs(through(twice, p).y) < 1e-8f);
}

TEST_CASE(
    "sphincter: strongest at the center, nothing on the ellipse, and flat in its depth"
    * technique("face.waters-muscle")) {
    const SphincterMuscle ring{
        .center = {1, 2, 3},
        .right = {0.03f, 0, 0},
        .up = {0, 0.02f, 0},
        .depth = 0.01f,
        .contraction = 0.5f};
    for (float angle = 0.0f; angle < 6.28f; angle += 0.1f) {
        const Vec3 out(0.03f * std::cos(angle), 0.02f * std::sin(angle), 0);
        CHECK(glm::distance(through(with(ring), ring.center + out), ring.center + out) < 1e-7f);
        CHECK(
            glm::distance(
                through(with(ring), ring.center + 0.999f * out), ring.center + 0.999f * out)
            < 2e-5f);
        // Halfway out the weight is a half: k f = 0.25 of the distance.
        const Vec3 moved = through(with(ring), ring.center + 0.5f * out);
        CHECK(glm::distance(moved, ring.center + 0.375f * out) < 1e-6f);
    }
    CHECK(through(with(ring), ring.center) == ring.center);
    const Vec3 deep = ring.center + Vec3(0.01f, 0, 0.005f);
    CHECK(through(with(ring), deep).z == deep.z);
    CHECK(through(with(ring), deep).x < deep.x);
    const Vec3 beyond = ring.center + Vec3(0.001f, 0, 0.0101f);
    CHECK(through(with(ring), beyond) == beyond);
}

TEST_CASE(
    "lattice: points at rest change nothing, points moved together move all that is inside"
    * technique("face.ffd")) {
    const Lattice rest = make_lattice([](const Vec3&, int, int, int) { return Vec3(0); });
    const Vec3 by(0.3f, -0.7f, 0.2f);
    const Lattice moved = make_lattice([&](const Vec3&, int, int, int) { return by; });
    for (const Vec3& at : kPlaces) {
        const Vec3 p =
            inside(rest, at.x * 0.999f + 5e-4f, at.y * 0.999f + 5e-4f, at.z * 0.999f + 5e-4f);
        CHECK(through(with(rest), p) == p);
        CHECK(glm::distance(through(with(moved), p), p + by) < 1e-6f);
    }
    const Vec3 outside = inside(rest, 1.01f, 0.5f, 0.5f);
    CHECK(through(with(moved), outside) == outside);
}

TEST_CASE(
    "lattice: an affine map of its points is the same map of the inside" * technique("face.ffd")) {
    const Mat3 turn(Vec3(0.9f, 0.1f, 0), Vec3(-0.3f, 1.1f, 0.2f), Vec3(0, 0.4f, 0.7f));
    const Vec3 shift(0.1f, 0.2f, -0.3f);
    const Lattice lattice =
        make_lattice([&](const Vec3& at, int, int, int) { return turn * at + shift - at; });
    for (const Vec3& at : kPlaces) {
        const Vec3 p =
            inside(lattice, at.x * 0.999f + 5e-4f, at.y * 0.999f + 5e-4f, at.z * 0.999f + 5e-4f);
        CHECK(glm::distance(through(with(lattice), p), turn * p + shift) < 1e-6f);
    }
}

TEST_CASE(
    "lattice: an inner point moves the center by 0.375^3 of its offset, a corner its vertex"
    * technique("face.ffd")) {
    const Vec3 by(0.5f, 0.25f, -1.0f);
    const Lattice inner = make_lattice([&](const Vec3&, int i, int j, int k) {
        return i == 1 && j == 2 && k == 1 ? by : Vec3(0);
    });
    const Vec3 center = inside(inner, 0.5f, 0.5f, 0.5f);
    CHECK(glm::distance(through(with(inner), center) - center, 0.052734375f * by) < 1e-6f);
    const Lattice corner = make_lattice([&](const Vec3&, int i, int j, int k) {
        return i == 0 && j == 0 && k == 0 ? by : Vec3(0);
    });
    const Vec3 at_corner = inside(corner, 1e-6f, 1e-6f, 1e-6f);
    CHECK(glm::distance(through(with(corner), at_corner) - at_corner, by) < 1e-4f);
    const Vec3 other = inside(corner, 1.0f - 1e-6f, 1e-6f, 1e-6f);
    CHECK(glm::distance(through(with(corner), other), other) < 1e-6f);
}

TEST_CASE(
    "lattice: with two layers at rest the surface is continuous and smooth at the side"
    * technique("face.ffd")) {
    const Lattice lattice = make_lattice(
        [](const Vec3&, int i, int, int) { return i < 2 ? Vec3(0) : Vec3(0, 0.5f, 0); });
    const auto offset = [&](float u) {
        const Vec3 p = inside(lattice, u, 0.5f, 0.5f);
        return through(with(lattice), p).y - p.y;
    };
    CHECK(std::abs(offset(0.001f)) < 1e-5f);
    CHECK(offset(-0.001f) == 0.0f);
    CHECK((offset(0.002f) - offset(0.001f)) / 0.001f < 0.01f);
    const Lattice one_layer = make_lattice(
        [](const Vec3&, int i, int, int) { return i < 1 ? Vec3(0) : Vec3(0, 0.5f, 0); });
    const Vec3 p = inside(one_layer, 0.001f, 0.5f, 0.5f);
    CHECK((through(with(one_layer), p).y - p.y) / 0.001f > 1.0f);
}

TEST_CASE(
    "tug: without offset no bit changes, and its point moves by the whole offset"
    * technique("face.pull")) {
    const Tug tug{.at = {0.1f, -0.2f, 0.3f}, .offset = {0.02f, 0.01f, -0.005f}, .radius = 0.07f};
    CHECK(pack_deformers({.tugs = {{.at = tug.at, .radius = tug.radius}}}).empty());
    CHECK(through({.tugs = {tug}}, tug.at) == tug.at + tug.offset);
    Random random(9, 8, 7, 6);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 beyond =
            tug.at + tug.radius * (1.00001f + 3.0f * random.uniform()) * random.direction();
        CHECK(through({.tugs = {tug}}, beyond) == beyond);
    }
}

TEST_CASE(
    "tug: every point matches double precision, without an edge at the border"
    * technique("face.pull")) {
    using glm::dvec3;
    const Tug tug{.at = {0.1f, -0.2f, 0.3f}, .offset = {0.02f, 0.01f, -0.005f}, .radius = 0.07f};
    Random random(1, 2, 3, 5);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 p = tug.at + tug.radius * random.uniform() * random.direction();
        const double distance_fraction =
            glm::distance(dvec3(p), dvec3(tug.at)) / double{tug.radius};
        const dvec3 wanted =
            dvec3(p) + std::pow(1 - distance_fraction * distance_fraction, 3) * dvec3(tug.offset);
        CHECK(glm::distance(dvec3(through({.tugs = {tug}}, p)), wanted) < 1e-7);
    }
    // (1 - x^2)^3 is 8 (1 - x)^3 near the border: a thousandth of the radius inside it, 8e-9.
    const Vec3 inside = tug.at + Vec3(0.999f * tug.radius, 0, 0);
    CHECK(glm::distance(through({.tugs = {tug}}, inside), inside) < 1e-7f);
}

TEST_CASE("deformers: normals are perpendicular to the deformed surface" * technique("face.ffd")) {
    const Lattice lattice = make_lattice([](const Vec3& at, int i, int j, int) {
        return Vec3(
            0.1f * at.y, 0.2f * std::sin(3.0f * static_cast<float>(i)),
            0.05f * static_cast<float>(j));
    });
    Deformers deformers = with(lattice);
    deformers.muscles.push_back(
        {.attachment = inside(lattice, 0.5f, 0, 0.5f),
         .insertion = inside(lattice, 0.5f, 0.6f, 0.5f),
         .angle = 1.0f,
         .full = 0.3f,
         .reach = 0.6f,
         .contraction = 0.3f});
    const std::vector<Vec4> packed = pack_deformers(deformers);
    const Vec3 normal = glm::normalize(Vec3(0.3f, 0.8f, -0.4f));
    const Vec3 s = glm::normalize(glm::cross(normal, Vec3(0, 0, 1)));
    const Vec3 t = glm::cross(normal, s);
    for (const Vec3& at :
         {Vec3(0.5f, 0.5f, 0.5f), Vec3(0.3f, 0.6f, 0.4f), Vec3(0.7f, 0.3f, 0.6f)}) {
        const Vec3 p = inside(lattice, at.x, at.y, at.z);
        const Vec3 turned = deform_normal(packed, p, normal);
        CHECK(glm::length(turned) == near(1));
        for (float angle = 0.0f; angle < 3.14f; angle += 0.3f) {
            const Vec3 d = 2e-3f * (std::cos(angle) * s + std::sin(angle) * t);
            const Vec3 along = deform_point(packed, p + d) - deform_point(packed, p - d);
            CHECK(std::abs(glm::dot(glm::normalize(along), turned)) < 2e-3f);
        }
        CHECK(glm::distance(turned, normal) > 0.02f);
        CHECK(glm::dot(turned, normal) > 0.0f);
    }
    CHECK(deform_normal({}, Vec3(1), normal) == normal);
}

TEST_CASE("deformers: no vertex moves farther than the bound, which is tight") {
    Deformers deformers = with(make_lattice([](const Vec3&, int i, int j, int k) {
        return (i + j + k) % 2 == 0 ? Vec3(0.3f, 0, 0) : Vec3(0, 0.1f, 0.1f);
    }));
    const float lattice_only = max_displacement(pack_deformers(deformers));
    CHECK(lattice_only == near(0.3));
    deformers.muscles.push_back(kMuscleUp);
    deformers.sphincters.push_back(
        {.center = {0.3f, 0, 0.4f},
         .right = {0.3f, 0, 0},
         .up = {0, 0.2f, 0},
         .depth = 0.2f,
         .contraction = -0.8f});
    const std::vector<Tug> pull = {{.offset = {0, 0.03f, 0.04f}, .radius = 0.3f}};
    const std::vector<Vec4> packed = pack_deformers(deformers, pull);
    const float most = max_displacement(packed);
    CHECK(most == near(0.3 + 0.01 + 0.25 * 0.8 * 0.3 + 0.05));
    Random random(1, 2, 3, 4);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p = random.uniform() * 1.5f * random.direction();
        CHECK(glm::distance(deform_point(packed, p), p) <= most);
    }
    CHECK(max_displacement({}) == 0.0f);
}

TEST_CASE(
    "deformers: SIMD and plain C++ give the same bits"
    * technique("face.ffd, face.pull, face.waters-muscle")) {
    Deformers deformers = with(make_lattice([](const Vec3&, int i, int j, int k) {
        return (i + j + k) % 2 == 0 ? Vec3(0.03f, 0, 0) : Vec3(0);
    }));
    deformers.muscles = {kMuscleUp, kMuscleUp};
    deformers.muscles[1].attachment = {0.01f, 0.05f, 0.02f};
    deformers.muscles[1].insertion = {0, 0, 0};
    deformers.muscles[1].contraction = 1;  // pulls beyond the attachment, but for the limit
    deformers.sphincters.push_back(
        {.center = {0.3f, 0, 0.4f},
         .right = {0.3f, 0.1f, 0},
         .up = {0, 0.2f, 0},
         .depth = 0.2f,
         .contraction = 0.8f});
    deformers.tugs = {
        {.at = {0.01f, 0.02f, 0}, .offset = {0, 0.02f, 0.01f}, .radius = 0.05f},
        {.at = {0.3f, 0.3f, 0.4f}, .offset = {0.1f, 0, 0}, .radius = 0.4f}};
    const std::vector<Vec4> packed = pack_deformers(deformers);
    Random random(5, 6, 7, 8);
    std::vector<Vec3> rest;
    for (int i = 0; i < 5003; ++i) {
        rest.push_back((i % 3 == 0 ? 0.9f : 0.09f) * random.uniform() * random.direction());
    }
    rest[7] = deformers.muscles[0].attachment;
    std::vector<Vec3> plain = rest;
    deform_points_scalar(packed, plain);
    CHECK(plain != rest);
    const std::int64_t targets = hwy::SupportedTargets();
    for (std::int64_t left = targets; left != 0; left &= left - 1) {
        hwy::SetSupportedTargetsForTest(left & -left);
        hwy::GetChosenTarget().DeInit();
        CAPTURE(std::string(hwy::TargetName(left & -left)));
        std::vector<Vec3> points = rest;
        deform_points(packed, points);
        CHECK(points == plain);
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
}

TEST_CASE("deformers: controls without extent or with numbers that are not finite do nothing") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    Deformers bad;
    LinearMuscle muscle = kMuscleUp;
    muscle.insertion = muscle.attachment;
    bad.muscles.push_back(muscle);
    muscle = kMuscleUp;
    muscle.reach = muscle.full;
    bad.muscles.push_back(muscle);
    muscle = kMuscleUp;
    muscle.contraction = kNan;
    bad.muscles.push_back(muscle);
    muscle = kMuscleUp;
    muscle.attachment.x = kNan;
    bad.muscles.push_back(muscle);
    bad.sphincters.push_back({.right = {1, 0, 0}, .up = {2, 0, 0}});
    bad.sphincters.push_back({.center = {kNan, 0, 0}});
    bad.lattices.push_back({.u = {1, 0, 0}, .v = {1, 0, 0}, .offsets = {}});
    bad.lattices.push_back({.u = {kNan, 0, 0}, .offsets = {}});
    bad.tugs.push_back({.offset = {1, 0, 0}, .radius = 0});
    bad.tugs.push_back({.offset = {kNan, 0, 0}});
    bad.tugs.push_back({.at = {0, kNan, 0}, .offset = {1, 0, 0}});
    bad.tugs.push_back({.offset = {1, 0, 0}, .radius = kNan});
    CHECK(pack_deformers(bad).empty());
    CHECK(pack_deformers({}).empty());
    Lattice part{.offsets = {Vec3(kNan, 0, 0), Vec3(1)}};
    for (float x = -0.5f; x <= 0.5f; x += 0.1f) {
        CHECK(std::isfinite(through(with(part), Vec3(x, 0, 0)).x));
    }
}

TEST_CASE("deformers: a mesh gets its state, deforms by itself, and has velocities") {
    World world;
    const Entity alone = world.create(MeshInstance{}, with(kMuscleUp));
    const Entity other = world.create();
    Deformed by_other;
    by_other.character = other;
    const Entity face = world.create(MeshInstance{}, with(kMuscleUp), by_other);
    world.run(add_deformer_states);
    CHECK(world.get<Deformed>(alone).character == alone);
    CHECK(world.get<Deformed>(face).character == other);
    world.run(update_deformers);
    const std::vector<Vec4> first = world.get<DeformerState>(alone).now;
    CHECK(first == pack_deformers(with(kMuscleUp)));
    CHECK(world.get<DeformerState>(alone).previous == first);
    world.get<Deformers>(alone).muscles[0].contraction = 0.7f;
    world.run(update_deformers);
    CHECK(world.get<DeformerState>(alone).previous == first);
    const std::vector<Vec4> second = world.get<DeformerState>(alone).now;
    CHECK(second != first);
    world.get<Deformers>(alone).muscles[0].contraction = 0.9f;
    world.run(update_deformers);
    CHECK(world.get<DeformerState>(alone).previous == second);
    world.get<Deformers>(alone).muscles.clear();
    world.run(update_deformers);
    CHECK(world.get<DeformerState>(alone).now.empty());
    CHECK(world.get<DeformerState>(alone).previous.empty());
}

}  // namespace limn::deformers_test
