#include "ecs/components/all.h"
#include "ecs/components/beam.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/particles/beam_system.h"
#include "systems/particles/particle_obstacles.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <limits>
#include <vector>

namespace limn::beam_test {
namespace {

const Vec3 kStart = {1, 2, 3};
const Vec3 kEnd = {5, -1, 15};  // 13 m away

Affine at(const Vec3& position) {
    return affine_from(position, {1, 0, 0, 0}, {1, 1, 1});
}

std::vector<Vec3> bolt(float jag, std::uint32_t detail, std::uint64_t seed = 7) {
    Random random(seed, 0, 0, 0);
    std::vector<Vec3> points;
    make_bolt(kStart, kEnd, jag, detail, random, points);
    return points;
}

struct Beams {
    World world;

    Beams() {
        register_all_components();
        world.insert_resource(Assets{});
        world.insert_resource(ParticleObstacles{});
    }
    Entity add(const Beam& beam, const Affine& world_from_beam) {
        const Entity entity = world.create(beam, WorldTransform{world_from_beam});
        world.run(add_beam_states);
        return entity;
    }
    const BeamState& update(Entity entity) {
        world.run(find_particle_obstacles);
        world.run(update_beams);
        return world.get<const BeamState>(entity);
    }
};

}  // namespace

TEST_CASE("beam: a bolt begins and ends exactly where it should, in as many pieces") {
    for (std::uint32_t detail = 0; detail <= 9; ++detail) {
        const std::vector<Vec3> points = bolt(0.3f, detail);
        CHECK(points.size() == (std::size_t{1} << detail) + 1);
        CHECK(points.front() == kStart);
        CHECK(points.back() == kEnd);
    }
}

TEST_CASE("beam: a bolt strays from its line at right angles, and no farther than its jag allows") {
    const Vec3 axis = glm::normalize(kEnd - kStart);
    float farthest = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const std::vector<Vec3> points = bolt(0.2f, 7, seed);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double along = 13.0 * static_cast<double>(i) / 128;
            const Vec3 offset = points[i] - kStart;
            CHECK(glm::dot(offset, axis) == test::near(along).scale(13).epsilon(1e-5));
            farthest = std::max(farthest, glm::length(offset - axis * glm::dot(offset, axis)));
        }
    }
    CHECK(farthest < 0.2f * 13);
    CHECK(farthest > 0.1f * 13);
    for (const Vec3& point : bolt(0, 5)) {
        const Vec3 offset = point - kStart;
        CHECK(glm::length(offset - axis * glm::dot(offset, axis)) < 1e-5f);
    }
}

TEST_CASE("beam: its shape lasts for a period of its rate, and is the same in every run") {
    const Beam beam = {.rate = 10};
    const Entity one{3, 1};
    const auto word = [&](double time, Entity entity = {3, 1}) {
        return beam_random(beam, entity, time).word();
    };
    CHECK(word(0.51) == word(0.59));
    CHECK(word(0.51) != word(0.61));
    CHECK(word(0.51) != word(0.51, {4, 1}));
    CHECK(beam_random({.rate = 0}, one, 1).word() == beam_random({.rate = 0}, one, 99).word());
    CHECK(beam_random({.seed = 5}, one, 1).word() == beam_random({.seed = 5}, {8, 2}, 1).word());
}

TEST_CASE("beam: it goes to an entity or along -z, and is gone when either has no transform") {
    Beams beams;
    const Entity target = beams.world.create(WorldTransform{at(kEnd)});
    const Entity to = beams.add({.to = target}, at(kStart));
    const Quat turned = glm::angleAxis(-kPi / 2, Vec3(0, 1, 0));  // -z becomes +x
    const Entity ahead = beams.add({.length = 4}, affine_from(kStart, turned, {2, 2, 2}));
    CHECK(beams.update(to).shown);
    CHECK(beams.update(to).start == kStart);
    CHECK(beams.update(to).end == kEnd);
    CHECK(glm::distance(beams.update(ahead).end, kStart + Vec3(4, 0, 0)) < 1e-5f);
    beams.world.get<WorldTransform>(target).world = at(Vec3(9));
    CHECK(beams.update(to).previous_end == kEnd);
    CHECK(beams.update(to).previous_end == Vec3(9));
    beams.world.destroy(target);
    CHECK_FALSE(beams.update(to).shown);
    beams.world.get<WorldTransform>(ahead).world =
        at(Vec3(std::numeric_limits<float>::quiet_NaN()));
    CHECK_FALSE(beams.update(ahead).shown);
    beams.world.get<WorldTransform>(ahead).world = at(kStart);
    CHECK(beams.update(ahead).previous_start == kStart);  // not from where it was before
    beams.world.get<Beam>(ahead).active = false;
    CHECK_FALSE(beams.update(ahead).shown);
}

TEST_CASE("beam: it stops at the nearest collider, but goes through if it should not stop") {
    Beams beams;
    for (const float z : {-6.0f, -3.0f, -9.0f}) {
        beams.world.create(
            ParticleCollider{.shape = ColliderShape::Box, .size = Vec3(0.5f)},
            WorldTransform{at({0, 0, z})});
    }
    const Entity beam = beams.add({.length = 20}, at(Vec3(0)));
    CHECK(beams.update(beam).end.z == test::near(-2.5));
    beams.world.get<Beam>(beam).length = 2;
    CHECK(beams.update(beam).end.z == test::near(-2));
    beams.world.get<Beam>(beam) = {.length = 20, .stops = false};
    CHECK(beams.update(beam).end.z == test::near(-20));
}

}  // namespace limn::beam_test
