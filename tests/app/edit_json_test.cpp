#include "content/app/commands/stage.h"
#include "content/app/panels/edit_json.h"
#include "content/load/files/json_document.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/particles.h"
#include "ecs/components/post.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "tests/app/run_program.h"
#include "tests/content/gltf_samples.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace limn::edit_json_test {
namespace {

constexpr const char* kLevel = R"({
  "title": "A lamp",
  "resources": {"exposure": {"ev": 1}},
  "materials": {"red": {"base_color": [0.8, 0.1, 0.05]}},
  "meshes": {"box": {"make": "box"}},
  "entities": [
    {"name": "lamp", "transform": {"position": [1, 2, 3]}, "point_light": {"intensity": 5}},
    {"name": "box", "mesh_instance": {"mesh": "box", "material": "red"}},
    {"name": "eye", "camera": {}}
  ]
})";

/// A bulb with a light, and a nameless triangle.
constexpr const char* kLamp = R"({
  "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 7}]},
                 "KHR_materials_variants": {"variants": [{"name": "red"}]}},
  "scene": 0, "scenes": [{"nodes": [0, 1]}],
  "nodes": [
    {"name": "Bulb.001", "translation": [1, 2, 3], "scale": [2, 2, 2], "mesh": 0,
     "extensions": {"KHR_lights_punctual": {"light": 0}}},
    {"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "bufferView": 0}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
                              R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]
})";

struct OpenLevel {
    test::TemporaryFolder folder;
    std::unique_ptr<Stage> stage;

    /// `text` is a.level.json; `scene` is opened.
    explicit OpenLevel(
        const std::string& text = kLevel, const std::string& scene = "a.level.json") {
        test::write_text(folder.file("lamp.gltf"), kLamp);
        test::write_text(folder.file("a.level.json"), text);
        const std::vector<std::byte> lantern = test::square_glb();
        test::write_text(
            folder.file("lantern.glb"),
            {reinterpret_cast<const char*>(lantern.data()), lantern.size()});
        Result<std::unique_ptr<Stage>> opened = open_stage(folder.file(scene));
        REQUIRE_MESSAGE(opened.ok(), (opened ? std::string() : opened.error().message));
        stage = *std::move(opened);
    }
    World& world() { return stage->world; }
    Entity find(const std::string& name) {
        Entity found;
        world().query<const Name>().each(
            [&](Entity entity, const Name& one) { found = one.text == name ? entity : found; });
        return found;
    }
};

}  // namespace

TEST_CASE(
    "edit_json: a copied entity, pasted into a level, is the same entity"
    * technique("engine.object-text")) {
    OpenLevel level;
    const std::string text = entity_as_json(level.world(), level.find("lamp"));
    const std::string pasted = std::string(R"({"title": "B", "entities": [)") + text
                               + R"(, {"name": "eye", "camera": {}}]})";
    OpenLevel other(pasted);
    const Entity lamp = other.find("lamp");
    REQUIRE(other.world().alive(lamp));
    CHECK(other.world().get<const PointLight>(lamp).intensity == 5.0f);
    CHECK(other.world().get<const Transform>(lamp).position == Vec3(1, 2, 3));
    CHECK(entity_as_json(other.world(), lamp) == text);
}

TEST_CASE("edit_json: a copied entity keeps its children when pasted into a level") {
    OpenLevel level(R"({
      "prefabs": {
        "bulb": {"point_light": {"intensity": 7}, "children": [{"name": "glow"}]},
        "pair": {"children": [
          {"name": "glow", "particle_emitter": {}, "particle_look": {}},
          {"particle_emitter": {}, "particle_look": {}, "particle_source": {"emitter": "glow"}}]}},
      "meshes": {"box": {"make": "box"}},
      "entities": [
        {"name": "post", "transform": {"position": [1, 0, 0]}, "children": [
          {"name": "arm", "mesh_instance": {"mesh": "box"}, "children": [
            {"name": "first", "prefab": "bulb", "transform": {"position": [0, 2, 0]}},
            {"name": "second", "prefab": "bulb"}, {"name": "last", "prefab": "pair"}]},
          {"name": "lantern", "gltf": "lamp.gltf"}]},
        {"name": "eye", "camera": {}}
      ]
    })");
    const std::string text = entity_as_json(level.world(), level.find("post"));
    OpenLevel other(
        R"({"meshes": {"box": {"make": "box"}}, "entities": [)" + text
        + R"(, {"name": "eye", "camera": {}}]})");
    World& world = other.world();
    CHECK(parent_of(world, other.find("second")) == other.find("arm"));
    CHECK(parent_of(world, other.find("arm")) == other.find("post"));
    CHECK(world.get<const PointLight>(other.find("second")).intensity == 7);
    CHECK(world.get<const Transform>(other.find("first")).position == Vec3(0, 2, 0));
    world.query<const ParticleSource>().each([&](const ParticleSource& source) {
        CHECK(source.emitter == other.find("glow 3"));
        CHECK(world.has<ParticleEmitter>(source.emitter));
    });
    CHECK(parent_of(world, other.find("Bulb.001")) == other.find("lantern"));
    CHECK(world.entity_count() == level.world().entity_count());
    CHECK(entity_as_json(world, other.find("post")) == text);
}

TEST_CASE("edit_json: a copy refers to its glTF file, and has rotations in degrees") {
    OpenLevel level(R"({
      "title": "A lantern",
      "entities": [
        {"name": "lantern", "gltf": "lantern.glb", "transform": {"rotation": [30, -20, 45]}},
        {"name": "eye", "camera": {}}
      ]
    })");
    const Entity lantern = level.find("lantern");
    const std::string text = entity_as_json(level.world(), lantern);
    const Result<JsonValue> json = parse_json(text, "copy");
    REQUIRE(json.ok());
    CHECK((*json)["gltf"].text == "lantern.glb");
    CHECK(write_json((*json)["transform"]["rotation"]) == "[30, -20, 45]");
    CHECK(json->find("gltf_source") == nullptr);
    // No angles of three decimals give these bits.
    level.world().get<Transform>(lantern).rotation = glm::normalize(Quat(0.9f, 0.1f, 0.2f, 0.3f));
    const Result<JsonValue> other = parse_json(entity_as_json(level.world(), lantern), "copy");
    CHECK((*other)["transform"]["rotation"].items.size() == 3);
}

TEST_CASE("edit_json: a copied node of a glTF file, pasted into a level, changes that node") {
    const char* const kLamps = R"({"entities": [
        {"name": "lamps", "children": [{"name": "left", "gltf": "lamp.gltf", "variant": "red"}]},
        {"name": "eye", "camera": {}}]})";
    OpenLevel level(kLamps);
    const Entity bulb = level.find("Bulb.001");
    level.world().get<PointLight>(bulb).intensity = 40;
    level.world().get<Transform>(bulb).scale = Vec3(1);  // the file has 2
    const std::string text = entity_as_json(level.world(), bulb);
    const Result<JsonValue> json = parse_json(text, "copy");
    REQUIRE_MESSAGE(json.ok(), text);
    CHECK((*json)["name"].text == "left");
    CHECK((*json)["gltf"].text == "lamp.gltf");
    CHECK((*json)["variant"].text == "red");
    CHECK(json->members.size() == 4);
    CHECK((*json)["nodes"]["Bulb.001"].find("mesh_instance") == nullptr);
    OpenLevel other(R"({"entities": [)" + text + R"(, {"name": "eye", "camera": {}}]})");
    const Entity pasted = other.find("Bulb.001");
    CHECK(other.world().get<const PointLight>(pasted).intensity == 40);
    CHECK(other.world().get<const Transform>(pasted).scale == Vec3(1));
    CHECK(other.world().get<const Transform>(pasted).position == Vec3(1, 2, 3));
    CHECK(entity_as_json(other.world(), pasted) == text);
}

TEST_CASE("edit_json: a node of a file opened directly names the file; an unnamed node says so") {
    OpenLevel lamp(kLevel, "lamp.gltf");
    const auto json_of_entity = [&](Entity entity) {
        const std::string text = entity_as_json(lamp.world(), entity);
        const Result<JsonValue> json = parse_json(text, "copy");
        REQUIRE_MESSAGE(json.ok(), text);
        CHECK((*json)["gltf"].text == "lamp.gltf");
        CHECK(json->find("name") == nullptr);
        return std::pair(*json, text);
    };
    const JsonValue bulb = json_of_entity(lamp.find("Bulb.001")).first;
    CHECK(bulb["nodes"]["Bulb.001"]["transform"].kind == JsonKind::Object);
    Entity nameless;
    lamp.world().query<const MeshInstance, Without<Name>>().each(
        [&](Entity entity, const MeshInstance&) { nameless = entity; });
    const auto [json, text] = json_of_entity(nameless);
    CHECK(json.members.size() == 1);
    CHECK(text.find("// unnamed node") != std::string::npos);
}

TEST_CASE("edit_json: an edit of a node of a glTF file is a change of nodes") {
    OpenLevel level(R"({"entities": [{"name": "left", "gltf": "lamp.gltf"},
                                     {"name": "eye", "camera": {}}]})");
    World& world = level.world();
    Edit change;
    change.part = LevelPart::Component;
    change.entity = level.find("Bulb.001");
    const ComponentInfo& light = component_info<PointLight>();
    change.before = AnyComponent::read(world, change.entity, light);
    PointLight brighter = world.get<const PointLight>(change.entity);
    brighter.intensity = 30;
    change.after = AnyComponent(light, &brighter);
    REQUIRE(apply_edit_value(world, change, change.after));
    const std::vector<Edit> edits = {change};
    CHECK(
        write_json(*parse_json(edits_as_json(world, edits), ""))
        == R"({"entities": [{"name": "left", "nodes": {"Bulb.001": {"point_light": {"intensity": 30}}}}]})");
}

TEST_CASE("edit_json: edits of children and of copies survive being pasted into the level") {
    const std::string prefabs = R"("prefabs": {"lamp": {"children": [
        {"name": "bulb", "point_light": {"intensity": 5, "radius": 7}}]}})";
    const auto level_text = [&](const std::string& nodes, const std::string& events) {
        return "{" + prefabs + R"(, "entities": [{"name": "left", "prefab": "lamp")" + nodes
               + R"(}, {"name": "post", "transform": {},
                    "repeat": {"count": [3, 1, 1], "spacing": [2, 0, 0]}},
                   {"name": "row", "prefab": "lamp", "repeat": {"count": [2, 1, 1]}},
                   {"name": "eye", "camera": {}}], "events": )"
               + events + "}";
    };
    OpenLevel level(level_text("", "[]"));
    World& world = level.world();
    std::vector<Edit> edits;
    const auto edit = [&](Entity entity, const ComponentInfo& info, auto change) {
        Edit one;
        one.entity = entity;
        one.before = AnyComponent::read(world, entity, info);
        one.after = one.before;
        change(one.after);
        REQUIRE(apply_edit_value(world, one, one.after));
        edits.push_back(std::move(one));
    };
    const auto brighten = [](AnyComponent& light) { light.as<PointLight>().intensity = 30; };
    Entity bulb;
    Entity other;
    world.query<const Name, const Parent>().each(
        [&](Entity entity, const Name& name, const Parent& parent) {
            if (name.text == "bulb") {
                (parent.entity == level.find("left") ? bulb : other) = entity;
            }
        });
    edit(bulb, component_info<PointLight>(), brighten);
    edit(level.find("post[2]"), component_info<Transform>(), [](AnyComponent& transform) {
        transform.as<Transform>().position = {1, 2, 3};
    });
    const Result<JsonValue> patch = parse_json(edits_as_json(world, edits), "patch");
    REQUIRE(patch.ok());
    const JsonValue& left = (*patch)["entities"].items.at(0);
    CHECK(left["name"].text == "left");
    OpenLevel pasted(
        level_text(R"(, "nodes": )" + write_json(left["nodes"]), write_json((*patch)["events"])));
    advance_stage(*pasted.stage, 0.1);
    CHECK(pasted.world().get<const Transform>(pasted.find("post[2]")).position == Vec3(1, 2, 3));
    std::vector<float> lights;
    pasted.world().query<const PointLight>().each([&](const PointLight& light) {
        CHECK(light.radius == 7);
        lights.push_back(light.intensity);
    });
    std::sort(lights.begin(), lights.end());
    CHECK(lights == std::vector<float>{5, 5, 30});  // that of `left`, not those of the copies

    // A child of a copy is reported as left out.
    edit(other, component_info<PointLight>(), brighten);
    CHECK(edits_as_json(world, edits).find("// without edits of children") != std::string::npos);
}

TEST_CASE("edit_json: a note warns of entities whose edits cannot be copied") {
    OpenLevel level(R"({
      "prefabs": {"lamp": {"children": [{"name": "bulb", "point_light": {}}, {"transform": {}}]}},
      "entities": [
        {"name": "single", "prefab": "lamp"},
        {"name": "row", "prefab": "lamp", "repeat": {"count": [3, 1, 1]}},
        {"name": "other", "repeat": {"count": [5, 1, 1]}},
        {"name": "yard", "children": [{"name": "post", "repeat": {"count": [2, 1, 1]}}]},
        {"name": "eye", "camera": {}}
      ]
    })");
    World& world = level.world();
    const auto child_of = [&](const char* name, std::size_t index) {
        return children_of(world, level.find(name))[index];
    };
    const auto is_kept = [&](Entity entity) {
        Edit edit;
        edit.entity = entity;
        edit.before = AnyComponent::read(world, entity, component_info<Transform>());
        edit.after = edit.before;
        edit.after.as<Transform>().scale = Vec3(2);
        REQUIRE(apply_edit_value(world, edit, edit.after));
        return edits_as_json(world, std::vector{edit}).find("scale") != std::string::npos;
    };
    const auto cannot = [](const std::string& note) {
        return note.find("cannot be copied") != std::string::npos;
    };
    for (const Entity kept : {level.find("single"), child_of("single", 0)}) {
        CHECK(edit_note(world, kept).empty());
        CHECK(is_kept(kept));
    }
    CHECK(edit_note(world, child_of("single", 1)).starts_with("has no name"));
    CHECK_FALSE(is_kept(child_of("single", 1)));
    const std::string copy = edit_note(world, level.find("row[1]"));
    CHECK(copy.starts_with("one of 3 copies of row by repeat: its edits are copied as an event"));
    CHECK(is_kept(level.find("row[1]")));
    const std::string part = edit_note(world, child_of("row[1]", 0));
    CHECK(part.starts_with("part of one of 3 copies of row by repeat"));
    for (const Entity lost : {child_of("row[1]", 0), child_of("row[1]", 1), child_of("yard", 0)}) {
        CHECK(cannot(edit_note(world, lost)));
        CHECK_FALSE(is_kept(lost));
    }
}

TEST_CASE("edit_json: a child beside the nodes of a glTF file is changed where it is written") {
    OpenLevel level(R"({"prefabs": {"torch": {"children": [{"name": "flame", "point_light": {}}]}},
      "entities": [{"name": "house", "gltf": "lamp.gltf",
        "children": [{"name": "door torch", "prefab": "torch"}]}, {"name": "eye", "camera": {}}]})");
    World& world = level.world();
    Edit dark;
    dark.entity = level.find("flame");
    dark.before = AnyComponent::read(world, dark.entity, component_info<PointLight>());
    dark.after = dark.before;
    dark.after.as<PointLight>().intensity = 0;
    REQUIRE(apply_edit_value(world, dark, dark.after));
    const std::vector<Edit> edits = {dark};
    CHECK(
        write_json(*parse_json(edits_as_json(world, edits), ""))
        == R"({"entities": [{"name": "door torch", "nodes": {"flame": {"point_light": {"intensity": 0}}}}]})");
}

TEST_CASE("edit_json: edits are a patch with the current values; removed components are null") {
    OpenLevel level;
    World& world = level.world();
    const Entity lamp = level.find("lamp");
    UndoStack undo;
    const auto edit = [&](LevelPart kind, Entity entity, AnyComponent before, AnyComponent after) {
        Edit change;
        change.part = kind;
        change.entity = entity;
        change.before = std::move(before);
        change.after = std::move(after);
        REQUIRE(apply_edit_value(world, change, change.after));
        undo.record(std::move(change));
    };
    const ComponentInfo& light = component_info<PointLight>();
    PointLight brighter = world.get<const PointLight>(lamp);
    for (const float intensity : {20.0f, 30.0f}) {
        const AnyComponent before = AnyComponent::read(world, lamp, light);
        brighter.intensity = intensity;
        edit(LevelPart::Component, lamp, before, AnyComponent(light, &brighter));
    }
    Exposure exposure = world.resource<Exposure>();
    const AnyComponent before(component_info<Exposure>(), &exposure);
    exposure.ev = -2;
    edit(LevelPart::Resource, {}, before, AnyComponent(component_info<Exposure>(), &exposure));
    edit(
        LevelPart::Component, level.find("box"),
        AnyComponent::read(world, level.find("box"), component_info<MeshInstance>()), {});
    const Result<JsonValue> patch = parse_json(edits_as_json(world, undo.done()), "patch");
    REQUIRE(patch.ok());
    const JsonValue& entities = (*patch)["entities"];
    REQUIRE(entities.items.size() == 2);
    CHECK(
        write_json(entities.items[0]["point_light"])
        == write_json(*parse_json(R"({"intensity": 30})", "")));
    CHECK(entities.items[0]["name"].text == "lamp");
    CHECK(entities.items[1]["name"].text == "box");
    CHECK(entities.items[1].members.size() == 2);
    CHECK(entities.items[1]["mesh_instance"].kind == JsonKind::Null);
    CHECK((*patch)["resources"]["exposure"].members.size() == 1);
    CHECK((*patch)["resources"]["exposure"]["ev"].number == -2.0);
}

}  // namespace limn::edit_json_test
