#include "content/app/panels/edit_json.h"
#include "content/app/panels/subtree_edits.h"
#include "content/app/panels/undo.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "tests/content/level_text.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace limn::subtree_edits_test {
namespace {

/// A street with a post, whose arm has a lamp; the camera looks at the lamp.
struct EditedStreet {
    World world;
    UndoStack undo;
    SubtreeEditor editor;
    Entity street = world.create(Name{"street"}, Transform{.position = {0, 0, 5}});
    Entity post = world.create(Name{"post"}, Transform{.position = {1, 2, 3}}, Parent{street, 1});
    Entity other = world.create(Name{"other"}, Transform{}, Parent{street, 2});
    Entity arm = world.create(Name{"arm"}, Transform{}, Parent{post, 1});
    Entity lamp = world.create(Name{"lamp"}, Transform{}, PointLight{}, Parent{arm, 1});

    /// The whole world as text: what a level would have, and the tree.
    [[nodiscard]] std::string text() {
        std::string all;
        world.each_entity([&](Entity entity) {
            if (!world.components_of(entity).empty() && parent_of(world, entity).is_null()) {
                all += entity_as_json(world, entity) + '\n';
            }
        });
        return all;
    }
};

}  // namespace

TEST_CASE(
    "subtree edits: undo of each is the state before it, redo the state after"
    * technique("engine.cut-copy-paste")) {
    EditedStreet level;
    std::vector<std::string> states = {level.text()};
    const auto keep = [&](const Result<std::string>& done) {
        REQUIRE(done.ok());
        states.push_back(level.text());
        CHECK(states.back() != states[states.size() - 2]);
    };
    SubtreeEditor& editor = level.editor;
    keep(editor.cut(level.world, level.undo, level.arm));
    keep(editor.paste(level.world, level.undo, level.other));
    REQUIRE(editor.copy(level.world, level.arm).ok());
    keep(editor.paste(level.world, level.undo, level.post));
    keep(editor.duplicate(level.world, level.undo, editor.pasted()));
    keep(editor.remove(level.world, level.undo, level.post));
    keep(editor.remove(level.world, level.undo, level.lamp));
    for (int round = 0; round < 2; ++round) {
        for (std::size_t i = states.size() - 1; i-- > 0;) {
            CHECK_FALSE(level.undo.undo(level.world).empty());
            CHECK(level.text() == states[i]);
        }
        CHECK(level.undo.undo(level.world).empty());
        for (std::size_t i = 1; i < states.size(); ++i) {
            CHECK_FALSE(level.undo.redo(level.world).empty());
            CHECK(level.text() == states[i]);
        }
        CHECK(level.undo.redo(level.world).empty());
    }
}

TEST_CASE("subtree edits: what comes back is the same entity, with edits before and after") {
    EditedStreet level;
    Edit edit;
    edit.entity = level.lamp;
    edit.before = AnyComponent::of(level.world.value<PointLight>(level.lamp));
    level.world.get<PointLight>(level.lamp).intensity = 7;
    edit.after = AnyComponent::of(level.world.value<PointLight>(level.lamp));
    edit.label = "lamp: point_light.intensity";
    level.undo.record(edit);
    REQUIRE(level.editor.remove(level.world, level.undo, level.post).ok());
    CHECK_FALSE(level.world.has<PointLight>(level.lamp));
    CHECK(level.undo.undo(level.world) == "post: delete");
    CHECK(level.world.value<PointLight>(level.lamp).intensity == 7);
    CHECK(parent_of(level.world, level.post) == level.street);
    CHECK(children_of(level.world, level.street).front() == level.post);
    CHECK(level.undo.undo(level.world) == "lamp: point_light.intensity");
    CHECK(level.world.value<PointLight>(level.lamp).intensity == PointLight{}.intensity);
}

TEST_CASE("subtree edits: pasted on itself, a copy is beside it; without one, paste says so") {
    EditedStreet level;
    CHECK_FALSE(level.editor.paste(level.world, level.undo, level.post).ok());
    REQUIRE(level.editor.copy(level.world, level.arm).ok());
    REQUIRE(level.editor.paste(level.world, level.undo, level.arm).ok());
    CHECK(parent_of(level.world, level.editor.pasted()) == level.post);
    CHECK_FALSE(level.editor.cut(level.world, level.undo, {}).ok());
    CHECK_FALSE(level.editor.remove(level.world, level.undo, {}).ok());
    REQUIRE(level.editor.cut(level.world, level.undo, level.post).ok());
    const std::string before = level.text();
    const std::size_t edits = level.undo.undo_count();
    CHECK_FALSE(level.editor.paste(level.world, level.undo, level.lamp).ok());  // its descendant
    CHECK(level.text() == before);
    CHECK(level.undo.undo_count() == edits);
}

TEST_CASE("subtree edits: what was destroyed meanwhile is left out, the rest comes back") {
    EditedStreet level;
    REQUIRE(level.editor.remove(level.world, level.undo, level.post).ok());
    level.world.destroy(level.arm);
    CHECK(level.undo.undo(level.world) == "post: delete");
    CHECK(level.world.value<Name>(level.post).text == "post");
    CHECK(level.world.value<Name>(level.lamp).text == "lamp");
    CHECK(parent_of(level.world, level.post) == level.street);
    CHECK(level.undo.redo(level.world) == "post: delete");
    CHECK_FALSE(exists(level.world, level.lamp));
    level.world.destroy(level.post);
    CHECK(level.undo.undo(level.world).empty());
}

TEST_CASE("subtree edits: nothing is pasted below what an undo took away") {
    EditedStreet level;
    REQUIRE(level.editor.copy(level.world, level.lamp).ok());
    REQUIRE(level.editor.paste(level.world, level.undo, level.other).ok());
    const Entity pasted = level.editor.pasted();
    level.undo.undo(level.world);
    const std::string before = level.text();
    CHECK_FALSE(level.editor.paste(level.world, level.undo, pasted).ok());
    CHECK_FALSE(level.editor.duplicate(level.world, level.undo, pasted).ok());
    CHECK_FALSE(level.editor.remove(level.world, level.undo, pasted).ok());
    CHECK_FALSE(level.editor.cut(level.world, level.undo, pasted).ok());
    CHECK(level.text() == before);
}

TEST_CASE("subtree edits: as JSON, what was made is below its root, what was deleted destroyed") {
    EditedStreet level;
    REQUIRE(level.editor.copy(level.world, level.arm).ok());
    REQUIRE(level.editor.paste(level.world, level.undo, level.street).ok());
    World loaded;
    test::spawn_into(loaded, edits_as_json(level.world, level.undo.done()));
    CHECK(
        parent_of(loaded, test::find_named(loaded, "arm 2")) == test::find_named(loaded, "street"));
    CHECK(
        parent_of(loaded, test::find_named(loaded, "lamp 2")) == test::find_named(loaded, "arm 2"));
    REQUIRE(level.editor.remove(level.world, level.undo, level.other).ok());
    REQUIRE(level.editor.cut(level.world, level.undo, level.lamp).ok());
    const std::string text = edits_as_json(level.world, level.undo.done());
    CAPTURE(text);
    CHECK(text.find(R"("name": "arm 2")") != std::string::npos);
    CHECK(text.find(R"("destroy": ["other"])") != std::string::npos);
    CHECK(text.find(R"(move "lamp" out of its parent's children)") != std::string::npos);
    // Below a child, a patch cannot have children: a note says where it belongs.
    REQUIRE(level.editor.duplicate(level.world, level.undo, level.arm).ok());
    CHECK(
        edits_as_json(level.world, level.undo.done())
            .find(R"(move "arm 3" to the children of "post")")
        != std::string::npos);
    const Entity nameless = level.world.create(Transform{});
    REQUIRE(level.editor.remove(level.world, level.undo, nameless).ok());
    CHECK(edits_as_json(level.world, level.undo.done()).find("has no name") != std::string::npos);
    // Undone, nothing is left of them.
    while (!level.undo.undo(level.world).empty()) {
    }
    CHECK(edits_as_json(level.world, level.undo.done()) == "{}");
}

}  // namespace limn::subtree_edits_test
