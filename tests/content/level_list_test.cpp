#include "content/game/game.h"
#include "content/load/level_list.h"
#include "content/load/scene_load.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/world.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace limn;

TEST_CASE("levels: every level of the project loads, is named and has a camera that moves or that "
          "keys place") {
    register_game_components();
    const std::vector<LevelEntry> levels = list_levels();
    for (const LevelEntry& entry : levels) {
        CAPTURE(entry.name);
        CHECK_FALSE(entry.title.empty());
        World world;
        const Result<LoadedScene> scene = load_scene(world, entry.name);
        REQUIRE_MESSAGE(scene.ok(), (scene.ok() ? "" : scene.error().message));
        CHECK(scene->name == entry.name);
        CHECK(scene->title == entry.title);
        const bool on_a_path =
            world.find<CameraPath>(scene->camera) != nullptr && scene->duration > 0.0;
        const auto* const orbit = world.find<OrbitCamera>(scene->camera);
        const bool after_something = orbit != nullptr && world.alive(orbit->target);
        const bool placed_by_keys = entry.name == "phonglab";
        const bool stands_still = entry.name == "relax";  // to compare two times by eye
        CHECK((on_a_path || after_something || placed_by_keys || stands_still));
    }
}

TEST_CASE("levels: a name that is none names the nearest") {
    const Result<std::string> path = find_level("galery");
    REQUIRE_FALSE(path.ok());
    CHECK(path.error().message.find("(did you mean gallery?)") != std::string::npos);
}
