// What a level says that has no effect, or not the one that its author expects.

#include "content/load/level_load.h"
#include "content/load/scene_warnings.h"
#include "ecs/base/log.h"
#include "ecs/components/all.h"
#include "ecs/world.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>
#include <vector>

using namespace limn;

namespace {

std::vector<std::string> warnings_of(std::string_view text) {
    register_all_components();
    Result<Level> level = parse_level(text, "t.level.json");
    REQUIRE_MESSAGE(level.ok(), (level ? std::string() : level.error().message));
    World world;
    (void)spawn_level(world, *std::move(level));
    return find_scene_warnings(world);
}

using Warnings = std::vector<std::string>;

std::vector<std::string> logged;

}  // namespace

TEST_CASE("scene warnings: keyframes whose times do not increase") {
    CHECK(warnings_of(R"({"entities": [{"name": "eye", "camera": {},
        "camera_path": {"keys": [{"time": 0}, {"time": 1}, {"time": 2}]}}]})")
              .empty());
    CHECK(
        warnings_of(R"({"entities": [{"name": "eye", "camera": {},
        "camera_path": {"keys": [{"time": 0}, {"time": 2}, {"time": 1}]}}]})")
        == Warnings{"entity \"eye\": camera_path.keys[2].time is 1 s, not after the key before it "
                    "(2 s)"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "pot",
        "rotation_track": {"keys": [{"time": 1}, {"time": 1}]}}]})")
        == Warnings{"entity \"pot\": rotation_track.keys[1].time is 1 s, not after the key before "
                    "it (1 s)"});
}

TEST_CASE("scene warnings: components that do nothing without another") {
    CHECK(
        warnings_of(R"({"entities": [{"name": "eye", "camera": {}, "autofocus": {}}]})")
        == Warnings{"entity \"eye\": autofocus has no effect without lens"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "eye", "camera_path": {"keys": [{}]}}]})")
        == Warnings{"entity \"eye\": camera_path has no effect without camera"});
}

TEST_CASE("scene warnings: a resolution that is rounded, with its field") {
    CHECK(
        warnings_of(R"({"entities": [{"name": "lamp", "spot_light": {},
        "shadow": {"resolution": 700}}]})")
        == Warnings{"entity \"lamp\": shadow.resolution 700 is rounded to the power of two 1024"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "sea", "water": {}, "ocean": {"resolution": 100}}]})")
        == Warnings{"entity \"sea\": ocean.resolution 100 is rounded to the power of two 64"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "hall", "env_probe": {"resolution": 100}}]})")
        == Warnings{"entity \"hall\": env_probe.resolution 100 is rounded to the power of two 64"});
}

TEST_CASE("scene warnings: events on a component that the entity lacks") {
    const auto with = [](const char* components, const char* action) {
        return fmt::format(
            R"({{"entities": [{{"name": "box"{}}}],
                "events": [{{"at": 1, "{}": {{"box": {{"spin": {{"speed": 2}}}}}}}}]}})",
            components, action);
    };
    CHECK(warnings_of(with(R"(, "spin": {})", "set")).empty());
    CHECK(
        warnings_of(with("", "set"))
        == Warnings{"events[0]: entity \"box\" has no spin; the event adds it, with defaults"});
    CHECK(
        warnings_of(with("", "impulse"))
        == Warnings{"events[0]: entity \"box\" has no spin; the event does nothing"});
}

TEST_CASE("scene warnings: state that systems keep, written by hand") {
    register_all_components();
    logged.clear();
    set_log_sink([](LogLevel, std::string_view message) { logged.emplace_back(message); });
    CHECK(parse_level(R"({"entities": [{"name": "a", "world_transform": {}}]})", "t.level.json")
              .ok());
    set_log_sink(nullptr);
    REQUIRE(logged.size() == 1);
    CHECK(
        logged[0]
        == "t.level.json:1:29: entity \"a\": systems keep world_transform and overwrite "
           "what is written here");
}
