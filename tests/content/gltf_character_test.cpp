#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_spawn.h"
#include "content/load/level/level_load.h"
#include "content/load/level/set_value.h"
#include "content/load/scene_load.h"
#include "ecs/components/all.h"
#include "ecs/components/name.h"
#include "ecs/components/time.h"
#include "ecs/hierarchy.h"
#include "systems/update_world.h"
#include "tests/content/gltf_samples.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <fstream>

namespace limn::gltf_character_test {

using namespace limn::test;

namespace {

/// A puppet: joints hip > knee, a skinned and morphed body, a lamp and a stick (no joint) on the
/// knee; clips "nod" of the joints and "grin" of the morph target.
std::string puppet_json(const Numbers& numbers, const std::string& knee_extras) {
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, {},
        "meshes": [
            {{"name": "body", "primitives": [{{
                "attributes": {{"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}},
                "targets": [{{"POSITION": 0}}]}}]}},
            {{"name": "stick", "primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "skins": [{{"name": "cloth", "joints": [1, 2]}}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {{"KHR_lights_punctual": {{"lights": [{{"type": "point"}}]}}}},
        "nodes": [
            {{"name": "body", "mesh": 0, "skin": 0, "translation": [50, 0, 0]}},
            {{"name": "hip", "children": [2], "translation": [0, 1, 0]}},
            {{"name": "knee", "children": [3, 4], "translation": [0, 1, 0]{}}},
            {{"name": "stick", "mesh": 1, "translation": [0.5, 0, 0]}},
            {{"name": "toe", "translation": [0, 0.25, 0],
              "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}],
        "scenes": [{{"nodes": [0, 1]}}],
        "animations": [
            {{"name": "nod",
              "channels": [{{"sampler": 0, "target": {{"node": 1, "path": "translation"}}}},
                           {{"sampler": 0, "target": {{"node": 4, "path": "translation"}}}}],
              "samplers": [{{"input": 3, "output": 4}}]}},
            {{"name": "grin",
              "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "weights"}}}}],
              "samplers": [{{"input": 3, "output": 5}}]}}]}})",
        numbers.json(), knee_extras);
}

std::vector<std::byte> puppet_glb(const std::string& knee_extras = "") {
    Numbers numbers;
    numbers.add("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
    numbers.add_typed<std::uint8_t>("VEC4", 4, 5121, false, {0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    numbers.add("VEC4", 4, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    numbers.add("SCALAR", 1, {0, 1});
    numbers.add("VEC3", 3, {0, 1, 0, 0, 3, 0});
    numbers.add("SCALAR", 1, {0, 1});
    return make_glb(puppet_json(numbers, knee_extras), numbers.bytes());
}

GltfScene load_puppet(const std::string& knee_extras = "") {
    register_all_components();
    Result<GltfScene> scene = parse_gltf(puppet_glb(knee_extras), "puppet.glb", "");
    REQUIRE_MESSAGE(scene.ok(), scene.error().message);
    CHECK(scene->warnings.empty());
    return *std::move(scene);
}

Entity find_named(World& world, std::string_view name, Entity below = {}) {
    Entity found;
    world.query<const Name>().each([&](Entity entity, const Name& candidate) {
        const bool is_below = below.is_null() || parent_of(world, entity) == below;
        found = candidate.text == name && is_below ? entity : found;
    });
    return found;
}

Vec3 world_position(World& world, Entity entity) {
    return transform_point(world.get<const WorldTransform>(entity).world, Vec3(0));
}

/// A level of its own folder with the puppet in it.
class PuppetLevel {
  public:
    PuppetLevel() {
        register_all_components();
        const std::vector<std::byte> bytes = puppet_glb();
        std::ofstream file(folder_.file("puppet.glb"), std::ios::binary);
        file.write(
            reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
    }
    Result<LoadedScene> load(World& world, const std::string& text) const {
        const std::string path = folder_.file("stage.level.json");
        std::ofstream(path) << text;
        return load_scene(world, path);
    }

  private:
    TemporaryFolder folder_;
};

}  // namespace

TEST_CASE("gltf character: a file with joints spawns one character with its clip and weights") {
    World world;
    Assets& assets = world.insert_resource(Assets{});
    assets.clips.resize(2);
    assets.skeletons.resize(1);
    assets.skins.resize(3);
    assets.meshes.resize(4);
    const std::vector<Entity> roots = spawn_gltf(world, assets, load_puppet()).roots;
    REQUIRE(roots.size() == 1);
    const Entity puppet = roots[0];
    CHECK(world.get<const Name>(puppet).text == "puppet");
    CHECK(world.get<const Skeleton>(puppet).skeleton.index == 1);
    CHECK(world.get<const ClipPlayer>(puppet).clip.index == 2);
    CHECK(world.get<const MorphWeights>(puppet).weights == std::vector<float>{0});

    // Joints become entities only where something hangs on them.
    CHECK(find_named(world, "hip").is_null());
    const Entity knee = find_named(world, "knee");
    const Entity toe = find_named(world, "toe");
    REQUIRE_FALSE(knee.is_null());
    REQUIRE_FALSE(toe.is_null());
    CHECK(world.get<const JointAttachment>(knee).character == puppet);
    CHECK(parent_of(world, knee) == puppet);
    CHECK(world.has<PointLight>(toe));
    CHECK(world.has<JointAttachment>(toe));
    const Entity stick = find_named(world, "stick");
    CHECK(parent_of(world, stick) == knee);
    CHECK_FALSE(world.has<JointAttachment>(stick));
    CHECK_FALSE(world.has<Deformed>(stick));

    // The node of a skinned mesh does not move it.
    const Entity body = find_named(world, "body.skin");
    REQUIRE_FALSE(body.is_null());
    CHECK(parent_of(world, body) == puppet);
    CHECK(world.get<const Transform>(body).position == Vec3(0));
    const auto& deformed = world.get<const Deformed>(body);
    CHECK(deformed.character == puppet);
    CHECK(deformed.skin.index == 3);
    CHECK(deformed.first_morph == 0);
    CHECK(world.get<const MeshInstance>(body).mesh.index == 4);
}

TEST_CASE("gltf character: what hangs on a joint moves with the clip from the first frame on") {
    World world;
    Assets& assets = world.insert_resource(Assets{});
    (void)spawn_gltf(world, assets, load_puppet());
    world.insert_resource(FrameTime{.step = 0.5f});
    start_world(world);
    const Entity stick = find_named(world, "stick");
    CHECK(glm::distance(world_position(world, stick), Vec3(0.5f, 2, 0)) < 1e-6f);
    Schedule schedule = make_world_schedule();
    step_world(world, schedule);
    CHECK(glm::distance(world_position(world, stick), Vec3(0.5f, 3, 0)) < 1e-6f);
    // The toe's own keys: 0, 1 .. 3 above the knee, which is 1 above the hip.
    CHECK(glm::distance(world_position(world, find_named(world, "toe")), Vec3(0, 5, 0)) < 1e-6f);
}

TEST_CASE("gltf character: joints at rest are where the camera is to look") {
    const GltfScene scene = load_puppet();
    // One vertex on the hip, 1 up, two on the knee, 2 up; the stick beside the knee.
    const Bounds bounds = find_bounds(scene);
    CHECK(bounds.min == Vec3(0, 1, 0));
    CHECK(bounds.max == Vec3(1.5f, 3, 0));
}

TEST_CASE("gltf character: clip_player in extras.limn of a joint is the character's") {
    World world;
    Assets& assets = world.insert_resource(Assets{});
    const std::string extras =
        R"(, "extras": {"limn": {"clip_player": {"clip": "grin", "speed": 2}}})";
    const Entity puppet = spawn_gltf(world, assets, load_puppet(extras)).roots[0];
    CHECK(world.get<const ClipPlayer>(puppet).clip.index == 1);
    CHECK(world.get<const ClipPlayer>(puppet).speed == 2);
    CHECK(find_named(world, "knee").is_null() == false);  // for the stick
    const Result<GltfScene> wrong = parse_gltf(
        puppet_glb(R"(, "extras": {"limn": {"clip_player": {"clip": "gris"}}})"), "puppet.glb", "");
    REQUIRE_FALSE(wrong.ok());
    CHECK(wrong.error().message.find("did you mean grin?") != std::string::npos);
}

TEST_CASE("gltf character: a level chooses the clip by name on the entity that has the file") {
    const PuppetLevel level;
    World world;
    const Result<LoadedScene> scene = level.load(world, R"({"entities": [
        {"name": "first", "gltf": "puppet.glb"},
        {"name": "second", "gltf": "puppet.glb", "transform": {"position": [7, 0, 0]},
         "clip_player": {"clip": "grin", "time": 0.25}},
        {"name": "third", "gltf": "puppet.glb", "clip_player": {"speed": 0}}],
        "events": [{"at": 0.5, "set": {"first": {"clip_player": {"clip": "grin"}}}}]})");
    REQUIRE_MESSAGE(scene.ok(), scene.error().message);
    const Entity first = find_named(world, "first");
    const Entity second = find_named(world, "second");
    const Entity third = find_named(world, "third");
    CHECK(world.get<const ClipPlayer>(first).clip.index == 0);
    CHECK(world.get<const ClipPlayer>(second).clip.index == 1);
    CHECK(world.get<const ClipPlayer>(second).time == 0.25f);
    CHECK(world.get<const ClipPlayer>(third).clip.index == 0);
    CHECK(world.get<const ClipPlayer>(third).speed == 0);
    for (const Entity puppet : {first, second, third}) {
        CHECK(world.get<const Skeleton>(puppet).skeleton.index == 0);
        CHECK(world.get<const MorphWeights>(puppet).weights.size() == 1);
        const Entity body = find_named(world, "body.skin", puppet);
        REQUIRE_FALSE(body.is_null());
        CHECK(world.get<const Deformed>(body).character == puppet);
        CHECK(
            world.get<const JointAttachment>(find_named(world, "knee", puppet)).character
            == puppet);
    }
    CHECK(world.resource<Assets>().clips.size() == 2);
    start_world(world);
    Schedule schedule = make_world_schedule();
    for (int i = 0; i < 40; ++i) {
        step_world(world, schedule);
    }
    CHECK(world.get<const ClipPlayer>(first).clip.index == 1);
    CHECK(world.get<const MorphWeights>(second).weights[0] > 0.25f);
    CHECK(
        glm::distance(world_position(world, find_named(world, "knee", second)), Vec3(7, 2, 0))
        < 1e-5f);
}

TEST_CASE(
    "gltf character: a clip that nobody has is refused with the entity and the nearest name") {
    const PuppetLevel level;
    World world;
    const Result<LoadedScene> scene = level.load(
        world,
        R"({"entities": [{"name": "puppet", "gltf": "puppet.glb", "clip_player": {"clip": "nid"}}]})");
    REQUIRE_FALSE(scene.ok());
    CHECK(
        scene.error().message.find(
            R"(entity "puppet": clip_player: found the clip "nid", expected one of nod, grin )"
            R"((did you mean nod?))")
        != std::string::npos);
}

TEST_CASE("gltf character: --set and the names of a world know skeletons, skins and clips") {
    World world;
    Assets& assets = world.insert_resource(Assets{});
    const Entity puppet = spawn_gltf(world, assets, load_puppet()).roots[0];
    const Status set = set_value(world, "puppet.clip_player.clip", "grin");
    REQUIRE_MESSAGE(set.ok(), set.error().message);
    CHECK(world.get<const ClipPlayer>(puppet).clip.index == 1);
    const NameResolver names = make_name_resolver(world);
    CHECK(names.asset("skeleton", "puppet", {}) == std::optional<std::uint32_t>(0));
    CHECK(names.asset("skin", "cloth", {}) == std::optional<std::uint32_t>(0));
    CHECK(make_name_provider(world).asset("clip", 1) == "grin");
    CHECK_FALSE(set_value(world, "puppet.clip_player.clip", "grim").ok());
}

TEST_CASE("gltf character: in a level, what names no character follows the one it is on or below") {
    register_all_components();
    const Result<Level> level = parse_level(
        R"({"entities": [
            {"morph_weights": {"weights": [1]}, "deformed": {}, "children": [
                {"children": [{"deformed": {"first_morph": 2}}]}]},
            {"deformed": {}},
            {"name": "far", "deformed": {"character": "near"}},
            {"name": "near", "morph_weights": {}}]})",
        "stage.level.json");
    REQUIRE_MESSAGE(level.ok(), level.error().message);
    const auto character = [&](std::size_t entity) {
        for (const AnyComponent& component : level->entities.entities[entity].components) {
            if (&component.info() == &component_info<Deformed>()) {
                return component.as<Deformed>().character;
            }
        }
        return prefab_entity(99);
    };
    CHECK(character(0) == prefab_entity(0));
    CHECK(character(2) == prefab_entity(0));
    CHECK(character(3).is_null());
    CHECK(character(4) == prefab_entity(5));
}

}  // namespace limn::gltf_character_test
