// Text into the level loader, without a file system: whatever it is, there is a level that can be
// spawned, or a few lines. Meshes and images are not made, so that small texts stay quick.

#include "content/load/level/level_load.h"
#include "content/load/level/set_value.h"
#include "ecs/component_bytes.h"
#include "ecs/components/all.h"
#include "ecs/components/camera_path.h"
#include "ecs/world.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

const limn::LevelLimits kLimits = {
    .json = {.max_bytes = 1 << 16, .max_values = 1 << 13, .max_depth = 32},
    .entities = {.max_entities = 500, .max_values = 1 << 14, .max_depth = 32},
    .max_vertices = 0,
    .max_pixels = 0,
    .gltf = {},
};

void require(bool condition) {
    if (!condition) {
        std::abort();
    }
}

/// What everybody who gets a level relies on.
void check_level(const limn::Level& level) {
    const std::size_t count = level.entities.entities.size();
    require(count <= kLimits.entities.max_entities);
    for (const limn::PrefabEntity& entity : level.entities.entities) {
        for (const limn::AnyComponent& component : entity.components) {
            limn::AnyComponent copy = component;
            require(limn::validate_fields(copy.info(), copy.data()).ok());
            limn::for_each_entity(copy.info().fields, copy.data(), [&](limn::Entity& reference) {
                require(reference.is_null() || reference.index < count);
            });
        }
    }
}

void check_world(limn::World& world) {
    world.query<const limn::CameraPath>().each([](const limn::CameraPath& path) {
        for (const double time : {0.0, 0.7, 1e5}) {
            const limn::CameraPose pose = limn::camera_pose(path, time);
            require(!std::isnan(pose.rotation.w));
        }
    });
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    limn::register_all_components();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    limn::Result<limn::Level> level = limn::parse_level(text, "fuzz.level.json", kLimits);
    if (!level) {
        const std::string& message = level.error().message;
        require(std::count(message.begin(), message.end(), '\n') <= 10);
        return 0;
    }
    check_level(*level);
    limn::World world;
    level->meshes.clear();
    level->gltfs.clear();
    (void)limn::spawn_level(world, *std::move(level));
    check_world(world);
    // The same bytes as an assignment.
    const std::size_t half = size / 2;
    (void)limn::set_value(world, text.substr(0, half), text.substr(half)).ok();
    return 0;
}
