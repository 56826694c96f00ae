#include "ecs/base/log.h"
#include "ecs/base/rng.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/schedule.h"
#include "ecs/snapshot.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

namespace hierarchy_test {

using namespace limn;

std::vector<Entity> list(std::span<const Entity> entities) {
    return {entities.begin(), entities.end()};
}

/// What must hold for every hierarchy, against the definition.
void check_order(World& world) {
    const Hierarchy& order = hierarchy(world);
    std::size_t linked = 0;
    world.query<const Parent>().each([&](Entity entity, const Parent&) {
        linked += parent_of(world, entity).is_null() ? 0 : 1;
    });
    REQUIRE(order.nodes().size() == linked);
    std::set<Entity> seen;
    std::uint32_t depth = 1;
    for (std::size_t i = 0; i < order.nodes().size(); ++i) {
        const HierarchyNode& node = order.nodes()[i];
        CHECK(seen.insert(node.entity).second);
        CHECK(node.parent == parent_of(world, node.entity));
        CHECK(node.depth == depth_of(world, node.entity));
        CHECK(node.depth >= depth);
        depth = node.depth;
        if (node.parent_node == HierarchyNode::kRoot) {
            CHECK(parent_of(world, node.parent).is_null());
        } else {
            CHECK(node.parent_node < i);
            CHECK(order.nodes()[node.parent_node].entity == node.parent);
        }
    }
    std::size_t in_levels = 0;
    for (std::uint32_t level = 1; level <= order.depth_count(); ++level) {
        CHECK_FALSE(order.level(level).empty());
        for (const HierarchyNode& node : order.level(level)) {
            CHECK(node.depth == level);
            ++in_levels;
        }
    }
    CHECK(in_levels == order.nodes().size());
}

}  // namespace hierarchy_test

using namespace limn;
using namespace hierarchy_test;

TEST_CASE(
    "hierarchy: a child has its parent and the parent its children, in the order of their links"
    * technique("engine.render-object")) {
    World world;
    const Entity root = world.create(Transform{});
    const Entity c = world.create(Transform{});
    const Entity a = world.create(Transform{});
    const Entity b = world.create(Transform{});
    CHECK(set_parent(world, a, root).ok());
    CHECK(set_parent(world, b, root).ok());
    CHECK(set_parent(world, c, root).ok());
    CHECK(parent_of(world, a) == root);
    CHECK(parent_of(world, root).is_null());
    CHECK(list(children_of(world, root)) == std::vector<Entity>{a, b, c});
    CHECK(children_of(world, a).empty());
    check_order(world);

    CHECK(set_parent(world, a, root).ok());  // again: now the last
    CHECK(list(children_of(world, root)) == std::vector<Entity>{b, c, a});
    CHECK(set_parent(world, c, b).ok());
    CHECK(list(children_of(world, root)) == std::vector<Entity>{b, a});
    CHECK(depth_of(world, c) == 2);
    CHECK(set_parent(world, c, Entity{}).ok());
    CHECK(parent_of(world, c).is_null());
    CHECK(depth_of(world, c) == 0);
    check_order(world);
}

TEST_CASE("hierarchy: a link given at creation counts, too") {
    World world;
    const Entity root = world.create();
    const Entity a = world.create(Parent{root});
    const Entity b = world.create(Parent{root});
    const Entity first = world.create();
    CHECK(set_parent(world, first, root).ok());
    CHECK(list(children_of(world, root)) == std::vector<Entity>{a, b, first});
    world.get<Parent>(b).order = 0;
    world.get<Parent>(a).order = 5;
    CHECK(list(children_of(world, root)) == std::vector<Entity>{b, first, a});
}

TEST_CASE("hierarchy: a cycle is refused with a reason and changes nothing") {
    World world;
    const Entity a = world.create();
    const Entity b = world.create();
    const Entity c = world.create();
    REQUIRE(set_parent(world, b, a).ok());
    REQUIRE(set_parent(world, c, b).ok());
    const std::uint64_t before = state_hash(world);
    CHECK(
        set_parent(world, a, c).error().message
        == "set_parent: entity 2 v1 cannot be the parent of entity 0 v1: it is its descendant");
    CHECK(
        set_parent(world, a, a).error().message
        == "set_parent: entity 0 v1 cannot be the parent of entity 0 v1: it is the same entity");
    const Entity gone = world.create();
    world.destroy(gone);
    CHECK_FALSE(set_parent(world, a, gone).ok());
    CHECK_FALSE(set_parent(world, gone, a).ok());
    CHECK(state_hash(world) == before);
    check_order(world);
}

TEST_CASE("hierarchy: a cycle written directly is reported and broken, and nothing hangs") {
    World world;
    const Entity a = world.create();
    const Entity b = world.create(Parent{a});
    const Entity c = world.create(Parent{b});
    const Entity below = world.create(Parent{c});
    const Entity self = world.create();
    world.add(a, Parent{c});
    world.add(self, Parent{self});
    const std::uint64_t errors = logged_error_count();
    const Hierarchy& order = hierarchy(world);
    CHECK(logged_error_count() == errors + 2);
    std::vector<Entity> nodes;
    for (const HierarchyNode& node : order.nodes()) {
        nodes.push_back(node.entity);
    }
    CHECK(nodes == std::vector<Entity>{b, c, below});
    CHECK(depth_of(world, below) <= world.entity_count());
    CHECK_FALSE(set_parent(world, world.create(), below).ok());
    CHECK(subtree_of(order, a) == std::vector<Entity>{a, b, c, below});
    destroy_tree(world, a);
    CHECK(world.alive(self));
    CHECK_FALSE(world.alive(below));
}

TEST_CASE("hierarchy: children of a destroyed entity are roots") {
    World world;
    const Entity root = world.create();
    const Entity child = world.create(Parent{root});
    const Entity grandchild = world.create(Parent{child});
    CHECK(depth_of(world, grandchild) == 2);
    CHECK(hierarchy(world).nodes().size() == 2);
    world.destroy(root);
    CHECK(parent_of(world, child).is_null());
    CHECK(children_of(world, root).empty());
    CHECK(depth_of(world, grandchild) == 1);
    CHECK(hierarchy(world).nodes().size() == 1);
    // The slot's next tenant is no parent of theirs.
    std::vector<Entity> others = world.create_many(5000);
    const auto heir =
        std::find_if(others.begin(), others.end(), [&](Entity e) { return e.index == root.index; });
    if (heir != others.end()) {
        CHECK(children_of(world, *heir).empty());
    }
    check_order(world);
}

TEST_CASE(
    "hierarchy: destroying a tree destroys all descendants, children first, and nothing else") {
    std::vector<Entity> gone;
    World world;
    const Entity root = world.create(Transform{});
    const Entity a = world.create(Transform{}, Parent{root});
    const Entity b = world.create(Transform{}, Parent{a});
    const Entity c = world.create(Transform{}, Parent{root});
    const Entity other = world.create(Transform{});
    world.on_remove<Transform>([&](World&, std::span<const Entity> entities) {
        gone.insert(gone.end(), entities.begin(), entities.end());
    });
    destroy_tree(world, root);
    CHECK(gone == std::vector<Entity>{c, b, a, root});
    CHECK(world.alive(other));
    CHECK(world.entity_count() == 1);
    CHECK(hierarchy(world).nodes().empty());
}

TEST_CASE("hierarchy: it is rebuilt when a link changed, and only then") {
    World world;
    const Entity root = world.create(Transform{});
    const Entity child = world.create(Transform{}, Parent{root});
    const std::uint64_t version = hierarchy(world).version();
    world.get<Transform>(child).position.x = 1;
    world.create(Transform{});
    world.query<const Parent>().each([](const Parent&) {});
    CHECK(hierarchy(world).version() == version);
    world.get<Parent>(child).order = 3;
    CHECK(hierarchy(world).version() == version + 1);
    world.destroy(child);
    CHECK(hierarchy(world).version() == version + 2);
    world.create(Parent{root});
    CHECK(hierarchy(world).version() == version + 3);
    world.clear();
    CHECK(hierarchy(world).nodes().empty());
}

TEST_CASE("hierarchy: random changes keep the order right") {
    World world;
    Random random(3, 0, 0, 0);
    std::vector<Entity> entities = world.create_many(200);
    for (int step = 0; step < 60; ++step) {
        for (int i = 0; i < 20; ++i) {
            const Entity child = entities[random.below(200)];
            const Entity parent = entities[random.below(200)];
            switch (random.below(8)) {
            case 0:
                if (world.alive(child)) {
                    world.destroy(child);
                }
                break;
            case 1:
                static_cast<void>(set_parent(world, child, Entity{}));
                break;
            default:
                static_cast<void>(set_parent(world, child, parent));
                break;
            }
        }
        check_order(world);
        for (Entity& entity : entities) {
            if (!world.alive(entity)) {
                entity = world.create();
            }
        }
    }
}

TEST_CASE("hierarchy: a system gets an up-to-date hierarchy, also after an earlier system changed "
          "a link") {
    World world;
    const Entity a = world.create();
    const Entity b = world.create();
    const Entity child = world.create(Parent{a});
    Entity wanted = b;
    Entity found_before;
    Entity found_after;
    Schedule schedule;
    schedule.add("before", [&](HierarchyRef links) { found_before = links->nodes()[0].parent; });
    schedule.add("move", [&](Query<Parent> parents) {
        parents.each([&](Parent& parent) { parent.entity = wanted; });
    });
    schedule.add("after", [&](HierarchyRef links) { found_after = links->nodes()[0].parent; });
    schedule.run(world);
    CHECK(found_before == a);
    CHECK(found_after == b);
    wanted = a;
    schedule.run(world);
    CHECK(found_before == b);
    CHECK(found_after == a);
    CHECK(parent_of(world, child) == a);
}

TEST_CASE("hierarchy: ten thousand links deep or wide is no problem") {
    World world;
    Entity above = world.create();
    const Entity root = above;
    for (int i = 0; i < 10'000; ++i) {
        above = world.create(Parent{above});
    }
    CHECK(hierarchy(world).depth_count() == 10'000);
    destroy_tree(world, root);
    CHECK(world.entity_count() == 0);
    const Entity hub = world.create();
    world.create_many(10'000, Parent{hub});
    CHECK(children_of(world, hub).size() == 10'000);
    CHECK(hierarchy(world).depth_count() == 1);
}
