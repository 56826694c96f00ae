#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/prefab.h"
#include "ecs/schedule.h"
#include "systems/motion_kernels.h"
#include "systems/transform_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cstring>
#include <map>
#include <vector>

namespace limn::transform_system_test {
namespace {

Schedule make_schedule() {
    Schedule schedule;
    schedule.add<add_world_transforms>();
    schedule.sync();
    schedule.add<update_transforms>();
    return schedule;
}

bool same(const Affine& a, const Affine& b) {
    return a.row[0] == b.row[0] && a.row[1] == b.row[1] && a.row[2] == b.row[2];
}
float apart(const Affine& a, const Affine& b) {
    float worst = 0;
    for (int i = 0; i < 3; ++i) {
        worst = std::max(worst, glm::length(a.row[i] - b.row[i]));
    }
    return worst;
}

Transform at(float x, float y, float z) {
    return {.position = {x, y, z}};
}
Transform turned(float angle, const Vec3& position) {
    return {.position = position, .rotation = glm::angleAxis(angle, Vec3(0, 1, 0))};
}
Affine matrix(const Transform& t) {
    return affine_from(t.position, t.rotation, t.scale);
}
Affine world_of(const World& world, Entity e) {
    return world.get<WorldTransform>(e).world;
}
Affine previous_of(const World& world, Entity e) {
    return world.get<PreviousWorldTransform>(e).world;
}

/// Rows whose chunk was taken for writing since.
std::size_t written(const World& world, std::uint32_t since) {
    return world.query<const WorldTransform, Changed<WorldTransform>>().since(since).count();
}
std::size_t written_past(const World& world, std::uint32_t since) {
    return world.query<const PreviousWorldTransform, Changed<PreviousWorldTransform>>()
        .since(since)
        .count();
}

Transform random_transform(Random& random) {
    const Quat rotation(random.normal(), random.normal(), random.normal(), random.normal());
    return {
        .position = 3.0f * Vec3(random.normal(), random.normal(), random.normal()),
        .rotation = glm::normalize(rotation),
        .scale = Vec3(random.uniform(0.5f, 1.5f))};
}

}  // namespace

TEST_CASE("transform: a root's matrix is its own, and it has no velocity in its first step") {
    World world;
    Schedule schedule = make_schedule();
    const Transform start = {
        .position = {1, 2, 3}, .rotation = glm::normalize(Quat(1, 2, 3, 4)), .scale = {1, 2, 0.5f}};
    const Entity e = world.create(start);
    schedule.run(world);
    CHECK(same(world_of(world, e), matrix(start)));
    CHECK(same(previous_of(world, e), matrix(start)));
    const Vec3 p = transform_point(world_of(world, e), {1, 1, 1});
    CHECK(glm::length(p - (start.position + start.rotation * Vec3(1, 2, 0.5f))) < 1e-5f);
}

TEST_CASE(
    "transform: the previous matrix is one step old, and catches up when an entity comes to rest") {
    World world;
    Schedule schedule = make_schedule();
    const Entity e = world.create(at(0, 0, 0));
    schedule.run(world);
    world.get<Transform>(e).position.x = 1;
    schedule.run(world);
    CHECK(world_of(world, e).row[0].w == 1);
    CHECK(previous_of(world, e).row[0].w == 0);
    world.get<Transform>(e).position.x = 3;
    schedule.run(world);
    CHECK(world_of(world, e).row[0].w == 3);
    CHECK(previous_of(world, e).row[0].w == 1);
    schedule.run(world);
    CHECK(world_of(world, e).row[0].w == 3);
    CHECK(previous_of(world, e).row[0].w == 3);
}

TEST_CASE("transform: nothing is written for entities at rest") {
    World world;
    Schedule schedule = make_schedule();
    world.create_many(3000, at(1, 0, 0));
    const Entity parent = world.create(at(0, 1, 0));
    world.create(at(0, 0, 1), Parent{parent});
    for (int i = 0; i < 3; ++i) {
        schedule.run(world);  // births; the past catches up
    }
    const std::uint32_t since = world.version();
    schedule.run(world);
    CHECK(written(world, since) == 0);
    CHECK(written_past(world, since) == 0);
}

TEST_CASE("transform: a moving entity costs its chunk, and no more") {
    World world;
    Schedule schedule = make_schedule();
    const std::vector<Entity> all = world.create_many(5000, at(1, 0, 0));
    for (int i = 0; i < 3; ++i) {
        schedule.run(world);
    }
    world.get<Transform>(all[2500]).position.y = 2;
    std::uint32_t since = world.version();
    schedule.run(world);
    CHECK(written(world, since) == 1024);
    CHECK(world_of(world, all[2500]).row[1].w == 2);
    since = world.version();
    schedule.run(world);
    CHECK(written(world, since) == 0);  // only the past catches up
    CHECK(written_past(world, since) == 1024);
}

TEST_CASE(
    "transform: a chain of children is the product of its links"
    * technique("engine.object-step")) {
    World world;
    Schedule schedule = make_schedule();
    std::vector<Entity> chain = {world.create(turned(0.3f, {1, 0, 0}))};
    for (int i = 0; i < 6; ++i) {
        chain.push_back(world.create(turned(0.3f, {1, 0, 0}), Parent{chain.back()}));
    }
    schedule.run(world);
    Affine expected;
    for (const Entity e : chain) {
        expected = expected * matrix(world.get<const Transform>(e));
        CHECK(apart(world_of(world, e), expected) < 1e-5f);
        CHECK(same(previous_of(world, e), world_of(world, e)));
    }

    const Affine before = world_of(world, chain.back());
    world.get<Transform>(chain[0]).position.y = 5;
    schedule.run(world);
    CHECK(world_of(world, chain.back()).row[1].w == test::near(before.row[1].w + 5));
    CHECK(same(previous_of(world, chain.back()), before));
    schedule.run(world);
    CHECK(same(previous_of(world, chain.back()), world_of(world, chain.back())));
}

TEST_CASE("transform: a moving child does not affect its parent") {
    World world;
    Schedule schedule = make_schedule();
    const Entity parent = world.create(at(1, 0, 0));
    const Entity child = world.create(at(0, 1, 0), Parent{parent});
    schedule.run(world);
    schedule.run(world);
    world.get<Transform>(child).position.y = 2;
    const std::uint32_t since = world.version();
    schedule.run(world);
    CHECK(written(world, since) == 1);
    CHECK(world_of(world, child).row[0].w == 1);
    CHECK(world_of(world, child).row[1].w == 2);
}

TEST_CASE("transform: a new parent moves the child, and without its parent it is a root") {
    World world;
    Schedule schedule = make_schedule();
    const Entity a = world.create(at(10, 0, 0));
    const Entity b = world.create(at(0, 20, 0));
    const Entity child = world.create(at(0, 0, 1), Parent{a});
    schedule.run(world);
    CHECK(world_of(world, child).row[0].w == 10);
    REQUIRE(set_parent(world, child, b).ok());
    schedule.run(world);
    CHECK(world_of(world, child).row[0].w == 0);
    CHECK(world_of(world, child).row[1].w == 20);
    world.destroy(b);
    schedule.run(world);
    CHECK(world_of(world, child).row[1].w == 0);
    CHECK(world_of(world, child).row[2].w == 1);
    schedule.run(world);
    schedule.run(world);
    const std::uint32_t since = world.version();
    schedule.run(world);
    CHECK(written(world, since) == 0);
}

TEST_CASE("transform: a new parent moves a child that was at rest") {
    World world;
    Schedule schedule = make_schedule();
    const Entity a = world.create(at(10, 0, 0));
    const Entity b = world.create(at(0, 20, 0));
    const Entity child = world.create(at(0, 0, 1), Parent{a});
    for (int i = 0; i < 5; ++i) {
        schedule.run(world);
    }
    world.get<Parent>(child).entity = b;
    schedule.run(world);
    CHECK(world_of(world, child).row[0].w == 0);
    CHECK(world_of(world, child).row[1].w == 20);
    CHECK(previous_of(world, child).row[0].w == 10);
}

TEST_CASE("transform: a child comes to rest while its neighbor in memory moves") {
    World world;
    Schedule schedule = make_schedule();
    const Entity a = world.create(at(0, 0, 0), Spin{});  // not in the chunk of b
    const Entity b = world.create(at(0, 0, 0));
    const Entity on_a = world.create(at(0, 0, 1), Parent{a});
    const Entity on_b = world.create(at(0, 0, 2), Parent{b});
    for (int i = 0; i < 5; ++i) {
        schedule.run(world);
    }
    world.get<Transform>(a).position.x = 1;
    schedule.run(world);
    CHECK(previous_of(world, on_a).row[0].w == 0);
    CHECK(world_of(world, on_a).row[0].w == 1);
    world.get<Transform>(b).position.x = 7;
    schedule.run(world);
    CHECK(previous_of(world, on_a).row[0].w == 1);
    CHECK(world_of(world, on_b).row[0].w == 7);
    CHECK(previous_of(world, on_b).row[0].w == 0);
}

TEST_CASE("transform: after a teleport there is no velocity, also for descendants") {
    World world;
    Schedule schedule = make_schedule();
    const Entity parent = world.create(at(0, 0, 0));
    const Entity child = world.create(at(0, 1, 0), Parent{parent});
    const Entity other = world.create(at(0, 0, 0));
    schedule.run(world);
    schedule.run(world);
    world.get<Transform>(parent).position.x = 100;
    world.get<Transform>(other).position.x = 100;
    world.add(parent, Teleport{});
    schedule.run(world);
    CHECK(world_of(world, parent).row[0].w == 100);
    CHECK(world_of(world, child).row[0].w == 100);
    CHECK(same(previous_of(world, parent), world_of(world, parent)));
    CHECK(same(previous_of(world, child), world_of(world, child)));
    CHECK(previous_of(world, other).row[0].w == 0);
    CHECK(!world.has<Teleport>(parent));

    world.get<Transform>(parent).position.x = 101;
    schedule.run(world);
    CHECK(previous_of(world, parent).row[0].w == 100);
    CHECK(previous_of(world, child).row[0].w == 100);
    CHECK(world_of(world, child).row[0].w == 101);
}

TEST_CASE("transform: the SIMD kernel gives the bits of the scalar one, whatever the count") {
    Random random(1, 0, name_hash("transforms"), 0);
    for (std::size_t count = 1; count < 70; ++count) {
        std::vector<Transform> local(count);
        std::vector<WorldTransform> world(count);
        std::vector<PreviousWorldTransform> previous(count);
        for (std::size_t i = 0; i < count; ++i) {
            local[i] = random_transform(random);
            local[i].scale = {random.uniform(0.1f, 3), random.uniform(0.1f, 3), -1};
            world[i].world = matrix(random_transform(random));
            if (i % 3 != 0) {
                previous[i].world = world[i].world;
            }
        }
        std::vector<WorldTransform> plain_world = world;
        std::vector<PreviousWorldTransform> plain_previous = previous;
        compose_worlds(local, world, previous);
        compose_worlds_scalar(local, plain_world, plain_previous);
        CHECK(std::memcmp(world.data(), plain_world.data(), count * sizeof(WorldTransform)) == 0);
        CHECK(
            std::memcmp(previous.data(), plain_previous.data(), count * sizeof(WorldTransform))
            == 0);
    }
}

TEST_CASE("transform: a copy of a prefab has no velocity in its first step") {
    World world;
    Schedule schedule = make_schedule();
    const Entity original = world.create(at(1, 2, 3));
    schedule.run(world);
    const Prefab prefab = make_prefab(world, original);
    const Entity copy = spawn(world, prefab)[0];
    world.get<Transform>(copy).position = {40, 50, 60};
    schedule.run(world);
    CHECK(same(
        world.get<WorldTransform>(copy).world,
        affine_from({40, 50, 60}, Quat(1, 0, 0, 0), Vec3(1))));
    CHECK(
        same(world.get<PreviousWorldTransform>(copy).world, world.get<WorldTransform>(copy).world));
}

TEST_CASE("transform: a random forest matches plain recursion, through moves, creation, "
          "destruction and teleports") {
    World world;
    Schedule schedule = make_schedule();
    Random random(7, 0, name_hash("forest"), 0);
    std::vector<Entity> alive;
    std::map<Entity, Affine> last;  // matrices after the step before
    for (int step = 0; step < 120; ++step) {
        const auto pick = [&] {
            return alive[random.below(static_cast<std::uint32_t>(alive.size()))];
        };
        std::map<Entity, bool> jumped;
        for (int i = 0; i < 12; ++i) {
            const std::uint32_t what = random.below(10);
            if (what < 4 || alive.empty()) {
                alive.push_back(world.create(random_transform(random)));
                if (alive.size() > 1 && random.below(4) != 0) {
                    (void)set_parent(world, alive.back(), pick());
                }
            } else if (what < 7) {
                world.get<Transform>(pick()) = random_transform(random);
            } else if (what == 7) {
                const Entity child = pick();
                (void)set_parent(world, child, random.below(4) == 0 ? Entity{} : pick());
            } else if (what == 8) {
                const Entity e = pick();
                world.add(e, Teleport{});
                jumped[e] = true;
            } else if (alive.size() > 30) {
                const std::uint32_t k = random.below(static_cast<std::uint32_t>(alive.size()));
                world.destroy(alive[k]);
                alive.erase(alive.begin() + k);
            }
        }
        if (random.below(5) == 0) {
            schedule.run(world);
            schedule.run(world);  // to rest, and past it
            for (const Entity e : alive) {
                last[e] = world_of(world, e);
                REQUIRE(same(previous_of(world, e), last[e]));
            }
            continue;
        }
        schedule.run(world);
        float worst = 0;
        for (const Entity e : alive) {
            Affine expected = matrix(world.get<const Transform>(e));
            bool jumps = jumped.contains(e) || !last.contains(e);
            for (Entity up = parent_of(world, e); !up.is_null(); up = parent_of(world, up)) {
                expected = matrix(world.get<const Transform>(up)) * expected;
                jumps = jumps || jumped.contains(up);
            }
            const float size = 1 + glm::length(expected.row[0]) + glm::length(expected.row[1])
                               + glm::length(expected.row[2]);
            worst = std::max(worst, apart(world_of(world, e), expected) / size);
            REQUIRE(same(previous_of(world, e), jumps ? world_of(world, e) : last[e]));
        }
        REQUIRE(worst < 1e-4f);
        last.clear();
        for (const Entity e : alive) {
            last[e] = world_of(world, e);
        }
    }
    CHECK(alive.size() > 60);
}

TEST_CASE("transform: the bits do not depend on the number of threads") {
    const auto run = [](int threads) {
        set_thread_count(threads);
        World world;
        Schedule schedule = make_schedule();
        Random random(3, 0, name_hash("threads"), 0);
        std::vector<Entity> all;
        for (int i = 0; i < 4000; ++i) {
            all.push_back(world.create(random_transform(random)));
            if (i % 3 != 0) {
                world.add(all.back(), Parent{all[random.below(static_cast<std::uint32_t>(i))]});
            }
        }
        schedule.run(world);
        world.get<Transform>(all[0]).position.x += 1;
        schedule.run(world);
        std::uint64_t hash = 0;
        for (const Entity e : all) {
            const Affine affines[2] = {world_of(world, e), previous_of(world, e)};
            hash = hash_bytes(affines, sizeof affines, hash);
        }
        return hash;
    };
    const int threads = thread_count();
    const std::uint64_t one = run(1);
    CHECK(run(2) == one);
    CHECK(run(4) == one);
    set_thread_count(threads);
}

}  // namespace limn::transform_system_test
