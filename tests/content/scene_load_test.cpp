// Scenes of any kind of file, with what every scene needs.

#include "content/load/scene_load.h"
#include "ecs/components/camera.h"
#include "ecs/components/environment.h"
#include "ecs/components/script.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "tests/near.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace limn::scene_load_test {

TEST_CASE("level: files are found below its own folder, and glTF files share their meshes") {
    const std::optional<std::string> fox = test::shared_asset("gltf/Fox.glb");
    if (!fox) {
        return;
    }
    const test::TemporaryFolder folder;
    std::filesystem::copy_file(*fox, folder.file("fox.glb"));
    std::ofstream(folder.file("zoo.level.json"))
        << R"({"entities": [{"gltf": "fox.glb"}, {"gltf": "fox.glb", "transform": {"position": [9, 0, 0]}}]})";
    World world;
    const Result<LoadedScene> scene = load_scene(world, folder.file("zoo.level.json"));
    REQUIRE_MESSAGE(scene.ok(), (scene.ok() ? "" : scene.error().message));
    CHECK(scene->name == "zoo");
    CHECK(world.resource<Assets>().meshes.size() == 1);
    CHECK(world.query<const MeshInstance>().count() == 2);
}

TEST_CASE("scene: a glTF alone is framed and lit") {
    const std::optional<std::string> fox = test::shared_asset("gltf/Fox.glb");
    if (!fox) {
        return;
    }
    World world;
    const Result<LoadedScene> scene = load_scene(world, *fox);
    REQUIRE_MESSAGE(scene.ok(), (scene.ok() ? "" : scene.error().message));
    CHECK(scene->name == "Fox");
    REQUIRE(scene->model);
    CHECK(scene->camera == scene->model->camera);
    CHECK(world.alive(scene->camera));
    CHECK(center(scene->model->subject) == center(scene->bounds));
}

TEST_CASE("scene: seed and missing resources are filled in") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("bare.level.json")) << R"({"title": "Bare"})";
    World world;
    const Result<LoadedScene> scene =
        load_scene(world, folder.file("bare.level.json"), {.seed = 77});
    REQUIRE(scene.ok());
    CHECK(scene->title == "Bare");
    CHECK(world.alive(scene->camera));
    CHECK(world.resource<RandomSeed>().seed == 77);
    CHECK(world.find_resource<Assets>() != nullptr);
    CHECK(world.find_resource<EventList>() != nullptr);
    CHECK(is_empty(scene->bounds));
}

TEST_CASE("scene: bounds follow the hierarchy") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("b.level.json")) << R"({
        "materials": {"m": {}}, "meshes": {"box": {"make": "box"}},
        "entities": [{"transform": {"position": [10, 0, 0], "scale": [2, 2, 2]}, "children": [
            {"transform": {"position": [1, 0, 0]}, "mesh_instance": {"mesh": "box", "material": "m"}}]}]})";
    World world;
    const Result<LoadedScene> scene = load_scene(world, folder.file("b.level.json"));
    REQUIRE(scene.ok());
    CHECK(scene->bounds.min.x == test::near(11.0f));
    CHECK(scene->bounds.max.x == test::near(13.0f));
}

}  // namespace limn::scene_load_test
