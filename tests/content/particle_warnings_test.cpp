// Particles from what cannot give any: one line for each, and nothing is lost.

#include "content/load/level/level_load.h"
#include "content/load/level/particle_warnings.h"
#include "ecs/components/all.h"
#include "ecs/components/name.h"
#include "ecs/components/particle_surface.h"
#include "ecs/components/particles.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limn::particle_warnings_test {
namespace {

using Lines = std::vector<std::string>;

Lines warnings_of(std::string_view text) {
    register_all_components();
    Result<Level> level = parse_level(text, "t.level.json");
    REQUIRE_MESSAGE(level.ok(), (level ? std::string() : level.error().message));
    World world;
    (void)spawn_level(world, *std::move(level));
    Lines lines;
    for (const SceneWarning& warning : find_scene_warnings(world)) {
        lines.push_back(warning.text);
    }
    return lines;
}

std::string error_of(const char* emitter) {
    register_all_components();
    const std::string text = fmt::format(
        R"({{"entities": [{{"name": "fire", "particle_look": {{}}, "particle_emitter": {{{}}}}}]}})",
        emitter);
    const Result<Level> level = parse_level(text, "t.level.json");
    REQUIRE_FALSE(level.ok());
    return level.error().message;
}

/// Of an emitter with these components beside it.
Lines warnings_beside(const char* components, const char* emitter = "") {
    return warnings_of(fmt::format(
        R"({{"entities": [{{"name": "fire", "particle_look": {{}}, "particle_emitter": {{{}}}{}}}]}})",
        emitter, components));
}

}  // namespace

TEST_CASE("bad emitter: rates, lifetimes and capacities that are refused, with what is expected") {
    const auto has = [](const std::string& message, std::string_view part) {
        CAPTURE(message);
        return message.find(part) != std::string::npos;
    };
    CHECK(has(
        error_of(R"("rate": -5)"),
        R"(t.level.json:1:82: entity "fire": particle_emitter.rate: found the number -5, expected a number 0 .. 10000000 1/s)"));
    CHECK(has(error_of(R"("rate": NaN)"), R"(t.level.json:1:82: found "N", expected a value)"));
    CHECK(has(error_of(R"("rate": 1e9)"), "found the number 1e9, expected a number 0 .. 10000000"));
    CHECK(has(error_of(R"("rate": 1e999)"), "t.level.json:1:82: "));
    CHECK(has(error_of(R"("life": -1)"), "found the number -1, expected a number 0 .. 100000 s"));
    CHECK(
        has(error_of(R"("capacity": 1000000000)"),
            "found the number 1000000000, expected an integer 0 .. 4194304"));
    CHECK(has(error_of(R"("capacity": 1.5)"), "expected an integer 0 .. 4194304"));
    CHECK(
        has(error_of(R"("rate_curve": [{"at": 1.5}])"), "rate_curve[0].at: found the number 1.5"));
}

TEST_CASE("bad emitter: a capacity or lifetime of zero is reported") {
    CHECK(warnings_beside("").empty());
    CHECK(
        warnings_beside("", R"("capacity": 0)")
        == Lines{R"(entity "fire": particle_emitter.capacity is 0: it emits nothing)"});
    CHECK(
        warnings_beside("", R"("life": 0, "life_spread": 0)")
        == Lines{R"(entity "fire": particle_emitter.life is 0 s: nothing is visible)"});
    CHECK(warnings_beside("", R"("life": 0)").empty());  // give or take half a second
}

TEST_CASE("bad emitter: a source that is itself, by itself or through others") {
    CHECK(
        warnings_beside(R"(, "particle_source": {"emitter": "fire"})")
        == Lines{R"(entity "fire": particle_source names itself: it emits nothing)"});
    CHECK(
        warnings_of(R"({"entities": [
            {"name": "a", "particle_look": {}, "particle_emitter": {}, "particle_source": {"emitter": "b"}},
            {"name": "b", "particle_look": {}, "particle_emitter": {}, "particle_source": {"emitter": "a"}},
            {"name": "c", "particle_look": {}, "particle_emitter": {}, "particle_source": {"emitter": "a"}}]})")
        == Lines{
            R"(entity "a": particle_source is part of a cycle: it emits nothing)",
            R"(entity "b": particle_source is part of a cycle: it emits nothing)"});
}

TEST_CASE("bad emitter: a flipbook with more frames than its image has pixels") {
    const auto of_image = [](std::uint32_t columns, std::uint32_t rows) {
        World world;
        ImageData& image = world.insert_resource(Assets{}).images.emplace_back();
        image.width = 16;
        image.height = 8;
        ParticleLook look;
        look.image = {0};
        look.columns = columns;
        look.rows = rows;
        world.create(Name{"fire"}, ParticleEmitter{}, ParticleLook(look));
        Lines lines;
        std::vector<SceneWarning> found;
        find_particle_warnings(world, found);
        for (const SceneWarning& warning : found) {
            lines.push_back(warning.text);
        }
        return lines;
    };
    CHECK(of_image(16, 8).empty());
    CHECK(
        of_image(17, 4)
        == Lines{R"(entity "fire": particle_look has 17 x 4 frames in an image of 16 x 8 pixels)"});
    CHECK(of_image(4, 64).size() == 1);
}

TEST_CASE("bad emitter: a mesh without triangles") {
    for (const char* const beside :
         {R"(, "particle_surface": {"on": "mesh"})", R"(, "particle_surface": {"on": "volume"})"}) {
        CHECK(
            warnings_beside(beside)
            == Lines{
                R"(entity "fire": particle_surface on a mesh needs an entity with mesh_instance)"});
    }
    World world;
    world.insert_resource(Assets{}).meshes.emplace_back();
    world.create(
        ParticleEmitter{}, ParticleLook{}, Transform{}, MeshInstance{.mesh = {0}, .material = {}},
        ParticleSurface{});
    std::vector<SceneWarning> found;
    find_particle_warnings(world, found);
    REQUIRE(found.size() == 1);
    CHECK(found[0].text.ends_with(
        "particle_surface is on a mesh without triangles: it emits nothing"));
}

TEST_CASE("bad emitter: dropped particles are reported with the limit to raise") {
    World world;
    ParticlePool pool;
    ParticleEmitter emitter;
    emitter.capacity = 78;
    world.create(Name{"fire"}, ParticleEmitter(emitter), ParticlePool(pool));
    CHECK(find_dropped_births(world).empty());
    pool.clock.dropped = 5;
    world.create(Name{"smoke"}, ParticleEmitter(emitter), ParticlePool(pool));
    const std::vector<SceneWarning> found = find_dropped_births(world);
    REQUIRE(found.size() == 1);
    CHECK(
        found[0].text
        == R"(entity "smoke": 5 new particles were dropped; particle_emitter.capacity is 78)");
}

}  // namespace limn::particle_warnings_test
