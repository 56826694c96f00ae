#include "ecs/components/camera.h"
#include "ecs/components/name.h"
#include "ecs/components/transform.h"
#include "ecs/prefab.h"
#include "ecs/schedule.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <memory>

namespace prefab_test {

using namespace limn;

struct Gears {
    std::vector<Entity> teeth;
    std::string label;
};
template <typename Visitor>
void visit_fields(Gears& gears, Visitor&& visit) {
    visit("teeth", gears.teeth);
    visit("label", gears.label);
}

struct Scratch {
    std::vector<float> values;
};
struct Unique {
    std::unique_ptr<int> value;
};
struct Chosen {};  // a sparse tag

}  // namespace prefab_test

template <>
struct limn::ComponentTraits<prefab_test::Scratch> : DefaultTraits {
    static constexpr bool saved = false;
};
template <>
struct limn::ComponentTraits<prefab_test::Chosen> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};

namespace prefab_test {

/// root (with a camera that circles `arm`) - arm - hand, and root - lamp; `outside` is named, but
/// not part.
struct Robot {
    World world;
    Entity outside = world.create(Transform{});
    Entity root = world.create(Transform{.position = {1, 0, 0}}, Name{"robot"}, Parent{outside});
    Entity arm = world.create(Transform{.position = {2, 0, 0}}, Parent{root});
    Entity hand = world.create(Transform{.position = {3, 0, 0}}, Parent{arm});
    Entity lamp = world.create(Transform{.position = {4, 0, 0}}, Parent{root, 7});

    Robot() {
        world.add(root, OrbitCamera{.target = arm});
        world.add(hand, Gears{{root, outside, lamp}, "a label longer than a small string"});
        world.add(lamp, Scratch{{1, 2, 3}});
        world.add(lamp, Unique{});
    }
};

}  // namespace prefab_test

using namespace limn;
using namespace prefab_test;

TEST_CASE(
    "prefab: a copy has the structure and values of the original, with its own links"
    * technique("engine.stock-active")) {
    Robot robot;
    World& world = robot.world;
    const Prefab prefab = make_prefab(world, robot.root);
    CHECK(prefab.entities.size() == 4);

    const std::vector<Entity> roots = spawn(world, prefab);
    REQUIRE(roots.size() == 1);
    const Entity root = roots.front();
    CHECK(root != robot.root);
    CHECK(parent_of(world, root).is_null());  // the link of the root is not part of it
    CHECK(world.get<const Name>(root).text == "robot");
    CHECK(world.get<const Transform>(root).position.x == 1);
    REQUIRE(children_of(world, root).size() == 2);
    const Entity arm = children_of(world, root)[0];
    const Entity lamp = children_of(world, root)[1];
    CHECK(world.get<const Transform>(arm).position.x == 2);
    CHECK(world.get<const Transform>(lamp).position.x == 4);
    CHECK(world.get<const Parent>(lamp).order == 7);
    REQUIRE(children_of(world, arm).size() == 1);
    const Entity hand = children_of(world, arm)[0];
    CHECK(world.get<const OrbitCamera>(root).target == arm);
    CHECK(world.get<const Gears>(hand).teeth == std::vector<Entity>{root, robot.outside, lamp});
    CHECK(world.get<const Gears>(hand).label == "a label longer than a small string");
    // The original is as it was.
    CHECK(world.get<const OrbitCamera>(robot.root).target == robot.arm);
    CHECK(world.get<const Gears>(robot.hand).teeth[0] == robot.root);
}

TEST_CASE("prefab: what is not saved or cannot be copied is left out") {
    Robot robot;
    const std::vector<Entity> roots = spawn(robot.world, make_prefab(robot.world, robot.root));
    const Entity lamp = children_of(robot.world, roots.front())[1];
    CHECK_FALSE(robot.world.has<Scratch>(lamp));
    CHECK_FALSE(robot.world.has<Unique>(lamp));
}

TEST_CASE("prefab: sparse tags, which have no value to read, are copied like others") {
    Robot robot;
    robot.world.add<Chosen>(robot.root);
    const std::vector<Entity> roots = spawn(robot.world, make_prefab(robot.world, robot.root));
    CHECK(robot.world.has<Chosen>(roots.front()));
    CHECK_FALSE(robot.world.has<Chosen>(children_of(robot.world, roots.front())[0]));
}

TEST_CASE(
    "prefab: many copies are created in one batch and do not share links"
    * technique("engine.stock-active")) {
    Robot robot;
    World& world = robot.world;
    const Prefab prefab = make_prefab(world, robot.root);
    const std::size_t before = world.entity_count();
    std::size_t batches = 0;
    world.on_add<Name>([&](World&, std::span<const Entity>) { ++batches; });
    const std::vector<Entity> roots = spawn(world, prefab, 500, robot.outside);
    CHECK(batches == 1);
    CHECK(roots.size() == 500);
    CHECK(world.entity_count() == before + 2000);
    CHECK(children_of(world, robot.outside).size() == 501);
    for (const Entity root : roots) {
        CHECK(parent_of(world, root) == robot.outside);
        const std::vector<Entity> tree = subtree_of(hierarchy(world), root);
        REQUIRE(tree.size() == 4);
        CHECK(world.get<const OrbitCamera>(root).target == tree[1]);
        CHECK(
            world.get<const Gears>(tree[2]).teeth
            == std::vector<Entity>{root, robot.outside, tree[3]});
    }
    CHECK(spawn(world, prefab, 0).empty());
    CHECK(spawn(world, Prefab{}, 3).empty());
}

TEST_CASE("prefab: a hand-written prefab references its entities by number") {
    Prefab prefab;
    prefab.entities.resize(2);
    prefab.entities[0].components = {AnyComponent::of(OrbitCamera{.target = prefab_entity(1)})};
    prefab.entities[1].components = {
        AnyComponent::of(Parent{prefab_entity(0)}), AnyComponent::of(Name{"aim"})};
    World world;
    const Entity root = spawn(world, prefab).front();
    REQUIRE(children_of(world, root).size() == 1);
    CHECK(world.get<const OrbitCamera>(root).target == children_of(world, root)[0]);
}

TEST_CASE("prefab: a system spawns copies through commands") {
    Robot robot;
    World& world = robot.world;
    const Prefab prefab = make_prefab(world, robot.root);
    const std::size_t before = world.entity_count();
    Schedule schedule;
    schedule.add("spawn", [&](Commands commands) {
        spawn(commands, prefab, robot.outside);
        spawn(commands, prefab);
    });
    schedule.run(world);
    CHECK(world.entity_count() == before + 8);
    CHECK(children_of(world, robot.outside).size() == 2);
    world.query<const OrbitCamera>().each([&](Entity root, const OrbitCamera& camera) {
        const std::span<const Entity> children = children_of(world, root);
        REQUIRE(children.size() == 2);
        CHECK(camera.target == children[0]);
        CHECK(world.get<const Gears>(children_of(world, children[0])[0]).teeth[0] == root);
    });
}
