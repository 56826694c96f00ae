#include "ecs/base/rng.h"
#include "ecs/components/name.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "systems/attach_system.h"
#include "systems/subtrees.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace limn::subtrees_test {
namespace {

/// Refers to another entity.
struct Leash {
    Entity to;
};
LIMN_FIELDS(Leash) {
    LIMN_FIELD(to, "the other end");
}

/// A post with an arm, which has two lamps; the second is leashed to the first, the first to the
/// post.
struct Street {
    World world;
    Entity post = world.create(Name{"post"}, Transform{.position = {1, 2, 3}});
    Entity arm = child("arm", post, {0, 3, 0});
    Entity first = child("lamp", arm, {1, 0, 0});
    Entity second = child("lamp 2", arm, {2, 0, 0});

    Street() {
        world.add(first, Leash{post});
        world.add(second, Leash{first});
    }
    Entity child(const char* name, Entity parent, const Vec3& position) {
        const Quat turn = glm::angleAxis(0.3f * position.y + 0.2f, Vec3(0, 0.6f, 0.8f));
        const Entity made = world.create(Name{name}, Transform{position, turn, Vec3(0.5f)});
        REQUIRE(set_parent(world, made, parent).ok());
        return made;
    }
    [[nodiscard]] std::string name(Entity entity) { return world.value<Name>(entity).text; }
    [[nodiscard]] std::vector<Entity> tree(Entity root) {
        return subtree_of(hierarchy(world), root);
    }
};

}  // namespace

TEST_CASE(
    "subtrees: cut and pasted below the same parent, a subtree is as before"
    * technique("engine.cut-copy-paste")) {
    Street street;
    const Transform before = street.world.value<Transform>(street.arm);
    const std::vector<Entity> tree = street.tree(street.arm);
    REQUIRE(tree.size() == 3);
    REQUIRE(cut_tree(street.world, street.arm).ok());
    CHECK(parent_of(street.world, street.arm).is_null());
    CHECK(street.tree(street.arm) == tree);
    CHECK(street.tree(street.post).size() == 1);
    REQUIRE(paste_tree(street.world, street.post, street.arm).ok());
    CHECK(street.tree(street.post).size() == 4);
    CHECK(street.tree(street.arm) == tree);
    CHECK(street.world.value<Transform>(street.arm).position == before.position);
    CHECK(street.world.value<Transform>(street.arm).rotation == before.rotation);
}

TEST_CASE("subtrees: one that keeps its place is where it was, below any parent") {
    Street street;
    const Affine placed = world_from_entity(street.world, street.second);
    const auto is_there = [&] {
        const Affine now = world_from_entity(street.world, street.second);
        for (int row = 0; row < 3; ++row) {
            for (int i = 0; i < 4; ++i) {
                CHECK(now.row[row][i] == test::near(placed.row[row][i]).epsilon(1e-5));
            }
        }
    };
    REQUIRE(cut_tree(street.world, street.second, KeptPlace::World).ok());
    is_there();
    REQUIRE(paste_tree(street.world, street.first, street.second, KeptPlace::World).ok());
    is_there();
    CHECK(parent_of(street.world, street.second) == street.first);
}

TEST_CASE("subtrees: a copy has new entities and names, and its own state") {
    Street street;
    const Result<Entity> made = copy_tree(street.world, street.arm);
    REQUIRE(made.ok());
    const std::vector<Entity> copies = street.tree(*made);
    REQUIRE(copies.size() == 3);
    CHECK(parent_of(street.world, *made).is_null());
    for (const Entity copy : copies) {
        for (const Entity one : street.tree(street.post)) {
            CHECK(copy != one);
        }
    }
    CHECK(street.name(copies[0]) == "arm 2");
    CHECK(street.name(copies[1]) == "lamp 3");
    CHECK(street.name(copies[2]) == "lamp 4");
    // References inside are to the copies, those to others stay.
    CHECK(street.world.value<Leash>(copies[2]).to == copies[1]);
    CHECK(street.world.value<Leash>(copies[1]).to == street.post);
    street.world.get<Transform>(copies[1]).position = {9, 9, 9};
    CHECK(street.world.value<Transform>(street.first).position == Vec3(1, 0, 0));
    CHECK(street.tree(street.post).size() == 4);
}

TEST_CASE("subtrees: what makes no tree is refused and changes nothing") {
    Street street;
    const auto unchanged = [&] {
        CHECK(street.tree(street.post).size() == 4);
        CHECK(parent_of(street.world, street.post).is_null());
        CHECK(parent_of(street.world, street.first) == street.arm);
    };
    CHECK_FALSE(cut_tree(street.world, street.post).ok());                  // a root
    CHECK_FALSE(paste_tree(street.world, street.post, street.first).ok());  // not a root
    CHECK_FALSE(paste_tree(street.world, street.first, street.post).ok());  // its descendant
    CHECK_FALSE(paste_tree(street.world, street.post, street.post).ok());
    unchanged();
    const Entity gone = street.world.create(Name{"gone"});
    street.world.destroy(gone);
    CHECK_FALSE(cut_tree(street.world, gone).ok());
    CHECK_FALSE(copy_tree(street.world, gone).ok());
    CHECK_FALSE(paste_tree(street.world, street.post, gone).ok());
    CHECK_FALSE(paste_tree(street.world, gone, street.post).ok());
    unchanged();
}

}  // namespace limn::subtrees_test
