#include "content/load/level/level_load.h"
#include "content/load/level/level_update.h"
#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/post.h"
#include "ecs/components/script.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace limn::level_update_test {
namespace {

/// A level with two sparks of an included file, one of them at another rate.
struct Playing {
    Playing() {
        register_all_components();
        write_effect(R"({"prefabs": {"spark": {"particle_emitter": {"rate": 10, "speed": 2}}}})");
        write_level("");
        Result<Level> level = load_level(path());
        REQUIRE_MESSAGE(level.ok(), (level ? "" : level.error().message));
        fields = remember_fields(*level, path());
        fields.entities = spawn_level(world, *std::move(level));
    }
    void write_effect(const std::string& text) const {
        std::ofstream(folder.path() + "/a.effect.json") << text;
    }
    void write_level(const std::string& more) const {
        std::ofstream(path()) << R"({"include": ["a.effect.json"], "entities": [
            {"name": "one", "prefab": "spark", "transform": {"position": [1, 0, 0]}},
            {"name": "two", "prefab": "spark", "particle_emitter": {"rate": 99},
             "particle_source": {"emitter": "one"}})"
                              << more << "]}";
    }
    [[nodiscard]] std::string path() const { return folder.path() + "/t.level.json"; }
    [[nodiscard]] std::string update() {
        const Result<std::vector<LevelChange>> updated = update_level(world, fields);
        return updated ? std::to_string(updated->size())
                       : updated.error().message.substr(folder.path().size() + 1);
    }
    [[nodiscard]] const ParticleEmitter& emitter(std::size_t i) const {
        return world.get<const ParticleEmitter>(fields.entities[i]);
    }

    test::TemporaryFolder folder;
    World world;
    LevelFields fields;
};

}  // namespace

TEST_CASE("level update: changes of an included file are applied to the running level") {
    Playing level;
    const Entity one = level.fields.entities[0];
    // What has happened since then stays: a place, particles.
    level.world.get<Transform>(one).position = {5, 6, 7};
    ParticlePool pool;
    pool.clock.born = 42;
    level.world.add(one, pool);
    CHECK(level.update() == "0");
    level.write_effect(R"({"prefabs": {"spark": {"particle_emitter": {"rate": 30, "speed": 3}}}})");
    CHECK(level.update() == "2");
    CHECK(level.emitter(0).rate == 30);
    CHECK(level.emitter(0).speed == 3);
    CHECK(level.emitter(1).rate == 99);  // its own
    CHECK(level.emitter(1).speed == 3);
    CHECK(level.world.get<const Transform>(one).position == Vec3(5, 6, 7));
    CHECK(level.world.get<const ParticlePool>(one).clock.born == 42);
    CHECK(level.update() == "0");
    // What an event destroyed is left out.
    level.world.destroy(one);
    level.write_effect(R"({"prefabs": {"spark": {"particle_emitter": {"rate": 31, "speed": 4}}}})");
    CHECK(level.update() == "1");
}

TEST_CASE("level update: fields of resources, materials and components are updated individually") {
    Playing level;
    const auto write = [&](const char* ev, const char* color, const char* place) {
        std::ofstream(level.path())
            << R"({"resources": {"exposure": {)" << ev
            << R"(}}, "materials": {"m": {"roughness": 0.3)" << color
            << R"(}}, "entities": [{"name": "one", "transform": {)" << place << "}}]}";
    };
    write("", "", "");
    World world;
    Result<Level> loaded = load_level(level.path());
    REQUIRE(loaded.ok());
    LevelFields fields = remember_fields(*loaded, level.path());
    fields.entities = spawn_level(world, *std::move(loaded));
    const Entity one = fields.entities[0];
    // Edits that the file does not have.
    world.get<Transform>(one).scale = {2, 2, 2};
    world.resource<Exposure>().key = 0.5f;
    world.resource<Assets>().materials[0].metalness = 0.9f;
    const std::uint64_t version = world.resource<Assets>().material_version;
    CHECK(update_level(world, fields)->empty());
    CHECK(world.resource<Assets>().material_version == version);
    write(R"("ev": 2)", R"(, "base_color": [1, 0, 0])", R"("position": [1, 2, 3])");
    const Result<std::vector<LevelChange>> changes = update_level(world, fields);
    REQUIRE(changes.ok());
    CHECK(changes->size() == 3);
    CHECK(world.get<const Transform>(one).position == Vec3(1, 2, 3));
    CHECK(world.get<const Transform>(one).scale == Vec3(2, 2, 2));
    CHECK(world.resource<Exposure>().ev == 2);
    CHECK(world.resource<Exposure>().key == 0.5f);
    const Material& material = world.resource<Assets>().materials[0];
    CHECK(material.base_color == Vec4(1, 0, 0, 1));
    CHECK(material.metalness == 0.9f);
    CHECK(world.resource<Assets>().material_version > version);
    // What is taken out of the file is as by default.
    write("", "", "");
    CHECK(update_level(world, fields)->size() == 3);
    CHECK(world.resource<Exposure>().ev == Exposure{}.ev);
    CHECK(world.get<const Transform>(one).position == Vec3(0));
}

TEST_CASE("level update: what a new event sets at the start is applied to a running level") {
    Playing level;
    const auto write = [&](const std::string& events) {
        std::ofstream(level.path())
            << R"({"entities": [{"name": "row", "repeat": {"count": [2, 1, 1]}}], "events": [)"
            << events << "]}";
    };
    write("");
    World world;
    Result<Level> loaded = load_level(level.path());
    REQUIRE(loaded.ok());
    LevelFields fields = remember_fields(*loaded, level.path());
    fields.entities = spawn_level(world, *std::move(loaded));
    const Entity copy = fields.entities[1];
    const Vec3 place = world.get<const Transform>(copy).position;
    const std::string first =
        R"({"at": 0, "set": {"row[1]": {"transform": {"scale": [2, 2, 2]}}}})";
    write(first);
    const Result<std::vector<LevelChange>> changes = update_level(world, fields);
    REQUIRE(changes.ok());
    REQUIRE(changes->size() == 1);
    CHECK((*changes)[0].entity == copy);
    CHECK((*changes)[0].fields.size() == 1);
    CHECK(world.get<const Transform>(copy).scale == Vec3(2));
    CHECK(world.get<const Transform>(copy).position == place);
    // It is not set again, and a later one waits.
    world.get<Transform>(copy).scale = Vec3(5);
    write(first + R"(, {"at": 7, "set": {"row[1]": {"transform": {"scale": [3, 3, 3]}}}})");
    CHECK(update_level(world, fields)->empty());
    CHECK(world.get<const Transform>(copy).scale == Vec3(5));
    CHECK(world.resource<EventList>().events.size() == 2);
}

TEST_CASE("level update: names of entities resolve to the spawned ones") {
    Playing level;
    std::ofstream(level.path()) << R"({"include": ["a.effect.json"], "entities": [
            {"name": "one", "prefab": "spark", "transform": {"position": [1, 0, 0]}},
            {"name": "two", "prefab": "spark", "particle_emitter": {"rate": 99},
             "particle_source": {"emitter": "one", "count": 7}}]})";
    CHECK(level.update() == "1");
    const auto& source = level.world.get<const ParticleSource>(level.fields.entities[1]);
    CHECK(source.count == 7);
    CHECK(source.emitter == level.fields.entities[0]);
}

TEST_CASE("level update: a broken file is reported with its line, and changes nothing") {
    Playing level;
    level.write_effect("{\"prefabs\":\n {\"spark\": {\"particle_emitter\": {\"rate\": -4}}}}");
    CHECK(level.update().starts_with("a.effect.json:2:"));
    level.write_effect("{\"prefabs\":\n {\"spark\": ");
    CHECK(level.update().starts_with("a.effect.json:2:"));
    CHECK(level.emitter(0).rate == 10);
    // As soon as it is right again, it counts.
    level.write_effect(R"({"prefabs": {"spark": {"particle_emitter": {"rate": 20, "speed": 2}}}})");
    CHECK(level.update() == "1");
    CHECK(level.emitter(0).rate == 20);
}

TEST_CASE("level update: added or removed entities, components or assets need a reload") {
    Playing level;
    const std::string refusal =
        "t.level.json: entities or components were added or removed: reload the level";
    level.write_level(R"(, {"name": "three"})");
    CHECK(level.update() == refusal);
    level.write_level("");
    CHECK(level.update() == "0");
    level.write_effect(
        R"({"prefabs": {"spark": {"particle_emitter": {"rate": 11}, "particle_motion": {}}}})");
    CHECK(level.update() == refusal);
    level.write_effect(
        R"({"materials": {"m": {}}, "prefabs": {"spark": {"particle_emitter": {"rate": 11}}}})");
    CHECK(level.update() == "t.level.json: \"m\" was added: reload the level");
    CHECK(level.emitter(0).rate == 10);
}

TEST_CASE("level update: another component that events remove at the start needs a reload") {
    Playing level;
    const std::string start = R"(], "events": [{"at": )";
    const std::string rest = R"(, "set": {"one": {"particle_emitter": null}}})";
    level.write_level(start + "0" + rest);
    CHECK(
        level.update()
        == "t.level.json: events at the start remove other components: reload the level");
    level.write_level(start + "3" + rest);
    CHECK(level.update() == "0");
}

TEST_CASE("level update: events spawn what the updated files define") {
    Playing level;
    level.write_level("");
    std::ofstream(level.path()) << R"({"include": ["a.effect.json"], "entities": [
            {"name": "one", "prefab": "spark", "transform": {"position": [1, 0, 0]}},
            {"name": "two", "prefab": "spark", "particle_emitter": {"rate": 99},
             "particle_source": {"emitter": "one"}}],
            "events": [{"at": 1, "destroy": ["two"]}]})";
    CHECK(level.update() == "0");
    const auto& events = std::as_const(level.world).resource<EventList>().events;
    REQUIRE(events.size() == 1);
    REQUIRE(events[0].actions.size() == 1);
    CHECK(events[0].actions[0].entity == level.fields.entities[1]);
}

}  // namespace limn::level_update_test
