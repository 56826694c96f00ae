#include "content/app/commands/stage.h"
#include "content/app/panels/edit_json.h"
#include "content/app/panels/edit_save.h"
#include "content/app/panels/edit_script.h"
#include "content/app/panels/inspector.h"
#include "content/app/panels/subtree_edits.h"
#include "content/load/files/atomic_file.h"
#include "ecs/components/camera.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/post.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn::edit_script_test {
namespace {

constexpr const char* kStreet = R"({
  // a comment
  "title": "A street",
  "resources": {"exposure": {"ev": 1}},
  "materials": {"red": {"base_color": [0.8, 0.1, 0.05]}},
  "meshes": {"box": {"make": "box"}},
  "prefabs": {"lantern": {"point_light": {"intensity": 5}, "spot_light": {"intensity": 1},
                          "children": [{"name": "flame", "point_light": {"intensity": 2}}]},
              "torch": {"children": [{"name": "spark", "point_light": {}}, {"name": "flame"}]}},
  "entities": [
    {"name": "street", "transform": {"position": [0, 0, 5]}, "children": [
      {"name": "post", "transform": {"position": [1, 2, 3]}, "children": [
        {"name": "arm", "children": [{"name": "lamp", "point_light": {"intensity": 3}}]}]},
      {"name": "other"}]},
    {"name": "left", "prefab": "lantern"},
    {"name": "right", "prefab": "lantern", "spot_light": {"intensity": 2}},
    {"name": "row", "repeat": {"count": [2, 1, 1]}, "spot_light": {}},
    {"name": "torch", "prefab": "torch"},
    {"name": "lamp 2", "point_light": {"intensity": 9}},
    {"transform": {"position": [0, 0, 1]}, "children": [{"name": "inner"}]},
    {"name": "box", "mesh_instance": {"mesh": "box", "material": "red"}},
    {"name": "eye", "camera": {}, "transform": {"position": [0, 1, 9]}}
  ]
})";

struct EditedLevelFile {
    test::TemporaryFolder folder;
    std::string path = folder.file("street.level.json");
    std::unique_ptr<Stage> stage;
    EditScript script;

    explicit EditedLevelFile(const std::string& text = kStreet) {
        REQUIRE(write_file(path, text).ok());
        REQUIRE(write_file(folder.file("leaf.effect.json"), R"({"prefabs": {"leaf": {}}})").ok());
        stage = open(path);
        script = EditScript({path, stage->scene.fields.entities});
    }

    static std::unique_ptr<Stage> open(const std::string& file) {
        Result<std::unique_ptr<Stage>> opened = open_stage(file);
        REQUIRE_MESSAGE(opened.ok(), (opened ? std::string() : opened.error().message));
        return *std::move(opened);
    }
    World& world() { return stage->world; }
    void run(std::string_view line) {
        const Result<std::string> done = script.run(world(), line);
        REQUIRE_MESSAGE(done.ok(), (done ? std::string() : done.error().message));
    }
    std::string error(std::string_view line) {
        CAPTURE(line);
        const Result<std::string> done = script.run(world(), line);
        REQUIRE_FALSE(done.ok());
        return done.error().message;
    }
    [[nodiscard]] EditedLevel save(std::span<const Edit> edits) {
        const Result<EditedLevel> saved = edited_level(
            path, folder.file("out.level.json"), world(), edits, stage->scene.fields.entities);
        REQUIRE_MESSAGE(saved.ok(), (saved ? std::string() : saved.error().message));
        return *saved;
    }
    [[nodiscard]] EditedLevel save() { return save(script.undo_stack().done()); }
};

Entity find(const World& world, std::string_view name) {
    Entity found;
    world.query<const Name>().each([&](Entity entity, const Name& one) {
        found = one.text == name && found.is_null() ? entity : found;
    });
    return found;
}

/// Every root with all that is below it, and what a level can set beside.
std::string describe(World& world) {
    std::string all;
    std::vector<std::string> roots;
    world.each_entity([&](Entity entity) {
        if (exists(world, entity) && parent_of(world, entity).is_null()) {
            roots.push_back(entity_as_json(world, entity));
        }
    });
    std::sort(roots.begin(), roots.end());
    for (const std::string& root : roots) {
        all += root + '\n';
    }
    for (const Material& material : world.resource<Assets>().materials) {
        all += component_as_json(world, component_info<Material>(), &material) + '\n';
    }
    return all
           + component_as_json(world, component_info<Exposure>(), world.find_resource<Exposure>());
}

constexpr const char* kEdits[] = {
    "set lamp.point_light.intensity = 20",
    "set exposure.ev = -1",
    "set materials.red.roughness = 0.25",
    "add post.spot_light",
    "remove right.spot_light",
    "set row[1].spot_light.intensity = 4",
    "cut arm",
    "paste other",
    "duplicate left",
    "set left 2.point_light.color = #ff8000",
    "copy lamp",
    "paste street",
    "cut post",
    "paste",
    "delete box",
};

}  // namespace

TEST_CASE(
    "edit script: what is saved loads as the world that was edited"
    * technique("engine.editor-inspector")) {
    EditedLevelFile level;
    const std::string before = describe(level.world());
    std::string last;
    for (const char* const line : kEdits) {
        CAPTURE(line);
        level.run(line);
        const EditedLevel saved = level.save();
        CHECK(saved.left_out.empty());
        const std::string file = level.folder.file("out.level.json");
        REQUIRE(write_file(file, saved.text).ok());
        const std::unique_ptr<Stage> reopened = EditedLevelFile::open(file);
        step_stage(*reopened);  // events destroy what was deleted
        step_stage(*level.stage);
        CHECK(describe(reopened->world) == describe(level.world()));
        last = saved.text;
    }
    CHECK(describe(level.world()) != before);
}

TEST_CASE(
    "edit script: whole entities are saved where they are in the end"
    * technique("engine.editor-inspector")) {
    const std::vector<std::vector<const char*>> scripts = {
        {"duplicate arm", "cut lamp 3"},
        {"duplicate arm", "cut lamp 3", "paste box", "delete arm 2"},
        {"cut lamp", "paste other", "delete other"},
        {"delete lamp 2", "duplicate lamp"},
        {"cut post", "paste other", "cut arm", "cut post", "paste arm"},
        {"duplicate box", "cut post", "paste box 2", "cut box 2", "paste other"},
        {"duplicate box", "cut box", "paste box 2", "delete box 2"},
        {"delete street"},
        {"cut arm", "delete street", "set lamp.point_light.intensity = 4"},
        {"duplicate left", "delete left", "duplicate left 2", "delete left 2"},
        {"set flame.point_light.intensity = 3", "undo"},
        {"remove row[1].spot_light"},
        {"set row[1].spot_light.intensity = 4", "remove row[0].spot_light"},
        {"set box.name.text = crate", "set crate.transform.scale = [2, 2, 2]"},
        {"set box.name.text = crate", "undo"},
        {"set box.name.text = crate", "delete crate"},
        {"set post.name.text = pole", "cut pole", "paste other", "duplicate arm"},
        {"set lamp.name.text = x", "set lamp 2.name.text = lamp", "set x.name.text = lamp 2"},
        {"delete box", "set other.name.text = box"},
        {"duplicate box", "set box 2.name.text = crate", "set box.name.text = box 2"},
        {"cut inner"},
        {"place lantern", "set lantern.point_light.intensity = 8", "cut lantern", "paste post"},
        {"place torch", "place torch", "set torch 3.transform.position = [1, 1, 1]"},
        {"place lantern", "undo", "place torch", "delete torch 2"},
        {"cut box", "paste inner", "set inner.transform.position = [1, 2, 3]"},
    };
    for (const std::vector<const char*>& script : scripts) {
        EditedLevelFile level;
        for (const char* const line : script) {
            level.run(line);
        }
        CAPTURE(std::string(script.back()));
        const EditedLevel saved = level.save();
        CHECK_MESSAGE(
            saved.left_out.empty(), (saved.left_out.empty() ? "" : saved.left_out.front()));
        const std::string file = level.folder.file("out.level.json");
        REQUIRE(write_file(file, saved.text).ok());
        const std::unique_ptr<Stage> reopened = EditedLevelFile::open(file);
        step_stage(*reopened);
        step_stage(*level.stage);
        CHECK(describe(reopened->world) == describe(level.world()));
    }
}

TEST_CASE(
    "edit script: edits of entities without a name are saved where they are"
    * technique("engine.editor-inspector")) {
    // The first two look the same in the file.
    EditedLevelFile level(R"({"entities": [
        {"transform": {"position": [0, 0, 1]}}, {"transform": {"position": [0, 0, 1]}},
        {"name": "post", "children": [{"point_light": {}}, {"children": [{"name": "inner"}]}]},
        {"name": "eye", "camera": {}}]})");
    World& world = level.world();
    const std::span<const Entity> spawned = level.stage->scene.fields.entities;
    UndoStack undo;
    const auto set = [&](Entity entity, AnyComponent after) {
        Edit edit;
        edit.entity = entity;
        edit.before = AnyComponent::read(world, entity, after.info());
        apply_edit_value(world, edit, after);
        edit.after = std::move(after);
        undo.record(edit);
    };
    const auto check = [&] {
        const EditedLevel saved = level.save(undo.done());
        CHECK_MESSAGE(
            saved.left_out.empty(), (saved.left_out.empty() ? "" : saved.left_out.front()));
        const std::string file = level.folder.file("out.level.json");
        REQUIRE(write_file(file, saved.text).ok());
        CHECK(describe(EditedLevelFile::open(file)->world) == describe(world));
    };
    REQUIRE(spawned.size() == 7);
    set(spawned[1], AnyComponent::of(Transform{.position = {3, 3, 3}}));
    set(spawned[3], AnyComponent::of(PointLight{.intensity = 7}));
    check();
    set(spawned[4], AnyComponent::of(Name{"middle"}));
    set(spawned[5], AnyComponent::of(Transform{.position = {1, 1, 1}}));
    check();
    SubtreeEditor subtrees;
    REQUIRE(subtrees.remove(world, undo, spawned[0]).ok());
    REQUIRE(subtrees.cut(world, undo, spawned[3]).ok());
    check();
}

TEST_CASE(
    "edit script: a new name is that in events, shows and fields, too"
    * technique("engine.editor-inspector")) {
    EditedLevelFile level(R"({
        "prefabs": {"watcher": {"orbit_camera": {"target": "box"}},
                    "lantern": {"children": [{"name": "flame"}]}},
        "entities": [
            {"name": "box"}, {"name": "flame"}, {"name": "watcher", "prefab": "watcher"},
            {"name": "row", "repeat": {"count": [2, 1, 1]}, "spot_light": {}},
            {"name": "eye", "camera": {}, "orbit_camera": {"target": "box"}}],
        "events": [{"at": 0, "set": {"box": {"transform": {"scale": [2, 2, 2]}},
                                     "row[1]": {"spot_light": {"intensity": 4}}}},
                   {"at": 5, "destroy": ["box"]}],
        "shows": [{"technique": "light.spot", "camera": "eye", "text": "light on a crate",
                   "set": {"entities": {"box": {"orbit_camera": {"target": "eye"}}}}}]})");
    level.run("set box.name.text = crate");
    level.run("set eye.name.text = view");
    level.run("set flame.name.text = fire");  // a lantern has one as well
    const EditedLevel saved = level.save();
    REQUIRE(saved.left_out.size() == 1);
    CHECK(saved.left_out[0].find("prefabs have entities of that name") != std::string::npos);
    CHECK(saved.text.find("\"box\"") == std::string::npos);
    CHECK(saved.text.find("\"eye\"") == std::string::npos);
    const std::string file = level.folder.file("out.level.json");
    REQUIRE(write_file(file, saved.text).ok());
    const std::unique_ptr<Stage> reopened = EditedLevelFile::open(file);
    step_stage(*reopened);
    step_stage(*level.stage);
    level.run("set fire.name.text = flame");
    CHECK(describe(reopened->world) == describe(level.world()));
}

TEST_CASE(
    "edit script: what is placed equals an instance in the level's file"
    * technique("engine.editor-inspector")) {
    const std::string level_text = R"({
        "include": ["leaf.effect.json"],
        "materials": {"red": {}}, "meshes": {"box": {"make": "box"}, "ball": {"make": "sphere"}},
        "prefabs": {"pair": {
            "mesh_instance": {"mesh": "ball", "material": "red"},
            "orbit_camera": {"target": "second"},
            "children": [{"name": "second", "mesh_instance": {"mesh": "box"}},
                         {"name": "far", "orbit_camera": {"target": "eye"}}]}},
        "entities": [{"name": "eye", "camera": {}})";
    EditedLevelFile level(level_text + "]}");
    EditedLevelFile other(
        level_text
        + R"(, {"name": "pair", "prefab": "pair"}, {"name": "leaf", "prefab": "leaf"}]})");
    level.run("place pair");
    level.run("place leaf");
    step_stage(*level.stage);  // orbits, as when a level is opened
    CHECK(describe(level.world()) == describe(other.world()));
    for (int i = 0; i < 2; ++i) {
        level.run("undo");
    }
    CHECK(find(level.world(), "second").is_null());
    // By the names of the file.
    level.run("set eye.name.text = view");
    level.run("place pair");
    CHECK(describe(level.world()).find(R"("target": "view")") != std::string::npos);
    level.script = EditScript();
    CHECK(level.error("place pair").find("expected one with prefabs") != std::string::npos);
}

TEST_CASE("edit script: one instance is placed of a prefab that is repeated") {
    for (const char* const count : {"6", "1"}) {
        EditedLevelFile level(
            R"({"prefabs": {"wisp": {"point_light": {}, "repeat": {"count": [)" + std::string(count)
            + R"(, 1, 1]}, "children": [{"name": "glow"}]}}, "entities": [{"name": "eye", "camera": {}}]})");
        const std::string before = describe(level.world());
        level.run("place wisp");
        CHECK_FALSE(find(level.world(), "wisp").is_null());
        CHECK(find(level.world(), "wisp[0]").is_null());
        CHECK(level.save().left_out.empty());
        level.run("undo");
        CHECK(describe(level.world()) == before);
    }
}

TEST_CASE("edit script: what is placed refers to the level's entities, not to inner ones") {
    EditedLevelFile level(R"({
        "prefabs": {"lantern": {"children": [{"name": "flame"}]},
                    "watcher": {"orbit_camera": {"target": "flame"}}},
        "entities": [{"name": "lantern", "prefab": "lantern"}, {"name": "flame"},
                     {"name": "eye", "camera": {}}]})");
    World& world = level.world();
    const Entity flame = level.stage->scene.fields.entities[2];
    REQUIRE(parent_of(world, flame).is_null());
    level.run("place watcher");
    CHECK(world.get<const OrbitCamera>(find(world, "watcher")).target == flame);
    CHECK(level.error("set flame.name.text = ember").find("found 2 entities") != std::string::npos);
}

TEST_CASE("edit script: what sways about its place does so where the inspector places it") {
    EditedLevelFile level(R"({"prefabs": {"bough": {"sway": {}, "repeat": {"count": [2, 1, 1]}}},
                              "entities": [{"name": "eye", "camera": {}}]})");
    World& world = level.world();
    const std::string before = describe(world);
    Inspector inspector;
    CHECK_FALSE(inspector.place(world, "bough", {1, 2, 3}).ends_with("placed"));
    inspector.reset({level.path, level.stage->scene.fields.entities});
    CHECK(inspector.take_placed().empty());
    CHECK(inspector.place(world, "bogh", {}).find("did you mean bough?") != std::string::npos);
    CHECK(inspector.place(world, "bough", {1, 2, 3}) == "bough: placed");
    const Entity bough = find(world, "bough");
    CHECK(inspector.selected() == bough);
    CHECK(world.value<Transform>(bough).position == Vec3(1, 2, 3));
    CHECK(world.value<Sway>(bough).center == Vec3(1, 2, 3));
    inspector.undo_stack().undo(world);
    CHECK(describe(world) == before);
}

TEST_CASE("edit script: a name that the file cannot have keeps nothing else from it") {
    EditedLevelFile level;
    level.run("add eye.orbit_camera");
    level.run("set eye.orbit_camera.target = row[0]");
    level.run("set row[0].name.text = gap");
    level.run("duplicate eye");
    level.run("duplicate box");
    level.run("set box 2.name.text = crate");
    level.run("set eye.orbit_camera.target = crate");
    const EditedLevel saved = level.save();
    REQUIRE(saved.left_out.size() == 1);
    CHECK(saved.left_out[0].starts_with("the new name of \"row[0]\""));
    CHECK(saved.text.find("\"eye 2\"") != std::string::npos);
    CHECK(saved.text.find(R"("target": "crate")") != std::string::npos);
}

TEST_CASE("edit script: a new name that would change what others refer to is left out") {
    struct Case {
        const char* level;
        std::vector<const char*> lines;
        const char* why;
    };
    const Case cases[] = {
        {R"("prefabs": {"lantern": {"orbit_camera": {"target": "box"},
                                    "children": [{"name": "flame"}]}},
            "entities": [{"name": "box"})",
         {"set box.name.text = flame"},
         "prefabs have entities called \"flame\""},
        {R"("entities": [{"name": "box"}, {"name": "other"})",
         {"delete box", "set other.name.text = box"},
         "the file refers to the deleted \"box\""},
        {R"("prefabs": {"fox": {"repeat": {"count": [1, 1, 1]}}},
            "entities": [{"name": "box"}, {"name": "row", "prefab": "fox"})",
         {"set row[0].name.text = gap"},
         "the level's file does not list it"}};
    for (const Case& one : cases) {
        CAPTURE(one.level);
        EditedLevelFile level(
            R"({"events": [{"at": 5, "destroy": ["box"]}], )" + std::string(one.level)
            + R"(, {"name": "eye", "camera": {}}]})");
        for (const char* const line : one.lines) {
            level.run(line);
        }
        const EditedLevel saved = level.save();
        REQUIRE(saved.left_out.size() == 1);
        CHECK(saved.left_out[0].find(one.why) != std::string::npos);
    }
}

TEST_CASE("edit script: two entities of a file with one name keep it") {
    EditedLevelFile level(R"({"prefabs": {"post": {"spin": {}}}, "entities": [
        {"name": "a", "prefab": "post", "children": [{"name": "sign"}]},
        {"name": "b", "prefab": "post", "children": [{"name": "sign"}]},
        {"name": "eye", "camera": {}}]})");
    UndoStack undo;
    Edit edit;
    edit.entity = level.stage->scene.fields.entities[1];
    edit.before = AnyComponent::of(Name{"sign"});
    edit.after = AnyComponent::of(Name{"board"});
    apply_edit_value(level.world(), edit, edit.after);
    undo.record(edit);
    const EditedLevel saved = level.save(undo.done());
    REQUIRE(saved.left_out.size() == 1);
    CHECK(saved.left_out[0].find("other entities have that name") != std::string::npos);
    CHECK(saved.text.find("board") == std::string::npos);
}

TEST_CASE("edit script: a file that was written since is not taken for the level") {
    EditedLevelFile level(R"({"entities": [
        {"name": "first"}, {"name": "second"}, {"name": "eye", "camera": {}}]})");
    level.run("set first.transform.scale = [2, 2, 2]");
    REQUIRE(write_file(level.path, R"({"entities": [{"name": "second"}, {"name": "first"},
                                                     {"name": "eye", "camera": {}}]})")
                .ok());
    const std::string file = level.folder.file("out.level.json");
    REQUIRE(write_file(file, level.save().text).ok());
    const std::unique_ptr<Stage> reopened = EditedLevelFile::open(file);
    const World& world = reopened->world;
    CHECK(world.value<Transform>(find(world, "first")).scale == Vec3(2));
}

TEST_CASE("edit script: what is deleted and referred to is destroyed at the start") {
    EditedLevelFile level(R"({"entities": [
        {"name": "box", "children": [{"name": "lid"}]},
        {"name": "eye", "camera": {}, "orbit_camera": {"target": "box"}}]})");
    level.run("delete box");
    const std::string text = level.save().text;
    CHECK(text.find(R"("destroy": ["box"])") != std::string::npos);
    CHECK(text.find(R"("name": "lid")") != std::string::npos);
}

TEST_CASE("edit script: where an edit cannot be saved, all others are, and it is named") {
    const std::pair<const char*, const char*> lines[] = {
        {"cut spark", "the move of \"spark\""},
        {"delete spark", "the deletion of \"spark\""},
        {"set flame.transform.position = [1, 1, 1]", ""},
        {"set spark.name.text = ember", "the new name of \"spark\""},
        {"set row[0].name.text = gap", "the new name of \"row[0]\""}};
    for (const auto& [edit, left_out] : lines) {
        const char* const line = edit;
        CAPTURE(line);
        EditedLevelFile level;
        level.run("set lamp.point_light.intensity = 20");
        level.run(line);
        const EditedLevel saved = level.save();
        CHECK(saved.text.find("\"intensity\": 20") != std::string::npos);
        if (*left_out != '\0') {
            REQUIRE(!saved.left_out.empty());
            CHECK(saved.left_out.front().starts_with(left_out));
        }
    }
    EditedLevelFile level;
    for (const char* const line :
         {"copy lamp", "paste spark", "cut box", "paste spark", "add box.point_light",
          "set box.transform.position = [9, 9, 9]"}) {
        level.run(line);
    }
    const EditedLevel saved = level.save();
    REQUIRE(saved.left_out.size() == 2);
    CHECK(saved.left_out[0].starts_with("\"lamp 3\", whose parent is \"spark\""));
    CHECK(saved.left_out[1].starts_with("the move of \"box\""));
    const std::string file = level.folder.file("out.level.json");
    REQUIRE(write_file(file, saved.text).ok());
    const std::unique_ptr<Stage> reopened = EditedLevelFile::open(file);
    const Entity box = find(reopened->world, "box");
    CHECK(parent_of(reopened->world, box).is_null());
    CHECK(reopened->world.has<PointLight>(box));
    // A place relative to the parent that it did not get would be wrong.
    CHECK(reopened->world.value<Transform>(box).position == Vec3(0));
}

TEST_CASE("edit script: the first of two thousand edits is saved, too") {
    EditedLevelFile level;
    level.run("set box.transform.scale = [2, 2, 2]");
    for (int i = 0; i < 2000; ++i) {
        level.run(i % 2 == 0 ? "set exposure.ev = 2" : "set exposure.ev = 3");
    }
    CHECK(level.save().text.find("\"scale\": [2, 2, 2]") != std::string::npos);
}

TEST_CASE(
    "edit script: undo of any edit restores the saved text"
    * technique("engine.editor-inspector")) {
    EditedLevelFile level;
    std::vector<std::string> texts = {level.save().text};
    for (const char* const line : kEdits) {
        const std::size_t edits = level.script.undo_stack().undo_count();
        level.run(line);
        if (level.script.undo_stack().undo_count() > edits) {
            texts.push_back(level.save().text);
        }
    }
    REQUIRE(texts.size() > 12);
    for (std::size_t i = texts.size() - 1; i-- > 0;) {
        level.run("undo");
        CHECK(level.save().text == texts[i]);
    }
    CHECK(level.error("undo").find("nothing to undo") != std::string::npos);
    for (std::size_t i = 1; i < texts.size(); ++i) {
        level.run("redo");
        CHECK(level.save().text == texts[i]);
    }
}

TEST_CASE("edit script: the inspector saves the same file" * technique("engine.editor-inspector")) {
    EditedLevelFile by_script;
    EditedLevelFile by_hand;
    for (const char* const line :
         {"set lamp.point_light.intensity = 20", "duplicate left", "cut arm", "paste other",
          "delete box"}) {
        by_script.run(line);
    }
    World& world = by_hand.world();
    Inspector inspector;
    UndoStack& undo = inspector.undo_stack();
    const auto run = [&](const char* name, Inspector::TreeCommand command) {
        inspector.select(find(world, name));
        inspector.run(world, command);
    };
    Edit edit;  // as a widget does
    edit.entity = find(world, "lamp");
    edit.before = AnyComponent::of(world.value<PointLight>(edit.entity));
    PointLight brighter = world.value<PointLight>(edit.entity);
    brighter.intensity = 20;
    std::string last;
    record_edit(world, undo, edit, AnyComponent::of(brighter), "lamp: point_light.intensity", last);
    run("left", Inspector::TreeCommand::Duplicate);
    run("arm", Inspector::TreeCommand::Cut);
    run("other", Inspector::TreeCommand::Paste);
    run("box", Inspector::TreeCommand::Delete);
    CHECK(by_hand.save(undo.done()).text == by_script.save().text);
    CHECK(inspector.edit_count() == 5);
    inspector.note_saved();
    CHECK(inspector.edit_count() == 0);
    undo.undo(world);
    CHECK(inspector.edit_count() > 0);
}

TEST_CASE("edit script: what cannot be done is one line, and changes nothing") {
    EditedLevelFile level;
    const std::string before = describe(level.world());
    CHECK(level.error("sett a.b = 1").find("did you mean set?") != std::string::npos);
    CHECK(level.error("set lamp.point_light.intensity").find("found no =") != std::string::npos);
    CHECK(
        level.error("set lamp.point_light.intensity = -1").find("intensity") != std::string::npos);
    CHECK(level.error("cut lampp").find("did you mean lamp?") != std::string::npos);
    CHECK(level.error("cut flame").find("found 3 entities named \"flame\"") != std::string::npos);
    CHECK(level.error("paste lamp").find("nothing was cut or copied") != std::string::npos);
    CHECK(
        level.error("add lamp.point_light").find("expected an entity without it")
        != std::string::npos);
    CHECK(
        level.error("remove lamp.spot_light").find("expected an entity with it")
        != std::string::npos);
    CHECK(level.error("add lamp.spotlight").find("did you mean spot_light?") != std::string::npos);
    CHECK(level.error("add lamp").find("expected NAME.COMPONENT") != std::string::npos);
    CHECK(level.error("set lamp.parent.entity = lamp").find("cut and paste") != std::string::npos);
    CHECK(level.error("remove lamp.parent").find("cut and paste") != std::string::npos);
    CHECK(level.error("set lamp.name.text = box").find("a second \"box\"") != std::string::npos);
    CHECK(level.error("set lamp.name.text = a.b").find("without . [ ]") != std::string::npos);
    CHECK(level.error("set lamp.name.text = \"\"").find("found the name") != std::string::npos);
    CHECK(level.error("remove lamp.name").find("a new one") != std::string::npos);
    CHECK(level.error("place lanter").find("did you mean lantern?") != std::string::npos);
    CHECK(level.error("redo").find("nothing to redo") != std::string::npos);
    level.run("copy street");
    CHECK_FALSE(level.error("set street.transform.scale = [0, 0, 0]").empty());
    level.run("  # a comment");
    level.run("");
    CHECK(describe(level.world()) == before);
    CHECK(level.script.undo_stack().undo_count() == 0);
}

TEST_CASE("edit script: a cut parent is not pasted below its own child") {
    EditedLevelFile level;
    level.run("cut post");
    const std::string before = describe(level.world());
    CHECK_FALSE(level.error("paste lamp").empty());
    CHECK(describe(level.world()) == before);
}

TEST_CASE("edit save: the file beside it that does not exist yet") {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("a.level.json");
    CHECK(new_edited_path(path) == folder.file("a-edited.level.json"));
    REQUIRE(write_file(folder.file("a-edited.level.json"), "{}").ok());
    CHECK(new_edited_path(path) == folder.file("a-edited-2.level.json"));
    CHECK(
        new_edited_path(folder.file("a-edited.level.json"))
        == folder.file("a-edited-2.level.json"));
    REQUIRE(write_file(folder.file("a-edited-2.level.json"), "{}").ok());
    CHECK(
        new_edited_path(folder.file("a-edited-2.level.json"))
        == folder.file("a-edited-3.level.json"));
    CHECK(
        new_edited_path(folder.file("un-edited-one.level.json"))
        == folder.file("un-edited-one-edited.level.json"));
}

TEST_CASE("edit save: a level with files stays in its folder; a model is no level") {
    EditedLevelFile level(
        R"({"include": ["leaf.effect.json"], "entities": [{"name": "a", "prefab": "leaf"}]})");
    level.run("set exposure.ev = 2");
    const auto save = [&](const std::string& path, const std::string& out) {
        const Result<EditedLevel> saved = edited_level(
            path, out, level.world(), level.script.undo_stack().done(),
            level.stage->scene.fields.entities);
        return saved ? saved->text : saved.error().message;
    };
    CHECK(
        save(level.path, level.folder.file("b.level.json")).find("\"ev\": 2") != std::string::npos);
    const test::TemporaryFolder other;
    CHECK(
        save(level.path, other.file("b.level.json")).find("refers to \"leaf.effect.json\"")
        != std::string::npos);
    CHECK(
        save("fox.glb", other.file("b.level.json")).find("expected a level") != std::string::npos);
}

TEST_CASE("edit save: what a level cannot say is named") {
    std::string text = kStreet;
    const std::string row = R"("name": "row", )";
    text.insert(text.find(row) + row.size(), R"("children": [{"transform": {}}], )");
    EditedLevelFile level(text);
    World& world = level.world();
    Entity part;
    // Copies by repeat are no entities of the file.
    Edit edit;
    edit.entity = find(world, "row[0]");
    edit.label = "row[0]: move";
    edit.after = AnyComponent::of(Parent{find(world, "other")});
    UndoStack undo;
    apply_edit_value(world, edit, edit.after);
    undo.record(edit);
    world.resource<Assets>().materials.emplace_back().name = "of a file";
    Edit material;
    material.part = LevelPart::Material;
    material.material = static_cast<std::uint32_t>(world.resource<Assets>().materials.size() - 1);
    material.before = AnyComponent::of(world.resource<Assets>().materials.back());
    Material rough = world.resource<Assets>().materials.back();
    rough.roughness = 0.9f;
    material.after = AnyComponent::of(rough);
    apply_edit_value(world, material, material.after);
    undo.record(material);
    const auto set = [&](Entity entity, AnyComponent after) {
        Edit change;
        change.entity = entity;
        change.before = AnyComponent::read(world, entity, after.info());
        apply_edit_value(world, change, after);
        change.after = std::move(after);
        undo.record(change);
    };
    set(find(world, "box"), AnyComponent::of(Name{"lamp"}));  // a second one
    world.query<const Parent>().each([&](Entity entity, const Parent& parent) {
        const Name* const above = world.find<Name>(parent.entity);
        if (above != nullptr && above->text == "row[0]") {
            part = entity;
        }
    });
    set(part, AnyComponent::of(Transform{.position = {3, 3, 3}}));
    const EditedLevel saved = level.save(undo.done());
    std::string all;
    for (const std::string& what : saved.left_out) {
        all += what + '\n';
    }
    CHECK(all.find("the move of \"row[0]\"") != std::string::npos);
    CHECK(all.find("the material \"of a file\"") != std::string::npos);
    CHECK(all.find("edits of children of copies") != std::string::npos);
    CHECK(all.find("the new name of \"box\"") != std::string::npos);
}

}  // namespace limn::edit_script_test
